// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/from_rest.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/interrupt.hpp"
#include "dynamics/linear_step.hpp"
#include "dynamics/soft_contacts.hpp"
#include "dynamics/start.hpp"
#include "system/revising.hpp"

namespace hilo {
namespace {

Stage rest_at(const Config& q) {
  Stage s = stage_at(q, 0);
  s.elapsed = slow;
  return s;
}

/// A step of tau [s] from rest at `before`, from the guess q.
NewtonReport step_from_rest(RunParts& run, double tau, const Config& before, const NewtonOptions& options, Config& q,
                            std::vector<double>& lambda) {
  Config acceleration;
  Unknown u(run.system, q, q);
  const NewtonReport report = newton(
      run.system, *run.solver,
      [&](const Unknown& at) {
        const double slope = 1 / (tau * tau);
        combine(acceleration, {{slope, &at.q}, {-slope, &before}});
        Stage s = rest_at(at.q);
        s.a = &acceleration, s.mass_slope = slope;
        return s;
      },
      u, lambda, options);
  q = u.q;
  return report;
}

/// Residual of statics.
Residual forces_at_rest(RunParts& run, const Config& q, const std::vector<double>& lambda) {
  Config none;
  combine(none, {{0, &q}});
  Stage s = rest_at(q);
  s.a = &none;
  Residual r;
  assemble(run.system, *run.solver, s, lambda, r, false);
  return r;
}

}  // namespace

std::string keep_at_rest(System& system, const Config& q) {
  system.commit(q), system.advance(rest_at(q));
  return system.fault(q);
}

/// A step that goes against the forces where it began leads to another state than the next below, as back to one that is not stable: it is
/// shortened.
NewtonReport come_to_rest(RunParts& run) {
  System& system = run.system;
  State& state = run.state;
  const NewtonOptions& options = run.newton;
  const Config start = state.q;
  constexpr int most = 1000;
  constexpr double first = 0.01, longest = 20, least = 1e-9;  // [s]
  constexpr int easy = 8;                                     // iterations
  NewtonReport report;
  int iterations = 0;
  Config q, way;  // of the last step
  std::vector<double> lambda;
  combine(way, {{0, &start}});
  SoftContacts soft(system);
  double tau = first;
  bool stays = false, at_rest = false;  // the last step, where it began; to its tolerance
  for (int k = 0; k < most && tau > least; ++k) {
    const Residual forces = forces_at_rest(run, state.q, state.lambda);  // by what the last step chose
    const auto begin_again = [&] {
      system.commit(state.q), system.settle(false);
      if (const auto carry = system.search(state.q, &way, 2)) run.follow(*carry);
      q = state.q, lambda = state.lambda;
      revise(system, rest_at(q));
    };
    if (stays && system.comm->max(relative_residual(system, forces)) <= std::max(options.tolerance, 2 * report.residual)) {
      if (tau == longest) return report;
      at_rest = true, tau = longest;  // a last one leaves least
    }
    const auto give_up = [&](const std::string& reason) { return report.converged = false, report.reason = reason, report; };
    if (system.largest_difference(start, state.q) > options.reach * system.length) return give_up("what nothing holds leaves the scene");
    if (system.comm->max(noted_signal().empty() ? 0 : 1) > 0) return give_up("a signal came");
    begin_again();
    int taken = 0;
    const auto attempt = [&](const NewtonOptions& how, SoftContacts::Turn turn) {
      NewtonReport r = step_from_rest(run, tau, state.q, how, q, lambda);
      taken += r.iterations;
      if (!r.converged || !turn.last) return r;
      r.reason = keep_at_rest(system, q);
      stays = system.largest_difference(q, state.q) <= 1e-6 * system.length;
      if (r.reason.empty() && !stays && work_of(system, forces, Unknown(system, state.q, q).increments(system)) > 0)
        r.reason = "a step goes against the forces";
      r.converged = r.reason.empty();
      return r;
    };
    report = at_rest ? attempt(options, {true, true}) : soft.find(options, begin_again, attempt, q);
    report.iterations = iterations += taken;
    if (!report.converged) {
      combine(way, {{0, &q}});
      if (at_rest) {
        system.commit(state.q), system.settle(false);
        report.converged = true, report.reason.clear();
        return report;
      }
      tau /= 4, stays = false;
      continue;
    }
    system.settle(true);
    combine(way, {{1, &q}, {-1, &state.q}});
    std::swap(state.q, q), std::swap(state.lambda, lambda);
    if (at_rest && stays) return report;
    at_rest = false;
    tau = std::min(tau * (taken <= easy ? 3 : 1.5), longest);
  }
  if (report.converged) report.converged = false, report.reason = fmt::format("{} steps do not end at rest", most);
  return report;
}

}  // namespace hilo
