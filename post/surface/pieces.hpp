// SPDX-License-Identifier: GPL-3.0-or-later
// Cells in tetrahedra, in which a level of a linear function is a triangle or a quadrangle: the ground of sections and iso-surfaces.
#pragma once
#include <array>
#include <vector>

#include "base/math.hpp"
#include "base/shape.hpp"

namespace hilo {

/// A shape in tetrahedra that meet those of its neighbours: hexahedra and wedges about centres of their faces and their own; shapes with
/// mid-side nodes are halved along each axis first.
struct Pieces {
  std::vector<std::vector<double>> point;      // weights of the nodes of the cell     (n_points x n_nodes)
  std::vector<std::array<int, 4>> tet;         // points of each tetrahedron
  std::vector<std::array<bool, 4>> on_border;  // is the face opposite to that corner on a face of the cell?
};
const Pieces& pieces(Shape shape);

/// Where a function crosses zero in a tetrahedron: on edges (from below zero, to zero or above), in the order of a polygon; `border` tells
/// whether the side from each to the next lies on a face of the cell.
struct Crossing {
  int n = 0;  // 0, 3 or 4
  std::array<std::array<int, 2>, 4> edge{};
  std::array<bool, 4> border{};
};
Crossing crossing(const std::array<double, 4>& value, const std::array<bool, 4>& on_border);

}  // namespace hilo
