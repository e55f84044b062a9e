// SPDX-License-Identifier: GPL-3.0-or-later
// The start from equilibrium.
#include <fmt/format.h>

#include "dynamics/held.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start.hpp"

namespace hilo {

bool settle_down(RunParts& run) {
  System& system = run.system;
  State& state = run.state;
  require_rest(system, state.q, run.scene.table("time").where("start"));
  const NewtonReport r = equilibrium(system, *run.solver, state.q, state.lambda, 0, 1, true, run.newton);
  if (!r.converged) {
    run.audit->start(state);
    run.recorder->first(state, run.audit->ledger());
    run.stop("no static equilibrium at the start: " + r.reason + unheld(system, system.start));
    return false;
  }
  Stage rest = stage_at(state.q, 0);
  rest.elapsed = slow, system.advance(rest), system.settle(true);
  if (run.talk) fmt::print(stderr, "equilibrium after {} iterations\n", r.iterations);
  return true;
}

}  // namespace hilo
