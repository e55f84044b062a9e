// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/start/from_rest.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/interrupt.hpp"
#include "dynamics/linear_step.hpp"
#include "dynamics/start/start.hpp"
#include "system/revising.hpp"

namespace hilo {
namespace {

Stage rest_at(const Config& q, const LoadLevel& under) {
  Stage s = stage_at(q, under.t);
  s.load_factor = under.ramp, s.elapsed = slow;
  return s;
}

/// A step of tau [s] from rest at `before`, from the guess q.
NewtonReport step_from_rest(RunParts& run, const LoadLevel& under, double tau, const Config& before, Config& q,
                            std::vector<double>& lambda) {
  NewtonOptions options = run.newton;
  options.reach *= 10;  // it may end outside the scene
  options.searches = run.system.traits().slides;
  Config acceleration;
  Unknown u(run.system, q, q);
  const NewtonReport report = newton(
      run.system, *run.solver,
      [&](const Unknown& at) {
        const double slope = 1 / (tau * tau);
        combine(acceleration, {{slope, &at.q}, {-slope, &before}});
        Stage s = rest_at(at.q, under);
        s.a = &acceleration, s.mass_slope = slope;
        return s;
      },
      u, lambda, options);
  q = u.q;
  return report;
}

/// Residual of statics.
Residual forces_at_rest(RunParts& run, const LoadLevel& under, const Config& q, const std::vector<double>& lambda) {
  Config none;
  combine(none, {{0, &q}});
  Stage s = rest_at(q, under);
  s.a = &none;
  Residual r;
  assemble(run.system, *run.solver, s, lambda, r, false);
  return r;
}

}  // namespace

std::string keep_at_rest(System& system, const Config& q, const LoadLevel& under) {
  Stage s = rest_at(q, under);
  s.mass_slope = 1;  // which tells it from a load step
  system.commit(q), system.advance(s);
  return system.fault(q);
}

/// A step that goes against the forces where it began leads to another state than the next below, as back to one that is not stable: it is
/// shortened.
RestReport come_to_rest(RunParts& run, State& state, const LoadLevel& under) {
  System& system = run.system;
  const Config start = state.q;
  constexpr int most = 200;
  constexpr double first = 0.01, longest = 20, least = 1e-9;  // [s]
  constexpr int easy = 8;                                     // iterations
  RestReport report;
  int iterations = 0;
  Config q, way;  // of the last step
  std::vector<double> lambda;
  combine(way, {{0, &start}});
  double tau = first;
  bool stays = false, at_rest = false;  // the last step, where it began; the state, to its tolerance
  bool rolls = false;                   // as far in each step as it may
  bool arrived = !system.moves();       // what moves by a law is where it is to be
  for (int k = 0; k < (rolls ? 10 * most : most) && tau > least; ++k) {
    const Residual forces = forces_at_rest(run, under, state.q, state.lambda);  // by what the last step chose
    const auto balanced = [&](const Residual& r) {
      constexpr double rounding = 1e-5;  // a step so short that nothing moves leaves any force
      return system.comm->max(relative_residual(system, r)) <=
             std::clamp(2 * report.residual, run.newton.tolerance, std::max(rounding, run.newton.tolerance));
    };
    const bool rests = stays && balanced(forces);
    if (rests && tau == longest) return report;
    const auto give_up = [&](const std::string& reason) {
      return report.converged = false, report.ends = true, report.reason = reason, report;
    };
    if (system.largest_difference(start, state.q) > run.newton.reach * system.length) return give_up("what nothing holds leaves the scene");
    if (system.comm->max(noted_signal().empty() ? 0 : 1) > 0) return give_up("a signal came");
    system.commit(state.q), system.settle(false);
    if (const auto carry = system.search(state.q, &way, 2)) {
      run.follow(*carry);
      if (&state != &run.state) state.lambda = (*carry)(state.lambda);
    }
    q = state.q, lambda = state.lambda;
    if (!arrived) system.prescribe(q, under.t, under.ramp);
    revise(system, rest_at(q, under));
    at_rest = rests || (stays && balanced(forces_at_rest(run, under, q, lambda)));  // or by what is chosen now
    if (at_rest) tau = longest;                                                     // a last step leaves least
    static_cast<NewtonReport&>(report) = step_from_rest(run, under, tau, state.q, q, lambda);
    const int taken = report.iterations;
    report.iterations = iterations += taken;
    if (report.converged) {
      report.reason = keep_at_rest(system, q, under);
      if (report.reason.empty()) report.reason = system.too_far(state.q, q), rolls = rolls || !report.reason.empty();
      stays = system.largest_difference(q, state.q) <= 1e-6 * system.length;
      if (report.reason.empty() && !stays && arrived && work_of(system, forces, Unknown(system, state.q, q).increments(system)) > 0)
        report.reason = "a step goes against the forces";
      report.converged = report.reason.empty();
    }
    if (!report.converged) {
      combine(way, {{0, &q}});
      if (at_rest) {
        system.commit(state.q), system.settle(false);
        report.converged = true, report.reason.clear();
        return report;
      }
      tau /= rolls ? 1.5 : 4, stays = false;
      continue;
    }
    system.settle(true), arrived = true;
    combine(way, {{1, &q}, {-1, &state.q}});
    std::swap(state.q, q), std::swap(state.lambda, lambda);
    if (at_rest && stays) return report;
    tau = std::min(tau * (rolls ? 1.15 : taken <= easy ? 3 : 1.5), longest);
  }
  if (report.converged) report.reason = fmt::format("{} steps do not end at rest", rolls ? 10 * most : most);
  report.ends = report.converged;
  report.converged = false;
  return report;
}

}  // namespace hilo
