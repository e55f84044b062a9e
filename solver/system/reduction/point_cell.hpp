// SPDX-License-Identifier: GPL-3.0-or-later
// A cell of a linear region that is given by its matrices: of a beam, whose sections are four nodes each, which move as one (a section's
// origin, and a point along each axis of space).  Its stiffness is that of its strains: a product with them keeps the digits of the soft
// motions of slender beams, which one with their sum of products would not.
#pragma once
#include <Eigen/Dense>
#include <array>

namespace hilo {

struct PointCell {
  std::array<int, 8> nodes;
  Eigen::Matrix<double, 6, 24> strains;  // the stiffness is strains^T strains   [(N/m)^1/2]
  Eigen::Matrix<double, 8, 8> mass;      // alike in every direction [kg]
  double beta = 0, alpha = 0;            // damping by them [s, 1/s]
  /// In the middle: of displacements of the nodes, int of stress over the volume (11, 22, 33, 23, 31, 12) [N], and du_i/dX_j at 3 i + j
  /// [1].
  Eigen::Matrix<double, 6, 24> stress;
  Eigen::Matrix<double, 9, 24> gradient;
  double length = 0;  // [m]
};

}  // namespace hilo
