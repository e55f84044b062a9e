// SPDX-License-Identifier: GPL-3.0-or-later
// Which columns of a sparse matrix are independent of each other.
#pragma once
#include <Eigen/SparseCore>
#include <utility>
#include <vector>

namespace hilo {

/// Columns of a matrix sorted: `rank` independent ones come first.  Column rank + k is these times depends[k]: their places in the order,
/// and factors.  Of nets with many millions of factors the first columns alone have a list.
struct Independence {
  Eigen::VectorXi order;
  Eigen::Index rank = 0;
  std::vector<std::vector<std::pair<int, double>>> depends;
  std::vector<char> bears;  // of each of the `rank`: some column depends on it, by a factor above 1e-6
  double largest = 0;       // factor
};

/// Independent columns, the first `n_plain` before the others, which are rows of drives: one of those is kept only where the joints leave
/// it something to drive.
/// `dependent`: what others leave of a unit column that counts as their sum.
Independence independent_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index n_plain, double dependent);
/// Columns that share no row, directly or through others, tell nothing of each other: lists of those that do, of the columns given.
std::vector<std::vector<int>> connected_columns(const Eigen::SparseMatrix<double>& A, const std::vector<int>& columns);
/// The columns of a list, over the rows that they meet.  `number`: of each row of A, anything.
Eigen::SparseMatrix<double> part_of(const Eigen::SparseMatrix<double>& A, const std::vector<int>& columns, std::vector<int>& number);
/// What is left of columns, neighbours in groups (`group`, ascending), once those are taken away that cannot depend on others: groups that
/// are independent over rows which no other group meets, one after the other from outside.  Trees lose all of theirs.
std::vector<int> columns_in_loops(const Eigen::SparseMatrix<double>& A, const std::vector<int>& group);

}  // namespace hilo
