// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include "base/error.hpp"
#include "import/gmsh/curve_beams.hpp"
#include "import/gmsh/element_types.hpp"
#include "import/shell_groups.hpp"

namespace hilo {
namespace {

/// gmsh lists the elements of an entity by their family.
int family(int type) {
  const GmshType* t = gmsh_type(type);
  const std::string name = t ? t->name : "";
  return name.starts_with("Tetra") ? 0 : name.starts_with("Hexa") ? 1 : name.starts_with("Prism") ? 2 : 3;
}

class GmshReading {
 public:
  GmshReading(const std::string& path, const GmshMesh& mesh, const ImportOptions& o, bool curved)
      : path_(path), from_(mesh), o_(o), beams_(o) {
    in_.curved = curved;
    in_.notes = from_.notes;
    in_.metre = from_.metre;
    for (const auto& [key, entity] : from_.entities)
      for (const int g : entity.groups) groups_[std::get<0>(key)][g].push_back(key);
  }

  Imported read() {
    read_nodes();
    read_solids();
    if (!o_.thickness.empty()) read_shells();
    std::int64_t flat = 0;
    for (const auto& [key, entity] : from_.entities)
      for (const auto& b : entity.blocks)
        if (std::get<0>(key) == 2) flat += static_cast<std::int64_t>(b.tags.size());
    refuse_flat(path_, flat, in_.mesh.n_cells());
    if (o_.thickness.empty() || !o_.beams.empty()) read_curves();
    if (beams_.n_lines() == 0 && in_.mesh.n_cells() == 0) throw Error(path_, "no volume cells and no bars");
    tell_pyramids(in_, n_pyramids_);
    for (const auto& w : reduced_) in_.notes.push_back(fmt::format("{} read without the nodes inside faces and cells", w));
    assign_regions(in_, path_, regions_, false, {}, o_);
    for (const auto& [colour, volumes] : from_.coloured) {
      std::vector<std::int64_t> cells;
      for (const int tag : volumes)
        if (const auto of = of_volume_.find({3, tag, 0}); of != of_volume_.end())
          cells.insert(cells.end(), of->second.begin(), of->second.end());
      SetNames(in_).cells(colour, std::move(cells));
    }
    surface_groups(), tell_loose();
    node_groups();
    if (!o_.beams.empty()) {
      std::map<std::int64_t, std::vector<std::string>> points;
      for (const auto& [tag, keys] : groups_[0])
        for (const auto node : group_nodes(keys)) points[node].push_back(group_name(0, tag));
      in_.scene = beams_.scene(in_, points);
      in_.n_beams = static_cast<std::int64_t>(beams_.n_lines());
    }
    for (const auto& [key, name] : from_.group_name)
      if (!groups_[key.first].count(key.second)) in_.notes.push_back(fmt::format("group \"{}\" has no elements: left out", name));
    return std::move(in_);
  }

 private:
  using Key = GmshMesh::Key;

  static constexpr const char* words[] = {"point", "curve", "surface", "volume"};
  std::string group_name(int dim, int tag) const {
    const auto name = from_.group_name.find({dim, tag});
    return name == from_.group_name.end() || name->second.empty() ? fmt::format("{}_{}", words[dim], tag) : name->second;
  }

  void read_nodes() {
    Mesh& m = in_.mesh;
    std::int64_t most = 0;
    for (const auto tag : from_.node_tag) most = std::max(most, tag);
    if (most > static_cast<std::int64_t>(50 * from_.node_tag.size() + 1000000))
      throw Error(path_, fmt::format("node numbers up to {} for {} nodes", most, from_.node_tag.size()), "renumber the mesh");
    row_.assign(static_cast<size_t>(most) + 1, -1);
    for (size_t i = 0; i < from_.node_tag.size(); ++i) {
      const std::int64_t tag = from_.node_tag[i];
      if (row_[tag] >= 0) continue;  // a node on two entities is listed once each
      row_[tag] = m.n_nodes();
      m.X.push_back(from_.X[i]);
      m.node_id.push_back(tag);
    }
  }

