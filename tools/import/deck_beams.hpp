// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of decks as lines of a scene: [section.NAME] of a property and its material, [beam.NAME] of an element.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/math.hpp"
#include "import/deck_material.hpp"
#include "physics/beam_section.hpp"

namespace hilo {

/// A cross-section as a deck says it, in units of the deck; axes 1 and 2 as in [section.NAME].
struct DeckSection {
  std::string kind = "general";                          // of hilo
  std::vector<std::pair<std::string, double>> sizes;     // its keys
  double I12 = 0;                                        // of "general": int X1 X2
  double line_mass = 0;                                  // beside that of the material
  std::optional<std::array<double, 2>> shear = {};       // factors along 1 and 2; absent: those of the kind
  std::array<bool, 2> no_shear_strain = {false, false};  // along 1 and 2: as stiff as 1e4 E A
  std::array<double, 2> shear_centre = {0, 0};           // along 1 and 2 from the centre of area; of "general" and of rectangles
  bool given() const { return !sizes.empty(); }
  /// A, I1, I2, J and shear factors; Error at `place` where no section has these sizes.
  SectionArea area(double nu, const std::string& place) const;
};

/// Those of [section.NAME] by their sizes.
DeckSection circle_section(double diameter);
DeckSection tube_section(double diameter, double thickness);
DeckSection rectangle_section(double width, double height);
DeckSection box_section(double width, double height, double thickness);
DeckSection I_section(double width, double height, double flange, double web);
/// One that is given by its area, second moments about axes 1 and 2, and J.
DeckSection general_section(double A, double I1, double I2, double J);

/// A rectangle of a section, along axes 1 and 2.
struct DeckRectangle {
  double from_1, to_1, from_2, to_2;
};
/// What these cover together, about its centre of area, with torsion and shear by a mesh (physics/section_mesh).  Not given where a size
/// is not above zero; Error at `place` where the parts do not hang together.
DeckSection section_of_rectangles(const std::vector<DeckRectangle>& parts, const std::string& place);

/// Whether the section is written with a material of the scene; else as stiffnesses, for what the material or its kind cannot say.
bool has_scene_material(const DeckSection& section, const DeckMaterial& material);
/// [section.NAME] in SI, its lengths scaled as those of the geometry, with the keys that `beside`, the other end of a taper or
/// itself, needs; Error at `place` where the material says no moduli.
void write_section(SceneWriter& scene, const std::string& name, DeckSection section, const DeckSection& beside,
                   const DeckMaterial& material, const ImportOptions& options, const std::string& place);

}  // namespace hilo
