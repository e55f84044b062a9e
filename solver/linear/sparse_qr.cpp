// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/sparse_qr.hpp"

#include <algorithm>
#include <new>
#include <suitesparse/SuiteSparseQR.hpp>
#include <vector>

#include "linear/blas_room.hpp"

namespace hilo {

SparseQr sparse_qr(const Eigen::SparseMatrix<double>& A, double dependent, ColumnOrder order) {
  make_room_for_blas();
  cholmod_common common;
  cholmod_l_start(&common);
  common.print = 0;
  std::vector<SuiteSparse_long> start(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1),
      row(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
  cholmod_sparse columns{};
  columns.nrow = static_cast<size_t>(A.rows()), columns.ncol = static_cast<size_t>(A.cols()), columns.nzmax = row.size();
  columns.p = start.data(), columns.i = row.data(), columns.x = const_cast<double*>(A.valuePtr());
  columns.itype = CHOLMOD_LONG, columns.xtype = CHOLMOD_REAL, columns.dtype = CHOLMOD_DOUBLE, columns.packed = 1, columns.sorted = 1;
  cholmod_sparse* R = nullptr;
  SuiteSparse_long* permutation = nullptr;
  const auto rank = SuiteSparseQR<double>(order == ColumnOrder::given ? SPQR_ORDERING_FIXED : SPQR_ORDERING_DEFAULT, dependent, A.cols(),
                                          &columns, &R, &permutation, &common);
  SparseQr out;
  if (R && rank >= 0 && (R->sorted || cholmod_l_sort(R, &common))) {
    const auto *p = static_cast<const SuiteSparse_long*>(R->p), *i = static_cast<const SuiteSparse_long*>(R->i);
    const auto* x = static_cast<const double*>(R->x);
    // each independent column ends one row below the one before it; those that end higher go behind
    std::vector<SuiteSparse_long> sorted, others;
    for (SuiteSparse_long k = 0; k < A.cols(); ++k) {
      const auto place = static_cast<SuiteSparse_long>(sorted.size());
      const bool reaches = std::any_of(i + p[k], i + p[k + 1], [&](SuiteSparse_long row) { return row == place; });
      (reaches ? sorted : others).push_back(k);
    }
    out.rank = static_cast<Eigen::Index>(sorted.size());
    sorted.insert(sorted.end(), others.begin(), others.end());
    out.order.resize(A.cols());
    out.R.resize(out.rank, A.cols());
    out.R.reserve(p[A.cols()]);
    for (Eigen::Index k = 0; k < A.cols(); ++k) {
      const SuiteSparse_long from = sorted[k];
      out.order[k] = static_cast<int>(permutation ? permutation[from] : from);
      out.R.startVec(k);
      for (SuiteSparse_long e = p[from]; e < p[from + 1]; ++e) out.R.insertBackByOuterInner(k, i[e]) = x[e];
    }
    out.R.finalize();
  }
  const bool is_full = common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE || !R;
  if (permutation) cholmod_l_free(static_cast<size_t>(A.cols()), sizeof(SuiteSparse_long), permutation, &common);
  cholmod_l_free_sparse(&R, &common);
  cholmod_l_finish(&common);
  if (is_full) throw std::bad_alloc();
  return out;
}

}  // namespace hilo
