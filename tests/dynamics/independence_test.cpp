// SPDX-License-Identifier: GPL-3.0-or-later
// Independent columns of sparse matrices, dense and sparse alike: what is called dependent is the sum that it is said to be.
// With assertions on (make -C tests sanitize) Eigen also stops where a part is taken of a matrix whose columns are not sorted.
#include "dynamics/redundancy/independence.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <random>

namespace hilo::test::independence_test {
namespace {

/// `n` columns of unit length with four entries each, in a band; every seventh is a sum of the two before it.
Eigen::SparseMatrix<double> banded(int n) {
  std::minstd_rand random(7);
  const auto number = [&] { return static_cast<double>(random()) / std::minstd_rand::max() - 0.5; };
  Eigen::SparseMatrix<double> A(n + 12, n);
  for (int k = 0; k < n; ++k) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(n + 12);
    if (k % 7 == 6)
      column = 0.6 * Eigen::VectorXd(A.col(k - 1)) - 0.8 * Eigen::VectorXd(A.col(k - 2));
    else
      for (int i = 0; i < 4; ++i) column[k + static_cast<int>(random() % 12)] += number();
    column.normalize();
    A.col(k) = column.sparseView();
  }
  A.makeCompressed();
  return A;
}

class IndependentColumns : public testing::TestWithParam<std::pair<int, int>> {};  // columns, of them plain
INSTANTIATE_TEST_SUITE_P(Sizes, IndependentColumns,
                         testing::Values(std::pair{42, 42}, std::pair{42, 20}, std::pair{70, 70}, std::pair{70, 40}, std::pair{910, 910},
                                         std::pair{910, 700}));

TEST_P(IndependentColumns, MakeUpTheOthers) {
  const auto [n, n_plain] = GetParam();
  const Eigen::SparseMatrix<double> A = banded(n);
  const Independence found = independent_columns(A, n_plain, 1e-9);
  EXPECT_EQ(found.rank, n - n / 7);
  Eigen::MatrixXd kept(A.rows(), found.rank);
  for (Eigen::Index i = 0; i < found.rank; ++i) kept.col(i) = A.col(found.order[i]);
  ASSERT_EQ(static_cast<Eigen::Index>(found.depends.size()), n - found.rank);
  for (Eigen::Index k = found.rank; k < n; ++k) {
    Eigen::VectorXd left = A.col(found.order[k]);
    for (const auto& [i, factor] : found.depends[k - found.rank]) left -= factor * kept.col(i);
    EXPECT_LT(left.norm(), 1e-7) << found.order[k];
  }
}

}  // namespace
}  // namespace hilo::test::independence_test
