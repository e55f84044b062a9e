// SPDX-License-Identifier: GPL-3.0-or-later
// Cross-sections of beams by name ([section.NAME]): stiffness and inertia by length.  Another one is a row of the table.
//
// Axis 1 lies across (widths), axis 2 upward (heights), 3 along the beam; the origin is the centre of area.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "base/entry_values.hpp"
#include "base/param.hpp"
#include "base/registry.hpp"

namespace hilo {

using SectionStiffness = Eigen::Matrix<double, 6, 6>;

/// Of an area by itself.
struct SectionArea {
  double A = 0;                     // [m^2]
  double I1 = 0, I2 = 0;            // int X2^2, int X1^2: bending about axes 1 and 2 [m^4]
  double J = 0;                     // of torsion [m^4]
  double shear_1 = 1, shear_2 = 1;  // factors of shear along 1 and 2
  double shear_12 = 0;              // what couples them, over G A
  double I12 = 0;                   // int X1 X2 [m^4]
  double s1 = 0, s2 = 0;            // shear centre, from the centre of area [m]
};

struct BeamSection {
  SectionStiffness C;                // by shear along 1 and 2, stretch, bending about 1 and 2, twist [N, N m, N m^2]
  double mass = 0;                   // [kg/m]
  double J11 = 0, J22 = 0, J12 = 0;  // int rho X1^2, X2^2, X1 X2 [kg m]
  double size = 0;                   // a length of the section, as its radius of gyration [m]
};

struct SectionKind {
  std::string_view name, meaning;
  std::vector<Param> keys;  // of the scene, besides the kind
  /// nu: Poisson's ratio, of which the shear factors depend; null: the section is given by its stiffness, without a material.
  SectionArea (*area)(const EntryValues& entry, double nu) = nullptr;
};
Registry<SectionKind>& section_kinds();

/// A section of an area, of Young's modulus E [Pa], Poisson's ratio nu and density [kg/m^3].
BeamSection section_of_area(const EntryValues& entry, const SectionKind& kind, double E, double nu, double density);
/// A section given by its stiffness.
BeamSection section_of_stiffness(const EntryValues& entry);

/// Saint-Venant's constant of torsion of a rectangle, by its series [m^4].
double torsion_of_rectangle(double a, double b);

}  // namespace hilo
