// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh of numbered elements with named groups, as universal files, Exodus II and MED hold it, and what it becomes: groups of solids are
// regions, of faces facet sets (shells with --thickness), of lines bars or node sets as in a gmsh file; without groups of solids a region
// is a property.
#pragma once
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "import/imported.hpp"

namespace hilo {

class GroupedMesh {
 public:
  struct Element {
    int dimension;
    Shape shape;
    std::int64_t id, property;
    std::vector<std::int64_t> nodes;
    bool has_middles = false;  // of a face: nodes that are not taken
    std::int64_t cell = -1;
    [[nodiscard]] bool is_pyramid() const { return dimension == 3 && shape == Shape::tet4 && nodes.size() == 5; }
  };
  struct Group {
    std::string name;
    std::vector<std::int64_t> nodes, elements;          // numbers of the file
    std::vector<std::vector<std::int64_t>> faces = {};  // corners, as rows of nodes: faces that are no elements
  };

  /// A node of the file; false where its number was there before.
  bool add_node(std::int64_t id, const Vec3& x);
  /// The row of a node by its number, or -1.
  [[nodiscard]] std::int64_t row(std::int64_t id) const;
  /// An element of dimension 1, 2 or 3 (its shape is of no use in dimension 2), its nodes in our order: of faces the corners, of lines the
  /// ends and what is between them; a solid tet4 of five nodes is a pyramid, base first.  False where its number was there before.
  bool add_element(int dimension, Shape shape, std::int64_t id, std::int64_t property, std::vector<std::int64_t> rows,
                   bool has_middles = false);
  /// The element of this number, or null.
  [[nodiscard]] const Element* find(std::int64_t id) const;
  void add_group(Group group);
  [[nodiscard]] size_t n_elements() const { return elements_.size(); }

  /// Cells, regions and sets of what was added; `property` names a region where no group holds solids.  Throws Error where there is neither
  /// a solid nor a bar.
  Imported finish(const std::string& path, const ImportOptions& options, const std::string& property);

  Imported in;  // with what a reader has to say

 private:
  std::vector<Element*> members(const Group& group, int dimension);
  void add_cells(Element& element, std::vector<std::int64_t>& cells);
  void add_shells(std::vector<CellGroup>& regions, const std::string& path, const ImportOptions& options);
  void add_bars(std::vector<CellGroup>& regions, const std::string& path);
  void tell_loose_faces(const std::string& path);
  void add_sets(const ImportOptions& options);

  std::unordered_map<std::int64_t, std::int64_t> row_;
  std::unordered_map<std::int64_t, size_t> of_id_;
  std::vector<Element> elements_;
  std::vector<Group> groups_;
};

}  // namespace hilo
