// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/uneven.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "system/springs.hpp"

namespace hilo {

std::string who_is_uneven(const System& system, const Config& q, const Config& v) {
  const auto axis = [&](int b) {
    const Mat3 S = v.R[b] * q.R[b].transpose();
    return Vec3(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1));
  };
  for (size_t b = 1; b < system.bodies.size(); ++b) {
    const Vec3 w = axis(static_cast<int>(b));
    if (w.norm() == 0) continue;
    const Mat3 J = q.R[b] * system.bodies[b].J * q.R[b].transpose(), turn = Eigen::AngleAxisd(1, w.normalized()).toRotationMatrix();
    if ((turn * J * turn.transpose() - J).norm() > 1e-9 * J.norm())
      return fmt::format("body \"{}\" has unequal moments of inertia about its axis of spin", system.bodies[b].name);
  }
  std::string names;
  for (const Spring& c : system.part<Springs>().list)
    for (const Carrier& end : c.ends())
      if (end.body >= 0 && axis(end.body).norm() > 0) {
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", c.name);
        break;
      }
  return names.empty() ? "" : "springs that what spins carries: " + names;
}

}  // namespace hilo
