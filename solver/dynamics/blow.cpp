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
  for (const auto& part : system.parts()) {
    std::vector<Jump> jumps;
    part->add_jumps(s.t, before, s.v, slack, jumps);
    for (const Jump& jump : jumps) {
      if (!(jump.by > most * jump.scale)) continue;
      most = jump.by / jump.scale;
      blow.by = jump.who, blow.speed = jump.told, blow.unit = jump.unit;
    }
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
