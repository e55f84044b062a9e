// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems for the solvers' tests: whole on every rank as a recipe, added by parts as a model would.
#pragma once
#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "base/comm.hpp"
#include "base/math.hpp"
#include "linear/kkt.hpp"

namespace hilo::test {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Cliques of global blocks (-1: none), each with the rank that adds it; flexible blocks come first, then dense ones.
struct Problem {
  int n_flexible = 0, n_dense = 0;
  std::vector<std::vector<int>> cliques;
  std::vector<int> rank;                    // that adds the clique
  std::vector<char> everywhere;             // other ranks know the clique too, but do not add it
  std::function<Matrix(int)> matrix;        // of a clique
  std::map<int, Eigen::Vector3d> diagonal;  // added to single blocks
  std::vector<int> common;                  // flexible blocks that every rank holds
  std::vector<double> X;                    // positions of the blocks, or empty
  int n_blocks() const { return n_flexible + n_dense; }
  int size() const { return 3 * n_blocks(); }
};

/// What one rank holds of a problem.
struct Share {
  BlockMap map;
  Cliques cliques;
  std::vector<int> problem_clique;  // of each local clique
  std::vector<int> local;           // of each global block, -1 where it is not held

  Share(const Problem& p, int rank, int size) : local(p.n_blocks(), -1) {
    map.n_global = p.n_blocks(), map.first_dense = p.n_flexible;
    map.first = std::int64_t{p.n_flexible} * rank / size;
    map.n_owned = std::int64_t{p.n_flexible} * (rank + 1) / size - map.first + (rank == size - 1 ? p.n_dense : 0);
    std::vector<char> held(p.n_blocks(), 0);
    for (int i = 0; i < p.n_blocks(); ++i) held[i] = i >= p.n_flexible || (i >= map.first && i < map.first + map.n_owned);
    for (const int i : p.common) held[i] = 1;
    const auto is_here = [&](size_t e) { return p.rank[e] % size == rank || p.everywhere[e]; };
    for (size_t e = 0; e < p.cliques.size(); ++e)
      if (is_here(e))
        for (const int i : p.cliques[e])
          if (i >= 0) held[i] = 1;
    // local numbers run against the global ones, so that nobody may mix them up
    for (int i = p.n_flexible - 1; i >= 0; --i)
      if (held[i]) local[i] = static_cast<int>(map.global.size()), map.global.push_back(i);
    for (int i = p.n_flexible; i < p.n_blocks(); ++i) local[i] = static_cast<int>(map.global.size()), map.global.push_back(i);
    if (!p.X.empty())
      for (const auto g : map.global) map.X.insert(map.X.end(), p.X.begin() + 3 * g, p.X.begin() + 3 * g + 3);
    std::vector<int> list;
    for (size_t e = 0; e < p.cliques.size(); ++e) {
      if (!is_here(e)) continue;
      list.clear();
      for (const int i : p.cliques[e]) list.push_back(i < 0 ? -1 : local[i]);
      cliques.add(list, !p.everywhere[e]);
      problem_clique.push_back(static_cast<int>(e));
    }
  }

  void fill(const Problem& p, KktSolver& solver, int rank, int size, double factor = 1) const {
    solver.zero();
    for (int e = 0; e < cliques.size(); ++e) {
      if (p.rank[problem_clique[e]] % size != rank) continue;
      const Matrix K = factor * p.matrix(problem_clique[e]);
      solver.add(e, K.data());
    }
    for (const auto& [block, d] : p.diagonal)
      if (block >= map.first && block < map.first + map.n_owned) solver.add_diagonal(local[block], Eigen::Vector3d(factor * d).data());
  }

