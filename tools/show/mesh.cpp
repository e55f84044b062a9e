// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh, tags and parts in a summary.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/outside_shapes.hpp"
#include "model/thin_regions.hpp"
#include "show/summary.hpp"

namespace hilo {
namespace {

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(const Vec3& x) { low = low.cwiseMin(x), high = high.cwiseMax(x); }
  std::string text() const {
    if (!(low.x() <= high.x())) return "-";
    return fmt::format("[{:.5g}, {:.5g}, {:.5g}] to [{:.5g}, {:.5g}, {:.5g}]", low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  }
};

std::string number(double x) { return std::isfinite(x) ? fmt::format("{}", x) : "-"; }

Table regions(const MeshFile& f, const std::string& path) {
  const Mesh& m = f.mesh;
  const auto thin = read_thin_regions(path);
  const size_t n = m.region_name.size();
  std::vector<std::int64_t> cells(n, 0);
  std::vector<double> volume(n, 0);
  std::vector<Box> box(n);
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto r = m.region[c];
    ++cells[r];
    if (info(m.shape[c]).dimension == 3) volume[r] += quality(m, c).volume;
    for (const auto a : m.cell(c)) box[r].add(m.X[a]);
  }
  Table t{{"region", "cells", "volume [m^3]", "density [kg/m^3]", "E [Pa]", "nu", "box [m]"}, {}, 1, 6};
  if (f.tagged) t.header.insert(t.header.begin() + 1, "fidelity"), t.n_text = 2;
  for (size_t r = 0; r < n; ++r) {
    const RegionData& d = m.region_data[r];
    if (!thin.empty()) volume[r] += thin[r].volume();
    t.rows.push_back(
        {m.region_name[r], fmt::format("{}", cells[r]), number(volume[r]), number(d.density), number(d.E), number(d.nu), box[r].text()});
    if (f.tagged) t.rows.back().insert(t.rows.back().begin() + 1, std::string(word(f.fidelity[r])));
  }
  return t;
}

Table sets(const Mesh& m) {
  Table t{{"set", "of", "size", "area [m^2]", "box [m]"}, {}, 2, 6};
  const auto row = [&](const std::string& name, const std::string& kind, size_t size, const auto& nodes,
                       double area = std::numeric_limits<double>::quiet_NaN()) {
    Box box;
    for (const auto a : nodes) box.add(m.X[a]);
    t.rows.push_back({name, kind, std::to_string(size), number(area), box.text()});
  };
  for (const auto& [name, list] : m.node_sets) row(name, "nodes", list.size(), list);
  for (const auto& [name, list] : m.facet_sets) {
    std::vector<std::int64_t> nodes;
    double area = 0;
    for (const auto& f : list) {
      for (const auto a : m.facet_nodes(f)) nodes.push_back(a);
      area += facet_area(m, f).norm();
    }
    row(name, "facets", list.size(), nodes, area);
  }
  for (const auto& [name, list] : m.cell_sets) {
    std::vector<std::int64_t> nodes;
    for (const auto c : list) nodes.insert(nodes.end(), m.cell(c).begin(), m.cell(c).end());
    row(name, "cells", list.size(), nodes);
  }
  return t;
}

Table parts(const MeshFile& f) {
  std::vector<std::int64_t> cells(f.n_parts, 0), nonlinear(f.n_parts, 0);
  for (size_t c = 0; c < f.rank.size(); ++c)
    ++cells[f.rank[c]], nonlinear[f.rank[c]] += f.fidelity[f.mesh.region[c]] == Fidelity::nonlinear;
  Table t{{"part", "cells", "nonlinear"}, {}, 0};
  for (int p = 0; p < f.n_parts; ++p) t.rows.push_back({std::to_string(p), std::to_string(cells[p]), std::to_string(nonlinear[p])});
  return t;
}

}  // namespace

void add_mesh(Summary& s, const MeshFile& f, const std::string& path) {
  const Mesh& m = f.mesh;
  std::vector<std::int64_t> of_shape(most_shapes, 0);
  for (const auto shape : m.shape) ++of_shape[shape];
  Box box;
  for (const auto& x : m.X) box.add(x);
  s.count("nodes", m.n_nodes());
  s.count("cells", m.n_cells());
  for (int k = 0; k < most_shapes; ++k)
    if (of_shape[k]) s.count(fmt::format("  {}", info(static_cast<Shape>(k)).name), of_shape[k]);
  s.say("box [m]", box.text());
  if (!f.rank.empty()) s.count("parts", f.n_parts);
  if (!m.deck_scene.empty()) s.count("scene lines of the deck", std::ranges::count(m.deck_scene, '\n'));
  s.list("regions", regions(f, path));
  s.list("sets", sets(m));
  if (!f.rank.empty()) s.list("parts", parts(f));
}

}  // namespace hilo
