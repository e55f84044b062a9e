// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/sparse_cholesky.hpp"

#include <suitesparse/cholmod.h>

#include <algorithm>
#include <new>

#include "linear/blas_room.hpp"

namespace hilo {

struct SparseCholesky::Impl {
  cholmod_common common{};
  cholmod_factor* L = nullptr;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;  // of solves
  std::vector<int> start, row;                             // the pattern

  Impl() {
    make_room_for_blas();
    cholmod_start(&common);
    common.print = 0, common.final_ll = 1;  // L D L^T would take what is indefinite
  }
  ~Impl() {
    cholmod_free_dense(&x, &common), cholmod_free_dense(&y, &common), cholmod_free_dense(&e, &common);
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
  }
  void check_memory() const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE) throw std::bad_alloc();
  }
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;

/// `kind`, CHOLMOD's stype: -1 of a symmetric matrix by its lower triangle, 0 of A A^T.
bool SparseCholesky::factor(const Eigen::SparseMatrix<double>& A, int kind, double mu) {
  Impl& my = *impl_;
  const auto is_same = [](const std::vector<int>& before, const int* now, Eigen::Index n) {
    return std::equal(before.begin(), before.end(), now, now + n);
  };
  if (!my.L || !is_same(my.start, A.outerIndexPtr(), A.cols() + 1) || !is_same(my.row, A.innerIndexPtr(), A.nonZeros())) {
    cholmod_free_factor(&my.L, &my.common);
    my.start.assign(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1),
        my.row.assign(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
  }
  cholmod_sparse view{};
  view.nrow = static_cast<size_t>(A.rows()), view.ncol = static_cast<size_t>(A.cols()), view.nzmax = my.row.size();
  view.p = my.start.data(), view.i = my.row.data(), view.x = const_cast<double*>(A.valuePtr());
  view.stype = kind, view.itype = CHOLMOD_INT, view.xtype = CHOLMOD_REAL, view.dtype = CHOLMOD_DOUBLE, view.packed = 1, view.sorted = 1;
  if (!my.L) my.L = cholmod_analyze(&view, &my.common);
  double shift[2] = {mu, 0};
  const bool done = my.L && cholmod_factorize_p(&view, shift, nullptr, 0, my.L, &my.common);
  my.check_memory();
  return done && my.common.status == CHOLMOD_OK && my.L->minor == my.L->n;
}

Eigen::VectorXd SparseCholesky::solve(const Eigen::VectorXd& b) const {
  Impl& my = *impl_;
  cholmod_dense B{};
  B.nrow = B.d = B.nzmax = static_cast<size_t>(b.size()), B.ncol = 1;
  B.x = const_cast<double*>(b.data()), B.xtype = CHOLMOD_REAL, B.dtype = CHOLMOD_DOUBLE;
  if (!cholmod_solve2(CHOLMOD_A, my.L, &B, nullptr, &my.x, nullptr, &my.y, &my.e, &my.common)) throw std::bad_alloc();
  return Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(my.x->x), b.size());
}

}  // namespace hilo
