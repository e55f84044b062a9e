// SPDX-License-Identifier: GPL-3.0-or-later
// What every solution for unknowns does: residual and tangent of a stage, what all ranks add to them, a correction by the solver, and the
// multipliers that it moves.
#pragma once
#include "linear/kkt.hpp"
#include "system/system.hpp"

namespace hilo {

/// What this rank has of a residual becomes all of it, without what acts on what moves by a law.  Collective.
void complete(const System& system, KktSolver& solver, std::vector<double>& r);
/// The same, with its largest force and least determinant.
void complete(const System& system, KktSolver& solver, Residual& r);
/// The complete residual of a stage; with `tangent` the solver gets its derivative.  Collective.
void assemble(const System& system, KktSolver& solver, const Stage& stage, std::span<const double> lambda, Residual& r, bool tangent);
/// K z = -r with the tangent assembled last, within `tolerance` (KktSolver::solve).  Collective.
SolveReport correct(KktSolver& solver, const std::vector<double>& r, std::vector<double>& z, double tolerance = 0);
/// Multipliers move by a share of a correction z, found with rows of the scale sigma.
void add_multipliers(const System& system, double sigma, std::span<const double> z, std::vector<double>& lambda, double share = 1);

}  // namespace hilo
