// SPDX-License-Identifier: GPL-3.0-or-later
// Before the first step: positions and velocities that satisfy the constraints, consistent accelerations, static equilibrium.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "dynamics/integrator.hpp"
#include "dynamics/newton.hpp"

namespace hilo {

/// Positions at t = 0 that satisfy the joints, as near to q as the mass norm says; returns the largest change [m].
/// Error naming the joint that is furthest apart where there are none.
double assemble_positions(System& system, KktSolver& solver, Config& q);

/// Velocities from time t on, in the mass norm: those of the laws for what moves by one, and consistent with the joints and what drives
/// them for the rest; returns the largest change of what is free [m/s].
double project_velocities(const System& system, KktSolver& solver, const Config& q, Config& v, double t);
/// Velocities at time t change by impulses of all rows, which change the rates of rows by `by` [m/s, 1/s; laid out like multipliers].
/// `sigma`: of the matrix of mass and rows at q that the solver holds; 0: it is made, and then held.  Returns the impulses [N s, N m s over
/// the scale of a row]; empty: masses and rows do not determine the change.
std::vector<double> change_rates(const System& system, KktSolver& solver, const Config& q, Config& v, double t, std::span<const double> by,
                                 double* sigma);
/// Accelerations and multipliers that satisfy equations and constraints at (s.q, s.v) at time s.t; returns why masses and joints do not
/// determine them, or nothing.  `has_mass`: the solver holds the matrix of mass and rows at s.q.
std::string find_acceleration(const System& system, KktSolver& solver, const State& s, Config& a, std::vector<double>& lambda,
                              bool has_mass = false);
/// The same; Error where they are not determined.
void solve_acceleration(const System& system, KktSolver& solver, const State& s, Config& a, std::vector<double>& lambda,
                        bool has_mass = false);
/// A stage at an instant, with accelerations: what is there, at rest or in motion.
struct Instant {
  Config a, before, after;  // the pair of the rate terms
  Stage stage;
  Instant(const Instant&) = delete;
  Instant(const State& s, Config accelerations);
};
/// v becomes the nearest velocities, in the mass norm, that directors, products of modes and joints allow at time t; the solver then holds
/// the matrix of mass and rows at q.
void nearest_velocities(const System& system, KktSolver& solver, const Config& q, Config& v, double t);
/// s.a and s.lambda that satisfy equations and constraints at (q, v) at time t, and s.jerk by forward differences over h.
void consistent_acceleration(const System& system, KktSolver& solver, State& s, double h);

/// Time of a step of statics, for materials: so slow that rates do not count.
inline constexpr double slow = std::numeric_limits<double>::infinity();

/// A load step begins at rest under the loads at time t times `ramp`; `foreseen`: the way that the tangent there foresees, where something
/// moves by a law.
struct LoadStep {
  double t, ramp;
  std::optional<Config> foreseen = {};
};
/// Newton to rest under the loads at time t times `ramp`.  With `mechanism`, a pseudo mass that fades away holds motions nothing resists.
/// `step`: where q is at rest; null: under the same loads.
NewtonReport equilibrium(System& system, KktSolver& solver, Config& q, std::vector<double>& lambda, double t, double ramp, bool mechanism,
                         const NewtonOptions& options, LoadStep* step = nullptr);

}  // namespace hilo
