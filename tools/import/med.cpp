// SPDX-License-Identifier: GPL-3.0-or-later
// MED (Salome, code_aster), by its library: groups of solids are regions, of faces facet sets, of edges bars or node sets, of nodes node
// sets.  Elements have no numbers of their own there that hold for all kinds: they are counted in the order of the file.
#define OMPI_SKIP_MPICXX 1
#include <fmt/format.h>
#include <med.h>

#include <array>
#include <exception>
#include <filesystem>
#include <map>
#include <vector>

#include "base/error.hpp"
#include "base/units.hpp"
#include "import/crash_guard.hpp"
#include "import/data_line.hpp"
#include "import/grouped.hpp"

namespace hilo {
namespace {

/// A geometric type: dimension, nodes, our shape, the nodes: ours[i] = theirs[p[i]]; faces keep their corners.  MED looks at a base from
/// within, so that its triangles and quadrangles turn the other way than ours.
struct MedKind {
  int type, dimension;
  std::int64_t n_nodes;
  Shape shape;
  std::vector<int> p;
};
const std::vector<MedKind>& med_kinds() {
  static const std::vector<int> line{0, 1}, line3{0, 1, 2}, line4{0, 1, 2, 3}, tri{0, 1, 2}, quad{0, 1, 2, 3};
  static const std::vector<int> hex20{0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17};
  static const std::vector<int> wedge15{0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13};
  static const std::vector<MedKind> kinds = {
      {MED_SEG2, 1, 2, Shape::bar2, line},
      {MED_SEG3, 1, 3, Shape::bar2, line3},
      {MED_SEG4, 1, 4, Shape::bar2, line4},
      {MED_TRIA3, 2, 3, Shape::bar2, tri},
      {MED_TRIA6, 2, 6, Shape::bar2, tri},
      {MED_TRIA7, 2, 7, Shape::bar2, tri},
      {MED_QUAD4, 2, 4, Shape::bar2, quad},
      {MED_QUAD8, 2, 8, Shape::bar2, quad},
      {MED_QUAD9, 2, 9, Shape::bar2, quad},
      {MED_TETRA4, 3, 4, Shape::tet4, {0, 2, 1, 3}},
      {MED_TETRA10, 3, 10, Shape::tet10, {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}},
      {MED_PYRA5, 3, 5, Shape::tet4, {0, 3, 2, 1, 4}},
      {MED_PENTA6, 3, 6, Shape::wedge6, {0, 2, 1, 3, 5, 4}},
      {MED_PENTA15, 3, 15, Shape::wedge15, wedge15},
      {MED_PENTA18, 3, 18, Shape::wedge15, wedge15},
      {MED_HEXA8, 3, 8, Shape::hex8, {0, 3, 2, 1, 4, 7, 6, 5}},
      {MED_HEXA20, 3, 20, Shape::hex20r, hex20},
      {MED_HEXA27, 3, 27, Shape::hex20r, hex20},
  };
  return kinds;
}

/// A text of fixed width that blanks or zeros fill up.
std::string trimmed(const char* text, size_t width) { return std::string(strip({text, strnlen(text, width)})); }

/// Closes what a damaged file left open, while nobody hears what the library says of it.
struct LeftOpen {
  ~LeftOpen() {
    if (std::uncaught_exceptions() > 0) H5close();
  }
};

class MedFile {
 public:
  explicit MedFile(const std::string& path) : path_(path), room_(static_cast<std::int64_t>(std::filesystem::file_size(path)) * 2000) {
    med_bool is_hdf = MED_FALSE, is_med = MED_FALSE;
    if (MEDfileCompatibility(path.c_str(), &is_hdf, &is_med) < 0 || !is_hdf)
      throw Error(path, "no MED file", "it is HDF5, from Salome or code_aster; or damaged");
    if (!is_med) throw Error(path, "a MED file of another version than 3 or 4, or an HDF5 file that is none", "Salome saves it anew");
    id_ = MEDfileOpen(path.c_str(), MED_ACC_RDONLY);
    if (id_ < 0) throw Error(path, "cannot be opened as MED: the file is damaged");
    med_int major = 0, minor = 0, release = 0;
    if (MEDfileNumVersionRd(id_, &major, &minor, &release) < 0 || major < 3) {
      MEDfileClose(id_);
      throw Error(path, fmt::format("a MED file of version {}.{}.{}", major, minor, release), "from version 3 on: Salome saves it anew");
    }
  }
  ~MedFile() { MEDfileClose(id_); }
  MedFile(const MedFile&) = delete;
  MedFile& operator=(const MedFile&) = delete;

