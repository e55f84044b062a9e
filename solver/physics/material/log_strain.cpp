// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/material/log_strain.hpp"

#include <cmath>

#include "physics/material/principal_axes.hpp"

namespace hilo {
namespace {

/// phi[a, b] = ln((1 + 2b)/(1 + 2a))/(2 (b - a)) = ln(1 + r)/r/(1 + 2a), r = 2 (b - a)/(1 + 2a)
double first_difference(double a, double b) {
  if (a > b) std::swap(a, b);
  const double l = 1 + 2 * a, r = 2 * (b - a) / l;
  if (r > 1e-3) return std::log1p(r) / r / l;
  return (1 + r * (-1. / 2 + r * (1. / 3 + r * (-1. / 4 + r * (1. / 5 - r / 6))))) / l;
}

/// phi[a, b, c], about the mean m of the three where they are close: phi''(m)/2 (1 + terms of complete symmetric polynomials of x - m).
double second_difference(double a, double b, double c) {
  if (a > c) std::swap(a, c);
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  const double m = (a + b + c) / 3, l = 1 + 2 * m;
  if (c - a > 0.01 * l) return (first_difference(b, c) - first_difference(a, b)) / (c - a);
  const double u = 2 * (a - m) / l, v = 2 * (b - m) / l, w = 2 * (c - m) / l;  // of ln(1 + u): n-th coefficient (-1)^(n+1)/n
  double power[3] = {1, 1, 1}, h[8] = {1};                                     // h_n of (u), (u, v), (u, v, w)
  for (int n = 1; n < 8; ++n) power[0] *= u, power[1] = power[0] + v * power[1], power[2] = power[1] + w * power[2], h[n] = power[2];
  double sum = 0;
  for (int n = 7; n >= 0; --n) sum += h[n] * (n % 2 ? 1. : -1.) / (n + 2);
  return 2 * sum / (l * l);  // half of ln, (2/l)^2 of the arguments
}

}  // namespace

LogStrain::LogStrain(const Mat3& E, bool twice) {
  principal_axes(E, V_, e_);
  for (int i = 0; i < 3; ++i) phi_[i] = std::log1p(2 * e_[i]) / 2;
  value_ = V_ * phi_.asDiagonal() * V_.transpose();
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      first_(i, j) = first_(j, i) = first_difference(e_[i], e_[j]);
      for (int k = j; k < 3 && twice; ++k) {
        const double f = second_difference(e_[i], e_[j], e_[k]);
        third_[i][j][k] = third_[i][k][j] = third_[j][i][k] = third_[j][k][i] = third_[k][i][j] = third_[k][j][i] = f;
      }
    }
}

LogStep::LogStep(const LogStrain& from, const LogStrain& to, const Lame& c, bool twice)
    : N_(to.V_), M_(from.V_), P_(to.V_.transpose() * from.V_) {
  const double mean = (from.phi_.sum() + to.phi_.sum()) / 2;  // of tr h
  Mat3 first, of_trace, of_all;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      first(i, j) = first_difference(to.e_[i], from.e_[j]);
      of_trace(i, j) = first(i, j) * P_(i, j);
      of_all(i, j) = (c.lambda * mean + c.mu * (to.phi_[i] + from.phi_[j])) * of_trace(i, j);
    }
  const auto joined = [&](const Mat3& m) {
    const Mat3 g = N_ * m * M_.transpose();
    return Mat3((g + g.transpose()) / 2);
  };
  stress_ = joined(of_all);
  if (!twice) return;
  trace_ = c.lambda / 2 * joined(of_trace);
  by_trace_ = N_ * to.first_.diagonal().asDiagonal() * N_.transpose();
  for (int i = 0; i < 3; ++i)
    for (int k = i; k < 3; ++k)
      for (int j = 0; j < 3; ++j) {
        const double f = second_difference(to.e_[i], to.e_[k], from.e_[j]);
        // of phi^2, symmetric in i and k
        const double square = (to.phi_[i] + from.phi_[j]) * f + to.first_(i, k) * first(k, j);
        twice_[i][k][j] = twice_[k][i][j] = c.lambda * mean * f + c.mu * square;
      }
}

Mat3 LogStep::slope(const Mat3& x) const {
  const Mat3 local = N_.transpose() * x * N_;
  Mat3 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      m(i, j) =
          local(i, 0) * twice_[i][0][j] * P_(0, j) + local(i, 1) * twice_[i][1][j] * P_(1, j) + local(i, 2) * twice_[i][2][j] * P_(2, j);
  const Mat3 g = N_ * m * M_.transpose();
  return (g + g.transpose()) / 2 + by_trace_.cwiseProduct(x).sum() * trace_;
}

Mat3 LogStrain::Q(const Mat3& x) const {
  const Mat3 local = V_.transpose() * x * V_;
  return V_ * first_.cwiseProduct(local) * V_.transpose();
}

Mat3 LogStrain::L(const Second& T, const Mat3& x) const {
  const Mat3 local = V_.transpose() * x * V_;
  Mat3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += third_[i][j][k] * (local(i, k) * T.T(k, j) + T.T(i, k) * local(k, j));
      out(i, j) = out(j, i) = sum;
    }
  return V_ * out * V_.transpose();
}

Mat3 LogStrain::power(double s) const {
  Mat3 out = Mat3::Zero();
  for (int i = 0; i < 3; ++i) out += std::pow(1 + 2 * e_[i], s / 2) * V_.col(i) * V_.col(i).transpose();
  return out;
}

Mat3 exponential(const Mat3& A) {
  Mat3 V, out = Mat3::Zero();
  Vec3 e;
  principal_axes(A, V, e);
  for (int i = 0; i < 3; ++i) out += std::exp(e[i]) * V.col(i) * V.col(i).transpose();
  return out;
}

}  // namespace hilo