  std::int64_t row(std::int64_t tag, std::int64_t element) const {
    if (tag < 0 || tag >= static_cast<std::int64_t>(row_.size()) || row_[tag] < 0)
      throw Error(path_, fmt::format("element {} names node {}, which does not exist", element, tag));
    return row_[tag];
  }

  /// Calls `use(number, nodes, type)` with each element of an entity.
  template <class Use>
  static void each(const GmshMesh::Entity& entity, const Use& use) {
    for (const auto& b : entity.blocks)
      for (size_t e = 0, per = b.nodes.size() / std::max<size_t>(1, b.tags.size()); e < b.tags.size(); ++e)
        use(b.tags[e], std::span(b.nodes).subspan(e * per, per), b.type);
  }

  static constexpr int pyramid5 = 7;
  void add_pyramids(const GmshMesh::Block& b, std::vector<std::int64_t>& cells) {
    if (next_id_ == 0)
      for (const auto& [key, entity] : from_.entities)
        for (const auto& block : entity.blocks)
          for (const auto id : block.tags) next_id_ = std::max(next_id_, id + 1);
    std::vector<std::int64_t> n(5);
    for (size_t e = 0; e < b.tags.size(); ++e) {
      for (size_t i = 0; i < 5; ++i) n[i] = row(b.nodes[5 * e + i], b.tags[e]);
      if (const auto same = again(pyramid5, n); same >= 0) {
        cells.push_back(same), cells.push_back(same + 1);
        continue;
      }
      ++n_pyramids_;
      std::int64_t id = b.tags[e];
      for (const auto& half : halves_of_pyramid(n)) {
        cells.push_back(in_.mesh.n_cells());
        in_.mesh.add_cell(Shape::tet4, half, -1, id);
        if (!ids_.insert(id).second) throw Error(path_, fmt::format("element {} is given twice", id), "number each element once");
        id = next_id_++;
      }
      --next_id_;
    }
  }

  /// The cell that an element is already, -1 for a new one.  msh 1 and 2 list an element of several groups once for each of them.
  std::int64_t again(int type, const std::vector<std::int64_t>& nodes) {
    if (!in_several_groups_) return -1;
    auto key = nodes;
    key.insert(key.end(), {type, tag_});
    const auto [at, fresh] = cell_of_.try_emplace(std::move(key), in_.mesh.n_cells());
    return fresh ? -1 : at->second;
  }

  void add_cells(const Key& key, std::vector<std::int64_t>& cells) {
    const int dim = std::get<0>(key), tag = std::get<1>(key);
    const auto first = from_.entities.lower_bound({dim, tag, std::numeric_limits<int>::min()}), second = std::next(first);
    in_several_groups_ = second != from_.entities.end() && std::get<0>(second->first) == dim && std::get<1>(second->first) == tag;
    tag_ = tag;
    std::vector<const GmshMesh::Block*> blocks;
    for (const auto& b : from_.entities.at(key).blocks) blocks.push_back(&b);
    std::stable_sort(blocks.begin(), blocks.end(), [](const auto* a, const auto* b) { return family(a->type) < family(b->type); });
    std::vector<std::int64_t> n;
    for (const auto* b : blocks) {
      if (b->type == pyramid5) {
        add_pyramids(*b, cells);
        continue;
      }
      const GmshType* k = gmsh_type(b->type);
      if (!k || !k->is_read())
        throw Error(path_,
                    fmt::format("{} cells of type \"{}\" in {} {} are not read", b->tags.size(), k ? k->name : fmt::format("{}", b->type),
                                words[dim], std::get<1>(key)),
                    "supported: tetrahedra, hexahedra and prisms of order 1 and 2, pyramids of 5 nodes, lines; with --thickness triangles "
                    "and quadrangles");
      if (k->reduced) reduced_.insert(k->reduced);
      const size_t per = b->nodes.size() / std::max<size_t>(1, b->tags.size());
      for (size_t e = 0; e < b->tags.size(); ++e) {
        n.clear();
        for (const int i : k->p) n.push_back(row(b->nodes[e * per + static_cast<size_t>(i)], b->tags[e]));
        if (const auto same = again(b->type, n); same >= 0) {
          cells.push_back(same);
          continue;
        }
        cells.push_back(in_.mesh.n_cells());
        in_.mesh.add_cell(k->shape, n, -1, b->tags[e]);
        if (!ids_.insert(b->tags[e]).second)
          throw Error(path_, fmt::format("element {} is given twice", b->tags[e]), "number each element once");
      }
    }
  }

