// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/points.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/wide.hpp"
#include "system/linear_beams.hpp"
#include "system/system.hpp"

namespace hilo {

void Points::move(Config& q, std::span<const double> z) const {
  for (const UnknownField& f : unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const Eigen::Map<const Vec3> by(z.data() + 3 * f.block(k));
      if (f.turns())
        q.R[f.item[k]] = cayley(by) * q.R[f.item[k]];
      else
        (q.*f.array)[f.item[k]] += by;
    }
  place(q);
}

double Points::add_rates(Config& v, const Config& q, std::span<const double> z) const {
  double change = 0;
  for (const UnknownField& f : unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      const Eigen::Map<const Vec3> by(z.data() + 3 * f.block(k));
      change = std::max(change, by.norm() * f.scale(k));
      if (f.turns())
        v.R[f.item[k]] += skew(by) * q.R[f.item[k]];
      else
        (v.*f.array)[f.item[k]] += by;
    }
  for (const Modes& m : modes) {
    const int turn = body_block[m.body] + 1;
    const Mat3 W = turn > 0 ? skew(Eigen::Map<const Vec3>(z.data() + 3 * turn)) : Mat3::Zero();
    for (int j = 0; j < 3 * m.n_blocks; ++j) {
      const int i = 3 * m.first + j;
      v.Y[i] += W * q.Y[i] + z[3 * m.block + j] * q.R[m.body];
    }
  }
  follow(v);
  return change;
}

double Points::largest_difference(const Config& a, const Config& b, double arm) const {
  double out = 0;
  for (size_t i = 0; i < a.x.size(); ++i) out = std::max(out, (a.x[i] - b.x[i]).norm());
  for (size_t i = 0; i < a.c.size(); ++i)
    out = std::max({out, (a.c[i] - b.c[i]).norm(), (a.R[i] - b.R[i]).norm() / std::sqrt(2) * (arm > 0 ? arm : bodies[i].size)});
  return comm->max(out);
}

double Points::largest_rate(const Config& v) const {
  double top = 0;
  for (const Vec3& x : v.x) top = std::max(top, x.norm());
  for (size_t b = 0; b < v.c.size(); ++b) top = std::max({top, v.c[b].norm(), bodies[b].size * v.R[b].colwise().norm().maxCoeff()});
  return comm->max(top);
}

Vec3 Points::followed(const Config& q, size_t node) const {
  const int b = follower[node];
  Vec3 x = q.c[b] + q.R[b] * (X[node] - bodies[b].Xc);
  const auto shapes = shapes_at(static_cast<int>(node));
  if (shapes.empty()) return x;
  const Mat3* Y = q.Y.data() + 3 * modes[modes_of[b]].first;
  double sum[3] = {x[0], x[1], x[2]};
  for (size_t j = 0; j < shapes.size(); ++j) {
    const double *y = Y[j].data(), *u = shapes[j].data();
    for (int i = 0; i < 3; ++i) sum[i] += y[i] * u[0] + y[3 + i] * u[1] + y[6 + i] * u[2];
  }
  return Vec3(sum);
}

/// x += Y u, Y by rows (3 x n).
HILO_WIDE static void add_product(size_t n, const double* Y, const double* u, double* x) {
  typedef double V __attribute__((vector_size(64)));
  constexpr size_t width = sizeof(V) / sizeof(double);
  V sum[3] = {};
  size_t j = 0;
  for (; j + width <= n; j += width) {
    V by, row;
    std::memcpy(&by, u + j, sizeof(V));
    for (size_t i = 0; i < 3; ++i) std::memcpy(&row, Y + i * n + j, sizeof(V)), sum[i] += row * by;
  }
  for (size_t i = 0; i < 3; ++i) {
    double rest = 0;
    for (size_t k = j; k < n; ++k) rest += Y[i * n + k] * u[k];
    for (size_t k = 0; k < width; ++k) rest += sum[i][k];
    x[i] += rest;
  }
}

void Points::follow(Config& q) const {
  std::vector<double> Y;  // of the modes of a body, by rows: nodes that follow one body come one after the other
  int of = -1;
  for (size_t i = 0; i < q.x.size(); ++i) {
    const int b = follower[i];
    if (b < 0) continue;
    const auto shapes = shapes_at(static_cast<int>(i));
    const size_t n = 3 * shapes.size();
    if (n > 0 && b != of) {
      of = b, Y.resize(3 * n);
      const Mat3* products = q.Y.data() + 3 * modes[modes_of[b]].first;
      for (size_t j = 0; j < shapes.size(); ++j)
        for (size_t k = 0; k < 9; ++k) Y[k % 3 * n + 3 * j + k / 3] = products[j].data()[k];
    }
    q.x[i] = q.c[b] + q.R[b] * (X[i] - bodies[b].Xc);
    if (n > 0) add_product(n, Y.data(), shapes[0].data(), q.x[i].data());
  }
  if (!modes.empty()) static_cast<const System&>(*this).part<LinearBeams>().carry(q);  // points are those of a system
}

std::vector<Vec3> Points::all_nodes(const Config& q) const {
  std::vector<Vec3> out = q.x;
  for (size_t i = q.x.size(); i < X.size(); ++i) out.push_back(followed(q, i));
  return out;
}

void Points::place(Config& q) const {
  for (const Modes& m : modes)
    for (int j = 3 * m.first; j < 3 * (m.first + m.n_blocks); ++j) q.Y[j] = q.eta[j / 3][j % 3] * q.R[m.body];
  follow(q);
}

void Points::mask_fixed(std::span<double> r) const {
  for (const UnknownField& f : unknowns)
    for (size_t k = 0; k < f.size() && f.held; ++k)
      for (size_t i = 0; i < 3; ++i)
        if ((*f.held)[f.item[k]][i]) r[3 * static_cast<size_t>(f.block(k)) + i] = 0;
}

std::vector<int> Points::blocks_of(std::span<const int> nodes) const {
  std::vector<int> list;
  for (int node : nodes)
    if (follower[node] < 0) list.push_back(node_block[node]);
  for (int node : nodes) {
    const int b = follower[node];
    if (b >= 0 && body_block[b] >= 0 && std::find(list.begin(), list.end(), body_block[b]) == list.end())
      list.push_back(body_block[b]), list.push_back(body_block[b] + 1);
  }
  for (int node : nodes) {
    if (shapes_at(node).empty()) continue;
    const Modes& m = modes[modes_of[follower[node]]];
    if (std::find(list.begin(), list.end(), m.block) == list.end())
      for (int k = 0; k < m.n_blocks; ++k) list.push_back(m.block + k);
  }
  return list;
}

void Points::make_maps(std::span<const int> nodes, std::span<const int> blocks, const Stage& s, std::vector<NodeMap>& maps,
                       std::vector<std::array<bool, 3>>& masks) const {
  maps.resize(nodes.size());
  masks.resize(nodes.size());
  for (size_t k = 0; k < nodes.size(); ++k) {
    const int node = nodes[k], body = follower[node], block = body < 0 ? node_block[node] : body_block[body];
    const auto slot_of = [&](int wanted) {
      const auto at = std::find(blocks.begin(), blocks.end(), wanted);
      return wanted < 0 || at == blocks.end() ? -1 : static_cast<int>(at - blocks.begin());
    };
    maps[k].slot = slot_of(block);
    maps[k].follower = body >= 0;
    maps[k].shapes = shapes_at(node), maps[k].mode_slot = -1;
    if (!maps[k].shapes.empty()) {
      maps[k].mode_slot = slot_of(modes[modes_of[body]].block);
      maps[k].left_turn = s.left->R[body].inverse().transpose(), maps[k].right_turn = s.end->R[body];
    }
    if (body >= 0) maps[k].left = s.left->x[node] - s.left->c[body], maps[k].right = s.end->x[node] - s.end->c[body];
    masks[k] = fixed[node];
  }
}

namespace {

/// The same where nodes follow modes: by products of whole matrices, L^T K R with the maps of all nodes in L and R (3n x 3m).
void add_with_modes(KktSolver& solver, int clique, int n, const double* K, const NodeMap* maps, int m, const std::array<bool, 3>* fixed) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  thread_local RowMajor L, R, reduced;
  L.setZero(3 * n, 3 * m), R.setZero(3 * n, 3 * m);
  for (int a = 0; a < n; ++a) {
    const NodeMap& map = maps[a];
    for (int i = 0; i < 3 && map.slot >= 0; ++i)
      if (map.follower || !fixed[a][i]) L(3 * a + i, 3 * map.slot + i) = R(3 * a + i, 3 * map.slot + i) = 1;
    if (map.follower && map.slot >= 0) {
      L.block<3, 3>(3 * a, 3 * map.slot + 3) = -skew(map.left);
      R.block<3, 3>(3 * a, 3 * map.slot + 3) = -skew(map.right);
    }
    for (size_t j = 0; j < map.shapes.size(); ++j) {
      L.block<3, 1>(3 * a, 3 * map.mode_slot + static_cast<int>(j)) = map.left_turn * map.shapes[j];
      R.block<3, 1>(3 * a, 3 * map.mode_slot + static_cast<int>(j)) = map.right_turn * map.shapes[j];
    }
  }
  reduced.noalias() = L.transpose() * (Eigen::Map<const RowMajor>(K, 3 * n, 3 * n) * R);
  solver.add(clique, reduced.data());
}

}  // namespace

