// SPDX-License-Identifier: GPL-3.0-or-later
// Exodus II (Cubit, Sierra, MOOSE), by its library: blocks of solids are regions, blocks of faces and side sets are facet
// sets, node sets are node sets.
#include <exodusII.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <vector>

#include "base/error.hpp"
#include "import/crash_guard.hpp"
#include "import/grouped.hpp"

namespace hilo {
namespace {

/// A topology by how its name begins, and numbers of nodes: dimension, our shape, the nodes: ours[i] = theirs[p[i]]; faces keep their
/// corners.
struct ExodusKind {
  std::string_view begins;
  std::vector<std::int64_t> n_nodes;
  int dimension;
  Shape shape;
  std::vector<int> p;
};
const ExodusKind* exodus_kind(const std::string& topology, std::int64_t n_nodes) {
  static const std::vector<int> line{0, 1}, line3{0, 1, 2}, tri{0, 1, 2}, quad{0, 1, 2, 3};
  // edges upwards come before those of the upper face
  static const std::vector<int> hex20{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
  static const std::vector<int> wedge15{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11};
  static const std::vector<ExodusKind> kinds = {
      {"BAR", {2}, 1, Shape::bar2, line},
      {"BAR", {3}, 1, Shape::bar2, line3},
      {"BEAM", {2}, 1, Shape::bar2, line},
      {"BEAM", {3}, 1, Shape::bar2, line3},
      {"TRUSS", {2}, 1, Shape::bar2, line},
      {"TRUSS", {3}, 1, Shape::bar2, line3},
      {"ROD", {2}, 1, Shape::bar2, line},
      {"EDGE", {2}, 1, Shape::bar2, line},
      {"EDGE", {3}, 1, Shape::bar2, line3},
      {"TRI", {3, 4, 6, 7}, 2, Shape::bar2, tri},
      {"QUAD", {4, 5, 8, 9}, 2, Shape::bar2, quad},
      {"SHELL", {3, 6}, 2, Shape::bar2, tri},
      {"SHELL", {4, 8, 9}, 2, Shape::bar2, quad},
      {"TET", {4}, 3, Shape::tet4, {0, 1, 2, 3}},
      {"TET", {10}, 3, Shape::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
      {"PYRAMID", {5}, 3, Shape::tet4, {0, 1, 2, 3, 4}},
      {"WEDGE", {6}, 3, Shape::wedge6, {0, 1, 2, 3, 4, 5}},
      {"WEDGE", {15, 18}, 3, Shape::wedge15, wedge15},
      {"HEX", {8}, 3, Shape::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},
      {"HEX", {20, 27}, 3, Shape::hex20r, hex20},
  };
  for (const auto& k : kinds)
    if (topology.starts_with(k.begins) && std::ranges::count(k.n_nodes, n_nodes) > 0) return &k;
  return nullptr;
}

/// The corners of a side of a solid, from 0; empty where it has none of this number (from 1).
std::vector<int> corners_of_side(const GroupedMesh::Element& e, std::int64_t side) {
  using Sides = std::vector<std::vector<int>>;
  static const Sides hex{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}};
  static const Sides wedge{{0, 1, 4, 3}, {1, 2, 5, 4}, {0, 3, 5, 2}, {0, 2, 1}, {3, 4, 5}};
  static const Sides tet{{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}};
  static const Sides pyramid{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 4, 3}, {0, 3, 2, 1}};
  const int corners = info(e.shape).n_corners;
  const Sides& all = e.is_pyramid() ? pyramid : corners == 4 ? tet : corners == 6 ? wedge : hex;
  if (side < 1 || side > static_cast<std::int64_t>(all.size())) return {};
  return all[static_cast<size_t>(side - 1)];
}

class ExodusFile {
 public:
  explicit ExodusFile(const std::string& path) : path_(path), room_(static_cast<std::int64_t>(std::filesystem::file_size(path)) * 2000) {
    int numbers = sizeof(double), in_file = 0;
    float version = 0;
    ex_opts(0);  // silent
    id_ = ex_open(path.c_str(), EX_READ, &numbers, &in_file, &version);
    if (id_ < 0) throw Error(path, "no Exodus II file", "it is NetCDF, from Cubit, Sierra or MOOSE; or damaged");
    ex_set_int64_status(id_, EX_ALL_INT64_API);
    longest_name_ = std::clamp<std::int64_t>(ex_inquire_int(id_, EX_INQ_DB_MAX_USED_NAME_LENGTH), 32, 4096);
    ex_set_max_name_length(id_, static_cast<int>(longest_name_));
    require(ex_get_init_ext(id_, &all_), "its sizes");
  }
  ~ExodusFile() { ex_close(id_); }
  ExodusFile(const ExodusFile&) = delete;
  ExodusFile& operator=(const ExodusFile&) = delete;

  [[nodiscard]] const ex_init_params& all() const { return all_; }

