// SPDX-License-Identifier: GPL-3.0-or-later
// What PETSc has, as kinds of hilo's iterative solver: only the flexible block and its approximate inverse are the library's, so that all
// share the Krylov method and the treatment of bodies and multipliers.
#pragma once
#include "linear/petsc/kinds.hpp"

namespace hilo::bench {

/// petsc-icc, petsc-ilu, petsc-gamg, petsc-hypre, petsc-cholmod; petsc-bddc, petsc-bddc-deluxe, petsc-bddc-adaptive, petsc-fetidp (one
/// subdomain a rank); or null.
const petsc::PetscKind* find_peer(const std::string& word);

}  // namespace hilo::bench