  /// Chooses the first mesh; the names of the others.
  std::vector<std::string> open_mesh() {
    const auto n = MEDnMesh(id_);
    if (n < 1) throw Error(path_, "no mesh");
    std::vector<std::string> others;
    for (int k = static_cast<int>(n); k >= 1; --k) {
      const auto axes = MEDmeshnAxis(id_, k);
      if (axes < 1 || axes > 3) throw Error(path_, fmt::format("mesh {} has {} axes", k, axes));
      std::array<char, MED_NAME_SIZE + 1> name{};
      std::array<char, MED_COMMENT_SIZE + 1> description{};
      std::array<char, MED_SNAME_SIZE + 1> dt_unit{};
      std::array<char, 3 * MED_SNAME_SIZE + 1> axis{}, unit{};
      med_int dimension = 0, steps = 0;
      med_mesh_type type{};
      med_sorting_type sorting{};
      med_axis_type system{};
      require(MEDmeshInfo(id_, k, name.data(), &axes_, &dimension, &type, description.data(), dt_unit.data(), &sorting, &steps, &system,
                          axis.data(), unit.data()),
              "a mesh");
      mesh_ = name.data();
      if (k > 1) {
        others.push_back(mesh_);
        continue;
      }
      if (type != MED_UNSTRUCTURED_MESH) throw Error(path_, fmt::format("mesh \"{}\" is a grid, not a mesh of elements", mesh_));
      if (system != MED_CARTESIAN)
        throw Error(path_, fmt::format("mesh \"{}\" has cylindrical or spherical coordinates", mesh_), "save it in x, y, z");
      unit_ = trimmed(unit.data(), MED_SNAME_SIZE);
      med_float t = 0;
      if (steps > 0) require(MEDmeshComputationStepInfo(id_, mesh_.c_str(), 1, &numdt_, &numit_, &t), "a mesh");
      if (steps > 1) others.push_back(fmt::format("{} at {} later instants", mesh_, steps - 1));
    }
    return others;
  }
  [[nodiscard]] const std::string& mesh() const { return mesh_; }
  [[nodiscard]] const std::string& unit() const { return unit_; }

  std::int64_t count(med_entity_type entity, int type) const {
    med_bool changed = MED_FALSE, transformed = MED_FALSE;
    const auto n = MEDmeshnEntity(id_, mesh_.c_str(), numdt_, numit_, entity, type, entity == MED_NODE ? MED_COORDINATE : MED_CONNECTIVITY,
                                  entity == MED_NODE ? MED_NO_CMODE : MED_NODAL, &changed, &transformed);
    if (n > room_ / 8) throw Error(path_, fmt::format("says that it has {} nodes or elements of a kind: the file is damaged", n));
    return std::max<std::int64_t>(n, 0);
  }
  std::vector<Vec3> points() const {
    const auto n = static_cast<size_t>(count(MED_NODE, MED_NONE));
    std::vector<double> x(n * static_cast<size_t>(axes_));
    if (n > 0) require(MEDmeshNodeCoordinateRd(id_, mesh_.c_str(), numdt_, numit_, MED_FULL_INTERLACE, x.data()), "the coordinates");
    std::vector<Vec3> X(n, Vec3::Zero());
    for (size_t i = 0; i < n; ++i)
      for (int c = 0; c < axes_; ++c) X[i][c] = x[i * static_cast<size_t>(axes_) + static_cast<size_t>(c)];
    return X;
  }
  /// Nodes of all elements of a kind, from 1.
  std::vector<med_int> connectivity(const MedKind& kind, std::int64_t n) const {
    std::vector<med_int> nodes(static_cast<size_t>(n * kind.n_nodes));
    require(
        MEDmeshElementConnectivityRd(id_, mesh_.c_str(), numdt_, numit_, MED_CELL, kind.type, MED_NODAL, MED_FULL_INTERLACE, nodes.data()),
        "the elements");
    return nodes;
  }
  /// The family of each node or element; all 0 where the file has none.
  std::vector<med_int> families(med_entity_type entity, int type, std::int64_t n) const {
    std::vector<med_int> family(static_cast<size_t>(n), 0);
    med_bool changed = MED_FALSE, transformed = MED_FALSE;
    if (MEDmeshnEntity(id_, mesh_.c_str(), numdt_, numit_, entity, type, MED_FAMILY_NUMBER, MED_NODAL, &changed, &transformed) > 0)
      require(MEDmeshEntityFamilyNumberRd(id_, mesh_.c_str(), numdt_, numit_, entity, type, family.data()), "the families");
    return family;
  }
  /// The groups that each family is in.
  std::map<med_int, std::vector<std::string>> groups() const {
    std::map<med_int, std::vector<std::string>> found;
    const auto n = MEDnFamily(id_, mesh_.c_str());
    for (int k = 1; k <= n; ++k) {
      const auto n_groups = MEDnFamilyGroup(id_, mesh_.c_str(), k);
      if (n_groups < 0 || n_groups > room_ / MED_LNAME_SIZE) throw Error(path_, fmt::format("family {} is damaged", k));
      std::array<char, MED_NAME_SIZE + 1> name{};
      std::vector<char> names(static_cast<size_t>(n_groups) * MED_LNAME_SIZE + 1);
      med_int number = 0;
      require(MEDfamilyInfo(id_, mesh_.c_str(), k, name.data(), &number, names.data()), "a family");
      for (med_int g = 0; g < n_groups; ++g)
        found[number].push_back(trimmed(&names[static_cast<size_t>(g) * MED_LNAME_SIZE], MED_LNAME_SIZE));
    }
    return found;
  }
  [[nodiscard]] std::int64_t n_fields() const { return MEDnField(id_); }

