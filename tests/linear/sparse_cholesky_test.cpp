// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/sparse_cholesky.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hilo::test::sparse_cholesky_test {
namespace {

/// The five-point Laplacian of m x m points less `shift`.
Eigen::SparseMatrix<double> laplacian(int m, double shift) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      entries.emplace_back(m * i + j, m * i + j, 4 - shift);
      if (i > 0) entries.emplace_back(m * i + j, m * (i - 1) + j, -1), entries.emplace_back(m * (i - 1) + j, m * i + j, -1);
      if (j > 0) entries.emplace_back(m * i + j, m * i + j - 1, -1), entries.emplace_back(m * i + j - 1, m * i + j, -1);
    }
  Eigen::SparseMatrix<double> K(m * m, m * m);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

// Truth: sin(a pi (i + 1)/(m + 1)) sin(b pi (j + 1)/(m + 1)) is a mode of it, of eigenvalue 4 - 2 cos(a pi/(m + 1)) - 2 cos(b pi/(m + 1)).
TEST(SparseCholesky, SolvesModesOfALaplacian) {
  SparseCholesky factors, squares;
  for (const int m : {5, 60, 60})  // few entries, many, and the same pattern again
    for (const double shift : {0., -0.5}) {
      const double step = std::numbers::pi / (m + 1);
      ASSERT_TRUE(factors.factor(laplacian(m, shift)));
      ASSERT_TRUE(squares.factor_square(laplacian(m, shift), 0.5));
      for (const int a : {1, 3}) {
        Eigen::VectorXd mode(m * m);
        for (int i = 0; i < m; ++i)
          for (int j = 0; j < m; ++j) mode[m * i + j] = std::sin(a * step * (i + 1)) * std::sin(2 * step * (j + 1));
        const double eigenvalue = 4 - 2 * std::cos(a * step) - 2 * std::cos(2 * step) - shift;
        EXPECT_LT((eigenvalue * factors.solve(mode) - mode).norm(), 1e-11 * mode.norm()) << m;
        EXPECT_LT(((eigenvalue * eigenvalue + 0.5) * squares.solve(mode) - mode).norm(), 1e-11 * mode.norm()) << m;
      }
    }
}

TEST(SparseCholesky, RefusesWhatIsNotDefinite) {
  for (const int m : {5, 60}) EXPECT_FALSE(SparseCholesky().factor(laplacian(m, 3))) << m;
}

}  // namespace
}  // namespace hilo::test::sparse_cholesky_test
