// SPDX-License-Identifier: GPL-3.0-or-later
// Lee's frame of hexahedra, one through the section: two legs of 1.2 m and a section of 20 x 30 mm, hinged at both feet; node set `load`
// beside its corner.
#pragma once
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

inline Mesh lee_frame() {
  constexpr double leg = 1.2, half = 0.01;
  Mesh mesh = block_mesh({.n = {80, 1, 1},
                          .low = Vec3(0, -half, 0),
                          .high = Vec3(2 * leg, half, 0.03),
                          .map = [](const Vec3& at) {  // a straight bar of 2.4 m folded to a frame, with a mitre at the corner
                            const double s = at[0], n = at[1], along = leg - n, z = 0.03 - at[2];
                            return s <= leg ? Vec3(n, s / leg * along, z) : Vec3(n + (s - leg) / leg * along, along, z);
                          }});
  add_node_set(mesh, "load", [](const Vec3& x) { return std::abs(x[0] - 0.232) < 0.01 && x[1] > leg + half / 2; });
  EXPECT_EQ(mesh.node_sets.at("load").size(), 2u);
  return mesh;
}

/// With what pushes it, and [time].
inline std::string lee_frame_scene(const std::string& rest) {
  return solid(70.608e9, 0.3, 2700) + axial("revolute", "foot", "ground", "xmin", {0, 0, 0.015}, {0, 0, 1}) +
         axial("revolute", "far", "ground", "xmax", {1.2, 1.2, 0.015}, {0, 0, 1}) + rest;
}

/// Moved down by 0.45 m while t goes to 1.
inline const std::string pushed_by_a_law =
    motion("translation", "push", "load", "components = [\"y\"]\ndisplacement = [0, -0.45, 0]\nhistory = {t = [0, 1], value = [0, 1]}");

}  // namespace hilo::test
