// Before the first step: redundant constraints, velocities that satisfy the constraints, consistent accelerations, static equilibrium.
#pragma once
#include "dynamics/integrator.hpp"
#include "dynamics/newton.hpp"

namespace hilo {

/// What the rank check found.
struct Redundancy {
  int rows = 0, rank = 0;
  std::vector<std::string> dropped;  // "joint \"b\" row 3 (depends on joints a, c)"
};
/// Rank of the joint rows at q by QR with column pivoting; dependent rows are switched off in the system's joints.
Redundancy drop_redundant_rows(System& system, const Config& q);
/// The same at a later q, where a step failed: another choice of as many rows is taken, fewer (a singular position) are not.
/// True where the choice has changed.
bool recheck_redundant_rows(System& system, const Config& q, const Redundancy& before);
/// Minimum-norm multipliers that give the same forces as `lambda`, all rows of all joints counted; laid out like lambda.
std::vector<double> minimum_norm(const System& system, const Stage& stage, std::span<const double> lambda);

/// Positions at t = 0 that satisfy the joints, as near to q as the mass norm says; returns the largest change [m].
/// Error naming the joint that is furthest apart where there are none.
double assemble_positions(System& system, KktSolver& solver, Config& q);

/// Velocities made consistent with the joints and what drives them at time t, in the mass norm; returns the largest change [m/s].
double project_velocities(const System& system, KktSolver& solver, const Config& q, Config& v, double t);
/// s.a and s.lambda that satisfy equations and constraints at (q, v) at time t, and s.jerk by forward differences over h.
void consistent_acceleration(const System& system, KktSolver& solver, State& s, double h);

/// Newton to rest under the loads at time t times `ramp`.  With `mechanism`, a pseudo mass that fades away holds motions nothing resists.
NewtonReport equilibrium(System& system, KktSolver& solver, Config& q, std::vector<double>& lambda, double t, double ramp, bool mechanism,
                         const NewtonOptions& options);

}  // namespace hilo
