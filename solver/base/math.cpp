// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/math.hpp"

namespace hilo {

Mat3 frame_of_axis(const Vec3& axis, const Vec3& x) {
  Mat3 f;
  f.col(2) = axis.normalized();
  Vec3 e1 = x - f.col(2) * f.col(2).dot(x);
  if (e1.norm() < 1e-9 * std::max(1e-300, x.norm()) || x.isZero()) {
    Eigen::Index smallest;
    f.col(2).cwiseAbs().minCoeff(&smallest);
    e1 = Vec3::Unit(smallest) - f.col(2) * f(smallest, 2);
  }
  f.col(0) = e1.normalized();
  f.col(1) = f.col(2).cross(f.col(0));
  return f;
}

}  // namespace hilo
