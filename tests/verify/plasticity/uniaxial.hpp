// SPDX-License-Identifier: GPL-3.0-or-later
// A block of metal pulled, pushed and pulled along x, free across: uniaxial stress at finite strain.
#pragma once
#include "scene_parts.hpp"

namespace hilo::test {

inline std::string uniaxial_cycle() {
  return solid(200e9, 0.3, 7800, "block", "kind = \"j2\"\nyield = 400e6\nhardening = 3e9\nkinematic = 5e9") + held("xmin", "x") +
         held("ymin", "y") + held("zmin", "z") +
         motion("translation", "pull", "xmax",
                "components = [\"x\"]\ndisplacement = [1, 0, 0]\nhistory = {t = [0, 1, 2, 3], value = [0, 0.3, -0.1, 0.15]}") +
         in_steps(24, "end = 3") + fields("\"displacement\", \"stress\", \"von_mises\", \"plastic_strain\"", "interval = 1");
}

}  // namespace hilo::test
