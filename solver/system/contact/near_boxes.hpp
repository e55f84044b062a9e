// SPDX-License-Identifier: GPL-3.0-or-later
// Which of many boxes meet: a tree of boxes about boxes, halved along the longest axis of their middles.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "base/math.hpp"

namespace hilo {

/// With its edges along the axes.
struct AxisBox {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  void take(const Vec3& x) { low = low.cwiseMin(x), high = high.cwiseMax(x); }
  void take(const AxisBox& b) { low = low.cwiseMin(b.low), high = high.cwiseMax(b.high); }
  void widen(double by) { low.array() -= by, high.array() += by; }
  bool meets(const AxisBox& other) const { return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all(); }
};

/// Numbers of one of `a` and one of `b`, ascending.  n log n for boxes of which few meet each other.
std::vector<std::pair<int, int>> near_boxes(std::span<const AxisBox> a, std::span<const AxisBox> b);

}  // namespace hilo
