// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of sections of beams: points, and the shear stress there by transverse forces and torsion.  Axial stress is linear over a face.
#pragma once
#include <vector>

#include "physics/beam_section.hpp"
#include "physics/thin_walls.hpp"

namespace hilo {

/// An open section: rectangles by their middles, widths and heights, and the middles of its walls.
struct OpenShape {
  struct Part {
    double x, y, b, h;
  };
  std::vector<Part> parts;
  std::vector<Wall> walls;
  Eigen::Vector2d centre() const;  // of the area of the rectangles
};

/// A circle, or a ring where ri > 0.  Shear after Saint-Venant, exact (Love, A treatise on the mathematical theory of elasticity, 232).
SectionFace round_face(const SectionArea& area, double ro, double ri, double nu);
/// A rectangle.  Torsion by Saint-Venant's series; the shear of a force is parabolic along it and alike across.
SectionFace full_face(const SectionArea& area, double width, double height);
/// A box of thin walls: Bredt's torsion, and the shear flow of forces.
SectionFace hollow_face(const SectionArea& area, double width, double height, double t);
/// Thin walls: shear flow of forces, and T t/J of opposite sign on both sides of a wall.
SectionFace open_face(const SectionArea& area, const OpenShape& shape);

}  // namespace hilo
