// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/surface/cut.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "base/error.hpp"

namespace hilo {

Plane parse_cut(const std::string& text, const Vec3& towards_camera) {
  Plane plane;
  char axis = 0, rest = 0;
  Vec3 n, p;
  if (std::sscanf(text.c_str(), "%c=%lf%c", &axis, &plane.distance, &rest) == 2 && axis >= 'x' && axis <= 'z') {
    plane.normal = Vec3::Unit(axis - 'x');
  } else if (std::sscanf(text.c_str(), "%lf,%lf,%lf@%lf,%lf,%lf%c", &n.x(), &n.y(), &n.z(), &p.x(), &p.y(), &p.z(), &rest) == 6 &&
             n.norm() > 0) {
    plane.normal = n.normalized();
    plane.distance = plane.normal.dot(p);
  } else {
    throw Error("--cut", fmt::format("\"{}\" is no plane", text), "write x=0.1, or normal and point: 1,0,1@0,0,0.5", Exit::usage);
  }
  if (plane.normal.dot(towards_camera) < -1e-9 * towards_camera.norm()) plane.normal = -plane.normal, plane.distance = -plane.distance;
  return plane;
}

}  // namespace hilo
