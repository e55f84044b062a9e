// SPDX-License-Identifier: GPL-3.0-or-later
// Cross-sections of beams by name ([section.NAME]): stiffness and inertia by length.  Another one is a row of the table.
//
// Axis 1 lies across (widths), axis 2 upward (heights), 3 along the beam; the origin is the centre of area.
#pragma once
#include <Eigen/Core>
#include <array>
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
  double H1 = 0, H2 = 0;            // int X1 r^2, int X2 r^2 [m^5]
  double I4 = 0;                    // int r^4 [m^6]; 0: not known
};

struct BeamSection {
  SectionStiffness C = SectionStiffness::Zero();  // by shear along 1 and 2, stretch, bending about 1 and 2, twist [N, N m, N m^2]
  double mass = 0;                                // [kg/m]
  double J11 = 0, J22 = 0, J12 = 0;               // int rho X1^2, X2^2, X1 X2 [kg m]
  double size = 0;                                // a length of the section, as its radius of gyration [m]
  double H1 = 0, H2 = 0, I4 = 0;                  // int E X1 r^2, int E X2 r^2 [N m^3], int E r^4 [N m^4], about the origin
  bool has_fibres = false;                        // made of an area
};

/// The face of a section: points with what stress they take, and cells between them for pictures.
struct SectionFace {
  struct Point {
    Eigen::Vector2d at;                 // from the centre of area [m]
    Eigen::Matrix<double, 2, 3> shear;  // stress along 1 and 2 by forces along 1, 2 [1/m^2] and by torsion about the shear centre [1/m^3]
  };
  SectionArea area;
  std::vector<Point> points = {};              // extreme fibres among them
  std::vector<std::array<int, 4>> cells = {};  // of points, about axis 3; -1 last in a triangle
  bool round = false;                          // alike in all directions
};

struct SectionKind {
  std::string_view name, meaning;
  std::vector<Param> keys;  // of the scene, besides the kind
  /// nu: Poisson's ratio, of which the shear factors depend; null, and not meshed: the section is given by its stiffness, without a
  /// material.
  SectionArea (*area)(const EntryValues& entry, double nu) = nullptr;
  /// Null: nothing is known of its shape, and it has no stress at points.
  SectionFace (*face)(const EntryValues& entry, double nu) = nullptr;
  bool meshed = false;  // its area and face are those of a mesh (physics/section_mesh) that `file` names
};
Registry<SectionKind>& section_kinds();

/// A section of an area of the entry's kind, or of its mesh, of Young's modulus E [Pa], Poisson's ratio nu and density [kg/m^3].
BeamSection section_of_area(const EntryValues& entry, SectionArea area, double E, double nu, double density);
/// A section given by its stiffness.
BeamSection section_of_stiffness(const EntryValues& entry);

/// Stress at a point of a face under the forces and moments of beams, V1, V2, N, M1, M2, T [N, N m].
struct SectionStress {
  double axial = 0, shear = 0;  // [Pa]
  double von_mises() const;
};
SectionStress stress_at(const SectionFace& face, const SectionFace::Point& point, const Vec6& forces);
/// Over all points: the highest and the lowest axial stress and the largest von Mises stress [Pa].
struct StressRange {
  double high = 0, low = 0, von_mises = 0;
};
StressRange stress_range(const SectionFace& face, const Vec6& forces);

/// Saint-Venant's constant of torsion of a rectangle, by its series [m^4].
double torsion_of_rectangle(double a, double b);

}  // namespace hilo