  std::vector<Vec3> points() const {
    check(all_.num_nodes, 3 * 8, "nodes");
    const auto n = static_cast<size_t>(all_.num_nodes);
    constexpr double unread = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> x(n, unread), y(n, all_.num_dim > 1 ? unread : 0), z(n, all_.num_dim > 2 ? unread : 0);
    require(ex_get_coord(id_, x.data(), all_.num_dim > 1 ? y.data() : nullptr, all_.num_dim > 2 ? z.data() : nullptr), "the coordinates");
    std::vector<Vec3> X;
    for (size_t i = 0; i < n; ++i) X.emplace_back(x[i], y[i], z[i]);
    if (const auto bad = std::ranges::find_if(X, [](const Vec3& p) { return !p.allFinite(); }); bad != X.end())
      throw Error(path_, fmt::format("the node in place {} has no coordinates, or no finite ones", bad - X.begin() + 1));
    return X;
  }
  /// The numbers of nodes or elements.
  std::vector<std::int64_t> numbers(ex_entity_type map, std::int64_t n) const {
    check(n, 8, "numbers");
    std::vector<std::int64_t> found(static_cast<size_t>(n));
    if (n > 0) require(ex_get_id_map(id_, map, found.data()), "the numbers of nodes or elements");
    return found;
  }
  std::vector<std::int64_t> ids(ex_entity_type of, std::int64_t n) const {
    check(n, 8, "blocks or sets");
    std::vector<std::int64_t> found(static_cast<size_t>(n));
    if (n > 0) require(ex_get_ids(id_, of, found.data()), "the numbers of blocks or sets");
    return found;
  }
  std::string name(ex_entity_type of, std::int64_t id, std::string_view otherwise) const {
    std::vector<char> text(static_cast<size_t>(longest_name_) + 1, '\0');
    std::string found = ex_get_name(id_, of, id, text.data()) == 0 ? text.data() : "";
    while (!found.empty() && std::isspace(static_cast<unsigned char>(found.back()))) found.pop_back();
    return found.empty() ? fmt::format("{}_{}", otherwise, id) : found;
  }
  ex_block block(std::int64_t id) const {
    ex_block b{};
    b.id = id, b.type = EX_ELEM_BLOCK;
    require(ex_get_block_param(id_, &b), "a block");
    for (char* c = b.topology; *c; ++c) *c = static_cast<char>(std::toupper(static_cast<unsigned char>(*c)));
    return b;
  }
  /// Nodes of the elements of a block, from 1.
  std::vector<std::int64_t> connectivity(const ex_block& b) const {
    check(b.num_nodes_per_entry, 8, "nodes of an element");
    check(b.num_entry, 8 * std::max<std::int64_t>(b.num_nodes_per_entry, 1), "elements");
    std::vector<std::int64_t> found(static_cast<size_t>(b.num_entry * b.num_nodes_per_entry));
    if (!found.empty()) require(ex_get_conn(id_, EX_ELEM_BLOCK, b.id, found.data(), nullptr, nullptr), "the elements of a block");
    return found;
  }
  /// Nodes of a node set, from 1.
  std::vector<std::int64_t> nodes(std::int64_t id) const {
    std::vector<std::int64_t> found(static_cast<size_t>(entries(EX_NODE_SET, id)));
    if (!found.empty()) require(ex_get_set(id_, EX_NODE_SET, id, found.data(), nullptr), "a node set");
    return found;
  }
  /// Of a side set the places of the elements and their sides, both from 1.  (The library's own lists of their nodes, in version 6.02, are
  /// wrong for wedges of 15 nodes.)
  std::vector<std::pair<std::int64_t, std::int64_t>> sides(std::int64_t id) const {
    std::vector<std::int64_t> elements(static_cast<size_t>(entries(EX_SIDE_SET, id))), sides(elements.size());
    if (!elements.empty()) require(ex_get_set(id_, EX_SIDE_SET, id, elements.data(), sides.data()), "a side set");
    std::vector<std::pair<std::int64_t, std::int64_t>> found;
    for (size_t i = 0; i < elements.size(); ++i) found.emplace_back(elements[i], sides[i]);
    return found;
  }
  [[nodiscard]] std::int64_t n_times() const { return ex_inquire_int(id_, EX_INQ_TIME); }

 private:
  std::int64_t entries(ex_entity_type of, std::int64_t id) const {
    std::int64_t n = 0, factors = 0;
    require(ex_get_set_param(id_, of, id, &n, &factors), "a set");
    check(n, 8, "members of a set");
    return n;
  }
  void require(int status, std::string_view what) const {
    if (status < 0) throw Error(path_, fmt::format("{} cannot be read: the file is damaged", what));
  }
  /// A count that the file states is one that it has room for.
  void check(std::int64_t n, std::int64_t bytes, std::string_view of) const {
    if (n < 0 || n > room_ / bytes) throw Error(path_, fmt::format("says that it has {} {}: the file is damaged", n, of));
  }

