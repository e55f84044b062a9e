// SPDX-License-Identifier: GPL-3.0-or-later
// The list of cell shapes (model/mesh_shape.cpp), and another row of it.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/outside_shapes.hpp"
#include "base/shape.hpp"

namespace hilo {

/// Has this number a shape in this program?
bool is_shape(std::uint8_t shape);

/// A shape by its corners: the local nodes of its facets, outward; per corner three neighbours that make a right-handed system; the edges
/// that have a node in the middle, in the order of these nodes; what it costs (model/partition.hpp).
struct ShapeRow {
  std::string_view name;
  int corners, dimension, vtk, xdmf, work;
  std::vector<std::vector<int>> facets, neighbours, edges;
};
/// One more shape, from outside the tree, before the first mesh is read.
void add_shape_row(Shape shape, const ShapeRow& row);

}  // namespace hilo
