// SPDX-License-Identifier: GPL-3.0-or-later
// Loads within an evaluation: mean of the history over the step, at the step's left configuration.
#include "system/loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "system/collocation.hpp"
#include "system/facet.hpp"

namespace hilo {

std::string Loads::count() const {
  std::set<std::string_view> names;
  for (const Load& load : list) names.insert(load.name);
  return fmt::format("{} loads", names.size());
}

/// A load whose direction is inertial may take any beside a region that turns.
void Loads::add_reference_forces(std::vector<NodalForces>& out) const {
  for (const Load& load : list) {
    for (int k = 0; k < 3 && load.kind == Load::Kind::nodal; ++k) {
      NodalForces& forces = out.emplace_back();
      for (size_t i = 0; i < load.nodes.size(); ++i) forces.emplace_back(load.nodes[i], load.weight[i] * load.value.norm() * Vec3::Unit(k));
    }
    if (load.kind != Load::Kind::pressure) continue;
    NodalForces& forces = out.emplace_back();
    std::vector<Vec3> at, f;
    for (const auto& facet : load.facets) {
      at.clear(), f.assign(facet.size(), Vec3::Zero());
      for (const int i : facet) at.push_back(points_.X[i]);
      pressure_force(load.pressure, at, at, f, nullptr);
      for (size_t a = 0; a < facet.size(); ++a) forces.emplace_back(facet[a], f[a]);
    }
  }
}

void Loads::number(Layout& layout) {
  const auto is_held = [&](int node) { return node < std::ssize(points_.start.x); };
  for (const Load& l : list)  // Builder::put_active_nodes_first has left it out
    if (!std::ranges::all_of(l.nodes, is_held) ||
        !std::ranges::all_of(l.facets, [&](const auto& f) { return std::ranges::all_of(f, is_held); }))
      throw Error("", fmt::format("load \"{}\" acts on a node that follows a body unseen", l.name), "", Exit::fault);
  for (Load& l : list) {
    l.cliques.clear();
    for (const auto& facet : l.facets) l.cliques.push_back(layout.cliques.add(points_.blocks_of(facet), true));
  }
}

void Loads::on_nodes(const Load& load, double factor, Pass& p) const {
  for (size_t i = 0; i < load.nodes.size(); ++i) {
    const Vec3 f = factor * load.weight[i] * load.value;
    p.node[load.nodes[i]] -= f;
    p.scale(f.norm());
  }
}

Vec3 Loads::acting(const Load& load, double factor, const Stage& s) {
  const Mat3& R = s.left->R[load.body];
  const Vec3 f = factor * (load.follower ? Vec3(R * load.value) : load.value);
  if (load.line.isZero(0)) return f;
  const Vec3 line = (R * load.line).normalized();
  return f - line * line.dot(f);
}

void Loads::on_body(const Load& load, double factor, Pass& p) const {
  if (!points_.counts(load.body)) return;
  const Stage& s = p.s;
  const int b = load.body;
  const bool force = load.kind == Load::Kind::body_force;
  const Vec3 f = acting(load, factor, s), arm = s.left->R[b] * load.arm;
  p.body[b].tail<3>() -= force ? Vec3(arm.cross(f)) : f;
  if (force) p.body[b].head<3>() -= f;
  p.scale(force ? f.norm() : f.norm() / points_.bodies[b].size);
  if (!p.K || points_.body_block[b] < 0) return;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> K = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>::Zero();
  const Mat3 turned = load.follower ? Mat3(s.slope * skew(s.end->R[b] * load.value * factor)) : Mat3::Zero();  // of -f, by a turn
  if (force) {
    K.topRightCorner<3, 3>() = turned;
    K.bottomRightCorner<3, 3>() = skew(arm) * turned - s.slope * skew(f) * skew(s.end->R[b] * load.arm);
  } else {
    K.bottomRightCorner<3, 3>() = turned;
  }
  p.K->add(points_.body_clique[b], K.data());
}

void Loads::on_facets(const Load& load, double factor, Pass& p) const {
  const Stage& s = p.s;
  std::vector<NodeMap> maps;
  std::vector<std::array<bool, 3>> masks;
  for (size_t e = 0; e < load.facets.size(); ++e) {
    const std::vector<int>& nodes = load.facets[e];
    const int n = static_cast<int>(nodes.size());
    std::vector<Vec3> x0(n), x1(n), f(n);
    for (int a = 0; a < n; ++a) x0[a] = s.e0->x[nodes[a]], x1[a] = s.e1->x[nodes[a]];
    if (!s.conserving())
      for (int a = 0; a < n; ++a) x0[a] = x1[a] = (1 - s.weight) * x0[a] + s.weight * x1[a];
    std::vector<double> K(p.K ? 9 * n * n : 0);
    pressure_force(factor * load.pressure, x0, x1, f, p.K ? K.data() : nullptr);
    for (int a = 0; a < n; ++a) p.node[nodes[a]] -= f[a], p.scale(f[a].norm());
    if (!p.K) continue;
    for (double& k : K) k *= -s.chain * (s.conserving() ? 1 : 2 * s.weight);
    const auto blocks = points_.layout.cliques[load.cliques[e]];
    points_.make_maps(nodes, blocks, s, maps, masks);
    add_reduced(*p.K, load.cliques[e], n, K.data(), maps.data(), static_cast<int>(blocks.size()), masks.data());
  }
}

void Loads::evaluate(Pass& p) const {
  if (!p.loads) return;
  for (const Load& load : list) {
    const double factor = load.factor(p.s.t0, p.s.t1, p.s.load_factor);
    switch (load.kind) {
      case Load::Kind::nodal:
        on_nodes(load, factor, p);
        break;
      case Load::Kind::body_force:
      case Load::Kind::body_torque:
        on_body(load, factor, p);
        break;
      case Load::Kind::pressure:
        on_facets(load, factor, p);
        break;
    }
  }
}

void Loads::add_work(const Moment& m, Work& sum) const {
  const Stage& s = m.s;
  for (const Load& load : list) {
    const double factor = load.factor(s.t0, s.t1, s.load_factor);
    if (load.kind == Load::Kind::nodal) {
      for (size_t i = 0; i < load.nodes.size(); ++i)
        sum.external += factor * load.weight[i] * load.value.dot(s.end->x[load.nodes[i]] - s.from().x[load.nodes[i]]);
    } else if (load.kind == Load::Kind::pressure) {
      for (const auto& nodes : load.facets) {
        std::vector<Vec3> x0(nodes.size()), x1(nodes.size()), f(nodes.size()), way(nodes.size());
        for (size_t a = 0; a < nodes.size(); ++a) {
          x0[a] = s.from().x[nodes[a]], x1[a] = s.end->x[nodes[a]], way[a] = x1[a] - x0[a];
          if (s.step) x0[a] = x1[a];  // there it acts
        }
        pressure_force(factor * load.pressure, x0, x1, f, nullptr);
        for (size_t a = 0; a < nodes.size(); ++a) sum.external += f[a].dot(way[a]);
      }
    } else if (points_.counts(load.body)) {
      const int b = load.body;
      const Vec3 f = acting(load, factor, s);
      if (load.kind == Load::Kind::body_force) {
        sum.external += f.dot(s.end->c[b] - s.from().c[b] + (s.end->R[b] - s.from().R[b]) * load.arm);
      } else {  // R1 - R0 = skew(w) (R0 + R1)/2 defines the rotation increment w
        sum.external += f.dot(turned(s, b));
      }
    }
  }
}

/// A torque counts as the force that it is at the body's size; of a pressure, how much is not asked.
void Loads::add_timed(std::span<const int> group, double t, double T, std::span<double> sum) const {
  for (const Load& l : list) {
    if (l.ramped) continue;
    const double df = l.factor(t, t + T, 1) - l.factor(t - T, t, 1);
    if (df == 0) continue;
    const auto add = [&](int b, double force) {
      if (b >= 0 && group[b] >= 0) sum[group[b]] += df * df * force * force / std::max(points_.bodies[b].mass, 1e-300);
    };
    if (l.body >= 0 && points_.counts(l.body))
      add(l.body, l.value.norm() / (l.kind == Load::Kind::body_torque ? points_.bodies[l.body].size : 1));
    for (size_t i = 0; i < l.nodes.size(); ++i) add(points_.follower[l.nodes[i]], l.weight[i] * l.value.norm());
    for (const auto& facet : l.facets)
      for (const int node : facet) add(points_.follower[node], 1e100);
  }
}

}  // namespace hilo
