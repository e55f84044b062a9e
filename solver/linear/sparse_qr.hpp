// SPDX-License-Identifier: GPL-3.0-or-later
// Rank and dependent columns of large sparse matrices.
#pragma once
#include <Eigen/SparseCore>

namespace hilo {

/// Of A P = Q R with orthonormal Q: the columns of R that are independent come first, upper triangular.
struct SparseQr {
  Eigen::VectorXi order;  // P, by column of R
  Eigen::Index rank = 0;
  Eigen::SparseMatrix<double> R;  // rank x columns
};

enum class ColumnOrder { least_fill, given };

/// Multifrontal QR [davis-2011].  A column of which those before it leave at most `dependent` is dropped behind the others
/// [heath-1982].
SparseQr sparse_qr(const Eigen::SparseMatrix<double>& A, double dependent, ColumnOrder order);

}  // namespace hilo
