// SPDX-License-Identifier: GPL-3.0-or-later
// The graph that is cut: cells, joined where they share a facet or a joint holds them together, and the work of each.
#pragma once
#include <cstdint>
#include <vector>

#include "model/mesh.hpp"
#include "model/scene.hpp"

namespace hilo {

struct CellGraph {
  std::vector<std::int32_t> first;      // first neighbour of each cell             (n_cells + 1)
  std::vector<std::int32_t> next;       // neighbours
  std::vector<std::int32_t> joined;     // weight of each of these edges
  std::vector<std::int32_t> nonlinear;  // work of a nonlinear cell [0.01 linear hexahedra], 0 for others (n_cells)
  std::vector<std::int32_t> other;      // work of a rigid or linear cell, which no step evaluates, 0 for nonlinear ones (n_cells)
  std::vector<char> is_nonlinear;       // (n_cells)
  int joints = 0;                       // joints and springs of the scene that were weighed in
  std::int32_t n() const { return static_cast<std::int32_t>(nonlinear.size()); }
};

/// The dual graph of the mesh.  A scene adds the work of its joints and springs to the cell nearest to each of their ends, and joins the
/// two.
CellGraph cell_graph(const Mesh& mesh, const std::vector<Fidelity>& fidelity, const Scene* scene);

/// Connected pieces of the cells (of the nonlinear ones alone, where asked) that `part` gives the same number, per part.
std::vector<int> pieces_of_parts(const CellGraph& graph, const std::vector<std::int32_t>& part, int n_parts, bool nonlinear_only = false);

}  // namespace hilo
