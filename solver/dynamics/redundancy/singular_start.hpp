// SPDX-License-Identifier: GPL-3.0-or-later
// Leaving a singular position.
//
// A mechanism drawn flat, or at a dead point, can leave it along several branches, and velocities that its rows allow there are those of
// all branches at once.  Poses a little ahead, where all rows close, tell which branch velocities (from rest, accelerations) lead to, and
// which rows are independent along it.  Velocities are projected onto what the joints allow there, at s, s/2 and s/4, and extrapolated to s
// = 0 (Richardson): a velocity that is off the branch by d would cost multipliers of d m/h^2.
#pragma once
#include "dynamics/redundancy/redundancy.hpp"
#include "dynamics/state.hpp"
#include "linear/kkt.hpp"

namespace hilo {

/// Velocities of `s` at a singular position, consistent with the rows independent there, become those of a branch, and the rows of all
/// joints those independent along it; `rows` where nothing leads out.  Returns the largest change of the velocity of a point [m/s].
double follow_branch(System& system, KktSolver& solver, State& s, Redundancy& redundancy, const std::vector<Active>& rows);

}  // namespace hilo
