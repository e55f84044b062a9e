// SPDX-License-Identifier: GPL-3.0-or-later
// Scaled Jacobian of a cell: at each corner the determinant of the three edges that meet there over the product of their lengths, least
// over the corners, as 1 for the regular tetrahedron, the right prism on a regular triangle and the box.
#pragma once
#include "model/mesh.hpp"

namespace hilo {

/// <= 0 where the cell is inverted; 1 for bars.
double scaled_jacobian(const Mesh& mesh, std::int64_t cell);
/// Cells below it are slivers.
inline constexpr double sliver_limit = 0.05;

}  // namespace hilo
