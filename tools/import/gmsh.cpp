// Meshes and geometries through the gmsh library: msh, mesh, stl; geo, step, brep, iges are meshed.
// Physical groups: volumes become regions, surfaces facet sets, curves and points node sets.  Without volume groups every volume is a
// region. A curve group whose lines are no edges of solid cells becomes a region of bars.
#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include "base/error.hpp"
#include "import/gmsh_session.hpp"

namespace hilo {
namespace {

/// A gmsh element type, ours and the order of its nodes: ours[i] = gmsh[p[i]].
struct Kind {
  int type;
  Shape shape;
  std::vector<int> p;
  const char* reduced = nullptr;  // what it was before nodes were left out
};
const Kind* kind_of(int type) {
  static const std::vector<int> hex20{0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
  static const std::vector<int> wedge15{0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11};
  static const std::vector<Kind> kinds = {
      {1, Shape::bar2, {0, 1}},
      {8, Shape::bar2, {0, 1}, "line3"},
      {4, Shape::tet4, {0, 1, 2, 3}},
      {5, Shape::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},
      {6, Shape::wedge6, {0, 1, 2, 3, 4, 5}},
      {11, Shape::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
      {17, Shape::hex20r, hex20},
      {12, Shape::hex20r, hex20, "hex27"},
      {18, Shape::wedge15, wedge15},
      {13, Shape::wedge15, wedge15, "wedge18"},
  };
  for (const auto& k : kinds)
    if (k.type == type) return &k;
  return nullptr;
}

/// Corners of a 2-D element type, 0 where it is none.
size_t face_corners(int type) { return type == 2 || type == 9 ? 3 : type == 3 || type == 16 || type == 10 ? 4 : 0; }

bool is_geometry(const std::string& ext) {
  return ext == ".geo" || ext == ".step" || ext == ".stp" || ext == ".brep" || ext == ".iges" || ext == ".igs" || ext == ".xao" ||
         ext == ".geo_unrolled";
}

class GmshReader {
 public:
  GmshReader(const std::string& path, const ImportOptions& o) : path_(path), o_(o) {}

  Imported read() {
    open();
    read_nodes();
    read_solids();
    refuse_flat_mesh();
    read_curves();
    if (in_.mesh.n_cells() == 0) throw Error(path_, "no volume cells and no bars");
    for (const auto& w : reduced_) in_.notes.push_back(fmt::format("{} read without the nodes inside faces and cells", w));
    assign_regions(in_, path_, regions_, false, {}, o_);
    surface_groups();
    node_groups();
    return std::move(in_);
  }

 private:
  std::string group_name(int dim, int tag) const {
    static const char* words[] = {"point", "curve", "surface", "volume"};
    std::string name;
    gmsh::model::getPhysicalName(dim, tag, name);
    return name.empty() ? fmt::format("{}_{}", words[dim], tag) : name;
  }

  void open() {
    std::string ext = std::filesystem::path(path_).extension().string();
    std::transform(ext.begin(), ext.end(), ext.begin(), [](unsigned char c) { return std::tolower(c); });
    gmsh::open(path_);
    if (const auto e = GmshSession::last_error(); !e.empty()) throw Error(path_, e);
    if (!is_geometry(ext)) return;
    gmsh::vectorpair volumes, surfaces, bars;
    gmsh::model::getEntities(volumes, 3);
    gmsh::model::getEntities(surfaces, 2);
    gmsh::model::getPhysicalGroups(bars, 1);
    if (volumes.empty() && (bars.empty() || !surfaces.empty()))
      throw Error(path_, "no volume to mesh", "the geometry holds points, curves or surfaces only");
    if (o_.size) {
      if (ext != ".geo") {  // a script may say its own sizes, which the option only bounds
        gmsh::vectorpair points;
        gmsh::model::getEntities(points, 0);
        gmsh::model::mesh::setSize(points, *o_.size);
      }
      gmsh::option::setNumber("Mesh.MeshSizeMax", *o_.size);
      double low;
      gmsh::option::getNumber("Mesh.MeshSizeMin", low);
      if (low > *o_.size) gmsh::option::setNumber("Mesh.MeshSizeMin", *o_.size);
    }
    gmsh::model::mesh::generate(volumes.empty() ? 1 : 3);
    if (const auto e = GmshSession::last_error(); !e.empty()) throw Error(path_, "gmsh cannot mesh it: " + e, "try another --size");
    if (o_.order == 2 && !volumes.empty()) gmsh::model::mesh::setOrder(2), in_.curved = true;
    for (const auto& [dim, tag] : volumes) {
      std::vector<int> types;
      std::vector<std::vector<std::size_t>> tags, nodes;
      gmsh::model::mesh::getElements(types, tags, nodes, 3, tag);
      if (types.empty()) throw Error(path_, fmt::format("gmsh made no cells in volume {}", tag), "try another --size");
    }
  }

  void read_nodes() {
    std::vector<std::size_t> tags;
    std::vector<double> x, u;
    gmsh::model::mesh::getNodes(tags, x, u);
    Mesh& m = in_.mesh;
    const auto most = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
    if (most > 50 * tags.size() + 1000000)
      throw Error(path_, fmt::format("node numbers up to {} for {} nodes", most, tags.size()), "renumber the mesh");
    row_.assign(most + 1, -1);
    for (size_t i = 0; i < tags.size(); ++i) {
      if (row_[tags[i]] >= 0) continue;  // a node on two entities is listed once each
      row_[tags[i]] = m.n_nodes();
      m.X.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
      m.node_id.push_back(static_cast<std::int64_t>(tags[i]));
    }
  }

  std::int64_t row(std::size_t tag, std::size_t element) const {
    if (tag >= row_.size() || row_[tag] < 0)
      throw Error(path_, fmt::format("element {} names node {}, which does not exist", element, tag));
    return row_[tag];
  }

  /// Cells of one entity; those of `kinds` of dimension `dim`.
  void add_cells(int dim, int entity, std::vector<std::int64_t>& cells) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dim, entity);
    std::vector<std::int64_t> n;
    for (size_t t = 0; t < types.size(); ++t) {
      std::string name;
      int d, order, count, primary;
      std::vector<double> local;
      gmsh::model::mesh::getElementProperties(types[t], name, d, order, count, local, primary);
      const Kind* k = kind_of(types[t]);
      if (!k)
        throw Error(
            path_,
            fmt::format("{} cells of type \"{}\" in {} {} are not read", tags[t].size(), name, dim == 3 ? "volume" : "curve", entity),
            "supported: tetrahedra, hexahedra and prisms of order 1 and 2, lines");
      if (k->reduced) reduced_.insert(k->reduced);
      for (size_t e = 0; e < tags[t].size(); ++e) {
        n.clear();
        for (const int i : k->p) n.push_back(row(nodes[t][e * static_cast<size_t>(count) + static_cast<size_t>(i)], tags[t][e]));
        cells.push_back(in_.mesh.n_cells());
        in_.mesh.add_cell(k->shape, n, -1, static_cast<std::int64_t>(tags[t][e]));
        if (!ids_.insert(tags[t][e]).second)
          throw Error(path_, fmt::format("element {} is given twice", tags[t][e]), "number each element once");
      }
    }
  }

  void read_solids() {
    gmsh::vectorpair entities, groups;
    gmsh::model::getEntities(entities, 3);
    for (const auto& [dim, tag] : entities) add_cells(3, tag, of_volume_[tag]);
    gmsh::model::getPhysicalGroups(groups, 3);
    for (const auto& [dim, tag] : groups) {
      std::vector<int> volumes;
      gmsh::model::getEntitiesForPhysicalGroup(3, tag, volumes);
      CellGroup g{group_name(3, tag), {}};
      for (const int v : volumes) g.cells.insert(g.cells.end(), of_volume_[v].begin(), of_volume_[v].end());
      if (g.cells.empty())
        in_.notes.push_back(fmt::format("group \"{}\" holds no cells: left out", g.name));
      else
        regions_.push_back(std::move(g));
    }
    // a geometry or mesh without groups: its volumes are its regions
    if (regions_.empty() && o_.rest.empty() && in_.mesh.n_cells() > 0) {
      for (const auto& [dim, tag] : entities) {
        std::string name;
        gmsh::model::getEntityName(3, tag, name);
        if (const auto slash = name.rfind('/'); slash != std::string::npos) name = name.substr(slash + 1);
        if (name.empty()) name = fmt::format("volume_{}", tag);
        for (const auto& r : regions_)
          if (r.name == name) {  // two volumes under one label
            name = fmt::format("{}_{}", name, tag);
            break;
          }
        if (!of_volume_[tag].empty()) regions_.push_back({name, of_volume_[tag]});
      }
      in_.notes.push_back(fmt::format("no volume groups: each of {} volumes is a region", regions_.size()));
    }
  }

  void refuse_flat_mesh() const {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, 2);
    std::int64_t flat = 0;
    for (const auto& t : tags) flat += static_cast<std::int64_t>(t.size());
    refuse_flat(path_, flat, in_.mesh.n_cells());
  }

