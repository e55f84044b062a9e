// SPDX-License-Identifier: GPL-3.0-or-later
// A cell of a beam between two sections: its law, its mass and its shares of loads by length, on the points of its sections.
//
// The mass is constant in the points x = (c, d1, d2, d3) of both sections: along the axis
//   c = (1 - t + g) c_A + (t - g) c_B + L (t - t^2)/2 (d3A - d3B) + L g/2 (d3A + d3B),   g = (2 t^3 - 3 t^2 + t)/(1 + Phi),
// Phi = 12 EI/(GA L^2); of d1 and d2 the mean of a consistent and a lumped one.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "physics/beam_arc.hpp"
#include "physics/beam_cell.hpp"
#include "physics/beam_section.hpp"
#include "system/loads.hpp"

namespace hilo {

using BeamVector = arc::LaneVector<double>;

struct BeamCell {
  std::array<int, 2> body{};  // or sections, of a linear region
  arc::ArcCell<double> arc;
  /// int u (1 - t)^2 ds, int u t (1 - t) ds, int u t^2 ds, u the shares of the points of the sections in a point at t [m, m^2]: across the
  /// axis as the cell bends, and along it as it stretches
  using Shares = std::array<Eigen::Matrix<double, 8, 1>, 3>;
  Shares across, along;
  Vec3 axis;        // as drawn
  double size = 0;  // of the section [m]
};

struct Beam {
  std::string name;
  int first = 0, n_cells = 0;  // of the list
  bool rigid = false;          // what it bears is not known
};

/// A force per length on the cells of a beam, linear along each cell: in inertial axes, or in axes of the sections, which it then turns
/// with.
struct LineLoad {
  Load load;
  int first = 0;
  std::vector<std::array<Vec3, 2>> at;  // both ends of each cell [N/m]
};

/// Where a section is in the reference configuration: its origin, directors by columns, and the body that it rides on.
struct SectionPlace {
  Vec3 at;
  Mat3 frame;
  int body;
};

/// Sections at the places along_arc of a cell.
using SectionsAlong = std::array<BeamSection, along_arc.size()>;
BeamSection mean_section(const SectionsAlong& sections);

/// Bodies as they are at q.
BeamCell beam_cell(const SectionPlace& a, const SectionPlace& b, const Config& q, const SectionsAlong& sections, double beta, double alpha);

/// M times rates of the points.
std::array<BeamVector, 8> momenta_of(const BeamCell& cell, const arc::SectionPoints<double>& rates);
/// Of forces on the points, on a way.
double work(const std::array<BeamVector, 8>& F, const arc::SectionPoints<double>& from, const arc::SectionPoints<double>& to);

/// What loads by length exert on the points of a cell's sections: F + K y, of the points y.
struct LineForces {
  Eigen::Matrix<double, 8, 3, Eigen::RowMajor> F = Eigen::Matrix<double, 8, 3, Eigen::RowMajor>::Zero();
  Eigen::Matrix<double, 8, 8, Eigen::RowMajor> K = Eigen::Matrix<double, 8, 8, Eigen::RowMajor>::Zero();
  std::array<BeamVector, 8> at(const arc::SectionPoints<double>& y) const;
  void add(const LineLoad& load, size_t k, const BeamCell& cell, double factor);
};
/// On each cell; empty without such loads.
std::vector<LineForces> line_forces(const std::vector<LineLoad>& lines, const std::vector<BeamCell>& cells, const Stage& s);

}  // namespace hilo
