// SPDX-License-Identifier: GPL-3.0-or-later
// Eigenvalues of matrices that are not symmetric: roots of polynomials, and pairs of random matrices.
#include "linear/eigen_pairs.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "base/error.hpp"

namespace hilo::test::eigen_pairs_test {
namespace {

TEST(EigenPairs, OfACompanionAreTheRoots) {
  // (x - 3) (x + 1/2) (x^2 + 2 x + 17): roots 3, -1/2, -1 + 4 i, -1 - 4 i
  const double c[] = {-25.5, -45.5, 10.5, -0.5};
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
  A.bottomLeftCorner(3, 3).setIdentity();
  for (int i = 0; i < 4; ++i) A(i, 3) = -c[i];
  const EigenPairs pairs = eigen_pairs(A);
  for (const std::complex<double> root : {std::complex<double>(3, 0), {-0.5, 0}, {-1, 4}, {-1, -4}}) {
    double nearest = 1;
    for (const auto& value : pairs.values) nearest = std::min(nearest, std::abs(value - root));
    EXPECT_LT(nearest, 1e-13) << root;
  }
}

TEST(EigenPairs, StandBesideEachOtherAndAnswerTheMatrix) {
  srand(7);
  for (const int n : {1, 2, 5, 40, 131}) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
    const EigenPairs pairs = eigen_pairs(A);
    EXPECT_LT((A * pairs.vectors - pairs.vectors * pairs.values.asDiagonal()).norm(), 1e-12 * n) << n;
    EXPECT_NEAR(std::abs(pairs.values.prod()) / std::abs(A.determinant()), 1, 1e-10) << n;
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(pairs.vectors.col(i).norm(), 1, 1e-14);
      if (pairs.values[i].imag() > 0) {
        EXPECT_EQ(pairs.values[i + 1], std::conj(pairs.values[i]));
        EXPECT_EQ(pairs.vectors.col(i + 1), pairs.vectors.col(i).conjugate());
      }
    }
  }
}

TEST(EigenPairs, OfNoNumbersAreRefused) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(3, 3);
  A(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(eigen_pairs(A), Error);
  EXPECT_EQ(eigen_pairs(Eigen::MatrixXd(0, 0)).values.size(), 0);
}

}  // namespace
}  // namespace hilo::test::eigen_pairs_test
