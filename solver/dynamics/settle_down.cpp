// SPDX-License-Identifier: GPL-3.0-or-later
// The start from equilibrium.
#include <fmt/format.h>

#include "dynamics/held.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/stability.hpp"
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
  Stability stability(system, *run.solver, 0, 1);
  if (const auto unstable = stability.look(state.q, state.lambda)) {
    const Config before = state.q;
    const std::string where = run.scene.table("time").where("start"),
                      found = "the equilibrium at the start is not stable: " + unstable->text;
    if (stability.leave(*unstable, state.q, state.lambda, true, run.newton))
      warn(where, fmt::format("{}. The run starts from a stable one, {:.3g} m away", found, system.largest_difference(before, state.q)));
    else
      warn(where, found + ". No stable one was found: the run starts there");
  }
  if (run.talk && !stability.known()) Stability::tell_unknown(run.solver->name());
  Stage rest = stage_at(state.q, 0);
  rest.elapsed = slow, system.advance(rest), system.settle(true);
  if (run.talk) fmt::print(stderr, "equilibrium after {} iterations\n", r.iterations);
  return true;
}

}  // namespace hilo
