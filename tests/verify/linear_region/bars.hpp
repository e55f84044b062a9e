// SPDX-License-Identifier: GPL-3.0-or-later
// Soft bars along x, alone or two on a skew hinge, in free flight or held at one end.
#pragma once
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::soft_bars {

inline Mesh bar(double from, double to, int n, Shape shape = Shape::hex8) {
  return block_mesh({.shape = shape, .n = {n, 1, 1}, .low = Vec3(from, 0, 0), .high = Vec3(to, 0.1, 0.1)});
}

/// Meshes as one, regions and sets under a prefix.
inline Mesh together(const std::vector<std::pair<const Mesh*, std::string>>& parts) {
  Mesh out;
  for (const auto& [m, prefix] : parts) {
    const std::int64_t nodes = out.n_nodes(), cells = out.n_cells();
    const auto region = static_cast<std::int32_t>(out.region_name.size());
    for (size_t r = 0; r < m->region_name.size(); ++r)
      out.region_name.push_back(prefix + m->region_name[r]), out.region_data.push_back(m->region_data[r]);
    for (std::int64_t i = 0; i < m->n_nodes(); ++i) out.X.push_back(m->X[i]), out.node_id.push_back(nodes + i);
    for (std::int64_t e = 0; e < m->n_cells(); ++e) {
      std::vector<std::int64_t> list;
      for (const std::int64_t i : m->cell(e)) list.push_back(nodes + i);
      out.add_cell(static_cast<Shape>(m->shape[e]), list, region + m->region[e], cells + e);
    }
    for (const auto& [name, set] : m->facet_sets)
      for (const Facet& f : set) out.facet_sets[prefix + name].push_back({cells + f.cell, f.facet});
  }
  return out;
}
/// One from 0 to 1 m and one from there to 2 m.
inline Mesh two_bars(int n) {
  const Mesh left = bar(0, 1, n), right = bar(1, 2, n);
  return together({{&left, "left_"}, {&right, "right_"}});
}

inline const std::string soft = "[material.soft]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"soft\"\n",
                         hinge = axial("revolute", "hinge", "left_xmax", "right_xmin", {1, 0.05, 0.05}, {0.3, 1, 0.2}),
                         thrown = initial("*", "velocity = [1, -2, 3]\nspin = [3, 15, 10]"),
                         flight = thrown + in_time(3.16, 0.0158) + fields("\"displacement\"", "interval = 0.316") + solved_to(1e-12),
                         in_flight = soft + flight, pair_in_flight = soft + hinge + flight;
/// A little weight pulls at it from the start; all of its modes.
inline const std::string cantilever = soft + "modes = 200\nup_to = 1e9\n" + held("xmin") + probe("tip", "xmax") + in_time(0.2, 1e-3) +
                                      fields("\"displacement\"", "interval = 0.1") + solved_to(1e-13),
                         sagging = "gravity = [0, 1e-6, -1e-6]\n" + cantilever;

}  // namespace hilo::test::soft_bars
