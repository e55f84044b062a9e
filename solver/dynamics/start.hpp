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
/// Minimum-norm multipliers that give the same forces as `lambda`, all rows of all joints counted; laid out like lambda.
std::vector<double> minimum_norm(const System& system, const Config& left, std::span<const double> lambda);

/// Velocities made consistent with the joints in the mass norm; returns the largest change [m/s].
double project_velocities(const System& system, KktSolver& solver, const Config& q, Config& v);
/// Accelerations and multipliers that satisfy equations and constraints at (q, v) at time t.
void consistent_acceleration(const System& system, KktSolver& solver, const State& s, Config& a, std::vector<double>& lambda);

/// Newton to rest under the loads at time t times `ramp`.  With `mechanism`, a pseudo mass that fades away holds motions nothing resists.
NewtonReport equilibrium(System& system, KktSolver& solver, Config& q, std::vector<double>& lambda, double t, double ramp, bool mechanism,
                         const NewtonOptions& options);

}  // namespace hilo
