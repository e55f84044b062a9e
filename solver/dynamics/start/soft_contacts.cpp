// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/start/soft_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "system/touching.hpp"

namespace hilo {

/// What goes in deeper than a part of a cell may come out on another side: it begins stiffer.
NewtonReport SoftContacts::find(LoadStep& step, double t, double ramp, const NewtonOptions& options, Config& q,
                                std::vector<double>& lambda) {
  constexpr double deepest = 0.25;
  System& system = run_.system;
  const auto begin_again = [&] {
    system.commit(run_.state.q), system.settle(false);
    q = run_.state.q, lambda = run_.state.lambda;
  };
  const auto solve = [&](const NewtonOptions& how, LoadStep* from) {
    system.commit(run_.state.q);
    const NewtonReport r = equilibrium(system, *run_.solver, q, lambda, t, ramp, false, how, from);
    return run_.report.iterations += r.iterations, r;
  };
  const auto softly = [&] {
    Touching& contact = *touching(system);
    NewtonOptions how = options;
    how.patient = true, how.max_iterations = std::max(options.max_iterations, 60);  // friction takes its time where all slides anew
    NewtonReport report;
    for (const double softest : {1e-4, 1e-2, 1.}) {
      begin_again();
      LoadStep same{step.t, step.ramp};  // what soft contacts foresee says nothing of a jump
      for (double most = softest;; most = most < 1 ? 100 * most : HUGE_VAL) {
        contact.soften(most);
        report = solve(how, most == softest ? &same : nullptr);
        contact.soften(HUGE_VAL);
        if (report.converged && most == HUGE_VAL) return report;
        if (report.converged && contact.depth(q) >= deepest)
          report.converged = false, report.reason = "contacts that are soft on the way are pressed too deep";
        if (!report.converged) break;
      }
    }
    return report;
  };
  q = run_.state.q, lambda = run_.state.lambda;
  const auto either = [&] { return begins_soft ? softly() : solve(options, &step); };
  NewtonReport report = either();
  if (report.converged || !touching(system)) return report;
  if (system.moves() && system.traits().slides) {  // what moves by a law takes along what lies on it: what sticks is found first
    begin_again();
    touching(system)->stick(true);
    report = solve(options, &step);
    touching(system)->stick(false);
    if (report.converged) report = solve(options, nullptr);
    if (report.converged) return report;
  }
  begin_again();
  begins_soft = !begins_soft;
  report = either();
  if (!report.converged) begins_soft = !begins_soft;
  return report;
}

}  // namespace hilo
