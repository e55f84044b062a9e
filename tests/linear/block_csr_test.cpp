// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix by blocks: its products are those of the sum of its cliques, in rows of any length.
#include "linear/block_csr.hpp"

#include <gtest/gtest.h>

#include "problem.hpp"

namespace hilo::test::block_csr_test {
namespace {

TEST(BlockCsr, MultipliesAsTheSumOfItsCliques) {
  for (const int large : {2, 5, 11, 40}) {  // blocks of the largest clique: rows of 6 to 120 numbers and what they share with chains
    const int n = large + 7;
    Cliques cliques;
    std::vector<int> all(static_cast<size_t>(large));
    for (int i = 0; i < large; ++i) all[static_cast<size_t>(i)] = i;
    cliques.add(all);
    for (int i = large - 1; i + 1 < n; ++i) cliques.add(std::vector{i, i + 1});
    cliques.add(std::vector{n - 1, -1, 0});  // the second is held
    BlockCsr A;
    A.structure(cliques, n);
    A.zero();
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int e = 0; e < cliques.size(); ++e) {
      const auto blocks = cliques[e];
      const auto m = static_cast<Eigen::Index>(3 * blocks.size());
      const Eigen::VectorXd K = test::random_vector(static_cast<int>(m * m), static_cast<unsigned>(e));
      A.add(e, K.data());
      for (Eigen::Index i = 0; i < m; ++i)
        for (Eigen::Index j = 0; j < m; ++j)
          if (const int row = blocks[static_cast<size_t>(i / 3)], column = blocks[static_cast<size_t>(j / 3)]; row >= 0 && column >= 0)
            dense(3 * row + i % 3, 3 * column + j % 3) += K[m * i + j];
    }
    const Eigen::VectorXd x = test::random_vector(3 * n, 99);
    Eigen::VectorXd y(3 * n), again(3 * n), sums(3 * n);
    A.multiply(x.data(), y.data());
    A.multiply(x.data(), again.data(), sums.data());
    EXPECT_LT((y - dense * x).cwiseAbs().maxCoeff(), 1e-13) << large;
    EXPECT_LT((y - again).cwiseAbs().maxCoeff(), 1e-14 * large) << large;
    EXPECT_LT((sums - dense.cwiseAbs() * x.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-13) << large;
  }
}

}  // namespace
}  // namespace hilo::test::block_csr_test
