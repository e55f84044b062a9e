// Which columns of a sparse matrix are independent of each other.
#pragma once
#include <Eigen/SparseCore>
#include <vector>

namespace hilo {

/// Columns of a matrix sorted: `rank` independent ones come first.  Of A P = Q R, the part of R that they and the others have.
struct Independence {
  Eigen::VectorXi order;
  Eigen::Index rank = 0;
  Eigen::SparseMatrix<double> kept, others;
  /// Column rank + k is the independent ones times these.
  Eigen::VectorXd depends(Eigen::Index k) const { return kept.triangularView<Eigen::Upper>().solve(Eigen::VectorXd(others.col(k))); }
};

/// Independent columns, the first `n_plain` before the others, which are rows of drives: one of those is kept only where the joints leave
/// it something to drive.
/// `dependent`: what others leave of a unit column that counts as their sum.
Independence independent_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index n_plain, double dependent);
/// Columns that share no row, directly or through others, tell nothing of each other: lists of those that do.
std::vector<std::vector<int>> connected_columns(const Eigen::SparseMatrix<double>& A);
/// The columns of a list, over the rows that they meet.  `number`: of each row of A, anything.
Eigen::SparseMatrix<double> part_of(const Eigen::SparseMatrix<double>& A, const std::vector<int>& columns, std::vector<int>& number);

}  // namespace hilo
