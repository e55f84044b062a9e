// What moves by a law: positions and their derivatives, reactions and work.
#include <cmath>
#include <numbers>

#include "system/facet.hpp"
#include "system/pass.hpp"

namespace hilo {

void System::prescribe(Config& q, double t, double ramp) const {
  for (const Motion& m : motions) {
    if (!m.moving) continue;
    const double f = m.law.at(t, t, ramp).value;
    if (m.body >= 0) {
      const Mat3 R = m.angle != 0 ? Mat3(Eigen::AngleAxisd(f * m.angle, m.axis).toRotationMatrix()) : Mat3::Identity();
      q.c[m.body] = m.at + R * (bodies[m.body].Xc - m.at) + f * m.displacement;
      q.R[m.body] = R;
    } else {
      for (int n : m.nodes)
        for (int i = 0; i < 3; ++i)
          if (m.component[i]) q.x[n][i] = X[n][i] + f * m.displacement[i];
    }
  }
  follow(q);
}

/// With the spin w along the axis, v = f' d + w x r and R' = w x R; a = f'' d + w' x r + w x (w x r) and R'' = (skew(w') + skew(w)^2) R.
void System::prescribe_rates(double t, Side side, Config* v, Config* a) const {
  for (const Motion& m : motions) {
    if (!m.moving) continue;
    const Course f = m.law.at(t, beside(t, side));
    const auto put = [&](Config& to, double scale, const Mat3& turn) {
      if (m.body < 0) {
        for (int n : m.nodes)
          for (int i = 0; i < 3; ++i)
            if (m.component[i]) to.x[n][i] = scale * m.displacement[i];
        return;
      }
      const Mat3 R = Eigen::AngleAxisd(f.value * m.angle, m.axis).toRotationMatrix();
      to.c[m.body] = scale * m.displacement + turn * (R * (bodies[m.body].Xc - m.at));
      to.R[m.body] = turn * R;
      for (int n : m.nodes) to.x[n] = to.c[m.body] + to.R[m.body] * (X[n] - bodies[m.body].Xc);
    };
    const Mat3 spin = skew(f.rate * m.angle * m.axis);
    if (v) put(*v, f.rate, spin);
    if (a) put(*a, f.acceleration, skew(f.acceleration * m.angle * m.axis) + spin * spin);
  }
}

std::string System::too_far(double t0, double t1) const {
  for (const Motion& m : motions)
    if (m.moving && !(std::abs(m.angle * (m.law.at(t1).value - m.law.at(t0).value)) <= std::numbers::pi / 2))
      return "motion \"" + m.name + "\" turns by more than a quarter of a turn in a step";
  return "";
}

void System::copy_prescribed(const Config& from, Config& to) const {
  for (const Motion& m : motions) {
    if (!m.moving) continue;
    if (m.body >= 0) to.c[m.body] = from.c[m.body], to.R[m.body] = from.R[m.body];
    for (int n : m.nodes)
      for (int i = 0; i < 3; ++i)
        if (m.body >= 0 || m.component[i]) to.x[n][i] = from.x[n][i];
  }
}

Vec6 System::reaction(const Motion& m, const Forces& f, const Config& q) const {
  Vec6 r = Vec6::Zero();
  if (m.body >= 0) return f.body[m.body];
  double count = 0;
  Vec3 mean = Vec3::Zero();
  for (int n : m.nodes)
    if (node_owned[n]) mean += q.x[n], ++count;
  double all[4] = {mean[0], mean[1], mean[2], count};
  comm->sum(all);
  mean = Vec3(all[0], all[1], all[2]) / std::max(1.0, all[3]);
  for (int n : m.nodes) {
    Vec3 force = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      if (m.component[i]) force[i] = f.node[n][i];
    r.head<3>() += force;
    r.tail<3>() += (q.x[n] - mean).cross(force);
  }
  comm->sum(std::span<double>(r.data(), 6));
  return r;
}

/// Work of the forces that prescribed motions exert, this rank's share.  With r = M a + f - F the force on what moves, elastic and other
/// forces work through the displacement d of the step, as everywhere.  Inertia works through h (v0 + v1)/2, which turns M a = M (v1 - v0)/h
/// into the change of the kinetic energy; for what is free that is d, but a law has velocities of its own:
///   W = r.d + M a.(h v0 + h^2 a/2 - d)
double System::motion_work(const Stage& s, std::span<const double> lambda, const Config& from) const {
  if (!moves_) return 0;
  double work = 0;
  Forces f;
  forces(s, lambda, f);
  for (const Motion& m : motions) {
    if (!m.moving) continue;
    if (m.body >= 0) {
      if (comm->rank == 0)
        work += f.body[m.body].head<3>().dot(s.end->c[m.body] - from.c[m.body]) +
                f.body[m.body].tail<3>().dot(rotation_increment(from.R[m.body], s.end->R[m.body]));
    } else {
      for (int n : m.nodes)
        for (int i = 0; i < 3; ++i)
          if (m.component[i]) work += f.node[n][i] * (s.end->x[n][i] - from.x[n][i]);
    }
  }
  if (!s.v0) return work;
  Stage inertia = s;
  inertia.rates_alone = true, inertia.load_factor = 0, inertia.v = nullptr, inertia.chi = 0, inertia.h = 0;
  inertia.e0 = inertia.e1 = inertia.w0 = inertia.w1 = &start;  // without strain
  const std::vector<double> none(lambda.size(), 0.0);
  forces(inertia, none, f);
  const double h = s.h;
  for (const Motion& m : motions) {
    if (!m.moving) continue;
    for (int n : m.nodes) {
      const Vec3 beyond = h * s.v0->x[n] + h * h / 2 * s.a->x[n] - (s.end->x[n] - from.x[n]);
      for (int i = 0; i < 3; ++i)
        if (m.body >= 0 || m.component[i]) work += f.node[n][i] * beyond[i];
    }
    if (const int b = m.body; b >= 0 && b % comm->size == comm->rank)
      work += bodies[b].inertia(s.a->c[b], s.a->R[b], h * s.v0->c[b] + h * h / 2 * s.a->c[b] - (s.end->c[b] - from.c[b]),
                                h * s.v0->R[b] + h * h / 2 * s.a->R[b] - (s.end->R[b] - from.R[b]));
  }
  return work;
}

}  // namespace hilo
