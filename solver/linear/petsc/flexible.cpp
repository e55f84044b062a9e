#include "linear/petsc/flexible.hpp"

#include <petscksp.h>

namespace hilo::petsc {

void FlexibleInverse::release() {
  PCDestroy(&pc_);
  MatDestroy(&scalar_);
}

void FlexibleInverse::use(Kind kind) {
  if (kind != kind_) release();
  kind_ = kind;
}

bool FlexibleInverse::set_up() {
  const bool fresh = !pc_;
  if (fresh) {
    check(PCCreate(PETSC_COMM_WORLD, &pc_));
    check(PCSetOptionsPrefix(pc_, "hilo_flexible_"));
    check(PCSetErrorIfFailure(pc_, PETSC_FALSE));
  }
  if (kind_ == Kind::incomplete) {
    check(PCSetOperators(pc_, F_.mat(), F_.mat()));
    if (fresh) check(PCSetType(pc_, PCBJACOBI));
  } else {
    check(MatConvert(F_.mat(), MATAIJ, scalar_ ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, &scalar_));
    check(MatSetBlockSize(scalar_, 3));
    if (fresh && !positions_.empty()) {
      Vec x;
      MatNullSpace modes;
      check(VecCreateMPIWithArray(PETSC_COMM_WORLD, 3, static_cast<PetscInt>(positions_.size()), PETSC_DETERMINE, positions_.data(), &x));
      check(MatNullSpaceCreateRigidBody(x, &modes));
      check(MatSetNearNullSpace(scalar_, modes));
      check(MatNullSpaceDestroy(&modes));
      check(VecDestroy(&x));
    }
    check(PCSetOperators(pc_, scalar_, scalar_));
    if (fresh) {
      check(PCSetType(pc_, PCGAMG));
      check(PCGAMGSetReuseInterpolation(pc_, PETSC_TRUE));
      check(PCGAMGSetNSmooths(pc_, 1));
    }
  }
  if (fresh) check(PCSetFromOptions(pc_));
  check(PCSetUp(pc_));
  PCFailedReason reason;
  check(PCGetFailedReason(pc_, &reason));
  if (kind_ == Kind::incomplete) check(PCSetUpOnBlocks(pc_)), check(PCGetFailedReason(pc_, &reason));
  int failed = reason != PC_NOERROR;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  return !failed;
}

double FlexibleInverse::bytes() const { return kind_ == Kind::incomplete ? F_.bytes() : 2.5 * F_.bytes(); }

}  // namespace hilo::petsc
