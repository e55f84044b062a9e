// SPDX-License-Identifier: GPL-3.0-or-later
// A section of a beam from a mesh of its face: Saint-Venant's torsion and flexure by finite elements, three Poisson problems of which two
// are those of transverse forces [pilkey-2002].
//
// Torsion by T about the shear centre:  tau = T/J (grad w + (-y, x)),  div grad w = 0.
// Axial stress that grows by  a x + b y  along the beam:  tau = (grad psi - nu D)/(2 (1 + nu)),  div grad psi = -2 (a x + b y),
//     D = (a (x^2 - y^2)/2 + b x y, a x y + b (y^2 - x^2)/2);  both without tau across the border.
// The shear centre is Trefftz's, where a force has no work with a twist: it does not depend on nu, and the energy of shear by forces there
// and of torsion is a sum.  Shear factors are those of this energy.
#pragma once
#include <array>
#include <vector>

#include "physics/beam_section.hpp"

namespace hilo {

/// Quadratic cells of a plane face: triangles of 6 nodes and quadrangles of 9, corners first, then the mid-nodes between them, then the
/// centre, counter-clockwise.
struct SectionMesh {
  static constexpr int none = -1;  // the last three of a triangle
  std::vector<Eigen::Vector2d> X;  // axes 1 and 2 [m]
  std::vector<std::array<int, 9>> cells;
  static bool is_triangle(const std::array<int, 9>& cell) { return cell[6] == none; }
};

/// The least and the largest determinant of the map of a cell, at its nodes and at points between, over the square of `size`.
std::array<double, 2> extreme_jacobian(const SectionMesh& mesh, const std::array<int, 9>& cell, double size);

/// Numbers and stress of a face about its centre of area; points: the nodes, in their order.  Its cells hang together.
SectionFace meshed_face(const SectionMesh& mesh, double nu);

}  // namespace hilo
