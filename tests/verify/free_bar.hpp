// SPDX-License-Identifier: GPL-3.0-or-later
// Bars of 1 m x 0.1 m x 0.1 m in free flight, which bend as they tumble.
#pragma once
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

inline Mesh free_bar(Shape shape = Shape::hex8, int along = 4) {
  return block_mesh({.shape = shape, .n = {along, 1, 1}, .high = {1, 0.1, 0.1}});
}

/// `bar`: its material and region; `output`: keys of [output].
inline std::string tumbling(const std::string& bar, double end, double step, const std::string& output) {
  return bar + initial("block", "spin = [3, 15, 10]") + in_time(end, step) + "[output]\n" + output + "\n" + solved_to(1e-12);
}
inline std::string soft_bar(const std::string& law = "stvk", double nu = 0.3, const std::string& of_region = "") {
  return solid(1e7, nu, 1000, "block", "kind = \"" + law + "\"", of_region);
}

/// It bends, and energy and angular momentum stay.
inline void expect_kept(const Results& r, double energy, double angular, const std::string& what) {
  const Drift kept = drift(r, 0);
  EXPECT_LT(kept.energy, energy) << what;
  EXPECT_LT(kept.angular, angular) << what;
  EXPECT_GT(kept.strained, 1e-3) << what;
}

}  // namespace hilo::test
