// SPDX-License-Identifier: GPL-3.0-or-later
// Vibrations about bodies that turn steadily, each about an axis through its centre that does not move: with turns z of the unknowns in
// inertial axes, directors (1 + z^) R0(t) and their derivatives by time, the equations linear in z have constant coefficients where what
// turns is the same all around,
//
//   z'' + C z' + K z = 0   in the modes without spin,
//
// C with the gyroscopic moments and what dampers see of the spin, K no longer symmetric.  Where joints turn along, z is seen from a frame
// that does (dynamics/modes/turning_frame.hpp).
#pragma once
#include "dynamics/modes/natural_modes.hpp"

namespace hilo {

/// Why the bodies that move at `state` do not turn steadily in their places, or "".
std::string not_steady(const System& system, const State& state);

/// The `wanted` slowest pairs of complex modes in the span of `basis`, real modes about the pose of `state` at rest; accelerations and
/// multipliers are those of the spin.  Their frequency is that of a swing, x its shape when it begins; effective masses are such that all
/// of them add up to those of the basis, and the same as those of the basis without spin.  Error where coefficients change as the bodies
/// turn.
std::vector<FoundMode> whirling_modes(const System& system, KktSolver& solver, const State& state, const std::vector<FoundMode>& basis,
                                      int wanted);

}  // namespace hilo
