// SPDX-License-Identifier: GPL-3.0-or-later
// Products of tall matrices by BLAS: those of Eigen are compiled for the oldest processor.
#pragma once
#include <Eigen/Dense>

#include "linear/lapack.hpp"

namespace hilo {

/// A^T X of the first k columns of A.
inline Eigen::MatrixXd transposed_times(const Eigen::MatrixXd& A, const Eigen::MatrixXd& X) {
  Eigen::MatrixXd out(A.cols(), X.cols());
  const auto n = static_cast<int>(A.rows()), m = static_cast<int>(A.cols());
  if (out.size() > 0) lapack::multiply('T', n, m, 1., A.data(), n, X.data(), n, 0., out.data(), m, static_cast<int>(X.cols()));
  return out;
}

/// Y += f A C, of as many columns of A as C has rows.
inline void add_product(double f, const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, Eigen::MatrixXd& Y) {
  const auto n = static_cast<int>(A.rows()), k = static_cast<int>(C.rows());
  if (Y.size() > 0 && k > 0) lapack::multiply('N', n, k, f, A.data(), n, C.data(), k, 1., Y.data(), n, static_cast<int>(Y.cols()));
}
/// A C
inline Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(A.rows(), C.cols());
  add_product(1, A, C, out);
  return out;
}

}  // namespace hilo
