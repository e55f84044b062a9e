// SPDX-License-Identifier: GPL-3.0-or-later
// What moves by a law: positions and their derivatives, reactions and work.
#include "system/motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "system/beams.hpp"
#include "system/collocation.hpp"

namespace hilo {

Traits Motions::traits() const { return {.is_driven = moves()}; }

bool Motions::moves() const {
  return std::any_of(list.begin(), list.end(), [](const Motion& m) { return m.moving; });
}

/// Followers of the bodies that are driven.
void Motions::prepare() {
  for (Motion& m : list)
    for (int i = 0; i < static_cast<int>(points_.start.x.size()) && m.body >= 0; ++i)
      if (points_.follower[i] == m.body) m.nodes.push_back(i);
}

void Motions::prescribe(Config& q, double t, double ramp) const {
  for (const Motion& m : list) {
    if (!m.moving) continue;
    const double f = m.law.at(t, t, ramp).value;
    if (m.body >= 0) {
      const Mat3 R = m.angle != 0 ? Mat3(Eigen::AngleAxisd(f * m.angle, m.axis).toRotationMatrix()) : Mat3::Identity();
      q.c[m.body] = m.at + R * (points_.bodies[m.body].Xc - m.at) + f * m.displacement;
      q.R[m.body] = R;
    } else {
      for (int n : m.nodes)
        for (int i = 0; i < 3; ++i)
          if (m.component[i]) q.x[n][i] = points_.X[n][i] + f * m.displacement[i];
    }
  }
}

/// With the spin w along the axis, v = f' d + w x r and R' = w x R; a = f'' d + w' x r + w x (w x r) and R'' = (skew(w') + skew(w)^2) R.
void Motions::prescribe_rates(double t, Side side, Config* v, Config* a) const {
  for (const Motion& m : list) {
    if (!m.moving) continue;
    const Course f = m.law.at(t, points_.beside(t, side));
    const auto put = [&](Config& to, double scale, const Mat3& turn) {
      if (m.body < 0) {
        for (int n : m.nodes)
          for (int i = 0; i < 3; ++i)
            if (m.component[i]) to.x[n][i] = scale * m.displacement[i];
        return;
      }
      const Mat3 R = Eigen::AngleAxisd(f.value * m.angle, m.axis).toRotationMatrix();
      to.c[m.body] = scale * m.displacement + turn * (R * (points_.bodies[m.body].Xc - m.at));
      to.R[m.body] = turn * R;
      for (int n : m.nodes) to.x[n] = to.c[m.body] + to.R[m.body] * (points_.X[n] - points_.bodies[m.body].Xc);
    };
    const Mat3 spin = skew(f.rate * m.angle * m.axis);
    if (v) put(*v, f.rate, spin);
    if (a) put(*a, f.acceleration, skew(f.acceleration * m.angle * m.axis) + spin * spin);
  }
}

std::string Motions::too_far(double t0, double t1) const {
  for (const Motion& m : list)
    if (m.moving && !(std::abs(m.angle * (m.law.at(t1).value - m.law.at(t0).value)) <= std::numbers::pi / 2))
      return "motion \"" + m.name + "\" turns by more than a quarter of a turn in a step";
  return "";
}

std::string Motions::fault(const Config& q) const {
  double found = -1, follows = 0;  // of the nodes that a joint or spring has made a rigid patch
  for (size_t k = 0; k < list.size(); ++k) {
    const Motion& m = list[k];
    if (m.moving || m.body >= 0) continue;
    for (const int n : m.nodes)
      for (int i = 0; i < 3; ++i)
        if (m.component[i] && !(std::abs(q.x[n][i] - points_.X[n][i]) <= 1e-12 * points_.length))
          found = static_cast<double>(k), follows = points_.follower[n] >= 0 ? 1 : 0;
  }
  const double last = points_.comm->max(found);
  if (last < 0) return "";
  follows = points_.comm->max(found == last ? follows : 0);
  return fmt::format(
      "nodes that motion \"{}\" holds have left their places{}", list[static_cast<size_t>(last)].name,
      follows > 0 ? ", with the rigid patch that a joint or spring makes of them: guide it by a joint, planar or prismatic" : "");
}

void Motions::copy_prescribed(const Config& from, Config& to) const {
  for (const Motion& m : list) {
    if (!m.moving) continue;
    if (m.body >= 0) to.c[m.body] = from.c[m.body], to.R[m.body] = from.R[m.body];
    for (int n : m.nodes)
      for (int i = 0; i < 3; ++i)
        if (m.body >= 0 || m.component[i]) to.x[n][i] = from.x[n][i];
  }
}

/// Force and moment on what a motion holds.
Vec6 Motions::reaction(const Motion& m, const Moment& at) const {
  const Forces& f = at.forces();
  const Config& q = *at.s.left;
  Vec6 r = Vec6::Zero();
  if (m.body >= 0) return f.body[m.body];
  double count = 0;
  Vec3 mean = Vec3::Zero();
  for (int n : m.nodes)
    if (points_.node_owned[n]) mean += q.x[n], ++count;
  double all[4] = {mean[0], mean[1], mean[2], count};
  points_.comm->sum(all);
  mean = Vec3(all[0], all[1], all[2]) / std::max(1.0, all[3]);
  for (int n : m.nodes) {
    Vec3 force = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      if (m.component[i]) force[i] = f.node[n][i];
    r.head<3>() += force;
    r.tail<3>() += (q.x[n] - mean).cross(force);
  }
  points_.comm->sum(std::span<double>(r.data(), 6));
  for (const int j : m.joints)
    for (const auto& [point, force] : held_(at, j)) {
      r.head<3>() += force;
      r.tail<3>() += (point - mean).cross(force);
    }
  return r;
}

/// Work of the forces that prescribed motions exert, this rank's share.  With r = M a + f - F the force on what moves, elastic and other
/// forces work through the displacement d of the step, as everywhere.  Inertia works through h (v0 + v1)/2, which turns M a = M (v1 - v0)/h
/// into the change of the kinetic energy; for what is free that is d, but a law has velocities of its own:
///   W = r.d + M a.(h v0 + h^2 a/2 - d)
void Motions::add_work(const Moment& moment, Work& sum) const {
  if (!moves()) return;
  const Stage& s = moment.s;
  const Config& from = s.from();
  double& work = sum.external;
  const Forces& f = moment.forces();
  for (const Motion& m : list) {
    if (!m.moving) continue;
    if (m.body >= 0) {
      if (points_.comm->rank == 0)
        work += f.body[m.body].head<3>().dot(s.end->c[m.body] - from.c[m.body]) + f.body[m.body].tail<3>().dot(turned(s, m.body));
    } else {
      for (int n : m.nodes)
        for (int i = 0; i < 3; ++i)
          if (m.component[i]) work += f.node[n][i] * (s.end->x[n][i] - from.x[n][i]);
    }
  }
  if (!s.v0) return;
  Stage inertia = s;
  inertia.rates_alone = true, inertia.load_factor = 0, inertia.v = nullptr, inertia.dissipation = nullptr, inertia.h = 0;
  inertia.e0 = inertia.e1 = inertia.w0 = inertia.w1 = &points_.start;  // without strain
  const std::vector<double> none(moment.lambda.size(), 0.0);
  const Moment inert(moment, inertia, none);
  const Forces& of_inertia = inert.forces();
  const double h = s.h;
  for (const Motion& m : list) {
    if (!m.moving) continue;
    for (int n : m.nodes) {
      const Vec3 beyond = h * s.v0->x[n] + h * h / 2 * s.a->x[n] - (s.end->x[n] - from.x[n]);
      for (int i = 0; i < 3; ++i)
        if (m.body >= 0 || m.component[i]) work += of_inertia.node[n][i] * beyond[i];
    }
    if (const int b = m.body; b >= 0 && points_.counts(b)) {
      const Vec3 beyond = h * s.v0->c[b] + h * h / 2 * s.a->c[b] - (s.end->c[b] - from.c[b]);
      const Mat3 turns = h * s.v0->R[b] + h * h / 2 * s.a->R[b] - (s.end->R[b] - from.R[b]);
      work += points_.bodies[b].inertia(s.a->c[b], s.a->R[b], beyond, turns) + beams_.inertia(b, *s.a, beyond, turns);
    }
  }
}

std::vector<Output> Motions::outputs() const {
  std::vector<Output> out;
  for (const Motion& m : list) out.push_back({.group = "motion", .name = m.name, .n_mid = 6});
  return out;
}

void Motions::observe(const Sight& at) {
  for (const Motion& m : list) {
    if (!at.step) return;
    const Vec6 f = reaction(m, *at.step);
    at.mid.insert(at.mid.end(), f.data(), f.data() + 6);
  }
}

/// At the start velocities jump from those given to those of the laws.
void Motions::add_jumps(double t, const Config& before, const Config& after, std::span<const double>, std::vector<Jump>& jumps) const {
  for (const Motion& m : list) {
    if (!m.moving) continue;
    const std::string who = "motion \"" + m.name + "\"";
    if (t > 0) {
      const bool turns = m.angle != 0;
      const double by = m.law.jump(t, points_.same_time);
      jumps.push_back({by, m.law.top_rate(), who, by * (turns ? std::abs(m.angle) : m.displacement.norm()), turns ? "rad/s" : "m/s"});
      continue;
    }
    double by = 0, speed = 0;
    const auto point = [&](const Vec3& from, const Vec3& to) {
      by = std::max(by, (to - from).norm()), speed = std::max({speed, from.norm(), to.norm()});
    };
    for (int n : m.nodes) {
      Vec3 from = before.x[n], to = after.x[n];
      for (int i = 0; i < 3; ++i)
        if (!m.component[i]) from[i] = to[i] = 0;
      point(from, to);
    }
    if (const int b = m.body; b >= 0) {
      const double size = points_.bodies[b].size;
      point(before.c[b], after.c[b]);
      for (int i = 0; i < 3; ++i) point(size * before.R[b].col(i), size * after.R[b].col(i));
    }
    by = points_.comm->max(by), speed = points_.comm->max(speed);
    jumps.push_back({by, speed, who, by, "m/s"});
  }
}

}  // namespace hilo
