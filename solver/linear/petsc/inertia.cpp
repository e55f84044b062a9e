// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/inertia.hpp"

#include <cmath>

namespace hilo::petsc {
namespace {

/// The rows of A in `rows` and its columns in `columns`.
Mat part(Mat A, IS rows, IS columns) {
  Mat some = nullptr;
  check(MatCreateSubMatrix(A, rows, columns, MAT_INITIAL_MATRIX, &some));
  return some;
}

/// Every row of G becomes `length` long; rows of zeros stay.
void stretch_rows(Mat G, double length) {
  Vec by = nullptr;
  PetscInt begin = 0, end = 0;
  check(MatCreateVecs(G, nullptr, &by));
  check(MatGetOwnershipRange(G, &begin, &end));
  for (PetscInt i = begin; i < end; ++i) {
    PetscInt n = 0;
    const PetscScalar* values = nullptr;
    double square = 0;
    check(MatGetRow(G, i, &n, nullptr, &values));
    for (PetscInt k = 0; k < n; ++k) square += values[k] * values[k];
    check(MatRestoreRow(G, i, &n, nullptr, &values));
    check(VecSetValue(by, i, square > 0 ? length / std::sqrt(square) : 1, INSERT_VALUES));
  }
  check(VecAssemblyBegin(by)), check(VecAssemblyEnd(by));
  check(MatDiagonalScale(G, by, nullptr));
  check(VecDestroy(&by));
}

double largest_diagonal(Mat K) {
  Vec diagonal = nullptr;
  PetscReal most = 0;
  check(MatCreateVecs(K, nullptr, &diagonal));
  check(MatGetDiagonal(K, diagonal));
  check(VecNorm(diagonal, NORM_INFINITY, &most));
  check(VecDestroy(&diagonal));
  return most;
}

std::optional<int> negative_pivots(Mat S) {
  check(MatSetOption(S, MAT_SYMMETRIC, PETSC_TRUE));
  PetscInt error = 0, negative = 0;
  for (PetscInt room = 100; room < 30000; room *= 2) {  // for delayed pivots [%]
    Mat factor = nullptr;
    check(MatGetFactor(S, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor));
    check(MatMumpsSetIcntl(factor, 13, 1));  // ScaLAPACK would hide the pivots of the root
    check(MatMumpsSetIcntl(factor, 24, 1));
    check(MatMumpsSetIcntl(factor, 14, room));
    MatFactorInfo info;
    check(MatFactorInfoInitialize(&info));
    check(MatCholeskyFactorSymbolic(factor, S, nullptr, &info));
    check(MatMumpsGetInfog(factor, 1, &error));
    if (error >= 0) {
      check(MatCholeskyFactorNumeric(factor, S, &info));
      check(MatMumpsGetInfog(factor, 1, &error));
      check(MatMumpsGetInfog(factor, 12, &negative));
    }
    check(MatDestroy(&factor));
    if (error != -8 && error != -9) break;
  }
  if (error < 0) return {};
  return static_cast<int>(negative);
}

}  // namespace

std::optional<int> eigenvalues_below_zero(Mat A, const SharedBlocks& shared, int first_row) {
  PetscInt begin = 0, end = 0;
  check(MatGetOwnershipRange(A, &begin, &end));
  std::vector<PetscInt> motions, rows;
  for (std::int64_t k = 0; k < shared.n_owned(); ++k)
    for (int i = 0; i < 3; ++i) (shared.owned(k) < first_row ? motions : rows).push_back(begin + static_cast<PetscInt>(3 * k) + i);
  const auto index = [](const std::vector<PetscInt>& of) {
    IS is = nullptr;
    check(ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(of.size()), of.data(), PETSC_COPY_VALUES, &is));
    return is;
  };
  IS at = index(motions), joints = index(rows);
  Mat scalar = nullptr, transpose = nullptr, held = nullptr;
  check(MatConvert(A, MATAIJ, MAT_INITIAL_MATRIX, &scalar));
  Mat K = part(scalar, at, at), G = part(scalar, joints, at);
  check(MatTranspose(K, MAT_INITIAL_MATRIX, &transpose));
  stretch_rows(G, std::sqrt(1e3 * largest_diagonal(K)));
  check(MatTransposeMatMult(G, G, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &held));
  check(MatAXPY(K, 1, transpose, DIFFERENT_NONZERO_PATTERN));
  check(MatAXPY(K, 2, held, DIFFERENT_NONZERO_PATTERN));
  const std::optional<int> found = negative_pivots(K);
  for (Mat* m : {&scalar, &K, &G, &transpose, &held}) check(MatDestroy(m));
  check(ISDestroy(&at)), check(ISDestroy(&joints));
  return found;
}

}  // namespace hilo::petsc