  void read_solids() {
    size_t volumes = 0;
    for (const auto& [key, entity] : from_.entities)
      if (std::get<0>(key) == 3) add_cells(key, of_volume_[key]), ++volumes;
    for (const auto& [tag, keys] : groups_[3]) {
      CellGroup g{group_name(3, tag), {}};
      for (const auto& k : keys) g.cells.insert(g.cells.end(), of_volume_[k].begin(), of_volume_[k].end());
      if (g.cells.empty())
        in_.notes.push_back(fmt::format("group \"{}\" holds no cells: left out", g.name));
      else
        regions_.push_back(std::move(g));
    }
    if (!regions_.empty() || !o_.rest.empty() || in_.mesh.n_cells() == 0) return;
    // a geometry or mesh without groups: its volumes are its regions
    for (const auto& [key, cells] : of_volume_) {
      const int tag = std::get<1>(key);
      std::string name = from_.entities.at(key).name;
      if (const auto slash = name.rfind('/'); slash != std::string::npos) name = name.substr(slash + 1);
      if (name.empty()) name = fmt::format("volume_{}", tag);
      const auto same = std::find_if(regions_.begin(), regions_.end(), [&](const CellGroup& r) { return r.name == name; });
      if (same != regions_.end() && from_.of_solids) {
        same->cells.insert(same->cells.end(), cells.begin(), cells.end());
        continue;
      }
      if (same != regions_.end()) name = fmt::format("{}_{}", name, tag);  // two volumes under one label
      if (!cells.empty()) regions_.push_back({name, cells});
    }
    in_.notes.push_back(fmt::format("no volume groups: each of {} volumes is a region", regions_.size()));
  }

  /// Triangles and quadrangles of the surface groups that --thickness names, or of all surfaces, as shells.
  void read_shells() {
    ShellGroups shells(o_, path_, in_.mesh.n_cells() > 0);
    const auto add = [&](const std::string& name, const std::vector<Key>& keys, double thickness) {
      CellGroup g{name, {}};
      for (const Key& key : keys) {
        bool is_new = of_surface_.insert(key).second;
        const auto first = static_cast<std::ptrdiff_t>(g.cells.size());
        if (is_new) add_cells(key, g.cells);
        for (const auto c : std::span(g.cells).subspan(static_cast<size_t>(first))) {  // msh 2 has an entity for each group
          const auto [at, fresh] = in_.thin.try_emplace(c);
          is_new = is_new && fresh, at->second.thickness = thickness;
        }
        if (!is_new) ShellGroups::refuse_twice(std::get<1>(key), name);
      }
      if (!g.cells.empty()) regions_.push_back(std::move(g));
    };
    for (const auto& [tag, keys] : groups_[2])
      if (const auto thickness = shells.thickness_of(group_name(2, tag))) add(group_name(2, tag), keys, *thickness);
    shells.require_all_names();
    if (!groups_[2].empty()) return;
    std::vector<Key> all;
    for (const auto& [key, entity] : from_.entities)
      if (std::get<0>(key) == 2) all.push_back(key);
    add("shell", all, shells.thickness_of_all());
  }

