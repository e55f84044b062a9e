// SPDX-License-Identifier: GPL-3.0-or-later
// A linear solver that only collects the matrix it is given.
#pragma once
#include <Eigen/Dense>

#include "linear/kkt.hpp"

namespace hilo::test {

class DenseKkt : public KktSolver {
 public:
  Eigen::MatrixXd A;
  void structure(const Cliques& cliques, const BlockMap& map) override {
    cliques_ = cliques;
    A.resize(3 * static_cast<Eigen::Index>(map.global.size()), 3 * static_cast<Eigen::Index>(map.global.size()));
  }
  void zero() override { A.setZero(); }
  void add(int clique, const double* K) override {
    const auto blocks = cliques_[clique];
    const int n = 3 * static_cast<int>(blocks.size());
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (blocks[i / 3] >= 0 && blocks[j / 3] >= 0) A(3 * blocks[i / 3] + i % 3, 3 * blocks[j / 3] + j % 3) += K[i * n + j];
  }
  void add_diagonal(int block, const double d[3]) override {
    for (int i = 0; i < 3; ++i) A(3 * block + i, 3 * block + i) += d[i];
  }
  void sum_shared(std::span<double>) override {}
  SolveReport solve(std::span<const double> b, std::span<double> x, double) override {
    const Eigen::Map<const Eigen::VectorXd> rhs(b.data(), static_cast<Eigen::Index>(b.size()));
    Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())) = A.partialPivLu().solve(rhs);
    return {};
  }
  std::string name() const override { return "dense"; }

 private:
  Cliques cliques_;
};

}  // namespace hilo::test
