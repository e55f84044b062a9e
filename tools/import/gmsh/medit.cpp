// SPDX-License-Identifier: GPL-3.0-or-later
// Medit's .mesh files in text (INRIA): Vertices, Edges, Triangles, ... each followed by a count and lines of nodes and a reference.  A
// reference is what gmsh calls an entity; there are no names.
#include <fmt/format.h>

#include <cctype>

#include "base/error.hpp"
#include "import/data_line.hpp"
#include "import/gmsh/element_types.hpp"
#include "import/gmsh/mesh.hpp"
#include "import/text_input.hpp"

namespace hilo {
namespace {

class MeditReader : TextInput {
 public:
  explicit MeditReader(const std::string& path) : TextInput(path, read_gz(path, ""), '#') {}

  GmshMesh read() {
    if (word() != "MeshVersionFormatted") fail("no mesh of Medit: it does not begin with MeshVersionFormatted");
    number<int>();
    for (auto key = word(); !key.empty() && key != "End"; key = word()) {
      if (key == "Dimension") {
        if (number<int>() != 3) fail("the mesh is not of dimension 3");
        continue;
      }
      const auto n = number<std::int64_t>();
      if (n < 0 || static_cast<size_t>(n) > text_.size() / 2) fail(fmt::format("a count of {}, more than the file can hold", n));
      if (key == "Vertices")
        vertices(n);
      else if (const Kind* k = kind_of(key))
        elements(*k, n);
      else {  // numbers only
        if (!says_nothing(key)) tell(std::string(key), n);
        while (at_ < text_.size() && !std::isalpha(static_cast<unsigned char>(peek()))) word();
      }
    }
    name_references();
    order_nodes(mesh_, entity_of_nodes(mesh_), true);
    return std::move(mesh_);
  }

 private:
  struct Kind {
    std::string_view key;
    int type;
    std::vector<int> p;  // gmsh[i] = theirs[p[i]]
  };
  static const Kind* kind_of(std::string_view key) {
    static const std::vector<Kind> kinds = {
        {"Edges", 1, {0, 1}},
        {"EdgesP2", 8, {0, 1, 2}},
        {"Triangles", 2, {0, 1, 2}},
        {"TrianglesP2", 9, {0, 1, 2, 3, 4, 5}},
        {"Quadrilaterals", 3, {0, 1, 2, 3}},
        {"Tetrahedra", 4, {0, 1, 2, 3}},
        {"TetrahedraP2", 11, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
        {"Hexahedra", 5, {0, 1, 2, 3, 4, 5, 6, 7}},
        {"Prisms", 6, {0, 1, 2, 3, 4, 5}},
        {"Pyramids", 7, {0, 1, 2, 3, 4}},
    };
    for (const auto& k : kinds)
      if (k.key == key) return &k;
    return nullptr;
  }

  /// What meshers mark of the geometry: a mesh without it is the same.
  static bool says_nothing(std::string_view key) {
    for (const auto* part :
         {"Corners", "Ridges", "Required", "Normal", "Tangent", "Parallel", "BoundingBox", "AngleOfCornerBound", "Geometry"})
      if (key.find(part) != key.npos) return true;
    return false;
  }
  void tell(const std::string& key, std::int64_t n) {
    for (const auto* cells : {"Tetra", "Hexa", "Prism", "Pyramid", "Wedge"})
      if (key.starts_with(cells) && n > 0)
        fail(fmt::format("{} {} are not read", n, key),
             "supported: Tetrahedra, TetrahedraP2, Hexahedra, Prisms, Pyramids, Triangles, Quadrilaterals and Edges");
    mesh_.notes.push_back(fmt::format("not read: {} {}", n, key));
  }
  /// References are all that a surface or a curve has for a name; 0 is none.
  void name_references() {
    for (auto& [key, entity] : mesh_.entities)
      if (const auto [dimension, reference, part] = key; (dimension == 1 || dimension == 2) && reference != 0) entity.groups = {reference};
  }

  char peek() {
    blanks();
    return at_ < text_.size() ? text_[at_] : 'x';
  }

  void vertices(std::int64_t n) {
    if (!mesh_.X.empty()) fail("Vertices a second time");
    for (std::int64_t i = 1; i <= n; ++i) {
      const double x = number<double>(), y = number<double>(), z = number<double>();
      number<int>();
      mesh_.X.emplace_back(x, y, z);
      mesh_.node_tag.push_back(i);
    }
  }

  void elements(const Kind& k, std::int64_t n) {
    const GmshType& t = *gmsh_type(k.type);
    std::vector<std::int64_t> nodes(k.p.size());
    for (std::int64_t e = 0; e < n; ++e) {
      for (auto& a : nodes) a = number<std::int64_t>();
      auto& b = mesh_.entities[{t.dimension, number<int>(), 0}].of(k.type);
      b.tags.push_back(++elements_);
      for (const int i : k.p) b.nodes.push_back(nodes[static_cast<size_t>(i)]);
    }
  }

  GmshMesh mesh_;
  std::int64_t elements_ = 0;
};

}  // namespace

Imported read_medit(const std::string& path, const ImportOptions& options) {
  return imported_from(path, MeditReader(path).read(), options);
}

}  // namespace hilo
