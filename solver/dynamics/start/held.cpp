// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/start/held.hpp"

#include <cmath>

#include "base/error.hpp"
#include "dynamics/newton.hpp"
#include "dynamics/start/start.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

System::Loose loose(const System& system, const Config& q, double t, double ramp, bool with_loads, double elapsed = 0) {
  Config zero;
  combine(zero, {{0, &q}});
  Stage s = stage_at(q, t);
  s.a = &zero, s.load_factor = ramp, s.elapsed = elapsed;
  return system.loose(s, with_loads);
}

/// Which contacts begin apart, to be said last, or "".
std::string apart(const System& system, const Config& q) {
  const std::string found = touching(system) ? touching(system)->apart(q) : "";
  return found.empty() ? "" : "; " + found + ", and what does not touch holds nothing";
}

}  // namespace

void require_held(const System& system, const Config& q, double t, double ramp, const std::string& where) {
  if (const auto found = loose(system, q, t, ramp, true); !found.text.empty())
    throw Error(where, found.text + ": a static analysis has no answer", "hold it by a motion, a joint or a spring" + apart(system, q));
}

/// A translation that is free here is free for ever where joints and springs feel nothing of a long way along it.
void require_rest(const System& system, const Config& q, const std::string& where) {
  const auto found = loose(system, q, 0, 1, true, slow);
  if (found.straight.empty() || touching(system)) return;  // what it may come to lie on is not known yet
  Config zero;
  combine(zero, {{0, &q}});
  Stage s = stage_at(q, 0);
  s.a = &zero;
  Residual r;
  system.evaluate(s, std::vector<double>(3 * system.n_joint_blocks(), 0.0), r, nullptr);
  const double force = system.comm->max(r.force_scale);
  for (const std::vector<double>& z : found.straight) {
    double push = 0, size = 0;  // shared nodes: every rank has its part of the residual
    for (size_t i = 0; i < z.size(); ++i) push += r.r[i] * z[i], size = std::max(size, std::abs(z[i]));
    push = system.comm->sum(push), size = system.comm->max(size);
    if (!(std::abs(push) > 1e-6 * force * size)) continue;
    bool for_ever = true;
    for (const double way : {0.37, -0.61}) {
      std::vector<double> far(z);
      for (double& x : far) x *= way * system.length / size;
      Config there = q;
      system.move(there, far);
      const double before = system.energy(q, zero).elastic, after = system.energy(there, zero).elastic;
      for_ever = for_ever && system.violation(there, 0).worst() < system.violation(q, 0).worst() + 1e-9 * system.length &&
                 std::abs(after - before) < 1e-9 * force * system.length;
    }
    if (for_ever)
      throw Error(where, found.text + ", and its weight or loads push it: it has no equilibrium",
                  "hold it by a motion, a joint or a spring, or leave out start");
  }
}

std::string unheld(const System& system, const Config& q) {
  const auto found = loose(system, q, 0, 1, false);
  return found.text.empty() ? "" : "; " + found.text + apart(system, q);
}

}  // namespace hilo
