// SPDX-License-Identifier: GPL-3.0-or-later
// Where a material point lies in a mesh, and the shape functions of its cell there.
#pragma once
#include <vector>

#include "model/mesh.hpp"

namespace hilo {

/// A point as a combination of the nodes of its cell: sum N_a X_a = X, to `most_outside` of the cell's size.
struct Located {
  std::int64_t cell = -1;           // -1: in none
  std::vector<std::int64_t> nodes;  // of the cell
  std::vector<double> N;            // shape functions at the point   (nodes)
  double outside = 0;               // how far beyond the cell's faces, in its own coordinates; below 0 within  [1]
};
/// A point this little beyond a face, in the coordinates of the cell, is in the cell: drawings are rounded.
inline constexpr double most_outside = 1e-4;

/// The solid cell or bar of the regions wanted that holds X in the reference configuration, the one in which X lies deepest where several
/// do.  Cells of three dimensions by Newton on X(xi) = sum N_a(xi) X_a; shells, which are only drawn, and shapes from outside hold none.
Located locate(const Mesh& mesh, const std::vector<bool>& wanted, const Vec3& X);

/// The region wanted that is nearest to a point, by the flat facets of its cells.
struct NearestRegion {
  int region = -1;      // -1: none has a facet
  double distance = 0;  // [m]
};
NearestRegion nearest_region(const Mesh& mesh, const std::vector<bool>& wanted, const Vec3& X);

}  // namespace hilo
