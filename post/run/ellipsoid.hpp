// SPDX-License-Identifier: GPL-3.0-or-later
// A body without a mesh is drawn as the ellipsoid that has its mass and inertia.
#pragma once
#include <string>

#include "base/math.hpp"
#include "model/scene.hpp"

namespace hilo {

struct Ellipsoid {
  std::string name;
  Vec3 centre;  // [m]
  Mat3 axes;    // columns: principal directions
  Vec3 radii;   // 0 where the body has no inertia  [m]
};
/// Of a [[body]]: J_i = m/5 (r_j^2 + r_k^2).
Ellipsoid ellipsoid_of(const Entry& body);

}  // namespace hilo
