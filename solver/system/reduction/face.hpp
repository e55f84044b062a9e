// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of an interface of a linear region about their mean: principal axes, and how they can be stretched.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "base/math.hpp"

namespace hilo {

struct Face {
  Mat3 axes = Mat3::Identity();                // e_i, columns, by rising share
  Vec3 share = Vec3::Constant(1. / 3);         // of the axes in sum |r|^2; 0 across a plane
  double second = 0;                           // sum |r|^2 [m^2]
  std::vector<std::pair<int, int>> stretches;  // pairs of axes that the nodes have an extent along, a <= b
  bool is_point = false;                       // one node
  /// One node too; bent by a thousandth of their extent.
  bool is_line() const { return !(share[0] + share[1] > 1e-6); }
  Face() = default;
  Face(std::span<const Vec3> nodes, const Vec3& mean);
};

}  // namespace hilo
