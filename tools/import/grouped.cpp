// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/grouped.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_set>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "base/utf8.hpp"
#include "import/shell_groups.hpp"
#include "model/thin_regions.hpp"

namespace hilo {

bool GroupedMesh::add_node(std::int64_t id, const Vec3& x) {
  if (!row_.try_emplace(id, in.mesh.n_nodes()).second) return false;
  in.mesh.X.push_back(x);
  in.mesh.node_id.push_back(id);
  return true;
}

std::int64_t GroupedMesh::row(std::int64_t id) const {
  const auto found = row_.find(id);
  return found == row_.end() ? -1 : found->second;
}

bool GroupedMesh::add_element(int dimension, Shape shape, std::int64_t id, std::int64_t property, std::vector<std::int64_t> rows,
                              bool has_middles) {
  if (!of_id_.try_emplace(id, elements_.size()).second) return false;
  elements_.push_back({dimension, shape, id, property, std::move(rows), has_middles});
  return true;
}

const GroupedMesh::Element* GroupedMesh::find(std::int64_t id) const {
  const auto found = of_id_.find(id);
  return found == of_id_.end() ? nullptr : &elements_[found->second];
}

void GroupedMesh::add_group(Group group) {
  group.name = printable(as_utf8(std::move(group.name)));
  groups_.push_back(std::move(group));
}

std::vector<GroupedMesh::Element*> GroupedMesh::members(const Group& group, int dimension) {
  std::vector<Element*> found;
  for (const auto id : group.elements)
    if (const auto e = of_id_.find(id); e != of_id_.end() && elements_[e->second].dimension == dimension)
      found.push_back(&elements_[e->second]);
  return found;
}

/// Its cells, made where they are not there yet, behind `cells`.
void GroupedMesh::add_cells(Element& e, std::vector<std::int64_t>& cells) {
  const bool made = e.cell >= 0;
  if (!made) e.cell = in.mesh.n_cells();
  cells.push_back(e.cell);
  if (!e.is_pyramid()) {
    const std::vector<std::int64_t> ends(e.nodes.begin(), e.dimension == 1 ? e.nodes.begin() + 2 : e.nodes.end());
    if (!made) in.mesh.add_cell(e.shape, ends, -1, e.id);
    return;
  }
  cells.push_back(e.cell + 1);
  if (made) return;
  const auto halves = halves_of_pyramid(e.nodes);
  in.mesh.add_cell(Shape::tet4, halves[0], -1, e.id);
  in.mesh.add_cell(Shape::tet4, halves[1], -1, e.id + second_half);
}

Imported GroupedMesh::finish(const std::string& path, const ImportOptions& options, const std::string& property) {
  std::int64_t flat = 0, solids = 0, pyramids = 0;
  for (const auto& e : elements_) flat += e.dimension == 2, solids += e.dimension == 3, pyramids += e.is_pyramid();
  if (options.thickness.empty()) refuse_flat(path, flat, solids);
  std::vector<CellGroup> regions;
  std::map<std::int64_t, CellGroup> by_property;
  for (auto& e : elements_)
    if (e.dimension == 3) add_cells(e, by_property[e.property].cells);
  for (const auto& g : groups_) {
    CellGroup c{g.name, {}};
    for (auto* e : members(g, 3)) add_cells(*e, c.cells);
    if (!c.cells.empty()) regions.push_back(std::move(c));
  }
  if (regions.empty() && options.rest.empty()) {
    for (auto& [number, c] : by_property) regions.push_back({fmt::format("{}_{}", property, number), std::move(c.cells)});
    if (!regions.empty()) in.notes.push_back(fmt::format("no groups of solids: each {} is a region", property));
  }
  if (options.thickness.empty())
    add_bars(regions, path);
  else
    add_shells(regions, path, options);
  if (in.mesh.n_cells() == 0) throw Error(path, "no solid elements and no bars");
  assign_regions(in, path, regions, false, {}, options);
  tell_loose_faces(path);
  add_sets(options);
  tell_pyramids(in, pyramids);
  return std::move(in);
}

/// Triangles and quadrangles of the groups that --thickness names, or all of them, as shells.
void GroupedMesh::add_shells(std::vector<CellGroup>& regions, const std::string& path, const ImportOptions& options) {
  ShellGroups shells(options, path, in.mesh.n_cells() > 0);
  std::int64_t middles = 0;
  const auto add = [&](const std::string& name, const std::vector<Element*>& faces, double thickness) {
    CellGroup g{name, {}};
    for (Element* e : faces) {
      if (e->cell >= 0) ShellGroups::refuse_twice(e->id, name);
      e->shape = e->nodes.size() == 3 ? tri3 : quad4;
      middles += e->has_middles;
      add_cells(*e, g.cells);
      in.thin[e->cell].thickness = thickness;
    }
    if (!g.cells.empty()) regions.push_back(std::move(g));
  };
  bool any = false;
  for (const auto& g : groups_)
    if (const auto faces = members(g, 2); !faces.empty()) {
      any = true;
      if (const auto thickness = shells.thickness_of(g.name)) add(g.name, faces, *thickness);
    }
  shells.require_all_names();
  if (!any) {
    std::vector<Element*> all;
    for (auto& e : elements_)
      if (e.dimension == 2) all.push_back(&e);
    add("shell", all, shells.thickness_of_all());
  }
  if (middles > 0) in.notes.push_back(fmt::format("{} shells lose the nodes in the middle of their edges", middles));
}

/// Groups of lines that lie on no solid; without solids all lines, in groups or not.
void GroupedMesh::add_bars(std::vector<CellGroup>& regions, const std::string& path) {
  std::vector<std::pair<std::int64_t, std::int64_t>> lines;
  for (const auto& e : elements_)
    if (e.dimension == 1) lines.emplace_back(e.nodes[0], e.nodes[1]);
  const auto on_solids = lines_on_solids(in.mesh, lines);
  const bool solids = in.mesh.n_cells() > 0;
  for (const auto& g : groups_) {
    const auto found = members(g, 1);
    if (found.empty() || std::any_of(found.begin(), found.end(), [&](const Element* e) {
          return on_solids.count({e->nodes[0], e->nodes[1]});
        }))
      continue;
    CellGroup c{g.name, {}};
    for (auto* e : found) add_cells(*e, c.cells);
    regions.push_back(std::move(c));
  }
  std::vector<std::int64_t> ignored;
  for (auto& e : elements_)
    if (e.dimension == 1 && e.cell < 0) {
      if (!solids)
        add_cells(e, ignored);
      else if (!on_solids.count({e.nodes[0], e.nodes[1]}))
        in.skip("lines of no group, on no solid", path);
    }
}

void GroupedMesh::tell_loose_faces(const std::string& path) {
  std::unordered_set<std::int64_t> grouped;
  for (const auto& g : groups_) grouped.insert(g.elements.begin(), g.elements.end());
  std::vector<std::vector<std::int64_t>> faces;
  for (const auto& e : elements_)
    if (e.dimension == 2 && !grouped.count(e.id)) faces.push_back(e.nodes);
  if (const auto n = std::ranges::count_if(facets_of(in.mesh, faces), [](const auto& of) { return of.empty(); }))
    in.skip("faces of no group, on no solid", path, n);
}

void GroupedMesh::add_sets(const ImportOptions& options) {
  SetNames names(in);
  const auto lost = [&](const Group& g, std::ptrdiff_t n, const char* what) {
    if (n > 0) in.notes.push_back(fmt::format("group \"{}\": {} of its numbers are no {}: left out", g.name, n, what));
  };
  for (const auto& g : groups_) {
    auto faces = g.faces;
    const bool is_shell = options.thickness.contains("") || options.thickness.contains(g.name);
    for (const auto* e : members(g, 2))
      if (!is_shell) faces.push_back(e->nodes);
    std::vector<Facet> facets;
    size_t loose = 0;
    for (const auto& of : facets_of(in.mesh, faces)) {
      facets.insert(facets.end(), of.begin(), of.end());
      loose += of.empty();
    }
    if (loose > 0)
      in.notes.push_back(fmt::format("group \"{}\": {} of its {} faces lie on no cell: left out", g.name, loose, faces.size()));
    if (!facets.empty()) names.facets(g.name, std::move(facets));
    std::vector<std::int64_t> rows;
    for (const auto* e : members(g, 1))
      if (e->cell < 0) rows.insert(rows.end(), e->nodes.begin(), e->nodes.end());
    for (const auto id : g.nodes)
      if (const auto found = row_.find(id); found != row_.end()) rows.push_back(found->second);
    if (!rows.empty()) names.nodes(g.name, std::move(rows));
    lost(g, std::ranges::count_if(g.nodes, [&](std::int64_t id) { return !row_.count(id); }), "node");
    if (g.nodes.empty() && g.elements.empty() && g.faces.empty())
      in.notes.push_back(fmt::format("group \"{}\" is empty: left out", g.name));
    lost(g, std::ranges::count_if(g.elements, [&](std::int64_t id) { return !of_id_.count(id); }), "element");
  }
}

}  // namespace hilo
