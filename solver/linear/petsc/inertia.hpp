// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues below zero of a matrix that the ranks share, by MUMPS (INFOG(12), Sylvester's law of inertia).
#pragma once
#include <petscmat.h>

#include <optional>

#include "linear/petsc/session.hpp"
#include "linear/petsc/shared.hpp"

namespace hilo::petsc {

/// As linear/inertia: of the rows of A that come before local block `first_row`, on the motions that the rows from there on allow.
/// Nothing where MUMPS fails.  Collective.
std::optional<int> eigenvalues_below_zero(Mat A, const SharedBlocks& shared, int first_row);

}  // namespace hilo::petsc
