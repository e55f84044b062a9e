// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/redundancy/minimum_norm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hilo {
namespace {

constexpr int klu_below = 200;   // blocks; beyond, nested dissection keeps the factors of nets thin
constexpr double shift = 1e-10;  // of unknowns whose rows are unit ones together
constexpr double least = 1e-26;  // of squares of gradients in a block; what is below is round-off

/// T with T S T^T diagonal, for S symmetric, semidefinite: Gauss' elimination from the largest diagonal on.  No entry is above 1 but by
/// round-off.
Mat3 apart(Mat3 S) {
  Mat3 T = Mat3::Identity();
  const auto take = [&](int p, int q) {  // what q has of p
    const double share = S(p, p) > 0 ? std::clamp(S(q, p) / S(p, p), -1.0, 1.0) : 0;
    S.row(q) -= share * S.row(p);
    S.col(q) -= share * S.col(p);
    T.row(q) -= share * T.row(p);
  };
  int first = 0;
  S.diagonal().maxCoeff(&first);
  int second = (first + 1) % 3, third = (first + 2) % 3;
  take(first, second), take(first, third);
  if (S(second, second) < S(third, third)) std::swap(second, third);
  take(second, third);
  return T;
}

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

void MinimumNorm::take_rows(const Stage& stage) {
  const auto all = system_.constraints();
  std::vector<DenseRows> G(all.size());
  for (size_t j = 0; j < all.size(); ++j) G[j] = all[j]->gradient(stage);
  const auto each_part = [&](const auto& visit) {  // of a row, in a block
    for (int j = 0; j < cliques_.size(); ++j)
      for (Eigen::Index r = 0; r < G[j].rows(); ++r)
        for (size_t k = 0; k < cliques_[j].size(); ++k) visit(cliques_[j][k], Eigen::Map<Vec3>(&G[j](r, 3 * static_cast<Eigen::Index>(k))));
  };
  std::vector<Mat3> axes(A_.n_blocks(), Mat3::Zero());  // of unknowns, whose rows next to each other are then near unit ones
  each_part([&](int block, const Vec3& g) { axes[block] += g * g.transpose(); });
  for (Mat3& S : axes) S = apart(S);
  std::vector<Vec3> scale(axes.size(), Vec3::Zero());  // along the axes of each block, by rows: those of the sum end in round-off
  each_part([&](int block, Eigen::Map<Vec3> g) { g = (axes[block] * g).eval(), scale[block] += g.cwiseAbs2(); });
  for (Vec3& s : scale) s = (s.array() > least * s.maxCoeff()).select(s.cwiseSqrt().cwiseInverse(), 0).eval();
  each_part([&](int block, Eigen::Map<Vec3> g) { g.array() *= scale[block].array(); });
  A_.zero();
  rows_.clear(), column_.clear(), value_.clear();
  std::array<double, max_directions * max_directions> K;
  for (int j = 0; j < cliques_.size(); ++j) {
    const DenseRows& own = G[j];
    const auto n = static_cast<size_t>(own.cols());
    std::fill_n(K.begin(), n * n, 0.0);
    for (Eigen::Index r = 0; r < own.rows(); ++r) {
      const double* g = own.row(r).data();
      for (size_t i = 0; i < n; ++i)
        if (g[i] != 0) {
          double* k = K.data() + i * n;
          for (size_t c = 0; c < n; ++c) k[c] += g[i] * g[c];
          column_.push_back(3 * cliques_[j][i / 3] + static_cast<int>(i % 3)), value_.push_back(g[i]);
        }
      rows_.push_back({j, all[j]->row() + static_cast<int>(r), all[j]->active()[static_cast<size_t>(r)], value_.size()});
    }
    A_.add(j, K.data());
  }
  constexpr double d[3] = {shift, shift, shift};
  for (int i = 0; i < A_.n_blocks(); ++i) A_.add_diagonal(i, d);
}

Eigen::VectorXd MinimumNorm::forces(std::span<const double> lambda, bool all_rows) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(A_.n());
  size_t k = 0;
  for (const Row& row : rows_) {
    const double own = all_rows || row.active ? lambda[row.place] : 0;
    for (; k < row.end; ++k) out[column_[k]] += own * value_[k];
  }
  return out;
}

std::vector<double> MinimumNorm::shares(const Eigen::VectorXd& y, size_t n) const {
  std::vector<double> out(n, 0.0);
  size_t k = 0;
  for (const Row& row : rows_)
    for (; k < row.end; ++k) out[row.place] += value_[k] * y[column_[k]];
  return out;
}

std::vector<double> MinimumNorm::operator()(const Stage& stage, std::span<const double> lambda) {
  take_rows(stage);
  const Eigen::VectorXd f = forces(lambda, false);
  double size = 0;  // of the forces of single rows, which may cancel
  size_t at = 0;
  for (const Row& row : rows_) {
    double square = 0;
    for (; at < row.end; ++at) square += value_[at] * value_[at];
    if (row.active) size += lambda[row.place] * lambda[row.place] * square;
  }
  size = std::sqrt(size);
  if (size == 0) return std::vector<double>(lambda.size(), 0.0);  // nothing that moves has a row, or all rows are at rest
  std::vector<double> best;
  Eigen::VectorXd left;  // of f by the best
  // conjugate gradients on G^T G y = f, from nothing: what an instant before left where rows hardly act would be shares that mean nothing.
  // A few passes, as the factors err by their shift alone; at round-off they would go astray.
  const auto find = [&](int passes, double enough) {
    std::vector<double> out(lambda.size(), 0.0);
    Eigen::VectorXd r = f, z(f.size()), p = Eigen::VectorXd::Zero(f.size());
    best = out, left = r;
    double before = 1;
    for (int pass = 0, since = 0; pass < passes && since < 3 && left.norm() > 1e-14 * size; ++pass) {
      factors_->solve(r.data(), z.data());
      const double now = r.dot(z);
      if (!(now > 0)) break;
      p = z + (pass > 0 ? now / before : 0) * p, before = now;
      const std::vector<double> q = shares(p, out.size());
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
  left.cwiseAbs().maxCoeff(&worst);
  const auto met = std::ranges::find(column_, static_cast<int>(worst / 3), [](int c) { return c / 3; }) - column_.begin();
  const Row& row = *std::ranges::upper_bound(rows_, std::min(static_cast<size_t>(met), column_.size() - 1), {}, &Row::end);
  if (!told_)
    warn("",
         fmt::format("{}: shares of redundant rows are not found (off by {:.1e}): at such instants reactions are those of the rows kept",
                     system_.constraints()[row.joint]->label(), left.norm() / size));
  told_ = true;
  return {lambda.begin(), lambda.end()};
}

}  // namespace hilo
