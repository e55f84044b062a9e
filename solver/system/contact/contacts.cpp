// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of contacts and their tangent.
//
// A force F = A f at a point, A = [a_j] the axes of the obstacle in the mean of the step, has its opposite at the same place of the
// obstacle's body, so that both have neither a resultant nor a moment.  The point of a ball that slides is the one that lies lowest in the
// mean of the step, as in physics/rolling.
#include "system/contact/contacts.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

namespace hilo {

/// By the directions of the point (3, and the turn of its body 3), and of the obstacle's body (3 and 3).
using Rows12 = Eigen::Matrix<double, 3, 12>;

Traits Contacts::traits() const {
  const bool bends = std::ranges::any_of(list, [](const ContactPair& pair) { return pair.friction > 0; });
  const bool loses = std::ranges::any_of(list, &ContactPair::loses);
  const bool finds = !surfaces.empty() || !heaps.empty();
  return {.remembers = bends || loses || finds, .searches = finds, .slides = bends || finds, .reaches = !surfaces.empty()};
}

std::string Contacts::count() const {
  const size_t n = list.size() + surfaces.size() + heaps.size();
  return n == 0 ? "" : fmt::format("{} contacts", n);
}

bool Contacts::search(const Config& q, const Config* v, double h) {
  bool changes = false;
  for (SurfacePair& pair : surfaces) changes |= pair.search(q, v, h);
  for (BallHeap& heap : heaps) changes |= heap.search(q, v, h);
  return changes;
}

bool Contacts::revise(const Stage& stage) {
  bool changes = false;
  for (SurfacePair& pair : surfaces) changes |= pair.revise(stage);
  if (holds() || !(is_static_ || settles(stage))) return changes;
  each_pair([&](ContactPair& pair) {
    for (ContactPoint& point : pair.points) {
      if (!is_pulled(gap(pair, point, *stage.e1), gap(pair, point, begin(stage)), touch(point))) continue;
      point.parts = changes = true;
    }
  });
  return changes;
}

void Contacts::number(Layout& layout) {
  each_pair([&](ContactPair& pair) {
    for (ContactPoint& point : pair.points) {
      std::vector<int> blocks = points_.blocks_of(point.nodes);
      for (const int b : {pair.body, pair.carrier})
        if (b >= 0 && points_.body_block[b] >= 0) blocks.push_back(points_.body_block[b]), blocks.push_back(points_.body_block[b] + 1);
      point.clique = layout.cliques.add(blocks, !point.nodes.empty());
    }
  });
  for (SurfacePair& pair : surfaces) pair.number(layout);
}

Vec3 Contacts::position(const ContactPair& pair, const ContactPoint& point, const Config& q) const {
  if (pair.body >= 0) return q.c[pair.body] + q.R[pair.body] * point.arm;
  Vec3 x = Vec3::Zero();
  for (size_t a = 0; a < point.nodes.size(); ++a) x += point.share[a] * q.x[point.nodes[a]];
  return x;
}

Vec3 Contacts::measures(const ContactPair& pair, const Vec3& x, const Config& q) const {
  return pair.axes.transpose() * (q.R[pair.carrier].transpose() * (x - q.c[pair.carrier]) - pair.at);
}

double Contacts::gap(const ContactPair& pair, const ContactPoint& point, const Config& q) const {
  return pair.met_by(point).at(measures(pair, position(pair, point, q), q)) - point.law.radius;
}

void Contacts::hold(const Config& q) {
  about_ = q;
  each_pair([&](ContactPair& pair) {
    for (ContactPoint& point : pair.points) point.held = HeldPoint::at(point.law, gap(pair, point, q));
  });
  for (SurfacePair& pair : surfaces) pair.hold(q);
}

void Contacts::soften(double most) {
  most_ = most;
  for (SurfacePair& pair : surfaces) pair.most = most;
}

void Contacts::stick(bool on) {
  sticks_ = on;
  for (SurfacePair& pair : surfaces) pair.sticks = on;
}

double Contacts::depth(const Config& q) const {
  double deepest = 0;
  each_pair([&](const ContactPair& pair) {
    for (const ContactPoint& point : pair.points) deepest = std::max(deepest, -gap(pair, point, q) / point.cell);
  });
  for (const SurfacePair& pair : surfaces) deepest = std::max(deepest, pair.depth(q));
  return points_.comm->max(deepest);
}

template <class T>
PointForce<T> Contacts::force(const ContactPair& pair, const ContactPoint& point, const Vec3& x0, const Triple<T>& x1, const Triple<T>& way,
                              const Stage& s, bool fixed) const {
  if (!is_static_ && !settles(s)) return over_step(pair.met_by(point), point.law, x0, x1, way, point.u, {s.h, point.approach});
  const double share = most_ < HUGE_VAL ? std::min(1., most_ * point.deep / point.cell) : 1;
  return at_end(pair.met_by(point), point.law.as(share, fixed, sticks_), x0, x1, way, point.u, touch(point), point.deep / share);
}

Contacts::Place Contacts::place(const ContactPair& pair, const ContactPoint& point, const Stage& s) const {
  Place at;
  const Config& e0 = begin(s);
  const Vec3 p0 = position(pair, point, e0), p1 = position(pair, point, *s.e1);
  at.x0 = measures(pair, p0, e0), at.x1 = measures(pair, p1, *s.e1);
  const PointLaw& law = point.law;
  const bool is_start = this->is_start(s);
  const double open = is_static_ || settles(s) ? touch(point) : 0;
  if (!is_start && pair.met_by(point).at(at.x0) >= law.radius + open && pair.met_by(point).at(at.x1) >= law.radius + open) {
    at.force.normal = at.force.tangential = at.force.n = at.force.u = triple<double>(Vec3::Zero());
    at.force.dissipated = law.kt / 2 * point.u.squaredNorm();
    return at;
  }
  const int o = pair.carrier, b = pair.body;
  at.A0 = e0.R[o] * pair.axes, at.A1 = s.e1->R[o] * pair.axes, at.Am = s.left->R[o] * pair.axes;
  at.rel = position(pair, point, *s.left) - s.left->c[o], at.rel1 = p1 - s.e1->c[o];
  if (b >= 0) {
    at.turn0 = e0.R[b], at.turn1 = s.e1->R[b], at.turn = s.left->R[b];
    at.arm = at.turn * point.arm, at.arm1 = at.turn1 * point.arm;
  }
  const bool rolls = law.radius > 0 && law.friction > 0;
  if (rolls) {
    double phi;
    Triple<double> n;
    pair.met_by(point)(triple<double>((at.x0 + at.x1) / 2), phi, n);
    at.low = -law.radius * (at.Am * values(n));
    at.lowest = at.turn.inverse() * at.low;
    at.way = at.A1.transpose() * (at.turn1 * at.lowest) - at.A0.transpose() * (at.turn0 * at.lowest);
  }
  if (holds())
    at.force = about(point.held, pair.met_by(point), law, triple<double>(at.x1), triple<double>(at.x1 - at.x0 + at.way), point.u);
  else if (!is_start)
    at.force = force(pair, point, at.x0, triple<double>(at.x1), triple<double>(at.x1 - at.x0 + at.way), s);
  else
    at.force = at_rest(pair.met_by(point), law, triple<double>((1 - s.weight) * at.x0 + s.weight * at.x1), point.u);
  at.normal = at.Am * values(at.force.normal), at.tangential = at.Am * values(at.force.tangential);
  return at;
}

void Contacts::evaluate(Pass& p) const {
  if (p.s.rates_alone) return;
  each_pair([&](const ContactPair& pair) {
    for (const ContactPoint& point : pair.points) {
      const Place at = place(pair, point, p.s);
      if (!at.force.acts) continue;
      const Vec3 F = at.normal + at.tangential;
      if (pair.body >= 0) {
        p.body[pair.body].head<3>() += F;
        p.body[pair.body].tail<3>() += at.arm.cross(F) + at.low.cross(at.tangential);
      }
      for (size_t a = 0; a < point.nodes.size(); ++a) p.node[point.nodes[a]] += point.share[a] * F;
      p.body[pair.carrier].head<3>() -= F;
      p.body[pair.carrier].tail<3>() -= at.rel.cross(F) + at.low.cross(at.tangential);
      p.scale(F.norm());
      if (p.K) add_tangent(p, pair, point, at);
    }
  });
  for (const SurfacePair& pair : surfaces) pair.evaluate(p);
}

void Contacts::add_tangent(Pass& p, const ContactPair& pair, const ContactPoint& point, const Place& at) const {
  const std::span<const int> blocks = points_.layout.cliques[point.clique];
  if (blocks.empty()) return;
  const Stage& s = p.s;
  const auto columns = [](int first, const Mat3& A) {
    Rows12 out = Rows12::Zero();
    out.middleCols<3>(3 * first) = A;
    return out;
  };
  const Mat3 I = Mat3::Identity();
  // increments of the measures, and of those of the material point
  const auto increments = [&](const Vec3& arm, const Vec3& rel) {
    Rows12 out;
    out << I, -skew(arm), -I, skew(rel);
    return Rows12(at.A1.transpose() * out);
  };
  const Rows12 dx = s.chain * increments(at.arm1, at.rel1);
  const bool rolls = !at.low.isZero(0);
  Mat3 J_normal, J_tangential, J_way = Mat3::Zero(), J_n;
  const auto seeds = [&]<int N>(std::integral_constant<int, N>) {
    using T = Jet<N>;
    Triple<T> x1 = triple<T>(at.x1), way = triple<T>(at.x1 - at.x0 + at.way);
    for (int i = 0; i < 3; ++i) x1[i].d[i] = 1, way[i].d[N - 3 + i] = 1;
    const auto f = [&] {
      if (holds()) return about(point.held, pair.met_by(point), point.law, x1, way, point.u);
      if (!is_start(s)) return force(pair, point, at.x0, x1, way, s, s.fixed_friction);
      const Triple<T> x = s.e0 == s.e1 ? x1 : T(1 - s.weight) * triple<T>(at.x0) + T(s.weight) * x1;
      return at_rest(pair.met_by(point), point.law, x, point.u);
    }();
    for (int i = 0; i < 3; ++i) {
      J_normal.row(i) = f.normal[i].d.template head<3>(), J_n.row(i) = f.n[i].d.template head<3>();
      J_tangential.row(i) = f.tangential[i].d.template head<3>();
      if (N == 6) J_way.row(i) = f.tangential[i].d.template tail<3>();
    }
  };
  if (rolls)
    seeds(std::integral_constant<int, 6>());
  else
    seeds(std::integral_constant<int, 3>());
  const double slope = s.slope;
  const Rows12 dn = at.Am * J_n * dx - slope * columns(3, skew(at.A1 * values(at.force.n)));  // of the normal, on the left
  Rows12 d_arm = -slope * columns(1, skew(at.arm1)), d_low = Rows12::Zero();
  Rows12 dF = at.Am * J_normal * dx - slope * columns(3, skew(at.A1 * values(at.force.normal)));
  Rows12 dT = at.Am * J_tangential * dx - slope * columns(3, skew(at.A1 * values(at.force.tangential)));
  if (rolls) {
    d_low = -point.law.radius * dn;
    const Vec3 low1 = at.turn1 * at.lowest;
    const Rows12 d_lowest = at.turn.inverse() * (d_low + slope * columns(1, skew(low1)));
    dT += at.Am * J_way *
          (s.chain * increments(at.arm1 + low1, at.rel1 + low1) + (at.A1.transpose() * at.turn1 - at.A0.transpose() * at.turn0) * d_lowest);
  }
  const Rows12 d_rel = slope * (columns(0, I) - columns(2, I)) + d_arm;
  const Vec3 F = at.normal + at.tangential;
  const Rows12 dS = dF + dT;
  Eigen::Matrix<double, 12, 12> K;
  const Rows12 of_low = skew(at.low) * dT - skew(at.tangential) * d_low;
  K.middleRows<3>(0) = dS;
  K.middleRows<3>(3) = skew(at.arm) * dS - skew(F) * d_arm + of_low;
  K.middleRows<3>(6) = -dS;
  K.middleRows<3>(9) = -(skew(at.rel) * dS - skew(F) * d_rel + of_low);

  // directions by the unknowns of the clique, on the left and on the right
  const int m = 3 * static_cast<int>(blocks.size());
  Eigen::Matrix<double, 12, Eigen::Dynamic> L = Eigen::Matrix<double, 12, Eigen::Dynamic>::Zero(12, m), R = L;
  int free = m;
  const auto take_body = [&](int b, int row) {
    if (b < 0 || points_.body_block[b] < 0) return;
    free -= 6;
    L.block<6, 6>(row, free).setIdentity(), R.block<6, 6>(row, free).setIdentity();
  };
  take_body(pair.carrier, 6), take_body(pair.body, 0);
  if (!point.nodes.empty()) {
    std::vector<NodeMap> maps;
    std::vector<std::array<bool, 3>> masks;
    points_.make_maps(point.nodes, blocks.first(static_cast<size_t>(free / 3)), s, maps, masks);
    for (size_t a = 0; a < maps.size(); ++a) {
      const NodeMap& map = maps[a];
      const double N = point.share[a];
      if (map.slot >= 0) {
        for (int i = 0; i < 3; ++i)
          if (map.follower || !masks[a][i]) L(i, 3 * map.slot + i) += N, R(i, 3 * map.slot + i) += N;
        if (map.follower) {
          L.block<3, 3>(0, 3 * map.slot + 3) -= N * skew(map.left);
          R.block<3, 3>(0, 3 * map.slot + 3) -= N * skew(map.right);
        }
      }
      for (size_t j = 0; j < map.shapes.size(); ++j) {
        L.block<3, 1>(0, 3 * map.mode_slot + static_cast<int>(j)) += N * (map.left_turn * map.shapes[j]);
        R.block<3, 1>(0, 3 * map.mode_slot + static_cast<int>(j)) += N * (map.right_turn * map.shapes[j]);
      }
    }
  }
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> dense = L.transpose() * (K * R);
  p.K->add(point.clique, dense.data());
}

Meeting what_may_meet(const System& system) {
  Meeting out;
  const Contacts& contacts = system.part<Contacts>();
  for (const ContactPair& pair : contacts.list) {
    for (const int b : {pair.body, pair.carrier})
      if (b >= 0) out.bodies.push_back(b);
    for (const ContactPoint& point : pair.points)
      if (!point.nodes.empty()) out.nodes.push_back(point.nodes[0]);
  }
  for (const BallHeap& heap : contacts.heaps)
    for (const BallHeap::Ball& ball : heap.balls) out.bodies.push_back(ball.body);
  for (const SurfacePair& pair : contacts.surfaces)
    for (const ContactSurface& surface : pair.side) {
      if (pair.itself) break;  // nothing else comes to it
      for (const ContactSurface::Face& face : surface.faces) out.nodes.push_back(face.node[0]);
    }
  return out;
}

std::vector<TouchedNodes> touched_nodes(const System& system) {
  const Contacts& contacts = system.part<Contacts>();
  std::vector<TouchedNodes> out;
  for (const ContactPair& pair : contacts.list) {
    out.push_back({pair.name, {}});
    for (const ContactPoint& point : pair.points) out.back().nodes.insert(out.back().nodes.end(), point.nodes.begin(), point.nodes.end());
  }
  for (const SurfacePair& pair : contacts.surfaces) {
    out.push_back({pair.name, {}});
    for (const ContactSurface& side : pair.side)
      for (const ContactSurface::Face& face : side.faces)
        out.back().nodes.insert(out.back().nodes.end(), face.node.begin(), face.node.begin() + face.n);
  }
  return out;
}

}  // namespace hilo
