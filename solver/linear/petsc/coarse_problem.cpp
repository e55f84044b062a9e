// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/coarse_problem.hpp"

#include <algorithm>
#include <new>

#include "base/stopwatch.hpp"
#include "linear/petsc/session.hpp"
#include "linear/supernodal.hpp"

namespace hilo::petsc {

CoarseProblem::CoarseProblem() {
  cholmod_start(&common_);
  common_.print = 0;
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.final_ll = 1;
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_METIS;
}

CoarseProblem::~CoarseProblem() {
  cholmod_free_factor(&L_, &common_);
  cholmod_finish(&common_);
}

bool CoarseProblem::factor(int n, const std::vector<Entry>& mine) {
  if (n == 0) return true;
  const std::vector<Entry> all = comm().gather(mine);
  const Stopwatch watch(seconds_);
  cholmod_triplet* T = cholmod_allocate_triplet(n, n, all.size(), -1, CHOLMOD_REAL, &common_);
  if (!T) throw std::bad_alloc();
  for (size_t k = 0; k < all.size(); ++k) {
    static_cast<int*>(T->i)[k] = static_cast<int>(all[k].row), static_cast<int*>(T->j)[k] = static_cast<int>(all[k].column);
    static_cast<double*>(T->x)[k] = all[k].value;
  }
  T->nnz = all.size();
  cholmod_sparse* K = cholmod_triplet_to_sparse(T, 0, &common_);
  cholmod_free_triplet(&T, &common_);
  if (!K) throw std::bad_alloc();
  const int *p = static_cast<const int*>(K->p), *i = static_cast<const int*>(K->i);
  if (!L_ || !std::equal(p, p + n + 1, start_.begin(), start_.end()) || !std::equal(i, i + p[n], rows_.begin(), rows_.end())) {
    cholmod_free_factor(&L_, &common_);
    start_.assign(p, p + n + 1), rows_.assign(i, i + p[n]);
    L_ = cholmod_analyze(K, &common_);
  }
  const bool done = L_ && cholmod_factorize(K, L_, &common_);
  cholmod_free_sparse(&K, &common_);
  if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE) throw std::bad_alloc();
  return done && common_.status == CHOLMOD_OK && L_->minor == L_->n;
}

void CoarseProblem::solve(Eigen::MatrixXd& x) {
  if (x.size() == 0) return;
  const Stopwatch watch(seconds_);
  const Eigen::Map<const Eigen::VectorXi> order(static_cast<const int*>(L_->Perm), x.rows());
  Eigen::MatrixXd y = x(order, Eigen::all);
  const int n = static_cast<int>(x.rows()), columns = static_cast<int>(x.cols());
  supernodal::forward(L_, supernodal::DoubleValues(L_), 0, n, y.data(), scratch_, columns);
  supernodal::backward(L_, supernodal::DoubleValues(L_), 0, n, y.data(), scratch_, columns);
  x(order, Eigen::all) = y;
}

}  // namespace hilo::petsc
