// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/accelerated_support.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "dynamics/state.hpp"

namespace hilo {
namespace {

constexpr double negligible = 1e-9;  // [m/s^2 or rad/s^2]

/// What is held to a law, and what that asks for.
struct Asked {
  std::vector<std::pair<int, double>> along;  // axis, acceleration along it
  double turning = 0;                         // the largest of a body, at its size
  std::string who;
};
Asked asked_by_motions(const System& system, const Config& q, const Config& zero) {
  Asked out;
  Config v = zero, a = zero;
  system.prescribe_rates(0, Side::right, &v, &a);
  const auto tell = [&](double size, const std::string& name) {
    if (std::abs(size) > negligible && out.who.empty()) out.who = name;
  };
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    const Body& body = system.bodies[b];
    if (!body.held) continue;
    for (int i = 0; i < 3; ++i) out.along.emplace_back(i, a.c[b][i]);
    const double turning = (a.R[b] - v.R[b] * q.R[b].transpose() * v.R[b]).norm();
    tell(a.c[b].norm() + turning, "motion \"" + body.motion + "\"");
    out.turning = std::max(out.turning, turning * body.size);
  }
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size() && f.array == &Config::x; ++k)
      for (int i = 0; i < 3; ++i)
        if (f.held_of(k)[static_cast<size_t>(i)]) {
          out.along.emplace_back(i, a.x[static_cast<size_t>(f.item[k])][i]);
          tell(out.along.back().second, "a motion");
        }
  return out;
}

/// Whether what stands holds a translation of all along u, by forces that count beside those of its inertia when it has gone its length.
bool is_held(const System& system, const Config& q, const Config& zero, const Vec3& u) {
  Residual r[2];
  for (const int moved : {0, 1}) {
    const Config along = uniform(system, q, moved * system.length * u.normalized());
    Config there;
    combine(there, {{1, &q}, {1, &along}});
    Stage s = stage_at(there, 0);
    s.a = &zero;
    system.evaluate(s, std::vector<double>(3 * static_cast<size_t>(system.n_joint_blocks()), 0.0), r[moved], nullptr);
  }
  double change = 0;
  for (size_t i = 0; i < 3 * static_cast<size_t>(system.first_joint_block()); ++i)
    change = std::max(change, std::abs(r[1].r[i] - r[0].r[i]));
  return change > 1e-3 * system.mass * u.norm();
}

}  // namespace

Config uniform(const System& system, const Config& q, const Vec3& u) {
  Config out;
  combine(out, {{0, &q}});
  for (Vec3& x : out.x) x = u;
  for (size_t b = 0; b < out.c.size(); ++b)
    if (!system.bodies[b].ground) out.c[b] = u;
  return out;
}

AcceleratedSupport accelerated_support(const System& system, const Config& q) {
  Config zero;
  combine(zero, {{0, &q}});
  AcceleratedSupport out;
  std::vector<double> rate, courses, moved;
  system.row_rates(q, zero, &zero, 0, rate, &courses);
  for (const auto& c : system.constraints())
    for (int r = 0; r < c->n_rows() && out.who.empty(); ++r)
      if (c->active()[r] && std::abs(courses[static_cast<size_t>(c->row() + r)]) > negligible) out.who = c->label();
  const Asked motions = asked_by_motions(system, q, zero);
  if (out.who.empty()) out.who = motions.who;
  if (out.who.empty()) return out;

  const auto n_rows = std::ssize(courses), n_held = std::ssize(motions.along);
  const std::vector<char> on = system.rows_on();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n_rows + n_held, 3);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n_rows + n_held);
  for (int k = 0; k < 3; ++k) {
    const Config along = uniform(system, q, Vec3::Unit(k));
    system.row_rates(q, zero, &along, 0, rate, &moved);
    for (Eigen::Index i = 0; i < n_rows; ++i)
      if (const auto at = static_cast<size_t>(i); on[at]) A(i, k) = moved[at] - courses[at], b[i] = -courses[at];
    for (Eigen::Index i = 0; i < n_held; ++i) {
      const auto& [axis, acceleration] = motions.along[static_cast<size_t>(i)];
      A(n_rows + i, k) = axis == k, b[n_rows + i] = acceleration;
    }
  }
  const Vec3 u = A.completeOrthogonalDecomposition().solve(b);
  if ((A * u - b).norm() + motions.turning <= 1e-6 * b.norm() && !is_held(system, q, zero, u)) out.all = u;
  return out;
}

}  // namespace hilo
