// SPDX-License-Identifier: GPL-3.0-or-later
// Energy and momentum of a block's cells from the positions and velocities of its nodes, by the definition of each element
// (docs/references.md): quadrature of 1/2 rho v.v and of the strain energy; the one-point hexahedron has its bending strains besides,
// nearly incompressible cells a part of lambda on their mean dilatation.
#pragma once
#include <vector>

#include "machines/machine.hpp"

namespace hilo::test {

struct BlockEnergy {
  double kinetic = 0, elastic = 0, gravity = 0, mass = 0, least_det = 1e300;
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero(), first_moment = Vec3::Zero();
};
BlockEnergy block_energy(const MachineBlock& block, const Mesh& mesh, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
                         const Vec3& gravity);

}  // namespace hilo::test
