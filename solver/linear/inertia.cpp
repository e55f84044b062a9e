// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/inertia.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "linear/sparse_cholesky.hpp"

namespace hilo {
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
  const Sparse S = 0.5 * (K + transpose) + Sparse(G.transpose() * G);
  if (n > 1000 && SparseCholesky().factor(S)) return 0;  // a tenth of the cost of factors that count
  const Eigen::SimplicialLDLT<Sparse> factors(S);
  if (factors.info() != Eigen::Success) return {};
  return static_cast<int>((factors.vectorD().array() < 0).count());
}

}  // namespace hilo
