// SPDX-License-Identifier: GPL-3.0-or-later
// What decks tie together, as the scene says it: shared by the readers of .bdf and .inp.
#pragma once
#include <optional>
#include <vector>

#include "base/math.hpp"

namespace hilo {

/// The joint that holds components (bits 0 to 5: displacements and turns along three axes), and which of the axes is its own, or -1.
struct HoldingJoint {
  const char* kind;
  int axis;
};
std::optional<HoldingJoint> joint_that_holds(unsigned components);

/// What a weighted mean of points makes of a force and a moment at a point of it: f = w (F/W + (T^-1 (M + (x - c) x F)) x r), with r from
/// the weighted mean c, W = sum w and T = sum w (r.r I - r r^T).  Nothing where the points cannot carry the moment.
std::optional<std::vector<Vec3>> shares_of_mean(const std::vector<Vec3>& X, const std::vector<double>& w, const Vec3& at, const Vec3& F,
                                                const Vec3& M);

/// Whether points lie on a line, or at one place.
bool on_a_line(const std::vector<Vec3>& points);

}  // namespace hilo
