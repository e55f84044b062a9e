// SPDX-License-Identifier: GPL-3.0-or-later
// Gradients of the shape functions of one solid cell.
#pragma once
#include <span>
#include <vector>

#include "physics/stress.hpp"

namespace hilo {

/// At the points of a cell that integrate the square of a strain: of hex8 its centroid, of other hexahedra 2 x 2 x 2.
struct CellGradients {
  std::vector<double> volume;  // (n_points) [m^3]
  std::vector<Vec3> dN;        // (n_points x n) [1/m]
};
void cell_gradients(Shape shape, const Material& material, std::span<const Vec3> X, CellGradients& out);

/// Stress xx yy zz yz xz xy by small strain (shear as angles) of a solid, as new   [Pa]
Eigen::Matrix<double, 6, 6> moduli_at_rest(const Material& material);

}  // namespace hilo
