// SPDX-License-Identifier: GPL-3.0-or-later
// Open sections of thin walls: shear flow of a transverse force, so shear centre and shear flexibility (Vlasov's theory without warping).
#pragma once
#include <Eigen/Core>
#include <vector>

namespace hilo {

/// The middle of a wall from a to b.  A wall follows those whose b is its a, so that shear flows from free ends on; no wall is in a ring.
struct Wall {
  Eigen::Vector2d a, b;  // axes 1 and 2 [m]
  double t;              // [m]
};

struct OpenWalls {
  Eigen::Vector2d shear_centre;  // from where the centre of area is, of the lines in the middle of the walls [m]
  Eigen::Matrix2d stiffness;     // of shear, over G A: the inverse of the flexibility that the energy of the flow has
};
/// q' = -t x.M^-1 V along each wall, of second moments M about the centre; the moment of q is that of V in the shear centre.
OpenWalls open_walls(const std::vector<Wall>& walls);

/// That flow in the wall nearest to a point, of those in the direction `along`, as a vector; columns: of unit forces along 1 and 2 [1/m].
Eigen::Matrix2d flow_near(const std::vector<Wall>& walls, const Eigen::Vector2d& at, const Eigen::Vector2d& along);

}  // namespace hilo
