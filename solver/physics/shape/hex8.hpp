// SPDX-License-Identifier: GPL-3.0-or-later
// Trilinear hexahedron.  Integrated with its mean gradients; what one point does not see is held by physics/hourglass.
#pragma once
#include "physics/shape/shape.hpp"

namespace hilo {

inline constexpr double hex_corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                            {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

struct Hex8 {
  static constexpr Shape shape = Shape::hex8;
  static constexpr int n = 8, n_points = 1;
  static constexpr void values(const double* xi, double* N) {
    for (int a = 0; a < 8; ++a) N[a] = (1 + hex_corner[a][0] * xi[0]) * (1 + hex_corner[a][1] * xi[1]) * (1 + hex_corner[a][2] * xi[2]) / 8;
  }
  static constexpr void gradients(const double* xi, double (*dN)[3]) {
    for (int a = 0; a < 8; ++a) {
      const double* c = hex_corner[a];
      const double u = 1 + c[0] * xi[0], v = 1 + c[1] * xi[1], w = 1 + c[2] * xi[2];
      dN[a][0] = c[0] * v * w / 8, dN[a][1] = u * c[1] * w / 8, dN[a][2] = u * v * c[2] / 8;
    }
  }
  static constexpr Quadrature<1> rule() { return hex_rule<1>(); }
  static constexpr int n_mass_points = 8;
  static constexpr Quadrature<8> mass_rule() { return hex_rule<2>(); }
};

/// The same cell at eight points, for laws that flow: what yields in bending is no multiple of what does not, so no modes stand for it.
struct Hex8Full : Hex8 {
  static constexpr int n_points = 8;
  static constexpr Quadrature<8> rule() { return hex_rule<2>(); }
};

}  // namespace hilo
