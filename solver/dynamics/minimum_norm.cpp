// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/minimum_norm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

constexpr int klu_below = 200;   // blocks; beyond, nested dissection keeps the factors of nets thin
constexpr double shift = 1e-10;  // of unknowns whose rows are unit ones together
constexpr double least = 1e-26;  // of squares of gradients in a block; what is below is round-off

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
  std::vector<DenseRows> G(n);
  std::vector<Mat3> scale(A_.n_blocks(), Mat3::Zero());  // of unknowns: their rows next to each other are near unit ones
  for (int j = 0; j < n; ++j) {
    G[j] = all[j]->gradient(stage);
    for (size_t k = 0; k < cliques_[j].size(); ++k) {
      const auto part = G[j].middleCols<3>(3 * static_cast<Eigen::Index>(k));
      scale[cliques_[j][k]] += part.transpose() * part;
    }
  }
  std::vector<Vec3> squares(scale.size(), Vec3::Zero());  // along the axes of each block, by rows: those of the sum end in round-off
  std::vector<Mat3> axes;
  for (const Mat3& S : scale) axes.push_back(Eigen::SelfAdjointEigenSolver<Mat3>(S).eigenvectors());
  for (int j = 0; j < n; ++j)
    for (size_t k = 0; k < cliques_[j].size(); ++k) {
      const int block = cliques_[j][k];
      squares[block] += (G[j].middleCols<3>(3 * static_cast<Eigen::Index>(k)) * axes[block]).colwise().squaredNorm().transpose();
    }
  for (size_t block = 0; block < scale.size(); ++block) {
    const Vec3& of = squares[block];
    const Vec3 factor = (of.array() > least * of.maxCoeff()).select(of.cwiseSqrt().cwiseInverse(), 0);
    scale[block] = axes[block] * factor.asDiagonal() * axes[block].transpose();
  }
  A_.zero();
  for (int j = 0; j < n; ++j) {
    DenseRows scaled = G[j];
    for (size_t k = 0; k < cliques_[j].size(); ++k) {
      auto part = scaled.middleCols<3>(3 * static_cast<Eigen::Index>(k));
      part = (part * scale[cliques_[j][k]]).eval();
    }
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, max_directions, max_directions> K =
        decltype(K)::Zero(scaled.cols(), scaled.cols());
    for (Eigen::Index r = 0; r < scaled.rows(); ++r)
      for (Eigen::Index i = 0; i < scaled.cols(); ++i)
        if (scaled(r, i) != 0) K.row(i) += scaled(r, i) * scaled.row(r);
    A_.add(j, K.data());
  }
  constexpr double d[3] = {shift, shift, shift};
  for (int i = 0; i < A_.n_blocks(); ++i) A_.add_diagonal(i, d);
  const auto scaled = [&](Eigen::VectorXd y) {
    for (size_t block = 0; block < scale.size(); ++block) {
      auto part = y.segment<3>(3 * static_cast<Eigen::Index>(block));
      part = (scale[block] * part).eval();
    }
    return y;
  };
  const auto forces = [&](std::span<const double> of, bool all_rows) {  // G^T lambda, scaled
    Eigen::VectorXd out = Eigen::VectorXd::Zero(A_.n());
    for (int j = 0; j < n; ++j)
      for (int r = 0; r < G[j].rows(); ++r)
        for (size_t k = 0; k < cliques_[j].size() && (all_rows || all[j]->active()[r]); ++k)
          out.segment<3>(3 * cliques_[j][k]) +=
              of[all[j]->row() + r] * G[j].row(r).segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
    return scaled(std::move(out));
  };
  const auto shares = [&](const Eigen::VectorXd& of) {  // G y
    const Eigen::VectorXd y = scaled(of);
    std::vector<double> out(lambda.size(), 0.0);
    Eigen::Matrix<double, max_directions, 1> own;
    for (int j = 0; j < n; ++j) {
      const auto blocks = cliques_[j];
      for (size_t k = 0; k < blocks.size(); ++k) own.segment<3>(3 * static_cast<Eigen::Index>(k)) = y.segment<3>(3 * blocks[k]);
      Eigen::Map<Eigen::VectorXd>(&out[all[j]->row()], G[j].rows()) = G[j] * own.head(G[j].cols());
    }
    return out;
  };
  const Eigen::VectorXd f = forces(lambda, false);
  double size = 0;  // of the forces of single rows, which may cancel
  for (int j = 0; j < n; ++j)
    for (int r = 0; r < G[j].rows(); ++r)
      for (size_t k = 0; k < cliques_[j].size() && all[j]->active()[r]; ++k)
        size = std::hypot(
            size, lambda[all[j]->row() + r] * (G[j].row(r).segment<3>(3 * static_cast<Eigen::Index>(k)) * scale[cliques_[j][k]]).norm());
  std::vector<double> best;
  Eigen::VectorXd left;  // of f by the best
  // conjugate gradients on G^T G y = f: a few, as the factors err by their shift alone; at round-off they would go astray
  const auto find = [&](int passes, double enough) {
    std::vector<double> out(lambda.size(), 0.0);
    Eigen::VectorXd r = f, z(f.size()), p = Eigen::VectorXd::Zero(f.size());
    best = out, left = r;
    double before = 1;
    for (int pass = 0, since = 0; pass < passes && since < 3 && left.norm() > 1e-15 * size; ++pass) {
      factors_->solve(r.data(), z.data());
      const double now = r.dot(z);
      if (!(now > 0)) break;
      p = z + (pass > 0 ? now / before : 0) * p, before = now;
      const std::vector<double> q = shares(p);
      const double alpha = now / Eigen::Map<const Eigen::VectorXd>(q.data(), static_cast<Eigen::Index>(q.size())).squaredNorm();
      for (size_t i = 0; i < out.size(); ++i) out[i] += alpha * q[i];
      r = f - forces(out, true);
      ++since;
      if (r.norm() < left.norm()) best = out, left = r, since = 0;
    }
    return left.norm() <= enough * size;
  };
  constexpr int most = 50, lagging = 10;
  if (serves_ && find(lagging, 1e-12)) return best;
  serves_ = false;
  if ((factors_->refactor(A_) && find(most, 1e-8)) || (factors_->factor(A_) && find(most, 1e-8))) {  // old pivots may be bad ones
    serves_ = A_.n_blocks() >= klu_below;
    return best;
  }
  Eigen::Index worst = 0;
  if (left.size() > 0) left.cwiseAbs().maxCoeff(&worst);
  int j = 0;
  while (j < n - 1 && std::ranges::find(cliques_[j], static_cast<int>(worst / 3)) == cliques_[j].end()) ++j;
  if (!told_)
    warn("",
         fmt::format("{}: shares of redundant rows are not found (off by {:.1e}): at such instants reactions are those of the rows kept",
                     all[j]->label(), size > 0 ? left.norm() / size : 1));
  told_ = true;
  return {lambda.begin(), lambda.end()};
}

}  // namespace hilo
