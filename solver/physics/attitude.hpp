// SPDX-License-Identifier: GPL-3.0-or-later
// Angles of directions and of rotations, from products of directors: their discrete gradients.
//
// A vector p = (s, c) of three parts and one stands for the rotation by phi = atan2(|s|, c) about s: its vector is w = phi s/|s|.  It is of
// degree 0 in p, so a mean of two rotations need not be scaled.  The discrete gradient is that at the middle, completed along the
// step [gonzalez-1996]: d.(p1 - p0) = w1 - w0.
#pragma once
#include <Eigen/Core>
#include <utility>

#include "base/archive.hpp"

namespace hilo {

using Vector4 = Eigen::Vector4d;

/// Component `axis` of w(p), its gradient and second derivatives.
struct Arc {
  double value;
  Vector4 d;
  Eigen::Matrix4d H;
};
Arc arc(const Vector4& p, int axis);

/// d with d.(p1 - p0) = w(p1) - w(p0), symmetric in both, and D = dd/dp1.
struct ArcGradient {
  Vector4 d;
  Eigen::Matrix4d D;
};
ArcGradient arc_gradient(const Vector4& p0, const Vector4& p1, int axis);

/// The quotient of the arcsines and of sines, and its derivative by the second.
std::pair<double, double> arcsine_gradient(double sine0, double sine1);

/// The p of the shortest rotation from z to the axis with these components, (-y, x, 0, z), and its derivative.
inline Vector4 tilted(const double* axis) { return {-axis[1], axis[0], 0, axis[2]}; }
Eigen::Matrix<double, 4, 3> tilted_slopes();

/// The quaternion of R from its entries, of the sign nearest to that accepted last.  4 q q^T is linear in R, so is its product with the
/// accepted quaternion u, p = q (q.u): no division, and no angle at which it fails but half a turn from u.
class Attitude {
 public:
  using Slopes = Eigen::Matrix<double, 4, 9>;
  /// p, vector first, from nine entries by columns.
  Vector4 quaternion(const double* R) const;
  Slopes slopes() const;
  /// Near u it stays: what a mean of two rotations is measured by depends on it a little.
  void accept(const double* R) {
    if (const Vector4 p = quaternion(R); p.norm() < 0.8) u_ = p.normalized();
  }
  void archive(Archive& a) { a("attitude", u_); }

 private:
  Vector4 u_{0, 0, 0, 1};
};

}  // namespace hilo
