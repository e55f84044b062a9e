// SPDX-License-Identifier: GPL-3.0-or-later
// The block of the scene "everything": its lowest cell rigid, the others soft.
#pragma once
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

}  // namespace hilo::test
