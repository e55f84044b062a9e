// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/minimum_norm.hpp"

namespace hilo {
namespace {

constexpr int klu_below = 200;  // blocks; beyond, nested dissection keeps the factors of nets thin

}  // namespace

MinimumNorm::MinimumNorm(const System& system) : system_(system) {
  std::vector<int> number(system.n_blocks(), -1);
  int n = 0;
  for (const auto& c : system.constraints()) {
    auto blocks = c->blocks();
    for (int& block : blocks) {
      if (number[block] < 0) number[block] = n++;
      block = number[block];
    }
    cliques_.add(blocks);
  }
  A_.structure(cliques_, n);
  if (n < klu_below) {
    factors_ = make_klu();
  } else {
    factors_ = make_cholesky(std::vector<char>(n, 0));
    factors_->sharpen();  // the shift is far below the round-off of single precision
  }
}

std::vector<double> MinimumNorm::operator()(const Stage& stage, std::span<const double> lambda) {
  const auto all = system_.constraints();
  const auto n = static_cast<int>(all.size());
  A_.zero();
  std::vector<DenseRows> G(n);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(A_.n());
  double largest = 0;
  for (int j = 0; j < n; ++j) {
    const Constraint& c = *all[j];
    G[j] = c.gradient(stage);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, max_directions, max_directions> K =
        decltype(K)::Zero(G[j].cols(), G[j].cols());
    for (Eigen::Index r = 0; r < G[j].rows(); ++r)
      for (Eigen::Index i = 0; i < G[j].cols(); ++i)
        if (G[j](r, i) != 0) K.row(i) += G[j](r, i) * G[j].row(r);
    largest = std::max(largest, K.diagonal().maxCoeff());
    A_.add(j, K.data());
    for (int r = 0; r < c.n_rows(); ++r) {
      if (!c.active()[r]) continue;
      const auto blocks = cliques_[j];
      for (size_t k = 0; k < blocks.size(); ++k)
        f.segment<3>(3 * blocks[k]) += lambda[c.row() + r] * G[j].row(r).segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
    }
  }
  const double shift = 1e-10 * largest;
  const double d[3] = {shift, shift, shift};
  for (int i = 0; i < A_.n_blocks(); ++i) A_.add_diagonal(i, d);
  if (!factors_->refactor(A_) && !factors_->factor(A_))
    throw Error("", "the shares of redundant joint rows cannot be found: no factors of them");
  Eigen::VectorXd y = Eigen::VectorXd::Zero(f.size()), r = f, product(f.size());
  for (int pass = 0; pass < 8 && r.norm() > 1e-14 * f.norm(); ++pass) {
    factors_->solve(r.data(), product.data());
    y += product;
    A_.multiply(y.data(), product.data());
    r = f - product + shift * y;
  }
  std::vector<double> out(lambda.size(), 0.0);
  Eigen::Matrix<double, max_directions, 1> own;
  for (int j = 0; j < n; ++j) {
    const auto blocks = cliques_[j];
    for (size_t k = 0; k < blocks.size(); ++k) own.segment<3>(3 * static_cast<Eigen::Index>(k)) = y.segment<3>(3 * blocks[k]);
    Eigen::Map<Eigen::VectorXd>(&out[all[j]->row()], G[j].rows()) = G[j] * own.head(G[j].cols());
  }
  return out;
}

}  // namespace hilo