  /// Curve groups: bars where none of the lines is an edge of a solid cell.
  void read_curves() {
    struct Curves {
      int tag;
      std::vector<int> entities;
      std::vector<std::pair<std::int64_t, std::int64_t>> lines;
    };
    std::vector<Curves> all;
    std::vector<std::pair<std::int64_t, std::int64_t>> lines;
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups, 1);
    for (const auto& [dim, tag] : groups) {
      Curves one{tag, {}, {}};
      gmsh::model::getEntitiesForPhysicalGroup(1, tag, one.entities);
      for (const int c : one.entities) {
        std::vector<int> types;
        std::vector<std::vector<std::size_t>> tags, nodes;
        gmsh::model::mesh::getElements(types, tags, nodes, 1, c);
        for (size_t t = 0; t < types.size(); ++t)
          for (size_t e = 0; e < tags[t].size(); ++e) {
            const size_t at = e * (nodes[t].size() / tags[t].size());
            one.lines.emplace_back(row(nodes[t][at], tags[t][e]), row(nodes[t][at + 1], tags[t][e]));
          }
      }
      lines.insert(lines.end(), one.lines.begin(), one.lines.end());
      all.push_back(std::move(one));
    }
    if (lines.empty()) return;
    const auto on_solids = lines_on_solids(in_.mesh, lines);
    std::unordered_set<int> used;
    for (const auto& one : all) {
      if (one.lines.empty() || std::any_of(one.lines.begin(), one.lines.end(), [&](const auto& l) { return on_solids.count(l); })) continue;
      CellGroup g{group_name(1, one.tag), {}};
      for (const int c : one.entities)
        if (used.insert(c).second) add_cells(1, c, g.cells);
      bar_groups_.insert(one.tag);
      if (!g.cells.empty()) regions_.push_back(std::move(g));
    }
  }

