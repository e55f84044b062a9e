// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/flexible.hpp"

#include <petscvec.h>

namespace hilo::petsc {

bool set_near_null_space(Mat A, const std::vector<double>& positions) {
  if (comm().max(positions.empty() ? 0 : 1) == 0) return false;
  Vec x;
  MatNullSpace modes;
  check(VecCreateMPIWithArray(PETSC_COMM_WORLD, 3, static_cast<PetscInt>(positions.size()), PETSC_DETERMINE, positions.data(), &x));
  check(MatNullSpaceCreateRigidBody(x, &modes));
  check(MatSetNearNullSpace(A, modes));
  check(MatNullSpaceDestroy(&modes));
  check(VecDestroy(&x));
  return true;
}

}  // namespace hilo::petsc
