// SPDX-License-Identifier: GPL-3.0-or-later
// From a solver that gives up to MUMPS, which does the rest of the run.
#pragma once
#include "linear/petsc/coupling.hpp"
#include "linear/petsc/direct.hpp"
#include "linear/petsc/flexible.hpp"

namespace hilo::petsc {

/// A direct solver with the matrix as it is assembled in `F` and `coupling`.
std::unique_ptr<DirectSolver> hand_over(const FlexibleMatrix& F, const Coupling& coupling, const Cliques& cliques, const BlockMap& map,
                                        double tolerance);

}  // namespace hilo::petsc
