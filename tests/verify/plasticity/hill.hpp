// SPDX-License-Identifier: GPL-3.0-or-later
// Hill's thick cylinder, elastic and perfectly plastic.
#pragma once
#include "scene_parts.hpp"

namespace hilo::test {

/// A quarter in plane strain, a = 0.1, b = 0.2 m, loads and strength a hundredth, so that strains are small; pressed by 0.18 of `pressure`.
inline std::string hill_cylinder(double pressure) {
  return solid(210e9, 0.3, 7800, "block", "kind = \"j2\"\nyield = 0.24e7") + held("left", "x") + held("bottom", "y") + held("block", "z") +
         load("pressure", "inside", "xmin", fmt::format("pressure = {}\nhistory = {{t = [0, 0.18], value = [0, 0.18]}}", pressure)) +
         probe("outer") + in_steps(9, "end = 0.18");
}

}  // namespace hilo::test