  /// Nodes of a group; empty when a node is of no entity that has a mesh.
  std::vector<std::int64_t> group_nodes(int dim, int tag) const {
    std::vector<std::size_t> tags;
    std::vector<double> x;
    gmsh::model::mesh::getNodesForPhysicalGroup(dim, tag, tags, x);
    std::vector<std::int64_t> nodes;
    for (const auto t : tags) nodes.push_back(row(t, 0));
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  void surface_groups() {
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups, 2);
    SetNames names(in_);
    std::vector<std::vector<std::int64_t>> faces;
    std::vector<size_t> first{0};
    for (const auto& [dim, tag] : groups) {
      std::vector<int> surfaces, types;
      gmsh::model::getEntitiesForPhysicalGroup(2, tag, surfaces);
      for (const int s : surfaces) {
        std::vector<std::vector<std::size_t>> tags, nodes;
        gmsh::model::mesh::getElements(types, tags, nodes, 2, s);
        for (size_t t = 0; t < types.size(); ++t) {
          const size_t corners = face_corners(types[t]), per = tags[t].empty() ? 0 : nodes[t].size() / tags[t].size();
          for (size_t e = 0; corners && e < tags[t].size(); ++e) {
            faces.emplace_back();
            for (size_t i = 0; i < corners; ++i) faces.back().push_back(row(nodes[t][e * per + i], tags[t][e]));
          }
        }
      }
      first.push_back(faces.size());
    }
    const auto found = match_facets(in_.mesh, faces);
    for (size_t g = 0; g < groups.size(); ++g) {
      const std::string name = group_name(2, groups[g].second);
      std::vector<Facet> facets;
      for (size_t i = first[g]; i < first[g + 1]; ++i)
        if (found[i].cell >= 0) facets.push_back(found[i]);
      const size_t missing = first[g + 1] - first[g] - facets.size();
      if (facets.empty()) {
        names.nodes(name, group_nodes(2, groups[g].second));
        in_.notes.push_back(fmt::format("surface group \"{}\" lies on no cell: a node set", name));
        continue;
      }
      if (missing)
        in_.notes.push_back(
            fmt::format("surface group \"{}\": {} of its {} faces lie on no cell: left out", name, missing, missing + facets.size()));
      names.facets(name, std::move(facets));
    }
  }

  void node_groups() {
    SetNames names(in_);
    for (const int dim : {1, 0}) {
      gmsh::vectorpair groups;
      gmsh::model::getPhysicalGroups(groups, dim);
      for (const auto& [d, tag] : groups)
        if (dim != 1 || !bar_groups_.count(tag)) names.nodes(group_name(dim, tag), group_nodes(dim, tag));
    }
  }

  std::string path_;
  const ImportOptions& o_;
  Imported in_;
  std::vector<std::int64_t> row_;  // node number of gmsh -> row of X, or -1
  std::unordered_set<std::size_t> ids_;
  std::unordered_map<int, std::vector<std::int64_t>> of_volume_;
  std::vector<CellGroup> regions_;
  std::unordered_set<int> bar_groups_;
  std::set<std::string> reduced_;
};

}  // namespace

Imported read_gmsh(const std::string& path, const ImportOptions& options) {
  const CrashGuard guard(path);
  const GmshSession session(options);
  try {
    return GmshReader(path, options).read();
  } catch (const std::string& e) {
    throw Error(path, "gmsh: " + e);
  } catch (const std::bad_alloc&) {
    throw Error(path, "not enough memory to read it, or its counts are damaged", "", Exit::resources);
  } catch (const std::length_error&) {
    throw Error(path, "its counts are damaged");
  } catch (int) {
    throw Error(path, "gmsh: " + GmshSession::last_error());
  }
}

}  // namespace hilo
