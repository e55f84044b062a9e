// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/direct.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "linear/petsc/inertia.hpp"

namespace hilo::petsc {
namespace {

constexpr PetscInt largest_room = 5000;  // [%], far beyond what delayed pivots need

}  // namespace

void DirectSolver::structure(const Cliques& cliques, const BlockMap& map) {
  check(MatDestroy(&factor_));
  factored_ = false, room_ = usual_room;
  is_mostly_dense_ = 4 * map.first_dense < 3 * map.n_global;
  cliques_ = &cliques;
  shared_.emplace(map);
  matrix_.reset();
  matrix_.emplace(cliques, map, *shared_, map.n_global);
  const PetscInt n = 3 * matrix_->n_owned();
  x_ = Vector(n), b_ = Vector(n), r_ = Vector(n), dx_ = Vector(n);
}

SolveReport DirectSolver::solve(std::span<const double> b, std::span<double> x, double) {
  if (!factored_) {
    matrix_->assemble();
    if (const SolveReport made = factor(); !made.ok) return made;
    factored_ = true;
  }
  to_owned(*shared_, b, b_);
  const double norm = max_norm(b_);
  SolveReport report;
  check(MatSolve(factor_, b_, x_));
  for (int pass = 0;; ++pass) {  // one or two steps of refinement where the residual asks for it
    check(MatMult(matrix_->mat(), x_, r_));
    check(VecAYPX(r_, -1, b_));
    report.residual = norm > 0 ? max_norm(r_) / norm : max_norm(r_);
    if (!std::isfinite(report.residual)) return SolveReport::singular(" to working precision", report.residual);
    if (report.residual < 1e-12 || pass == 2) break;
    check(MatSolve(factor_, r_, dx_));
    check(VecAXPY(x_, 1, dx_));
  }
  to_local(*shared_, x_, x);
  PetscReal A = 0;
  if (report.residual > 1e-6) check(MatNorm(matrix_->mat(), NORM_INFINITY, &A));
  // an ill-conditioned matrix leaves no better residual than round-off of what its rows sum
  if (report.residual > std::max(1e-6, tolerance_) && max_norm(r_) > 1e-12 * (A * max_norm(x_) + norm))
    report.ok = false, report.message = fmt::format("linear residual {:.1e}", report.residual);
  return report;
}

std::optional<int> DirectSolver::eigenvalues_below_zero(int first_row) {
  matrix_->assemble();
  return petsc::eigenvalues_below_zero(matrix_->mat(), *shared_, first_row);
}

std::string DirectSolver::name() const { return size() > 1 ? fmt::format("direct (MUMPS, {} ranks)", size()) : "direct (MUMPS)"; }

/// A factor with room for delayed pivots, or what went wrong.
SolveReport DirectSolver::analyse() {
  MatFactorInfo info;
  check(MatFactorInfoInitialize(&info));
  check(MatGetFactor(matrix_->mat(), MATSOLVERMUMPS, MAT_FACTOR_LU, &factor_));
  set(14, room_);
  set(24, 1);                                // find null pivots instead of dividing by them
  set(13, 1);                                // no ScaLAPACK at the root: it would hide them there
  set(10, 0);                                // refinement is ours
  check(MatMumpsSetCntl(factor_, 1, 0.01));  // threshold of partial pivoting: multipliers have no diagonal
  check(MatLUFactorSymbolic(factor_, matrix_->mat(), nullptr, nullptr, &info));
  const auto error = infog(1);
  return error < 0 ? failure("analysis", error) : SolveReport{};
}

/// The analysis is kept, as the pattern does not change, until a factorisation fails: PETSc does nothing with a
/// factor that has failed once, whatever is asked of it.
SolveReport DirectSolver::factor() {
  const Stopwatch watch(set_up_);
  PetscReal norm = 0;  // MUMPS asks for memory without end where numbers are not finite
  check(MatNorm(matrix_->mat(), NORM_FROBENIUS, &norm));
  if (!std::isfinite(norm)) return SolveReport::failed("the matrix is not finite");
  for (;; room_ *= 2) {
    if (!factor_)
      if (const SolveReport made = analyse(); !made.ok) return check(MatDestroy(&factor_)), made;
    MatFactorInfo info;
    check(MatFactorInfoInitialize(&info));
    check(MatLUFactorNumeric(factor_, matrix_->mat(), &info));
    PetscInt megabytes = 0;
    check(MatMumpsGetInfo(factor_, 16, &megabytes));
    factor_bytes_ = 1e6 * megabytes;
    const auto error = infog(1), null = infog(28);
    if (error >= 0) return null > 0 ? SolveReport::singular(fmt::format(" ({} null pivot{})", null, null > 1 ? "s" : "")) : SolveReport{};
    const bool wants_room = error == -8 || error == -9 || error == -14 || error == -15 || error == -17 || error == -20;
    const SolveReport made = error == -10                         ? SolveReport::singular()
                             : wants_room && room_ < largest_room ? SolveReport{}
                                                                  : failure("factorisation", error);
    check(MatDestroy(&factor_));
    if (!made.ok) return made;
  }
}

/// Memory is an Error, seen by all ranks alike; anything else a failed solve.
SolveReport DirectSolver::failure(const char* phase, PetscInt error) const {
  if (error == -5 || error == -7 || error == -9 || error == -13 || error == -19)
    throw Error("MUMPS", fmt::format("out of memory in the {}", phase), "use more ranks, or solver.kind = \"iterative\"", Exit::resources);
  return SolveReport::failed(fmt::format("MUMPS {} failed: INFOG(1) = {}, INFOG(2) = {}", phase, error, infog(2)));
}

PetscInt DirectSolver::infog(PetscInt i) const {
  PetscInt value = 0;
  check(MatMumpsGetInfog(factor_, i, &value));
  return value;
}

std::unique_ptr<KktSolver> make_direct(double tolerance) { return std::make_unique<DirectSolver>(tolerance); }

}  // namespace hilo::petsc
