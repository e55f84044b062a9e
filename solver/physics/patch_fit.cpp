// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/patch_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

constexpr double least = 0.1;  // eigenvalue of a moment of a round patch that counts as determined; a full one has 0.5 to 1, its cubes 0.2
/// Of what is above linear, times the share of deviations that it leaves.  A cubic stands on samples that are an order better.
double doubt(int degree) { return degree == 3 ? 2 : 8; }

/// Sum over the nine components of a stress.
double squared(const Vec6& s) { return s.head<3>().squaredNorm() + 2 * s.tail<3>().squaredNorm(); }

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

PatchFit::PatchFit(int degree, const double* s) : degree_(degree), n_(std::max(1.0, s[0])), mean_(Vec3(s[1], s[2], s[3]) / n_) {
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

PatchFit::Terms PatchFit::basis(const Vec3& y) const {
  static const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0), root6 = std::sqrt(6.0);
  const Vec3 e = G_ * (y - mean_), q = e.cwiseProduct(e);
  Terms b = Terms::Zero();
  b.head<3>() = e;
  if (degree_ < 2) return b;
  b.segment<3>(3) = q;
  b[6] = root2 * e[1] * e[2], b[7] = root2 * e[0] * e[2], b[8] = root2 * e[0] * e[1];
  if (degree_ < 3) return b;
  for (int i = 0; i < 3; ++i) {
    b[9 + i] = e[i] * q[i];
    b[12 + i] = root3 * q[i] * e[(i + 1) % 3], b[15 + i] = root3 * q[i] * e[(i + 2) % 3];
  }
  b[18] = root6 * e[0] * e[1] * e[2];
  return b;
}

void PatchFit::add_moments(const Vec3& y, double* m) const {
  const auto b = basis(y);
  const int k = n_terms(degree_);
  for (int i = 0; i < k; ++i) *m++ += b[i];
  for (int i = 0; i < k; ++i)
    for (int j = 0; j <= i; ++j) *m++ += b[i] * b[j];
}

void PatchFit::finish(const double* m) {
  const int k = n_terms(degree_);
  b_mean_ = Eigen::Map<const Eigen::VectorXd>(m, k) / n_;
  m += k;
  Eigen::MatrixXd M(k, k);
  for (int i = 0; i < k; ++i)
    for (int j = 0; j <= i; ++j) M(i, j) = M(j, i) = *m++;
  M -= n_ * b_mean_ * b_mean_.transpose();
  A_ = M.topLeftCorner<3, 3>();
  orthonormal_.resize(0, k);
  for (int from = 0, degree = 1; degree <= degree_; ++degree) {
    const int n = (degree + 1) * (degree + 2) / 2;
    Eigen::MatrixXd rest = -(M.middleRows(from, n) * orthonormal_.transpose()) * orthonormal_;
    rest.middleCols(from, n) += Eigen::MatrixXd::Identity(n, n);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rest * M * rest.transpose());
    for (int i = 0; i < n; ++i) {
      if (!(eigen.eigenvalues()[i] > least * n_)) continue;
      orthonormal_.conservativeResize(orthonormal_.rows() + 1, k);
      orthonormal_.bottomRows<1>() = eigen.eigenvectors().col(i).transpose() * rest / std::sqrt(eigen.eigenvalues()[i]);
    }
    from += n;
    if (degree == 1) n_linear_ = static_cast<int>(orthonormal_.rows());
  }
}

void PatchFit::add_stress(const Vec3& y, const Vec6& s, double* sums) const {
  const auto b = basis(y);
  for (int c = 0; c < 6; ++c) *sums++ += s[c];
  const int k = n_terms(degree_);
  for (int i = 0; i < k; ++i)
    for (int c = 0; c < 6; ++c) *sums++ += b[i] * s[c];
  if (degree_ > 1) *sums += squared(s);
}

void PatchFit::add_slope(const Eigen::Matrix<double, 6, 3>& slope, double* sums) {
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 6; ++c) sums[24 + 6 * i + c] += slope(c, i);
}

double PatchFit::solve(const double* sums, double* polynomial) const {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
  using Const = Eigen::Map<const Rows>;
  const int k = n_terms(degree_);
  const Eigen::Matrix<double, 1, 6> mean = Const(sums, 1, 6) / n_;
  Rows left = Const(sums + 6, k, 6) - n_ * b_mean_ * mean, slope = Rows::Zero(k, 6);
  if (degree_ == 1) {
    slope = G_.inverse() * Const(sums + 24, 3, 6) / n_;  // by eta; G is symmetric
    left -= A_ * slope;
  }
  Rows share = orthonormal_ * left;
  double trust = 1;
  if (degree_ > 1) {
    double about_linear = sums[6 + 6 * k] - n_ * squared(mean), explained = 0;
    for (int i = 0; i < share.rows(); ++i) (i < n_linear_ ? about_linear : explained) += (i < n_linear_ ? -1 : 1) * squared(share.row(i));
    trust = about_linear > 0 ? std::clamp(1 - doubt(degree_) * (1 - explained / about_linear), 0.0, 1.0) : 0.0;
    share.bottomRows(share.rows() - n_linear_) *= trust;
  }
  Eigen::Map<Rows> p(polynomial, k + 1, 6);
  p.bottomRows(k) = slope + orthonormal_.transpose() * share;
  p.row(0) = mean - b_mean_.transpose() * p.bottomRows(k);
  return trust;
}

void PatchFit::add_at(const double* polynomial, const Vec3& y, double weight, Vec6& to) const {
  const auto b = basis(y);
  Vec6 p = Eigen::Map<const Vec6>(polynomial);
  for (int i = 0; i < n_terms(degree_); ++i) p += b[i] * Eigen::Map<const Vec6>(polynomial + 6 * (i + 1));
  to += weight * p;
}

}  // namespace hilo
