#include "system/points.hpp"

#include <algorithm>
#include <cmath>

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
  follow(q);
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

void Points::follow(Config& q) const {
  for (size_t i = 0; i < X.size(); ++i)
    if (const int b = follower[i]; b >= 0) q.x[i] = q.c[b] + q.R[b] * (X[i] - bodies[b].Xc);
}

void Points::mask_fixed(std::span<double> r) const {
  for (size_t i = 0; i < X.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (node_block[i] >= 0 && fixed[i][k]) r[3 * node_block[i] + k] = 0;
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
  return list;
}

void Points::make_maps(std::span<const int> nodes, std::span<const int> blocks, const Stage& s, std::vector<NodeMap>& maps,
                       std::vector<std::array<bool, 3>>& masks) const {
  maps.resize(nodes.size());
  masks.resize(nodes.size());
  for (size_t k = 0; k < nodes.size(); ++k) {
    const int node = nodes[k], body = follower[node], block = body < 0 ? node_block[node] : body_block[body];
    maps[k].slot = -1;
    for (size_t i = 0; i < blocks.size() && block >= 0; ++i)
      if (blocks[i] == block) maps[k].slot = static_cast<int>(i);
    maps[k].follower = body >= 0;
    if (body >= 0) maps[k].left = s.left->x[node] - s.left->c[body], maps[k].right = s.end->x[node] - s.end->c[body];
    masks[k] = fixed[node];
  }
}

void add_reduced(KktSolver& solver, int clique, int n, const double* K, const NodeMap* maps, int m, const std::array<bool, 3>* fixed) {
  thread_local std::vector<double> reduced;
  const int n3 = 3 * n, m3 = 3 * m;
  reduced.assign(static_cast<size_t>(m3) * m3, 0.0);
  const auto add = [&](int row, int col, const Mat3& A) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) reduced[(3 * row + i) * m3 + 3 * col + j] += A(i, j);
  };
  for (int a = 0; a < n; ++a) {
    if (maps[a].slot < 0) continue;
    for (int b = 0; b < n; ++b) {
      if (maps[b].slot < 0) continue;
      Mat3 A;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          A(i, j) = !maps[a].follower && fixed[a][i] ? 0 : !maps[b].follower && fixed[b][j] ? 0 : K[(3 * a + i) * n3 + 3 * b + j];
      add(maps[a].slot, maps[b].slot, A);
      const Mat3 AR = maps[b].follower ? Mat3(-A * skew(maps[b].right)) : Mat3::Zero();
      if (maps[b].follower) add(maps[a].slot, maps[b].slot + 1, AR);
      if (maps[a].follower) {
        const Mat3 L = skew(maps[a].left);
        add(maps[a].slot + 1, maps[b].slot, L * A);
        if (maps[b].follower) add(maps[a].slot + 1, maps[b].slot + 1, L * AR);
      }
    }
  }
  solver.add(clique, reduced.data());
}

}  // namespace hilo
