// SPDX-License-Identifier: GPL-3.0-or-later
// The block of the scene "everything": its lowest cell rigid, the others soft.
#pragma once
#include "verify/verify.hpp"

namespace hilo::test {

inline Mesh half_rigid() {
  BlockOptions o;
  o.n[2] = 3;
  o.high = Vec3(0.4, 0.3, 1.2);
  o.regions = {"heavy", "soft"};
  o.region_of = [](const Vec3& x) { return x[2] < 0.4 ? 0 : 1; };
  Mesh m = block_mesh(o);
  add_node_set(m, "corner", [](const Vec3& x) { return std::abs(x[2] - 0.8) < 1e-9 && x[0] < 0.2 && x[1] < 0.1; });
  add_node_set(m, "line", [](const Vec3& x) { return std::abs(x[2] - 0.8) < 1e-9 && x[0] > 0.2; });
  return m;
}

}  // namespace hilo::test
