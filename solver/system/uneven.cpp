// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/uneven.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "system/collocation.hpp"
#include "system/springs.hpp"

namespace hilo {

std::vector<Vec3> spins(const System& system, const Config& q, const Config& v) {
  std::vector<Vec3> out;
  double fastest = 0;
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    out.push_back(axial(v.R[b] * q.R[b].transpose()));
    fastest = std::max(fastest, out.back().norm());
  }
  for (Vec3& w : out)
    if (w.norm() < 1e-9 * fastest) w.setZero();
  return out;
}

std::string who_is_uneven(const System& system, const Config& q, const Config& v) {
  const std::vector<Vec3> spin = spins(system, q, v);
  for (size_t b = 1; b < system.bodies.size(); ++b) {
    if (spin[b].norm() == 0) continue;
    const Mat3 J = q.R[b] * system.bodies[b].J * q.R[b].transpose(), turn = Eigen::AngleAxisd(1, spin[b].normalized()).toRotationMatrix();
    if ((turn * J * turn.transpose() - J).norm() > 1e-9 * J.norm())
      return fmt::format("body \"{}\" has unequal moments of inertia about its axis of spin", system.bodies[b].name);
  }
  std::string names;
  for (const Spring& c : system.part<Springs>().list)
    for (const Carrier& end : c.ends())
      if (end.body >= 0 && spin[static_cast<size_t>(end.body)].norm() > 0) {
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", c.name);
        break;
      }
  return names.empty() ? "" : "springs that what spins carries: " + names;
}

}  // namespace hilo
