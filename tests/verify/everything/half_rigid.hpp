// SPDX-License-Identifier: GPL-3.0-or-later
// A block, its lowest cell rigid, the others rubber, with bodies, joints, springs, loads and a driven edge.
#pragma once
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

inline Mesh half_rigid() {
  Mesh m = block_mesh({.n = {1, 1, 3}, .high = {0.4, 0.3, 1.2}, .regions = {"heavy", "soft"}, .region_of = [](const Vec3& x) {
                         return x[2] < 0.4 ? 0 : 1;
                       }});
  add_node_set(m, "corner", [](const Vec3& x) { return std::abs(x[2] - 0.8) < 1e-9 && x[0] < 0.2 && x[1] < 0.1; });
  add_node_set(m, "line", [](const Vec3& x) { return std::abs(x[2] - 0.8) < 1e-9 && x[0] > 0.2; });
  return m;
}

inline std::string scene_of_everything() {
  const std::string turned =
      "at = [0, 0, 0.6]\naxis = [0, 0, 1]\nangle = 0.3\n"
      "history = {t = [0, 0.5], value = [0, 1], interpolation = \"smooth\"}";
  return "gravity = [1, -2, -9.81]\n" + solid(2e5, 0.3, 1000, "*", "kind = \"neo-hookean\"", "damping = 0.01") +
         "[[body]]\nname = \"top\"\nmass = 3\ncom = [0.2, 0.1, 2]\ninertia = [0.2, 0.3, 0.4, 0.02, -0.01, 0.03]\n" +
         body("side", 2, {0.2, 1.5, 1}, {0.1, 0.1, 0.1}) + "[[point_mass]]\nname = \"lump\"\non = \"ymax\"\nmass = 5\n" +
         axial("revolute", "hinge", "zmax", "top", {0.2, 0.15, 1.2}, {1, 0.3, 0}) +
         axial("universal", "cross", "top", "side", {0.2, 0.8, 1.5}, {0, 1, 0}, "x = [1, 0, 0]") +
         "[[joint]]\nkind = \"distance\"\nname = \"rod\"\nb = \"side\"\nat_a = [2, 1.5, 1]\nat_b = [0.2, 1.6, 1]\n" +
         spring("axial", "strut", "heavy", "side",
                "at_a = [0.1, 0.1, 0.2]\nat_b = [0.2, 1.5, 0.9]\nstiffness = 4000\ndamping = 50\nlength = 1") +
         spring("torsion", "coil", "zmax", "top", "axis = [1, 0.3, 0]\nstiffness = 300\ndamping = 4") +
         spring("bushing", "mount", "ground", "heavy",
                "at = [0.2, 0.15, 0]\nstiffness = [3000, 4000, 5000]\ndamping = [10, 20, 30]\nangular_stiffness = [100, 200, 300]\n"
                "angular_damping = [1, 2, 3]") +
         load("torque", "follower", "top", "torque = [5, -7, 3]\nfollower = true") +
         force("push", "side", {50, 20, -30}, "at = [0.3, 1.7, 1.2]") + load("traction", "wind", "xmin", "traction = [300, 100, 0]") +
         held("corner", "xz") + motion("rotation", "turned", "line", turned) + in_time(0.5, 1e-3) + "[output]\ninterval = 0.5\n";
}

struct Everything : SceneCase {
  Everything() : SceneCase(scene_of_everything()) { use(half_rigid(), {Fidelity::rigid, Fidelity::nonlinear}); }
};

}  // namespace hilo::test
