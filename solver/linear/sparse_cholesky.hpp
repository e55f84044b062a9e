// SPDX-License-Identifier: GPL-3.0-or-later
// Factors of a sparse symmetric positive definite matrix, in double precision.
#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace hilo {

/// Cholesky factors [chen-2008], in the order of least fill or of nested dissection, whichever fills less.
class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;
  /// Of K, both triangles of which are there; its order is found anew where its pattern is another one.  False where K is not positive
  /// definite.  Errors: no memory for them.
  bool factor(const Eigen::SparseMatrix<double>& K) { return factor(K, -1, 0); }
  /// Of A A^T + mu, which is not set up.
  bool factor_square(const Eigen::SparseMatrix<double>& A, double mu) { return factor(A, 0, mu); }
  /// What was factored, inverse, times b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  bool factor(const Eigen::SparseMatrix<double>& A, int kind, double mu);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hilo
