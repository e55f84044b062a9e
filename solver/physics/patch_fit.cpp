// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/patch_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

constexpr double least = 0.1;  // eigenvalue of a moment of a round patch that counts as determined; a full one has 0.5 to 1
constexpr double doubt = 8;    // of a curvature, times the share of deviations that it leaves

/// Inverse on the eigenvectors whose eigenvalue is above `limit`; how many they are.
template <class M>
int inverse_above(const M& symmetric, double limit, M& inverse) {
  const Eigen::SelfAdjointEigenSolver<M> eigen(symmetric);
  inverse.setZero();
  int n = 0;
  for (int k = 0; k < symmetric.rows(); ++k) {
    if (!(eigen.eigenvalues()[k] > limit)) continue;
    inverse += eigen.eigenvectors().col(k) * eigen.eigenvectors().col(k).transpose() / eigen.eigenvalues()[k];
    ++n;
  }
  return n;
}

const double root2 = std::sqrt(2.0);

/// Sum over the nine components of a stress, from products by its six.
double squared(const Row6& products) { return products.head<3>().sum() + 2 * products.tail<3>().sum(); }

Vec6 squares(const Vec3& e) {
  Vec6 q;
  q << e[0] * e[0], e[1] * e[1], e[2] * e[2], root2 * e[1] * e[2], root2 * e[0] * e[2], root2 * e[0] * e[1];
  return q;
}

}  // namespace

void PatchFit::add_sample(const Vec3& y, double* s) {
  s[0] += 1;
  for (int i = 0; i < 3; ++i) s[1 + i] += y[i];
}

void PatchFit::add_extent(const Vec3& y, double w, double* s) {
  s[4] += w;
  for (int i = 0; i < 3; ++i) s[5 + i] += w * y[i], s[8 + i] += w * y[i] * y[i];
  s[11] += w * y[1] * y[2], s[12] += w * y[0] * y[2], s[13] += w * y[0] * y[1];
}

PatchFit::PatchFit(int order, const double* s) : order_(order), n_(std::max(1.0, s[0])), mean_(Vec3(s[1], s[2], s[3]) / n_) {
  const double w = s[4];
  const Vec3 m = Vec3(s[5], s[6], s[7]) / w;
  Mat3 spread;
  spread << s[8], s[13], s[12], s[13], s[9], s[11], s[12], s[11], s[10];
  spread = spread / w - m * m.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(spread);
  const double largest = eigen.eigenvalues()[2], floor = largest > 0 ? 1e-12 * largest : 1;
  G_ =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(floor).cwiseSqrt().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
}

Eigen::Matrix<double, 9, 1> PatchFit::basis(const Vec3& y) const {
  const Vec3 eta = G_ * (y - mean_);
  Eigen::Matrix<double, 9, 1> b;
  b << eta, squares(eta);
  return b;
}

void PatchFit::add_moments(const Vec3& y, double* m) const {
  const auto b = basis(y);
  const int k = order_ == 2 ? 9 : 3;
  for (int i = 0; i < k; ++i) *m++ += b[i];
  for (int i = 0; i < k; ++i)
    for (int j = 0; j <= i; ++j) *m++ += b[i] * b[j];
}

void PatchFit::finish(const double* m) {
  const int k = order_ == 2 ? 9 : 3;
  Eigen::Matrix<double, 9, 1> sum = Eigen::Matrix<double, 9, 1>::Zero();
  Eigen::Matrix<double, 9, 9> full = Eigen::Matrix<double, 9, 9>::Zero();
  for (int i = 0; i < k; ++i) sum[i] = *m++;
  for (int i = 0; i < k; ++i)
    for (int j = 0; j <= i; ++j) full(i, j) = full(j, i) = *m++;
  full -= sum * sum.transpose() / n_;
  A_ = full.topLeftCorner<3, 3>();
  rank_ = 1 + inverse_above<Mat3>(A_, least * n_, Ai_);
  if (order_ < 2) return;
  quadratic_ = std::make_unique<Quadratic>();
  quadratic_->mean = sum.tail<6>() / n_;
  const auto B = quadratic_->B = full.bottomLeftCorner<6, 3>();
  const Mat6 rest = full.bottomRightCorner<6, 6>() - B * Ai_ * B.transpose();
  rank_ += inverse_above<Mat6>(rest, least * n_, quadratic_->Ci);
}

void PatchFit::add_stress(const Vec3& y, const Vec6& s, double* sums) const {
  const auto b = basis(y);
  for (int c = 0; c < 6; ++c) *sums++ += s[c];
  const int k = order_ == 2 ? 9 : 3;
  for (int i = 0; i < k; ++i)
    for (int c = 0; c < 6; ++c) *sums++ += b[i] * s[c];
  if (order_ == 2) *sums += s.head<3>().squaredNorm() + 2 * s.tail<3>().squaredNorm();
}

void PatchFit::add_slope(const Eigen::Matrix<double, 6, 3>& slope, double* sums) {
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 6; ++c) sums[24 + 6 * i + c] += slope(c, i);
}

void PatchFit::solve(const double* sums, double* polynomial) const {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
  using Const = Eigen::Map<const Rows>;
  const Row6 mean = Const(sums, 1, 6) / n_;
  const Eigen::Matrix<double, 3, 6> b1 = Const(sums + 6, 3, 6);
  Eigen::Matrix<double, 3, 6> l;
  Mat6 q = Mat6::Zero();
  if (order_ == 2) {
    const auto& [B, Ci, q_mean] = *quadratic_;
    const Mat6 left = Const(sums + 24, 6, 6) - n_ * q_mean * mean - B * (Ai_ * b1);
    q = Ci * left;
    const double about_linear = sums[60] - n_ * squared(mean.cwiseProduct(mean)) - squared(b1.cwiseProduct(Ai_ * b1).colwise().sum());
    const double explained = squared(left.cwiseProduct(q).colwise().sum());
    q *= about_linear > 0 ? std::clamp(1 - doubt * (1 - explained / about_linear), 0.0, 1.0) : 0.0;
    l = Ai_ * (b1 - B.transpose() * q);
  } else {
    const Eigen::Matrix<double, 3, 6> slope = G_.inverse() * Const(sums + 24, 3, 6) / n_;  // by eta; G is symmetric
    l = slope + Ai_ * (b1 - A_ * slope);
  }
  Eigen::Map<Rows> p(polynomial, n_rows(order_), 6);
  const Vec3 eta = -(G_ * mean_);
  p.row(0) = mean + eta.transpose() * l;
  if (order_ == 2) p.row(0) += (squares(eta) - quadratic_->mean).transpose() * q;
  Eigen::Matrix<double, 3, 6> gradient = l;
  for (int c = 0; c < 6 && order_ == 2; ++c) {
    Mat3 Q;
    Q << q(0, c), q(5, c) / root2, q(4, c) / root2, q(5, c) / root2, q(1, c), q(3, c) / root2, q(4, c) / root2, q(3, c) / root2, q(2, c);
    gradient.col(c) += 2 * Q * eta;
    const Mat3 K = G_ * Q * G_;
    p(4, c) = K(0, 0), p(5, c) = K(1, 1), p(6, c) = K(2, 2), p(7, c) = K(1, 2), p(8, c) = K(0, 2), p(9, c) = K(0, 1);
  }
  p.middleRows<3>(1) = G_ * gradient;
}

}  // namespace hilo
