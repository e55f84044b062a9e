// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of two blocks whose surfaces are tied.
#pragma once
#include "scene_parts.hpp"

namespace hilo::test {

inline std::string tie(const std::string& a = "Azmax", const std::string& b = "Bzmin", const std::string& more = "",
                       const std::string& name = "weld") {
  return fmt::format("[[tie]]\nname = \"{}\"\na = \"{}\"\nb = \"{}\"\n{}\n", name, a, b, more);
}
/// One block on the other, pulled.
inline std::string pulled(double nu, double p, const std::string& holds) {
  return solid(1e4, nu, 1) + tie() + holds + load("traction", "p", "Bzmax", fmt::format("traction = [0, 0, {}]", p)) +
         fields("\"displacement\"") + in_steps(1) + solved_to(1e-12);
}
inline const std::string planes = held("Azmin", "z") + held("side", "x") + held("back", "y");
/// They turn and shake in free flight.
inline std::string flight(const std::string& tied = tie("Azmax", "Bzmin", "gap = 0.05")) {
  return solid(2e6, 0.3, 1000) + tied + initial("*", "velocity = [0.3, 0.1, 0]\nspin = [1, 2, 3]") +
         initial("Bzmax", "velocity = [0.5, -0.4, 0.6]") + fields("\"displacement\"") + in_time(0.16, 0.02) + solved_to(1e-13);
}

}  // namespace hilo::test
