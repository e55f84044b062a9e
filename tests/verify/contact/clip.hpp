// SPDX-License-Identifier: GPL-3.0-or-later
// A clip: a part that can meet itself.
#pragma once
#include "verify/contact/collision.hpp"

namespace hilo::test {

inline Vec3 cell_middle(const Mesh& m, std::span<const std::int64_t> nodes) {
  Vec3 sum = Vec3::Zero();
  for (const std::int64_t i : nodes) sum += m.X[i] / static_cast<double>(nodes.size());
  return sum;
}

/// The mesh without some of its cells, by their middles.
template <class Gone>
Mesh cut_out(const Mesh& from, Gone gone) {
  Mesh out;
  out.region_name = from.region_name, out.region_data = from.region_data;
  std::vector<std::int64_t> node(from.X.size(), -1);
  for (std::int64_t c = 0; c < from.n_cells(); ++c) {
    if (gone(cell_middle(from, from.cell(c)))) continue;
    std::vector<std::int64_t> nodes;
    for (const std::int64_t i : from.cell(c)) {
      if (node[i] < 0) node[i] = out.n_nodes(), out.X.push_back(from.X[i]), out.node_id.push_back(out.n_nodes());
      nodes.push_back(node[i]);
    }
    out.add_cell(static_cast<Shape>(from.shape[c]), nodes, from.region[c], out.n_cells() + 1);
  }
  return out;
}

/// Facets all of whose nodes are there.
template <class There>
void add_outer_set(Mesh& m, const std::string& name, There there) {
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    for (int f = 0; f < static_cast<int>(info(m.shape[c]).facets.size()); ++f) {
      const auto nodes = m.facet_nodes({c, f});
      if (std::ranges::all_of(nodes, [&](std::int64_t i) { return there(m.X[i]); })) m.facet_sets[name].push_back({c, f});
    }
}

/// Two arms of cubes of 0.1 m, joined at their left ends: a slot of one cube, 1 m long, between them.  Sets: the faces of the slot, the
/// outer faces of the arms.  `halves`: upper and lower half are regions of their own.
inline Mesh clip(Shape shape = Shape::hex8, bool halves = false) {
  BlockOptions o;
  o.shape = shape, o.n[0] = 12, o.n[1] = 2, o.n[2] = 5, o.high = Vec3(1.2, 0.2, 0.5);
  if (halves) o.regions = {"lower", "upper"}, o.region_of = [](const Vec3& x) { return x[2] > 0.3 ? 1 : 0; };
  Mesh m = cut_out(block_mesh(o), [](const Vec3& x) { return x[0] > 0.2 && x[2] > 0.2 && x[2] < 0.3; });
  const auto at = [](double z) { return [=](const Vec3& x) { return x[0] > 0.19 && std::abs(x[2] - z) < 1e-9; }; };
  add_outer_set(m, "up", at(0.3)), add_outer_set(m, "low", at(0.2)), add_outer_set(m, "top", at(0.5)), add_outer_set(m, "bottom", at(0));
  return m;
}

}  // namespace hilo::test
