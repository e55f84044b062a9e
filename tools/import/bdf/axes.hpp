// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinate systems of a Nastran file: rectangular, cylindrical (r, theta, z) and spherical (r, theta from z, phi), by points (CORD2x) or
// by grids (CORD1x), chained as far as the file likes.  Angles are in degrees.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/math.hpp"

namespace hilo {

struct BdfDeck;

struct BdfSystem {
  enum class Kind { rectangular, cylindrical, spherical } kind = Kind::rectangular;
  std::string place;
  std::int64_t reference = 0;           // of CORD2x: the system that its points are in
  std::array<Vec3, 3> points = {};      // of CORD2x: origin, on the third axis, in the plane of axes 1 and 3
  std::array<std::int64_t, 3> grids{};  // of CORD1x: the same as grids, 0 otherwise
  enum class State { raw, at_work, done } state = State::raw;
  Vec3 origin = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  // columns, in the basic system
};

/// A grid as given, until `resolve_axes`.  What it leaves blank GRDSET says.
struct BdfGrid {
  std::optional<std::int64_t> system;  // in which it is given
  std::optional<std::int64_t> output;  // in which its displacements and supports are
  std::string held;                    // permanent supports, "123"
  std::string place;
  BdfSystem::State state = BdfSystem::State::raw;
};

/// All systems and grids to the basic one; Error where a system is not there, depends on itself or spans no plane.
void resolve_axes(BdfDeck& deck);
/// The axes of a system at a point of the basic system, as columns: those of curved systems turn with the point.
Mat3 axes_at(const BdfDeck& deck, std::int64_t system, const Vec3& at, const std::string& place);

}  // namespace hilo
