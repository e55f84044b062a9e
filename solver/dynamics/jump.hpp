// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a load step ended on another branch of equilibrium than it began on, as where a flat truss snaps through.
#pragma once
#include <optional>
#include <vector>

#include "dynamics/newton.hpp"

namespace hilo {

/// A state of equilibrium and its loads: those at time t, times `ramp`.
struct Loaded {
  const Config& q;
  const std::vector<double>& lambda;
  double t, ramp;
};

/// On one branch a point moves about as far as the tangents at both ends of the step foresee, the less it differs the shorter the step is.
/// A jump has a length of its own, however short the step.  Where a point moved more than three times as far as both foresee, or all
/// against the way that one foresees, the step has jumped, or is too long to tell.  Where the tangent at the start alone explains the way
/// (it is soft just before a limit of the load, or the structure stiffens), the loads are taken back: what then comes to another state than
/// the start has jumped.  A start that its own loads do not balance, as before a preload, is on no branch.  Collective.
class BranchJump {
 public:
  BranchJump(System& system, KktSolver& solver, const NewtonOptions& options) : system_(system), solver_(solver), options_(options) {}
  /// The longest way of a point that was not foreseen [m], or 0.  `at_start`: what the tangent at `from` foresees, where that is known;
  /// `factored`: the solver has factors of the tangent at `to`.
  double between(const Loaded& from, const Loaded& to, std::optional<Config> at_start, bool factored);

 private:
  Residual evaluate(const Config& q, const Loaded& state, const Loaded& loads, bool tangent);
  bool balanced(const Loaded& at, const Loaded& other);
  std::optional<Config> foreseen(const Loaded& at, const Loaded& other, bool factored);
  System& system_;
  KktSolver& solver_;
  NewtonOptions options_;
  Config zero_;
};

/// Where friction turns, parts go ways that no tangent foresees and that are no jumps: they shorten with the step.
struct UnforeseenWays {
  double from = -1, to = 0, rate = 0;  // of the step tried last: shares of the loads, and its way for each [m]
  double last = 0;                     // rate of the step before, or 0 where all was foreseen
  /// Whether a way [m] between two shares of the loads is shorter than that of a longer step from the same share was, or for each share no
  /// longer than that of the step before.
  bool shorten(double begin, double end, double way);
};

}  // namespace hilo
