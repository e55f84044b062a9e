// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues and eigenvectors of a dense matrix that need not be symmetric, by LAPACK.
#pragma once
#include <Eigen/Core>

namespace hilo {

struct EigenPairs {
  Eigen::VectorXcd values;   // (n), those of a pair side by side, the one above the axis first
  Eigen::MatrixXcd vectors;  // (n x n), unit columns
};
/// Of A, (n x n).  Throws Error where an entry is no number or the iteration does not end.
EigenPairs eigen_pairs(Eigen::MatrixXd A);

}  // namespace hilo
