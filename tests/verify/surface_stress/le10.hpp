// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks with curved edges, and NAFEMS LE10 on them.
#pragma once
#include <array>
#include <numbers>
#include <set>

#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

/// A block whose nodes, mid-side ones too, lie where `map` puts them.
inline Mesh curved(Shape shape, const std::array<int, 3>& n, const std::function<Vec3(const Vec3&)>& map) {
  BlockOptions o{.shape = shape};
  for (int i = 0; i < 3; ++i) o.n[i] = n[i];
  Mesh m = block_mesh(o);
  for (Vec3& X : m.X) X = map(X);
  return m;
}

/// n: cells from the hole outwards, around, through the thickness.
inline Mesh le10(Shape shape, const std::array<int, 3>& n) {
  Mesh m = curved(shape, n, [](const Vec3& s) {
    const double t = s[1] * std::numbers::pi / 2;
    return Vec3((2 + 1.25 * s[0]) * std::cos(t), (1 + 1.75 * s[0]) * std::sin(t), 0.6 * s[2]);
  });
  std::set<std::int64_t> outer;
  for (const Facet& f : m.facet_sets["xmax"])
    for (const std::int64_t a : m.facet_nodes(f)) outer.insert(a);
  for (const std::int64_t a : outer) {
    const Vec3& X = m.X[a];
    m.node_sets[X[0] < 1e-9 ? "outer and ymax" : X[1] < 1e-9 ? "outer and ymin" : "outer"].push_back(a);
    if (std::abs(X[2] - 0.3) < 1e-9) m.node_sets["middle of outer"].push_back(a);
  }
  return m;
}

inline std::string steel_block(double E, const std::string& holds_and_loads, const std::string& output) {
  return solid(E, 0.3, 7800, "block") + holds_and_loads + in_steps(1) + fields(output);
}
inline const std::string stresses = "\"displacement\", \"stress\", \"von_mises\", \"stress_error\"";

/// How far sigma_yy at the hole's edge, on top, on the long axis is from -5.38 MPa, as a share of it.
inline double off_le10(Shape shape, const std::array<int, 3>& n) {
  // the outer face stays in its place but along z; on the planes of symmetry one component is held already
  SceneCase c(steel_block(210e9,
                          held("ymin", "y") + held("ymax", "x") + held("outer", "xy") + held("outer and ymax", "y") +
                              held("outer and ymin", "x") + held("middle of outer", "z") +
                              load("pressure", "top", "zmax", "pressure = 1e6"),
                          stresses));
  const Mesh m = le10(shape, n);
  c.use(m);
  const Results r = c.solved();
  const auto s = r.table("/field/" + r.steps().back() + "/stress");
  const auto error = r.table("/field/" + r.steps().back() + "/stress_error");
  double off = 1;
  for (std::int64_t a = 0; a < m.n_nodes(); ++a) {
    if ((m.X[a] - Vec3(2, 0, 0.6)).norm() > 1e-9) continue;
    off = std::abs(s(a, 1) / -5.38e6 - 1);
    EXPECT_LT(std::abs(s(a, 1) + 5.38e6), error(a, 0) + 0.03 * 5.38e6);
  }
  return off;
}

}  // namespace hilo::test
