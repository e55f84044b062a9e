// SPDX-License-Identifier: GPL-3.0-or-later
// A matrix of coupled stages is compared with differences of what is solved with it.
#pragma once
#include <Eigen/Dense>
#include <functional>

#include "linear/kkt.hpp"

namespace hilo::test {

/// Stands in for the solver of coupled stages: keeps the first matrix and answers with steps along a direction, 1, then 1/10.
class Along final : public SerialKktSolver {
 public:
  explicit Along(const std::function<double(int)>& direction) : direction_(direction) {}
  Eigen::MatrixXd A;
  std::vector<Eigen::VectorXd> b;
  static constexpr double step = 1e-7;
  Eigen::VectorXd d;
  void structure(const Cliques& cliques, const BlockMap& map) override {
    cliques_ = cliques;
    const auto n = 3 * static_cast<Eigen::Index>(map.global.size());
    A = Eigen::MatrixXd::Zero(n, n), d.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) d[i] = direction_(static_cast<int>(i));
  }
  void zero() override {
    if (b.empty()) A.setZero();
  }
  void add(int, const double*) override {}
  void add_part(int clique, int row, int column, int n, const double* K) override {
    const auto blocks = cliques_[clique];
    for (int i = 0; i < 3 * n && b.empty(); ++i)
      for (int j = 0; j < 3 * n; ++j)
        if (const int r = blocks[row + i / 3], c = blocks[column + j / 3]; r >= 0 && c >= 0)
          A(3 * r + i % 3, 3 * c + j % 3) += K[3 * n * i + j];
  }
  void add_diagonal(int block, const double v[3]) override {
    for (int i = 0; i < 3 && b.empty(); ++i) A(3 * block + i, 3 * block + i) += v[i];
  }
  void sum_shared(std::span<double>) override {}
  SolveReport solve(std::span<const double> rhs, std::span<double> x, double) override {
    b.emplace_back(Eigen::Map<const Eigen::VectorXd>(rhs.data(), static_cast<Eigen::Index>(rhs.size())));
    const double along = b.size() == 1 ? step : -0.9 * step;
    for (size_t i = 0; i < x.size(); ++i) x[i] = along * d[static_cast<Eigen::Index>(i)];
    return {b.size() < 3, 0, 0, "enough"};
  }
  std::string name() const override { return "along"; }

 private:
  std::function<double(int)> direction_;
  Cliques cliques_;
};

}  // namespace hilo::test
