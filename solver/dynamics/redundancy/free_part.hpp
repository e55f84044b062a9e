// SPDX-License-Identifier: GPL-3.0-or-later
// What a singular matrix leaves free, by name.
#pragma once
#include <string>

#include "system/system.hpp"

namespace hilo {

/// `: body "arm" is not held, or has no mass`: what moves most in the null vector of the solver's matrix, assembled and singular; "" where
/// it cannot be told.  By inverse iteration with the matrix shifted by 1e-9 of `sigma`, the scale of its constraint rows [N/m].  The matrix
/// is spoilt by it.  Collective.
std::string free_part(const System& system, KktSolver& solver, double sigma);

}  // namespace hilo
