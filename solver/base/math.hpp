// SPDX-License-Identifier: GPL-3.0-or-later
// Points and small matrices.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace hilo {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

inline constexpr double g0 = 9.80665;  ///< standard gravity [m/s^2]

/// Matrix of the cross product: skew(a) b = a x b.
inline Mat3 skew(const Vec3& a) {
  Mat3 s;
  s << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return s;
}

/// Cayley rotation of w: R - I = skew(w) (R + I)/2, so a mid-point step by w/h is exact.
/// |w| = 2 tan(angle/2).
inline Mat3 cayley(const Vec3& w) {
  const Vec3 a = w / 2;
  const double c = 2 / (1 + a.squaredNorm());
  return Mat3::Identity() + c * skew(a) + c * skew(a) * skew(a);
}

/// Right-handed orthonormal frame with its third column along `axis`, first column nearest to `x`
/// (any direction when x is zero or parallel to the axis).
Mat3 frame_of_axis(const Vec3& axis, const Vec3& x = Vec3::Zero());

}  // namespace hilo
