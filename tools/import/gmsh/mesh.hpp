// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh as gmsh sees one: nodes, and elements by entity (volume, surface, curve, point); physical groups of entities.  Filled by the
// readers of .msh and .mesh, and from the library where it has meshed a geometry.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "import/imported.hpp"

namespace hilo {

struct GmshMesh {
  /// Elements of one type, one after the other.
  struct Block {
    int type;
    std::vector<std::int64_t> tags, nodes;
  };
  struct Entity {
    std::string name;
    std::vector<int> groups;           // tags of the physical groups it is in
    std::vector<std::int64_t> points;  // a point: its node
    std::vector<Block> blocks;
    Block& of(int type);
  };
  using Key = std::tuple<int, int, int>;  // dimension, tag; in msh 2 elements of one tag in different groups are entities apart

  std::vector<std::int64_t> node_tag;
  std::vector<Vec3> X;  // [unit of the file]
  std::map<Key, Entity> entities;
  std::map<std::pair<int, int>, std::string> group_name;  // by dimension and tag
  // of a CAD file, where each name of a volume is that of one solid, in one or several pieces
  bool of_solids = false;
  std::map<std::string, std::vector<int>> coloured;  // volumes by colour
  std::optional<double> metre;                       // the file's unit of length  [m]
  std::optional<std::array<double, 2>> solids;       // volume and area of the solids, as the CAD kernel has them  [unit of the file]
  std::vector<std::string> notes;
};

/// The entity of least dimension whose elements have the node, for each node.
std::vector<GmshMesh::Key> entity_of_nodes(const GmshMesh& mesh);

/// The nodes by the dimension and tag of the entity that each is `on`, those of one by their numbers or as they stand.
void order_nodes(GmshMesh& mesh, const std::vector<GmshMesh::Key>& on, bool by_number);

/// Volume groups become regions, surface groups facet sets, curves and points node sets.  Without volume groups every volume is a region.
/// A curve group whose lines are no edges of solid cells becomes a region of bars.
Imported imported_from(const std::string& path, const GmshMesh& mesh, const ImportOptions& options, bool curved = false);

}  // namespace hilo
