// SPDX-License-Identifier: GPL-3.0-or-later
// Small vibrations about a state of rest:
//
//   (K - omega^2 M) x + G^T mu = 0,   G x = 0,   x_i^T M x_j = delta_ij
//
// with K, M and G the derivatives of the very equations that a run integrates: springs, joints, loads that follow, the stress of a preload.
#pragma once
#include "dynamics/state.hpp"
#include "system/mode_output.hpp"

namespace hilo {

/// Of the equations of motion that a mode may leave (`NaturalMode::error`).
inline constexpr double most_error = 1e-4;

struct FoundMode {
  NaturalMode figures;
  std::vector<double> x;   // increments of the unknowns, of unit mass (3 x n_blocks before the multipliers)
  bool is_real = true;     // all of it swings in phase
  bool is_rigid = false;   // nothing resists it
  std::vector<double> mu;  // multipliers, laid out like State::lambda
};

/// The `wanted` lowest modes about `rest`, whose multipliers hold it there, or all there are; `at_rest`: with their damping.  Error where
/// the forces of a small motion are no gradient, as those of follower pressure.
std::vector<FoundMode> natural_modes(const System& system, KktSolver& solver, const State& rest, int wanted, bool at_rest,
                                     const std::function<void(int)>& tell);

}  // namespace hilo
