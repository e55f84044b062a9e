// SPDX-License-Identifier: GPL-3.0-or-later
// Serendipity hexahedron of 20 nodes, 27 points: no zero-energy modes even one element wide.
#pragma once
#include "physics/shape/hex8.hpp"

namespace hilo {

struct Hex20 {
  static constexpr Shape shape = Shape::hex20;
  static constexpr int n = 20, n_points = 27;
  /// Mid-side nodes 8..19 sit between these corners.
  static constexpr int edge[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

  static constexpr void values(const double* xi, double* N) {
    double unused[20][3];
    evaluate(xi, N, unused);
  }
  static constexpr void gradients(const double* xi, double (*dN)[3]) {
    double unused[20];
    evaluate(xi, unused, dN);
  }
  static constexpr Quadrature<27> rule() { return hex_rule<3>(); }
  static constexpr int n_mass_points = 27;
  static constexpr Quadrature<27> mass_rule() { return hex_rule<3>(); }

 private:
  /// Corner: prod(1 + c_i x_i) (sum c_i x_i - 2)/8.  Mid-side along axis i: (1 - x_i^2) prod_{j != i}(1 + c_j x_j)/4.
  static constexpr void evaluate(const double* xi, double* N, double (*dN)[3]) {
    for (int a = 0; a < 20; ++a) {
      double c[3] = {}, f[3] = {}, df[3] = {};
      for (int i = 0; i < 3; ++i) {
        c[i] = a < 8 ? hex_corner[a][i] : (hex_corner[edge[a - 8][0]][i] + hex_corner[edge[a - 8][1]][i]) / 2;
        f[i] = c[i] == 0 ? 1 - xi[i] * xi[i] : 1 + c[i] * xi[i];
        df[i] = c[i] == 0 ? -2 * xi[i] : c[i];
      }
      const double product = f[0] * f[1] * f[2], factor = a < 8 ? (c[0] * xi[0] + c[1] * xi[1] + c[2] * xi[2] - 2) / 8 : 0.25;
      N[a] = product * factor;
      for (int i = 0; i < 3; ++i) {
        const double others = f[(i + 1) % 3] * f[(i + 2) % 3];
        dN[a][i] = df[i] * others * factor + (a < 8 ? product * c[i] / 8 : 0);
      }
    }
  }
};

}  // namespace hilo
