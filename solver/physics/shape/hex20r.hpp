// SPDX-License-Identifier: GPL-3.0-or-later
// Serendipity hexahedron of 20 nodes, 8 points: does not lock in thin or curved walls.  The six modes that the points do not see are held
// by physics/hourglass20.
#pragma once
#include "physics/shape/hex20.hpp"

namespace hilo {

struct Hex20R : Hex20 {
  static constexpr Shape shape = Shape::hex20r;
  static constexpr int n_points = 8;
  static constexpr Quadrature<8> rule() { return hex_rule<2>(); }
};

}  // namespace hilo
