// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/impulse.hpp"

#include <fmt/format.h>

#include "dynamics/start/start.hpp"

namespace hilo {

std::string Impulse::text(double t) const {
  return fmt::format("t = {:.6g} s: {} changes its speed by {:.6g} {} at once: an impulse that does work of {:.6g} J", t, by, speed, unit,
                     work);
}

Impulse strike(const System& system, KktSolver& solver, State& s) {
  Impulse impulse;
  const Config before = s.v;
  const double kinetic = system.energy(s.q, s.v).kinetic;
  std::vector<double> slack;  // rates of joint rows with the velocities before, less those of the laws
  system.row_rates(s.q, before, nullptr, s.t, slack, nullptr);
  impulse.change = project_velocities(system, solver, s.q, s.v, s.t);
  impulse.work = system.energy(s.q, s.v).kinetic - kinetic;
  double most = 1e-6;  // over the rates that occur, so that m/s and rad/s compare, and round-off is none
  for (const Jumping* part : system.all<Jumping>()) {
    std::vector<Jump> jumps;
    part->add_jumps(s.t, before, s.v, slack, jumps);
    for (const Jump& jump : jumps) {
      if (!(jump.by > most * jump.scale)) continue;
      most = jump.by / jump.scale;
      impulse.by = jump.who, impulse.speed = jump.told, impulse.unit = jump.unit;
    }
  }
  return impulse;
}

Impulse Impulses::strike(const System& system, KktSolver& solver, State& s, bool talk) {
  const Impulse impulse = hilo::strike(system, solver, s);
  if (impulse.by.empty()) return impulse;
  ++count_, work_ += impulse.work;
  if (talk && count_ <= 5) fmt::print(stderr, "{}{}\n", impulse.text(s.t), count_ == 5 ? "; further ones are not printed" : "");
  return impulse;
}

Json Impulses::json() const { return {{"count", count_}, {"work", {work_, 6}}}; }

}  // namespace hilo