  std::vector<double> of(const Eigen::VectorXd& whole) const {
    std::vector<double> v;
    for (const auto g : map.global)
      for (int c = 0; c < 3; ++c) v.push_back(whole[3 * g + c]);
    return v;
  }
};

inline Eigen::SparseMatrix<double> assembled(const Problem& p) {
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t e = 0; e < p.cliques.size(); ++e) {
    const Matrix K = p.matrix(static_cast<int>(e));
    const auto& list = p.cliques[e];
    for (size_t i = 0; i < list.size(); ++i)
      for (size_t j = 0; j < list.size(); ++j)
        for (int r = 0; r < 3 && list[i] >= 0 && list[j] >= 0; ++r)
          for (int c = 0; c < 3; ++c) entries.emplace_back(3 * list[i] + r, 3 * list[j] + c, K(3 * i + r, 3 * j + c));
  }
  for (const auto& [block, d] : p.diagonal)
    for (int c = 0; c < 3; ++c) entries.emplace_back(3 * block + c, 3 * block + c, d[c]);
  Eigen::SparseMatrix<double> A(p.size(), p.size());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

inline Eigen::VectorXd random_vector(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd v(n);
  for (auto& x : v) x = uniform(random);
  return v;
}

/// An unsymmetric saddle point: random elements, two bodies of two blocks, a joint of five rows between them and one of three from a body
/// to a flexible block.  The sixth row of the first joint is filled up by a diagonal.
inline Problem random_saddle(unsigned seed, int n_flexible = 30) {
  std::mt19937 random(seed);
  Problem p;
  p.n_flexible = n_flexible, p.n_dense = 7;
  const int body_a = n_flexible, body_b = n_flexible + 2, joint = n_flexible + 4, pin = n_flexible + 6;
  std::uniform_int_distribution<int> flexible(0, n_flexible - 1);
  const auto clique = [&](std::vector<int> blocks, int rank, bool everywhere) {
    p.cliques.push_back(std::move(blocks)), p.rank.push_back(rank), p.everywhere.push_back(everywhere);
  };
  for (int e = 0; e < 2 * n_flexible; ++e) {
    std::set<int> nodes{e % n_flexible};
    while (nodes.size() < 4) nodes.insert(flexible(random));
    std::vector<int> blocks(nodes.begin(), nodes.end());
    if (e % 5 == 1) blocks[1] = -1;                                     // a driven node
    if (e % 7 == 2) blocks.insert(blocks.end(), {body_a, body_a + 1});  // followers of a body
    if (e % 7 == 4) blocks.insert(blocks.end(), {body_b, body_b + 1});
    clique(blocks, e * 3 / n_flexible, false);
  }
  const int n_elements = static_cast<int>(p.cliques.size());
  clique({body_a, body_a + 1}, 0, true);
  clique({body_b, body_b + 1}, 1, true);
  clique({body_a, body_a + 1, body_b, body_b + 1, joint, joint + 1}, 0, true);
  clique({body_a, body_a + 1, n_flexible / 2, pin}, 1, true);
  p.common = {n_flexible / 2};
  p.diagonal[joint + 1] = Eigen::Vector3d(0, 0, 1);
  p.diagonal[3] = Eigen::Vector3d(2, 0, 0.5);
  const auto cliques = p.cliques;
  p.matrix = [=](int e) {
    const int n = 3 * static_cast<int>(cliques[e].size());
    std::mt19937 own(seed * 7919 + e);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Matrix R(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) R(i, j) = uniform(own);
    if (e < n_elements + 2) return Matrix(R * R.transpose() + 0.3 * R);  // positive on the whole, not symmetric
    const int rows = e == n_elements + 2 ? 5 : 3, first = e == n_elements + 2 ? 12 : 9;
    Matrix K = Matrix::Zero(n, n);
    K.block(first, 0, rows, first) = R.block(first, 0, rows, first);
    K.block(0, first, first, rows) = (R.block(first, 0, rows, first) + 0.1 * R.block(0, 0, rows, first)).transpose();
    return K;
  };
  return p;
}

/// Stiffness of a cube of edge h (E 1, nu 0.3) by 2 x 2 x 2 points, nodes in VTK's order.
inline Matrix cube_stiffness(double h) {
  const double sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  const double nu = 0.3, lambda = nu / (1 + nu) / (1 - 2 * nu), mu = 0.5 / (1 + nu), s = 1 / std::sqrt(3.);
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.topLeftCorner<3, 3>().setConstant(lambda);
  for (int i = 0; i < 3; ++i) C(i, i) += 2 * mu, C(3 + i, 3 + i) = mu;
  Matrix K = Matrix::Zero(24, 24);
  for (const auto& p : sign) {
    Eigen::Matrix<double, 6, 24> B = Eigen::Matrix<double, 6, 24>::Zero();
    for (int a = 0; a < 8; ++a) {
      Eigen::Vector3d g;
      for (int i = 0; i < 3; ++i) {
        g[i] = sign[a][i] / 4 / h;
        for (int j = 0; j < 3; ++j)
          if (j != i) g[i] *= 1 + sign[a][j] * p[j] * s;
      }
      for (int i = 0; i < 3; ++i) B(i, 3 * a + i) = g[i];
      B(3, 3 * a + 1) = B(4, 3 * a) = g[2], B(3, 3 * a + 2) = B(5, 3 * a) = g[1], B(4, 3 * a + 2) = B(5, 3 * a + 1) = g[0];
    }
    K += B.transpose() * C * B * (h * h * h / 8);
  }
  return K;
}

/// A bar of cubes, nx x ny x nz, in one step of dynamics (CFL number `cfl`: a wave crosses so many cubes).  The nodes of its first face
/// follow a body that a joint of three rows holds at a point; those of its last face follow a second body; a third joint ties a node.
inline Problem elastic_bar(int nx, int ny, int nz, double cfl) {
  Problem p;
  const auto node = [=](int i, int j, int k) {
    return (i - 1) * (ny + 1) * (nz + 1) + j * (nz + 1) + k;
  };  // planes of x, the ends left out
  p.n_flexible = (nx - 1) * (ny + 1) * (nz + 1), p.n_dense = 6;
  const int a = p.n_flexible, b = a + 2, joint = a + 4, tie = a + 5;
  for (int i = 1; i < nx; ++i)
    for (int j = 0; j <= ny; ++j)
      for (int k = 0; k <= nz; ++k) p.X.insert(p.X.end(), {double(i), double(j), double(k)});
  p.X.resize(3 * static_cast<size_t>(p.n_blocks()), 0.0);
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
        std::vector<int> blocks;
        for (const auto& c : corner)
          if (i + c[0] > 0 && i + c[0] < nx) blocks.push_back(node(i + c[0], j + c[1], k + c[2]));
        if (i == 0) blocks.insert(blocks.end(), {a, a + 1});
        if (i == nx - 1) blocks.insert(blocks.end(), {b, b + 1});
        p.cliques.push_back(blocks), p.rank.push_back(0), p.everywhere.push_back(false);
      }
  const int n_cells = nx * ny * nz, tied = node(nx / 2, 0, 0);
  p.common = {tied};
  for (const auto& blocks : {std::vector{a, a + 1, joint}, std::vector{tied, tie}, std::vector{b, b + 1}})
    p.cliques.push_back(blocks), p.rank.push_back(0), p.everywhere.push_back(true);
  const Matrix K0 = cube_stiffness(1);
  const double wave = std::sqrt(0.7 / 1.3 / 0.4), inertia = 4 * wave * wave / (cfl * cfl);  // 4 rho / dt^2 of unit density
  Matrix K = K0;
  K.diagonal().array() += inertia / 8;
  p.matrix = [=](int e) {
    Matrix out;
    if (e >= n_cells) {
      const int kind = e - n_cells;
      out = Matrix::Zero(kind == 1 ? 6 : kind == 0 ? 9 : 6, kind == 1 ? 6 : kind == 0 ? 9 : 6);
      if (kind == 0) {  // gap at the point c + r
        Matrix G(3, 6);
        G << 1, 0, 0, 0, 2., 1, 0, 1, 0, -2., 0, 0.5, 0, 0, 1, -1, -0.5, 0;
        out.block(6, 0, 3, 6) = G, out.block(0, 6, 6, 3) = G.transpose();
      } else if (kind == 1) {
        out.block(3, 0, 3, 3).setIdentity(), out.block(0, 3, 3, 3).setIdentity();
      } else {  // the second body is as heavy as a few layers
        out.diagonal().setConstant(inertia * 3 * ny * nz);
      }
      return out;
    }
    const int i = e / (ny * nz), j = e / nz % ny, k = e % nz;
    if (i > 0 && i < nx - 1) return K;
    // followers: u = c + theta x r, r from the middle of the face
    const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    std::vector<int> flexible;
    for (int c = 0; c < 8; ++c)
      if (i + corner[c][0] > 0 && i + corner[c][0] < nx) flexible.push_back(c);
    const int n = static_cast<int>(flexible.size());
    Matrix T = Matrix::Zero(24, 3 * n + 6);
    for (int c = 0, at = 0; c < 8; ++c) {
      if (at < n && flexible[at] == c) {
        T.block(3 * c, 3 * at++, 3, 3).setIdentity();
        continue;
      }
      const Vec3 r(0, j + corner[c][1] - ny / 2., k + corner[c][2] - nz / 2.);
      T.block(3 * c, 3 * n, 3, 3).setIdentity();
      T.block(3 * c, 3 * n + 3, 3, 3) = -skew(r);
    }
    return Matrix(T.transpose() * K * T);
  };
  return p;
}
/// Share of the cells of a bar: slabs along x.
inline void slabs(Problem& p, int size) {
  for (size_t e = 0; e < p.cliques.size(); ++e)
    p.rank[e] = p.everywhere[e] ? static_cast<int>(e) % size : static_cast<int>(e * size / p.cliques.size());
}

/// Irregular parts, as a partitioner would leave them: the nearest of scattered points.
inline void scattered(Problem& p, int size) {
  std::mt19937 random(5);
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < p.X.size(); ++i) high[i % 3] = std::max(high[i % 3], p.X[i]);
  std::vector<Eigen::Vector3d> seed;
  for (int r = 0; r < size; ++r) {
    std::uniform_real_distribution<double> uniform(0, 1);
    seed.emplace_back(high[0] * (r + uniform(random)) / size, high[1] * uniform(random), high[2] * uniform(random));
  }
  for (size_t e = 0; e < p.cliques.size(); ++e) {
    if (p.everywhere[e]) continue;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    int n = 0;
    for (const int i : p.cliques[e])
      if (i >= 0 && i < p.n_flexible) centre += Eigen::Vector3d(p.X[3 * i], p.X[3 * i + 1], p.X[3 * i + 2]), ++n;
    if (n == 0) continue;
    centre /= n;
    p.rank[e] = 0;
    for (int r = 1; r < size; ++r)
      if ((seed[r] - centre).norm() < (seed[p.rank[e]] - centre).norm()) p.rank[e] = r;
  }
}

}  // namespace hilo::test
