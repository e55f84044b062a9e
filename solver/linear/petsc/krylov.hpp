// SPDX-License-Identifier: GPL-3.0-or-later
// PETSc's conjugate gradients or GMRES on a matrix and a preconditioner that are given as functions.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscksp.h>

#include <cstdint>
#include <functional>

namespace hilo::petsc {

/// Flexible GMRES keeps the preconditioned directions too: for preconditioners that are not quite linear.
enum class Method { cg, gmres, flexible_gmres };

class Krylov {
 public:
  using Map = std::function<void(Vec x, Vec y)>;
  Krylov(PetscInt n_owned, std::int64_t n_global, Method method, Map multiply, Map precondition);
  ~Krylov();
  Krylov(const Krylov&) = delete;

  void use(Method method);
  Method method() const { return method_; }
  struct Result {
    int iterations = 0;
    bool converged = false, indefinite = false;  // the latter ends conjugate gradients alone
  };
  /// From x as it is, until |b - A x| < tolerance |b|.
  Result solve(Vec b, Vec x, double tolerance, int most_iterations);
  /// Vectors that it keeps.
  int vectors() const { return method_ == Method::cg ? 3 : method_ == Method::gmres ? restart_ : 2 * restart_; }

 private:
  Map multiply_, precondition_;
  Method method_ = Method::gmres;
  int restart_;
  Mat A_ = nullptr;
  KSP ksp_ = nullptr;
};

}  // namespace hilo::petsc
