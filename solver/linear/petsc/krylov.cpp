// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/krylov.hpp"

#include "linear/petsc/session.hpp"

namespace hilo::petsc {

Krylov::Krylov(PetscInt n_owned, std::int64_t n_global, Method method, Map multiply, Map precondition)
    : multiply_(std::move(multiply)),
      precondition_(std::move(precondition)),
      restart_(n_global > 1000000 ? 50 : 100) {  // at 3 million unknowns 50 vectors are 1.2 GB
  check(MatCreateShell(PETSC_COMM_WORLD, n_owned, n_owned, PETSC_DETERMINE, PETSC_DETERMINE, this, &A_));
  check(MatShellSetOperation(A_, MATOP_MULT, reinterpret_cast<void (*)(void)>(+[](Mat A, Vec x, Vec y) -> PetscErrorCode {
                               void* self;
                               PetscErrorCode code = MatShellGetContext(A, &self);
                               if (!code) static_cast<Krylov*>(self)->multiply_(x, y);
                               return code;
                             })));
  check(KSPCreate(PETSC_COMM_WORLD, &ksp_));
  check(KSPSetOptionsPrefix(ksp_, "hilo_outer_"));
  check(KSPSetOperators(ksp_, A_, A_));
  use(method);
  check(KSPSetInitialGuessNonzero(ksp_, PETSC_TRUE));
  PC pc;
  check(KSPGetPC(ksp_, &pc));
  check(PCSetType(pc, PCSHELL));
  check(PCShellSetContext(pc, this));
  check(PCShellSetApply(pc, [](PC pc, Vec x, Vec y) -> PetscErrorCode {
    void* self;
    PetscErrorCode code = PCShellGetContext(pc, &self);
    if (!code) static_cast<Krylov*>(self)->precondition_(x, y);
    return code;
  }));
  check(KSPSetFromOptions(ksp_));
}

Krylov::~Krylov() {
  KSPDestroy(&ksp_);
  MatDestroy(&A_);
}

void Krylov::use(Method method) {
  method_ = method;
  const bool is_cg = method == Method::cg;
  check(KSPSetType(ksp_, is_cg ? KSPCG : method == Method::flexible_gmres ? KSPFGMRES : KSPGMRES));
  check(KSPSetPCSide(ksp_, is_cg ? PC_LEFT : PC_RIGHT));
  check(KSPSetNormType(ksp_, KSP_NORM_UNPRECONDITIONED));
  if (!is_cg) check(KSPGMRESSetRestart(ksp_, restart_));
}

Krylov::Result Krylov::solve(Vec b, Vec x, double tolerance, int most_iterations) {
  KSPConvergedReason reason;
  PetscInt iterations = 0;
  check(KSPSetTolerances(ksp_, tolerance, 1e-300, PETSC_DEFAULT, most_iterations));
  check(KSPSolve(ksp_, b, x));
  check(KSPGetConvergedReason(ksp_, &reason));
  check(KSPGetIterationNumber(ksp_, &iterations));
  return {static_cast<int>(iterations), reason > 0, reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC};
}

}  // namespace hilo::petsc
