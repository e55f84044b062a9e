#include "dynamics/blow.hpp"

#include <fmt/format.h>

#include "dynamics/start.hpp"

namespace hilo {

std::string Blow::text(double t) const {
  return fmt::format("t = {:.6g} s: {} changes its speed by {:.6g} {} at once: a blow of {:.6g} J", t, by, speed, unit, work);
}

Blow strike(const System& system, KktSolver& solver, State& s) {
  Blow blow;
  const Config before = s.v;
  const double kinetic = system.energy(s.q, s.v).kinetic;
  std::vector<double> slack;  // rates of joint rows with the velocities before, less those of the laws
  system.row_rates(s.q, before, nullptr, s.t, slack, nullptr);
  blow.change = project_velocities(system, solver, s.q, s.v, s.t);
  blow.work = system.energy(s.q, s.v).kinetic - kinetic;
  double most = 1e-6;  // over the rates that occur, so that m/s and rad/s compare, and round-off is none
  const auto look = [&](double jump, double scale, const char* section, const std::string& name, double size, const char* unit) {
    if (!(jump > most * scale)) return;
    most = jump / scale;
    blow.by = fmt::format("{} \"{}\"", section, name), blow.speed = jump * size, blow.unit = unit;
  };
  const auto of_law = [&](const MotionLaw& law) {
    return std::abs(law.at(s.t, system.beside(s.t, Side::right)).rate - law.at(s.t, system.beside(s.t, Side::left)).rate);
  };
  for (const Motion& m : system.motions) {
    if (!m.moving) continue;
    if (s.t > 0) {
      const bool turns = m.angle != 0;
      look(of_law(m.law), m.law.top_rate(), "motion", m.name, turns ? std::abs(m.angle) : m.displacement.norm(), turns ? "rad/s" : "m/s");
      continue;
    }
    double jump = 0, speed = 0;
    const auto point = [&](const Vec3& from, const Vec3& to) {
      jump = std::max(jump, (to - from).norm()), speed = std::max({speed, from.norm(), to.norm()});
    };
    for (int n : m.nodes) {
      Vec3 from = before.x[n], to = s.v.x[n];
      for (int i = 0; i < 3; ++i)
        if (!m.component[i]) from[i] = to[i] = 0;
      point(from, to);
    }
    if (const int b = m.body; b >= 0) {
      point(before.c[b], s.v.c[b]);
      for (int i = 0; i < 3; ++i) point(system.bodies[b].size * before.R[b].col(i), system.bodies[b].size * s.v.R[b].col(i));
    }
    look(system.comm->max(jump), system.comm->max(speed), "motion", m.name, 1, "m/s");
  }
  for (size_t j = 0; j < system.joints.size(); ++j) {
    const Drive& d = system.joints[j].drive;
    if (d.row < 0) continue;
    const double jump = s.t > 0 ? of_law(d.law) : std::abs(slack[3 * (system.joint_block[j] - system.first_joint_block()) + d.row]);
    look(jump, d.law.top_rate(), "joint", system.joints[j].name, 1, d.unit);
  }
  return blow;
}

Blow Blows::strike(const System& system, KktSolver& solver, State& s, bool talk) {
  const Blow blow = hilo::strike(system, solver, s);
  if (blow.by.empty()) return blow;
  ++count_, work_ += blow.work;
  if (talk && count_ <= 5) fmt::print(stderr, "{}{}\n", blow.text(s.t), count_ == 5 ? "; no more are told" : "");
  return blow;
}

std::string Blows::json() const { return fmt::format("{{\"count\": {}, \"work\": {:.6g}}}", count_, work_); }

}  // namespace hilo
