// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/eigen_pairs.hpp"

#include "base/error.hpp"
#include "linear/lapack.hpp"

namespace hilo {

EigenPairs eigen_pairs(Eigen::MatrixXd A) {
  const auto n = static_cast<int>(A.rows());
  EigenPairs out{Eigen::VectorXcd(n), Eigen::MatrixXcd(n, n)};
  if (n == 0) return out;
  Eigen::VectorXd re(n), im(n);
  Eigen::MatrixXd V(n, n);
  if (!A.allFinite() || !lapack::eigen_pairs(n, A.data(), re.data(), im.data(), V.data()))
    throw Error("", "the eigenvalues of a dense matrix cannot be found", "", Exit::not_converged);
  for (Eigen::Index i = 0; i < n; ++i) {
    out.values[i] = {re[i], im[i]};
    if (im[i] == 0) {
      out.vectors.col(i).real() = V.col(i), out.vectors.col(i).imag().setZero();
    } else if (im[i] > 0) {  // the next one is its conjugate
      out.vectors.col(i).real() = V.col(i), out.vectors.col(i).imag() = V.col(i + 1);
      out.vectors.col(i + 1) = out.vectors.col(i).conjugate();
    }
  }
  return out;
}

}  // namespace hilo