  /// Curve groups: beams where --beams says so, bars where none of the lines is an edge of a solid cell.
  void read_curves() {
    using Lines = std::vector<std::pair<std::int64_t, std::int64_t>>;
    std::map<int, Lines> of_group;
    Lines lines;
    for (const auto& [tag, keys] : groups_[1]) {
      const std::string name = group_name(1, tag);
      const bool is_beam = beams_.wants(name);
      if (is_beam) bar_groups_.insert(tag);
      if (!is_beam && !o_.thickness.empty()) continue;
      Lines one;
      for (const auto& key : keys)
        each(from_.entities.at(key), [&](std::int64_t e, std::span<const std::int64_t> nodes, int) {
          const auto first = row(nodes[0], e), last = row(nodes[1], e);
          if (is_beam && nodes.size() > 2) {
            const auto middle = row(nodes[2], e);
            beams_.add(name, first, middle), beams_.add(name, middle, last);
          } else if (is_beam) {
            beams_.add(name, first, last);
          } else {
            one.emplace_back(first, last);
          }
        });
      lines.insert(lines.end(), one.begin(), one.end());
      if (!is_beam) of_group[tag] = std::move(one);
    }
    if (lines.empty()) return;
    const auto on_solids = lines_on_solids(in_.mesh, lines);
    std::set<Key> used;
    for (const auto& [tag, one] : of_group) {
      const auto on = std::ranges::count_if(one, [&](const auto& l) { return on_solids.count(l); });
      if (const auto off = static_cast<std::ptrdiff_t>(one.size()) - on; on > 0 && off > 0)
        in_.notes.push_back(
            fmt::format("curve group \"{}\": {} of its {} lines lie on no solid: no bars of them", group_name(1, tag), off, one.size()));
      if (one.empty() || on > 0) continue;
      CellGroup g{group_name(1, tag), {}};
      for (const auto& key : groups_[1][tag])
        if (used.insert(key).second) add_cells(key, g.cells);
      bar_groups_.insert(tag);
      if (!g.cells.empty()) regions_.push_back(std::move(g));
    }
  }

  /// The corners of each triangle or quadrangle of an entity.
  void add_faces(const GmshMesh::Entity& entity, std::vector<std::vector<std::int64_t>>& faces) const {
    each(entity, [&](std::int64_t e, std::span<const std::int64_t> nodes, int type) {
      const size_t corners = face_corners(type);
      if (corners) faces.emplace_back();
      for (const auto tag : nodes.first(corners)) faces.back().push_back(row(tag, e));
    });
  }

  std::vector<std::int64_t> group_nodes(const std::vector<Key>& keys) const {
    std::vector<std::int64_t> nodes;
    for (const auto& key : keys) {
      const auto& entity = from_.entities.at(key);
      for (const auto tag : entity.points) nodes.push_back(row(tag, 0));
      for (const auto& b : entity.blocks)
        for (const auto tag : b.nodes) nodes.push_back(row(tag, 0));
    }
    sort_unique(nodes);
    return nodes;
  }

  /// Of a shell the face of its normal, which becomes one of its two (thicken).
  void surface_groups() {
    SetNames names(in_);
    std::vector<std::vector<std::int64_t>> faces;
    std::vector<size_t> first{0};
    auto groups = groups_[2];
    std::erase_if(groups, [&](const auto& group) {  // these are regions
      return o_.thickness.contains("") || o_.thickness.contains(group_name(2, group.first));
    });
    for (const auto& [tag, keys] : groups) {
      for (const auto& key : keys) add_faces(from_.entities.at(key), faces);
      first.push_back(faces.size());
    }
    const auto found = facets_of(in_.mesh, faces);
    size_t g = 0;
    for (const auto& [tag, keys] : groups) {
      const std::string name = group_name(2, tag);
      std::vector<Facet> facets;
      size_t missing = 0;
      const size_t all = first[g + 1] - first[g];
      for (size_t i = first[g]; i < first[g + 1]; ++i)
        facets.insert(facets.end(), found[i].begin(), found[i].end()), missing += found[i].empty();
      ++g;
      if (facets.empty()) {
        names.nodes(name, group_nodes(keys));
        in_.notes.push_back(fmt::format("surface group \"{}\" lies on no cell: a node set", name));
        continue;
      }
      if (missing)
        in_.notes.push_back(fmt::format("surface group \"{}\": {} of its {} faces lie on no cell: left out", name, missing, all));
      names.facets(name, std::move(facets));
    }
  }

