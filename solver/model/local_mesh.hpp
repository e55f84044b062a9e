// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a mesh that one rank holds: its cells, and their nodes whether owned or shared.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/comm.hpp"
#include "model/mesh.hpp"

namespace hilo {

struct LocalMesh {
  Mesh mesh;                       // local numbering; region and set names are those of the whole mesh on every rank
  std::vector<Fidelity> fidelity;  // per region
  bool tagged = false;
  std::vector<std::int64_t> node_global;  // row of each local node in the file      (n_nodes)
  std::vector<std::int64_t> cell_global;  // row of each local cell in the file      (n_cells)
  std::vector<char> node_owned;           // 1 on the one rank that owns the node    (n_nodes)
  std::map<std::string, std::vector<std::int64_t>>
      elsewhere;  // local nodes that a region, facet or cell set has through cells of other ranks
  std::int64_t n_nodes_global = 0, n_cells_global = 0;
  std::string file;  // mesh, tags or parts file it came from ("" without a mesh)
  std::vector<std::string> provenance;
  double length = 1;  // diagonal of the bounding box of the whole mesh [m]

  /// All local nodes of a name, also those that only a cell of another rank puts there: what Mesh::nodes_of gives on one rank.
  std::vector<std::int64_t> nodes_of(const std::string& name, const std::string& where) const;
  /// Renumber the nodes: those marked come first, both kinds in the order they had; how many are marked.
  std::int64_t put_first(const std::vector<char>& marked);
  /// Renumber the nodes: `from` has their present numbers in the new order.
  void reorder(const std::vector<std::int64_t>& from);
};

/// Read a mesh, tags or parts file.  On several ranks each reads its slice of the rows and cells travel to the rank that the parts file
/// (or a partition made on the spot) gives them, so no rank holds the whole mesh.  The node of a set of one node is local to every rank
/// (a joint may end there).  Errors are the same on all ranks.
LocalMesh read_local_mesh(const std::string& path, const Comm& comm);

/// Rank 0 gets the nodes that any rank has marked (n_nodes), with all names that they belong to: nodes beside its cells, whose owners stay.
/// Nodes keep the order of the file.  Collective.
void bring_to_first(LocalMesh& local, const std::vector<char>& marked, const Comm& comm);

}  // namespace hilo
