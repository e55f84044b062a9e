// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/attitude.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {

/// w_i = f s_i, f = phi/|s|; f' = (df/d|s|)/|s|, f'' likewise of f'.
Arc arc(const Vector4& p, int axis) {
  const Eigen::Vector3d s = p.head<3>();
  const double c = p[3], square = s.squaredNorm(), rho2 = square + c * c;
  double f, f1, f2;
  if (const double y = square / (c * c); c > 0 && y < 1e-2) {  // atan(x)/x and its derivatives by y = x^2, in series
    double sum = 0, sum1 = 0, sum2 = 0;
    for (int n = 9; n >= 0; --n) {
      const double a = (n % 2 ? -1.0 : 1.0) / (2 * n + 1);
      sum = sum * y + a;
      if (n >= 1) sum1 = sum1 * y + n * a;
      if (n >= 2) sum2 = sum2 * y + n * (n - 1) * a;
    }
    f = sum / c, f1 = 2 * sum1 / (c * c * c), f2 = 4 * sum2 / (c * c * c * c * c);
  } else {
    const double sigma2 = std::max(square, 1e-18 * rho2), sigma = std::sqrt(sigma2);
    f = std::atan2(sigma, c) / sigma;
    f1 = (c / rho2 - f) / sigma2;
    f2 = -(2 * c / (rho2 * rho2) + 3 * f1) / sigma2;
  }
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
  Arc out;
  out.value = f * s[axis];
  out.d << f * unit + s[axis] * f1 * s, -s[axis] / rho2;
  Eigen::Matrix3d H = f1 * (unit * s.transpose() + s * unit.transpose()) + s[axis] * f2 * s * s.transpose();
  H.diagonal().array() += s[axis] * f1;
  const Eigen::Vector3d mixed = -unit / rho2 + 2 * s[axis] / (rho2 * rho2) * s;
  out.H << H, mixed, mixed.transpose(), 2 * c * s[axis] / (rho2 * rho2);
  return out;
}

ArcGradient arc_gradient(const Vector4& p0, const Vector4& p1, int axis) {
  const Vector4 step = p1 - p0;
  const Arc mid = arc((p0 + p1) / 2, axis);
  ArcGradient out{mid.d, mid.H / 2};
  const double square = step.squaredNorm();
  if (square < 1e-10)
    return out;  // what is missing is below the round-off that it would be made
                 // of
  const Arc end = arc(p1, axis);
  const double missing = end.value - arc(p0, axis).value - mid.d.dot(step);
  out.d += missing / square * step;
  out.D += step * (end.d - mid.d - mid.H * step / 2).transpose() / square;
  out.D -= 2 * missing / (square * square) * step * step.transpose();
  out.D.diagonal().array() += missing / square;
  return out;
}

/// With x = (a1 - a0)/2 and a = (a0 + a1)/2, sin a1 - sin a0 = 2 sin x cos a.
std::pair<double, double> arcsine_gradient(double sine0, double sine1) {
  constexpr double most = 1 - 1e-12;
  const double a0 = std::asin(std::clamp(sine0, -most, most)), a1 = std::asin(std::clamp(sine1, -most, most));
  const double x = (a1 - a0) / 2, a = (a0 + a1) / 2;
  const bool small = std::abs(x) < 1e-3;
  const double kappa = small ? 1 + x * x / 6 : x / std::sin(x);
  const double slope = small ? x / 3 : (std::sin(x) - x * std::cos(x)) / (std::sin(x) * std::sin(x));
  return {kappa / std::cos(a), (slope / std::cos(a) + kappa * std::sin(a) / (std::cos(a) * std::cos(a))) / (2 * std::cos(a1))};
}

Eigen::Matrix<double, 4, 3> tilted_slopes() {
  Eigen::Matrix<double, 4, 3> out = Eigen::Matrix<double, 4, 3>::Zero();
  out(0, 1) = -1, out(1, 0) = 1, out(3, 2) = 1;
  return out;
}

namespace {

/// (4 q q^T - I) u of an R, vector first, over 4: linear in R.
Vector4 linear(const Eigen::Matrix3d& R, const Vector4& u) {
  const double trace = R.trace();
  const Eigen::Vector3d a(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)), v = u.head<3>();
  Vector4 out;
  out << a * u[3] + R * v + R.transpose() * v - trace * v, trace * u[3] + a.dot(v);
  return out / 4;
}

}  // namespace

Vector4 Attitude::quaternion(const double* R) const { return linear(Eigen::Map<const Eigen::Matrix3d>(R), u_) + u_ / 4; }

Attitude::Slopes Attitude::slopes() const {
  Slopes out;
  for (int i = 0; i < 9; ++i) {
    Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
    R(i % 3, i / 3) = 1;
    out.col(i) = linear(R, u_);
  }
  return out;
}

}  // namespace hilo