  /// Elements of no group that are no faces or edges of the cells: shells and bars that nothing names.
  void tell_loose() {
    std::vector<std::vector<std::int64_t>> faces;
    std::vector<std::pair<std::int64_t, std::int64_t>> lines;
    for (const auto& [key, entity] : from_.entities) {
      if (!entity.groups.empty() || of_surface_.contains(key)) continue;
      add_faces(entity, faces);
      if (std::get<0>(key) == 1 && of_surface_.empty())
        each(entity,
             [&](std::int64_t e, std::span<const std::int64_t> nodes, int) { lines.emplace_back(row(nodes[0], e), row(nodes[1], e)); });
    }
    const auto found = facets_of(in_.mesh, faces);
    if (const auto n = std::ranges::count_if(found, [](const auto& f) { return f.empty(); }))
      in_.skip("triangles and quadrangles of no group, on no solid", path_, n);
    const auto on_solids = lines_on_solids(in_.mesh, lines);
    if (const auto n = std::ranges::count_if(lines, [&](const auto& l) { return !on_solids.count(l); }))
      in_.skip("lines of no group, on no solid", path_, n);
  }

  void node_groups() {
    SetNames names(in_);
    for (const int dim : {1, 0})
      for (const auto& [tag, keys] : groups_[dim])
        if (dim != 1 || !bar_groups_.count(tag)) names.nodes(group_name(dim, tag), group_nodes(keys));
  }

  std::string path_;
  const GmshMesh& from_;
  const ImportOptions& o_;
  Imported in_;
  std::map<int, std::map<int, std::vector<Key>>> groups_;  // by dimension and tag
  std::vector<std::int64_t> row_;                          // node number of gmsh -> row of X, or -1
  std::unordered_set<std::int64_t> ids_;
  std::map<Key, std::vector<std::int64_t>> of_volume_;
  std::set<Key> of_surface_;  // that became shells
  std::vector<CellGroup> regions_;
  std::unordered_set<int> bar_groups_;  // and groups of beams
  CurveBeams beams_;
  std::set<std::string> reduced_;
  bool in_several_groups_ = false;                             // this entity: its elements may be listed several times
  int tag_ = 0;                                                // of this entity
  std::map<std::vector<std::int64_t>, std::int64_t> cell_of_;  // of entities in several groups: by nodes, type and tag
  std::int64_t n_pyramids_ = 0, next_id_ = 0;
};

}  // namespace

GmshMesh::Block& GmshMesh::Entity::of(int type) {
  if (blocks.empty() || blocks.back().type != type) {
    for (auto& b : blocks)
      if (b.type == type) return b;
    blocks.push_back({type, {}, {}});
  }
  return blocks.back();
}

std::vector<GmshMesh::Key> entity_of_nodes(const GmshMesh& mesh) {
  std::unordered_map<std::int64_t, GmshMesh::Key> on;
  for (const auto& [key, entity] : mesh.entities)
    for (const auto& b : entity.blocks)
      for (const auto tag : b.nodes) on.try_emplace(tag, key);
  std::vector<GmshMesh::Key> keys;
  for (const auto tag : mesh.node_tag) {
    const auto found = on.find(tag);
    keys.push_back(found == on.end() ? GmshMesh::Key{4, 0, 0} : found->second);
  }
  return keys;
}

void order_nodes(GmshMesh& mesh, const std::vector<GmshMesh::Key>& on, bool by_number) {
  std::vector<size_t> order(mesh.node_tag.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {},
                           [&](size_t i) { return std::tuple(std::get<0>(on[i]), std::get<1>(on[i]), by_number ? mesh.node_tag[i] : 0); });
  std::vector<std::int64_t> tags;
  std::vector<Vec3> X;
  for (const size_t i : order) tags.push_back(mesh.node_tag[i]), X.push_back(mesh.X[i]);
  mesh.node_tag = std::move(tags), mesh.X = std::move(X);
}

Imported imported_from(const std::string& path, const GmshMesh& mesh, const ImportOptions& options, bool curved) {
  return GmshReading(path, mesh, options, curved).read();
}

}  // namespace hilo
