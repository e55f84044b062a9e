// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/axes.hpp"

#include <fmt/format.h>

#include <cmath>

namespace hilo {

Vec3 direction(const EntryValues& e, std::string_view key) {
  const Vec3 v = e.vector3(key);
  if (!(v.norm() > 0)) e.refuse(key, "the axis has zero length", fmt::format("give {} a direction, such as [0, 0, 1]", key));
  return v.normalized();
}

Mat3 joint_frame(const EntryValues& e) {
  if (!e.has("axis")) return Mat3::Identity();
  const Vec3 axis = direction(e, "axis"), x = e.has("x") ? direction(e, "x") : Vec3::Zero();
  if (!x.isZero() && std::abs(x.dot(axis)) > 1 - 1e-9) e.refuse("x", "x is parallel to the axis");
  return frame_of_axis(axis, x);
}

}  // namespace hilo