 private:
  void require(med_err status, std::string_view what) const {
    if (status < 0) throw Error(path_, fmt::format("{} cannot be read: the file is damaged", what));
  }

  std::string path_, mesh_, unit_;
  std::int64_t room_;  // bytes that the file may hold, compressed as it may be
  med_idt id_ = -1;
  med_int axes_ = 3, numdt_ = MED_NO_DT, numit_ = MED_NO_IT;
};

}  // namespace

Imported read_med(const std::string& path, const ImportOptions& options) {
  const CrashGuard guard(path, "the MED library", true);
  const MemoryLimit limit(path);
  const LeftOpen left;
  MedFile file(path);
  GroupedMesh mesh;
  for (const auto& other : file.open_mesh()) mesh.in.skip(fmt::format("mesh \"{}\"", other), path);
  if (!file.unit().empty()) {
    const auto unit = named_unit(file.unit());
    if (unit && unit->unit == "m")
      mesh.in.metre = unit->si;
    else
      mesh.in.notes.push_back(
          fmt::format("the file says that its unit of length is \"{}\": not known, taken as {}", file.unit(), options.units));
  }
  const auto points = file.points();
  if (points.empty()) throw Error(path, fmt::format("mesh \"{}\" has no nodes", file.mesh()));
  const auto n_nodes = static_cast<std::int64_t>(points.size());
  for (std::int64_t i = 0; i < n_nodes; ++i) mesh.add_node(i + 1, points[static_cast<size_t>(i)]);
  const auto groups_of = file.groups();
  std::map<std::string, GroupedMesh::Group> groups;  // named below
  for (const auto& [family, names] : groups_of)
    for (const auto& name : names) groups[name].name = name;
  const auto names_of = [&](med_int family) -> const std::vector<std::string>& {
    static const std::vector<std::string> none;
    const auto found = groups_of.find(family);
    return found == groups_of.end() ? none : found->second;
  };
  const auto node_family = file.families(MED_NODE, MED_NONE, n_nodes);
  for (std::int64_t i = 0; i < n_nodes; ++i)
    for (const auto& name : names_of(node_family[static_cast<size_t>(i)])) groups[name].nodes.push_back(i + 1);
  std::int64_t id = 0;
  GroupedMesh::Group solids{file.mesh(), {}, {}};
  bool solids_in_groups = false;
  for (const auto& kind : med_kinds()) {
    const auto n = file.count(MED_CELL, kind.type);
    if (n == 0) continue;
    const auto nodes = file.connectivity(kind, n);
    const auto family = file.families(MED_CELL, kind.type, n);
    for (std::int64_t e = 0; e < n; ++e) {
      ++id;
      std::vector<std::int64_t> rows;
      for (const int i : kind.p) {
        const auto node = nodes[static_cast<size_t>(e * kind.n_nodes + i)];
        if (node < 1 || node > n_nodes) throw Error(path, fmt::format("element {} names node {}, and there are {}", id, node, n_nodes));
        rows.push_back(node - 1);
      }
      mesh.add_element(kind.dimension, kind.shape, id, 0, std::move(rows), kind.n_nodes > 4);
      for (const auto& name : names_of(family[static_cast<size_t>(e)]))
        groups[name].elements.push_back(id), solids_in_groups |= kind.dimension == 3;
      if (kind.dimension == 3) solids.elements.push_back(id);
    }
  }
  const auto refuse = [&](std::string_view what, int type) {
    if (const auto n = file.count(MED_CELL, type))
      throw Error(path, fmt::format("{} {} are not read", n, what), "supported: tetrahedra, pyramids of 5 nodes, wedges, hexahedra");
  };
  refuse("pyramids of 13 nodes", MED_PYRA13);
  refuse("prisms of six sides", MED_OCTA12);
  if (const auto n = file.count(MED_CELL, MED_POLYHEDRON); n > 1) throw Error(path, fmt::format("{} polyhedra are not read", n - 1));
  if (const auto n = file.count(MED_CELL, MED_POINT1)) mesh.in.skip("elements of one node", path, n);
  if (const auto n = file.count(MED_CELL, MED_POLYGON); n > 1) mesh.in.skip("polygons", path, n - 1);
  if (id == 0) throw Error(path, fmt::format("mesh \"{}\" has no elements", file.mesh()));
  if (!solids_in_groups && !solids.elements.empty()) mesh.add_group(std::move(solids));
  for (auto& [name, group] : groups) mesh.add_group(std::move(group));
  if (const auto n = file.n_fields(); n > 0) mesh.in.skip("fields", path, n, true);
  return mesh.finish(path, options, "mesh");
}

}  // namespace hilo
