// SPDX-License-Identifier: GPL-3.0-or-later
// Shells and beams of decks: hilo has no element of them, but a rigid region needs none, only their mass.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "base/math.hpp"

namespace hilo {

struct Imported;

/// What a shell or beam cell is across its mid-surface or line, in the unit of the file.
struct ThinSection {
  double thickness = 0, offset = 0;        // of a shell: about its mid-surface, which lies off the nodes along the normal
  std::array<double, 4> own = {};          // of a shell: thickness at its corners where it states them, else zeros
  std::string no_solid;                    // why a solid-shell cannot stand for a shell
  double area = 0;                         // of a beam
  Mat3 second = Mat3::Zero();              // of a beam: int y y^T dA, axes of the mesh
  Vec3 start = Vec3::Zero(), end = start;  // of a beam: its ends off the nodes
  /// Of a shell, at its node number k: a corner, or behind them the middle of an edge.
  double thickness_at(size_t k, size_t corners) const {
    if (own[0] == 0) return thickness;
    return k < corners ? own[k] : (own[k - corners] + own[(k - corners + 1) % corners]) / 2;
  }
};

/// Second moments of a section: y lies in the plane of the beam and `v`, z = x cross y; I1 = int y^2 dA, I2 = int z^2 dA, I12 = int y z dA.
Mat3 second_of_section(const Vec3& along, const Vec3& v, double I1, double I2, double I12);

/// Volume, first and second moments of the thin cells of each region, to `in.thin_regions`; `factor` takes the file's lengths to metres.
/// Exact for flat shells of one thickness and straight beams; a shell's normal fibre counts with t^3/12.
void add_thin_moments(Imported& in, double factor);

}  // namespace hilo
