// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/soft_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "system/touching.hpp"

namespace hilo {

NewtonReport SoftContacts::find(const NewtonOptions& options, const std::function<void()>& begin_again, const Solve& solve,
                                const Config& q) {
  const auto find = [&] { return begins_soft ? softly(options, begin_again, solve, q) : solve(options, {true, true}); };
  NewtonReport report = find();
  if (report.converged || !touching(system_)) return report;
  begin_again();
  begins_soft = !begins_soft;
  return find();
}

/// What goes in deeper than a part of a cell may come out on another side: it begins stiffer.
NewtonReport SoftContacts::softly(const NewtonOptions& options, const std::function<void()>& begin_again, const Solve& solve,
                                  const Config& q) {
  constexpr double deepest = 0.25;
  Touching& contact = *touching(system_);
  NewtonOptions how = options;
  how.patient = true, how.max_iterations = std::max(options.max_iterations, 60);  // friction takes its time where all slides anew
  NewtonReport report;
  for (const double softest : {1e-4, 1e-2, 1.}) {
    begin_again();
    for (double most = softest;; most = most < 1 ? 100 * most : HUGE_VAL) {
      contact.soften(most);
      report = solve(how, {most == softest, most == HUGE_VAL});
      contact.soften(HUGE_VAL);
      if (report.converged && most == HUGE_VAL) return report;
      if (report.converged && contact.depth(q) >= deepest)
        report.converged = false, report.reason = "contacts that are soft on the way are pressed too deep";
      if (!report.converged) break;
    }
  }
  return report;
}

}  // namespace hilo
