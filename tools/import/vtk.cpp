// SPDX-License-Identifier: GPL-3.0-or-later
// VTK unstructured grids: solid cells, their regions by an integer array of the cells.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.hpp"
#include "import/data_line.hpp"
#include "import/imported.hpp"
#include "import/vtk_grid.hpp"

namespace hilo {
namespace {

constexpr const char* region_arrays[] = {"MATERIALIDS",   "MATERIALID",    "REGION",   "REGIONID", "REGIONS",
                                         "CELLENTITYIDS", "GMSH:PHYSICAL", "MATERIAL", "PARTID"};

struct VtkKind {
  int type;
  Shape shape;
  std::vector<int> p;  // ours[i] = theirs[p[i]]; as many as we keep
  const char* name;
  size_t n_nodes;
};
const VtkKind* vtk_kind(int type) {
  const auto first = [](int n) {
    std::vector<int> v(n);
    for (int i = 0; i < n; ++i) v[i] = i;
    return v;
  };
  static const std::vector<VtkKind> kinds = {
      {3, Shape::bar2, first(2), "line", 2},
      {10, Shape::tet4, first(4), "tetra", 4},
      {11, Shape::hex8, {0, 1, 3, 2, 4, 5, 7, 6}, "voxel", 8},
      {12, Shape::hex8, first(8), "hexahedron", 8},
      {13, Shape::wedge6, first(6), "wedge", 6},
      {24, Shape::tet10, first(10), "quadratic tetra", 10},
      {25, Shape::hex20r, first(20), "quadratic hexahedron", 20},
      {26, Shape::wedge15, first(15), "quadratic wedge", 15},
      {29, Shape::hex20r, first(20), "triquadratic hexahedron", 27},
      {32, Shape::wedge15, first(15), "biquadratic quadratic wedge", 18},
  };
  for (const auto& k : kinds)
    if (k.type == type) return &k;
  return nullptr;
}
constexpr int pyramid5 = 14;
bool is_flat_type(int type) { return type <= 2 || (type >= 4 && type <= 9) || (type >= 21 && type <= 23) || type == 28 || type == 34; }

void check(const VtkGrid& g, const std::string& path) {
  if (g.points.empty()) throw Error(path, "no points");
  if (g.types.empty() || g.offsets.size() != g.types.size() + 1)
    throw Error(path, fmt::format("{} cells but {} cell types", g.offsets.empty() ? 0 : g.offsets.size() - 1, g.types.size()));
  const auto n = static_cast<std::int64_t>(g.points.size() / 3);
  for (size_t c = 0; c < g.types.size(); ++c) {
    if (g.offsets[c] < 0 || g.offsets[c + 1] < g.offsets[c] || g.offsets[c + 1] > static_cast<std::int64_t>(g.connectivity.size()))
      throw Error(path, fmt::format("cell {} reaches beyond the connectivity", c));
    for (auto i = g.offsets[c]; i < g.offsets[c + 1]; ++i)
      if (g.connectivity[i] < 0 || g.connectivity[i] >= n)
        throw Error(path, fmt::format("cell {} names node {}, which does not exist", c, g.connectivity[i]));
  }
}

/// VTK's own linear wedges have the base the other way round than those of its quadratic ones and of other programs, which many writers
/// forget: where all are numbered so, all are turned.
void turn_wedges(Imported& in) {
  Mesh& m = in.mesh;
  std::vector<std::int64_t> wedges;
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    if (m.shape[c] == static_cast<std::uint8_t>(Shape::wedge6)) wedges.push_back(c);
  if (wedges.empty() || std::ranges::any_of(wedges, [&](std::int64_t c) { return !(quality(m, c).volume < 0); })) return;
  for (const auto c : wedges) {
    auto* n = m.nodes.data() + m.offset[c];
    std::swap(n[1], n[2]), std::swap(n[4], n[5]);
  }
  in.notes.push_back(fmt::format("{} wedges are numbered as VTK's documentation has them: turned", wedges.size()));
}

}  // namespace

Imported read_vtk(const std::string& path, const ImportOptions& options) {
  std::string bytes = read_gz(path, "");
  const bool xml = bytes.find("<VTKFile") < 1000;
  const VtkGrid g = xml ? read_vtu(path, std::move(bytes)) : read_vtk_legacy(path, std::move(bytes));
  check(g, path);
  Imported in;
  Mesh& m = in.mesh;
  for (size_t a = 0; 3 * a + 2 < g.points.size(); ++a) {
    m.X.emplace_back(g.points[3 * a], g.points[3 * a + 1], g.points[3 * a + 2]);
    m.node_id.push_back(static_cast<std::int64_t>(a));
  }
  const bool solids = std::any_of(g.types.begin(), g.types.end(),
                                  [](int t) { return t == pyramid5 || (vtk_kind(t) && vtk_kind(t)->shape != Shape::bar2); });
  refuse_flat(path, std::ranges::count_if(g.types, is_flat_type), solids);
  std::vector<std::int64_t> cell_of;  // number in the file
  std::vector<std::int64_t> nodes;
  std::int64_t n_pyramids = 0;
  for (size_t c = 0; c < g.types.size(); ++c) {
    const VtkKind* k = vtk_kind(g.types[c]);
    if (is_flat_type(g.types[c]) || (k && k->shape == Shape::bar2 && solids)) {
      in.skip(fmt::format("VTK cells of type {}", g.types[c]), path);
      continue;
    }
    if (g.types[c] == pyramid5) {
      if (g.offsets[c + 1] - g.offsets[c] != 5) throw Error(path, fmt::format("cell {}: a pyramid has 5 nodes", c));
      auto id = static_cast<std::int64_t>(c);
      for (const auto& half : halves_of_pyramid(std::span(g.connectivity).subspan(static_cast<size_t>(g.offsets[c]), 5))) {
        m.add_cell(Shape::tet4, half, -1, id);
        cell_of.push_back(static_cast<std::int64_t>(c));
        id = static_cast<std::int64_t>(g.types.size()) + n_pyramids;
      }
      ++n_pyramids;
      continue;
    }
    if (!k)
      throw Error(path, fmt::format("cell {} is of VTK type {}", c, g.types[c]),
                  "supported: lines, tetrahedra, hexahedra, voxels, wedges of order 1 and 2, pyramids of 5 nodes");
    if (static_cast<size_t>(g.offsets[c + 1] - g.offsets[c]) != k->n_nodes)
      throw Error(path, fmt::format("cell {}: a {} has {} nodes", c, k->name, k->n_nodes));
    if (k->p.size() < k->n_nodes) in.skip(fmt::format("nodes inside a {}", k->name), path);
    nodes.clear();
    for (const int i : k->p) nodes.push_back(g.connectivity[g.offsets[c] + i]);
    m.add_cell(k->shape, nodes, -1, static_cast<std::int64_t>(c));
    cell_of.push_back(static_cast<std::int64_t>(c));
  }
  if (m.n_cells() == 0) throw Error(path, "no volume cells and no lines");
  turn_wedges(in);
  tell_pyramids(in, n_pyramids);

  // Of an array of whole numbers the cells of each value.
  const auto by_values = [&](const std::string& name, const std::string& prefix) {
    std::map<std::int64_t, CellGroup> by_value;
    const auto& v = g.cell_data.at(name);
    for (size_t c = 0; c < cell_of.size(); ++c)
      by_value[static_cast<std::int64_t>(v[cell_of[c]])].cells.push_back(static_cast<std::int64_t>(c));
    std::vector<CellGroup> groups;
    for (auto& [value, group] : by_value) groups.push_back({fmt::format("{}_{}", prefix, value), std::move(group.cells)});
    return groups;
  };
  const auto is_whole = [&](const std::string& name) {
    const auto& v = g.cell_data.at(name);
    return v.size() == g.types.size() && std::ranges::all_of(v, [](double x) { return x == std::floor(x) && std::abs(x) < 9e15; });
  };
  std::vector<CellGroup> regions, groups;
  std::string of_regions;
  for (const char* wanted : region_arrays) {
    const auto found = std::ranges::find_if(g.cell_data, [&](const auto& a) { return upper(a.first) == wanted; });
    if (found == g.cell_data.end() || !is_whole(found->first)) continue;
    of_regions = found->first;
    regions = by_values(of_regions, "region");
    in.notes.push_back(fmt::format("regions by the values of cell array \"{}\"", of_regions));
    break;
  }
  constexpr size_t most_groups = 1000;  // an array of more values numbers cells
  for (const auto& [name, values] : g.cell_data) {
    if (name == of_regions) continue;
    std::set<double> different;
    for (size_t c = 0; c < values.size() && different.size() <= most_groups; ++c) different.insert(values[c]);
    const bool few = different.size() <= most_groups && !different.empty() && is_whole(name);
    auto more = few ? by_values(name, name) : std::vector<CellGroup>();
    in.skip(few ? fmt::format("cell array \"{}\" (--regions {},... makes regions of its values)", name, more.front().name)
                : fmt::format("cell array \"{}\"", name),
            path);
    if (few) std::ranges::move(more, std::back_inserter(groups));
  }
  for (const auto& name : g.not_read) in.skip(name, path);
  assign_regions(in, path, regions, false, groups, options);
  return in;
}

}  // namespace hilo
