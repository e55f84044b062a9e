// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/inertia.hpp"

#include <suitesparse/cholmod.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "linear/blas_room.hpp"

namespace hilo {
namespace {

/// By supernodal Cholesky factors, which cost a tenth of those that count.
bool is_definite(Eigen::SparseMatrix<double>& S) {
  make_room_for_blas();
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0, common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse A{};
  A.nrow = A.ncol = static_cast<size_t>(S.rows()), A.nzmax = static_cast<size_t>(S.nonZeros());
  A.p = S.outerIndexPtr(), A.i = S.innerIndexPtr(), A.x = S.valuePtr();
  A.stype = -1, A.itype = CHOLMOD_INT, A.xtype = CHOLMOD_REAL, A.dtype = CHOLMOD_DOUBLE, A.packed = 1, A.sorted = 1;
  cholmod_factor* L = cholmod_analyze(&A, &common);
  const bool is = L && cholmod_factorize(&A, L, &common) && common.status == CHOLMOD_OK && L->minor == L->n;
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  return is;
}

}  // namespace

std::optional<int> eigenvalues_below_zero(const BlockCsr& A, int first_row) {
  using Sparse = Eigen::SparseMatrix<double>;
  using ByRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const int n = 3 * first_row, rows = A.n() - n;
  if (n == 0) return 0;
  const Eigen::Map<const ByRows> all(A.n(), A.n(), static_cast<int>(A.values().size()), A.row_start().data(), A.column().data(),
                                     A.values().data());
  const Sparse K = all.topLeftCorner(n, n);
  ByRows G = all.bottomRows(rows).leftCols(n);
  double stiffness = 0;
  for (int i = 0; i < n; ++i) stiffness = std::max(stiffness, std::abs(K.coeff(i, i)));
  for (int i = 0; i < rows; ++i)
    if (const double size = G.row(i).norm(); size > 0) G.row(i) *= std::sqrt(1e3 * stiffness) / size;
  const Sparse transpose = K.transpose();
  Sparse S = 0.5 * (K + transpose) + Sparse(G.transpose() * G);
  if (n > 1000 && is_definite(S)) return 0;
  const Eigen::SimplicialLDLT<Sparse> factors(S);
  if (factors.info() != Eigen::Success) return {};
  return static_cast<int>((factors.vectorD().array() < 0).count());
}

}  // namespace hilo