  std::string path_;
  std::int64_t room_, longest_name_ = 32;  // bytes that the file may hold, compressed as it may be
  int id_ = -1;
  ex_init_params all_{};
};

void add_block(GroupedMesh& mesh, const ExodusFile& file, const ex_block& b, std::int64_t first, const std::vector<std::int64_t>& node_ids,
               const std::vector<std::int64_t>& element_ids, const std::string& path) {
  const std::string name = file.name(EX_ELEM_BLOCK, b.id, "block");
  if (b.num_entry == 0) return;
  const ExodusKind* kind = exodus_kind(b.topology, b.num_nodes_per_entry);
  if (!kind && std::string_view(b.topology).starts_with("SPHERE")) return mesh.in.skip("block of points", path);
  if (!kind)
    throw Error(path, fmt::format("block \"{}\": elements \"{}\" of {} nodes are not read", name, b.topology, b.num_nodes_per_entry),
                "supported: bars, triangles, quadrangles, shells, tetrahedra, pyramids of 5 nodes, wedges, hexahedra");
  GroupedMesh::Group group{name, {}, {}};
  const auto nodes = file.connectivity(b);
  for (std::int64_t e = 0; e < b.num_entry; ++e) {
    const auto id = element_ids[static_cast<size_t>(first + e)];
    std::vector<std::int64_t> rows;
    for (const int i : kind->p) {
      const auto node = nodes[static_cast<size_t>(e * b.num_nodes_per_entry + i)];
      if (node < 1 || node > static_cast<std::int64_t>(node_ids.size()))
        throw Error(
            path, fmt::format("element {} of block \"{}\" names the node in place {}, and there are {}", id, name, node, node_ids.size()));
      rows.push_back(node - 1);
    }
    if (!mesh.add_element(kind->dimension, kind->shape, id, b.id, std::move(rows), b.num_nodes_per_entry > 4))
      throw Error(path, fmt::format("element {} is given twice", id), "number each element once");
    group.elements.push_back(id);
  }
  mesh.add_group(std::move(group));
}

}  // namespace

Imported read_exodus(const std::string& path, const ImportOptions& options) {
  const CrashGuard guard(path, "the Exodus library", true);
  const MemoryLimit limit(path);
  const ExodusFile file(path);
  const auto& all = file.all();
  GroupedMesh mesh;
  const auto points = file.points();
  const auto node_ids = file.numbers(EX_NODE_MAP, all.num_nodes), element_ids = file.numbers(EX_ELEM_MAP, all.num_elem);
  if (points.empty()) throw Error(path, "no nodes");
  for (size_t i = 0; i < points.size(); ++i)
    if (!mesh.add_node(node_ids[i], points[i]))
      throw Error(path, fmt::format("node {} is given twice", node_ids[i]), "number each node once");
  std::int64_t first = 0;
  for (const auto id : file.ids(EX_ELEM_BLOCK, all.num_elem_blk)) {
    const ex_block b = file.block(id);
    if (b.num_entry < 0 || b.num_entry > all.num_elem - first)
      throw Error(path, fmt::format("block {} has more elements than the file: it is damaged", id));
    add_block(mesh, file, b, first, node_ids, element_ids, path);
    first += b.num_entry;
  }
  const auto row = [&](std::int64_t place) {
    if (place < 1 || place > all.num_nodes)
      throw Error(path, fmt::format("a set names the node in place {}, and there are {}", place, all.num_nodes));
    return place - 1;
  };
  std::int64_t of_surfaces = 0;
  for (const auto id : file.ids(EX_SIDE_SET, all.num_side_sets)) {
    GroupedMesh::Group group{file.name(EX_SIDE_SET, id, "side_set"), {}, {}};
    for (const auto& [place, side] : file.sides(id)) {
      const auto* e = place < 1 || place > all.num_elem ? nullptr : mesh.find(element_ids[static_cast<size_t>(place - 1)]);
      if (e && e->dimension < 3) {
        ++of_surfaces;
        continue;
      }
      const auto corners = e ? corners_of_side(*e, side) : std::vector<int>{};
      if (corners.empty())
        throw Error(path, fmt::format("side set \"{}\" names side {} of the element in place {}, which is none", group.name, side, place));
      group.faces.emplace_back();
      for (const int k : corners) group.faces.back().push_back(e->nodes[static_cast<size_t>(k)]);
    }
    if (!group.faces.empty()) mesh.add_group(std::move(group));
  }
  for (const auto id : file.ids(EX_NODE_SET, all.num_node_sets)) {
    GroupedMesh::Group group{file.name(EX_NODE_SET, id, "node_set"), {}, {}};
    for (const auto place : file.nodes(id)) group.nodes.push_back(node_ids[static_cast<size_t>(row(place))]);
    mesh.add_group(std::move(group));
  }
  const auto left_out = [&](std::string_view what, std::int64_t n) {
    if (n > 0) mesh.in.skip(std::string(what), path, n);
  };
  left_out("sides of bars and surfaces in side sets", of_surfaces);
  left_out("element sets", all.num_elem_sets);
  left_out("edge or face blocks and sets", all.num_edge_blk + all.num_face_blk + all.num_edge_sets + all.num_face_sets);
  if (file.n_times() > 0) mesh.in.skip("results in time", path, file.n_times(), true);
  return mesh.finish(path, options, "block");
}

}  // namespace hilo
