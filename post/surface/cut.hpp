// SPDX-License-Identifier: GPL-3.0-or-later
// A plane that takes away what is before it.
#pragma once
#include <string>

#include "base/math.hpp"

namespace hilo {

/// Taken away is where normal.X > distance, in reference positions: the section moves with the material.
struct Plane {
  Vec3 normal{1, 0, 0};  // of unit length
  double distance = 0;   // [m]
  double operator()(const Vec3& X) const { return normal.dot(X) - distance; }
};
/// "x=0.1", "y=..", "z=..", or "nx,ny,nz@x,y,z" (normal and a point); the side towards the camera is taken away, the normal's where the
/// plane is seen edge on.  Error (exit 1) otherwise.
Plane parse_cut(const std::string& text, const Vec3& towards_camera);

}  // namespace hilo