void add_reduced(KktSolver& solver, int clique, int n, const double* K, const NodeMap* maps, int m, const std::array<bool, 3>* fixed) {
  if (std::any_of(maps, maps + n, [](const NodeMap& map) { return !map.shapes.empty(); }))
    return add_with_modes(solver, clique, n, K, maps, m, fixed);
  thread_local std::vector<double> reduced;
  const int n3 = 3 * n, m3 = 3 * m;
  reduced.assign(static_cast<size_t>(m3) * m3, 0.0);
  const auto add = [&](int row, int col, const auto& A) {
    double* to = reduced.data() + 3 * (row * m3 + col);
    for (int i = 0; i < 3; ++i, to += m3)
      for (int j = 0; j < 3; ++j) to[j] += A(i, j);
  };
  const auto is_held = [&](int a) { return !maps[a].follower && (fixed[a][0] || fixed[a][1] || fixed[a][2]); };
  for (int a = 0; a < n; ++a) {
    if (maps[a].slot < 0) continue;
    const bool held = is_held(a);
    const Mat3 L = maps[a].follower ? skew(maps[a].left) : Mat3::Zero();
    for (int b = 0; b < n; ++b) {
      if (maps[b].slot < 0) continue;
      using Entries = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
      Entries A = Eigen::Map<const Entries, 0, Eigen::OuterStride<>>(K + 3 * (a * n3 + b), Eigen::OuterStride<>(n3));
      if (held || is_held(b))
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            if ((held && fixed[a][i]) || (!maps[b].follower && fixed[b][j])) A(i, j) = 0;
      add(maps[a].slot, maps[b].slot, A);
      if (maps[a].follower) add(maps[a].slot + 1, maps[b].slot, L * A);
      if (!maps[b].follower) continue;
      const Entries AR = -A * skew(maps[b].right);
      add(maps[a].slot, maps[b].slot + 1, AR);
      if (maps[a].follower) add(maps[a].slot + 1, maps[b].slot + 1, L * AR);
    }
  }
  solver.add(clique, reduced.data());
}

}  // namespace hilo
