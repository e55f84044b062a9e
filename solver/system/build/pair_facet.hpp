// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

namespace hilo {

/// A facet of a surface that meets another one or is tied to it, on the rank that evaluates the pair.
struct PairFacet {
  int region = -1, n = 0;
  std::array<int, 8> node{};   // n local nodes
  double area = 0, depth = 0;  // and depth of the cell behind it [m^2, m]
};

}  // namespace hilo
