// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic tetrahedron, four points.
#pragma once
#include "physics/shape/tet4.hpp"

namespace hilo {

struct Tet10 {
  static constexpr Shape shape = Shape::tet10;
  static constexpr int n = 10, n_points = 4;
  static constexpr int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

  /// N_corner = L (2L - 1), N_edge = 4 L_i L_j in volume coordinates L.
  static constexpr void values(const double* xi, double* N) {
    double L[4] = {};
    Tet4::values(xi, L);
    for (int a = 0; a < 4; ++a) N[a] = L[a] * (2 * L[a] - 1);
    for (int e = 0; e < 6; ++e) N[4 + e] = 4 * L[edge[e][0]] * L[edge[e][1]];
  }
  static constexpr void gradients(const double* xi, double (*dN)[3]) {
    double L[4] = {}, dL[4][3] = {};
    Tet4::values(xi, L);
    Tet4::gradients(xi, dL);
    for (int i = 0; i < 3; ++i) {
      for (int a = 0; a < 4; ++a) dN[a][i] = (4 * L[a] - 1) * dL[a][i];
      for (int e = 0; e < 6; ++e) dN[4 + e][i] = 4 * (L[edge[e][0]] * dL[edge[e][1]][i] + dL[edge[e][0]][i] * L[edge[e][1]]);
    }
  }
  static constexpr Quadrature<4> rule() { return tet_rule4(); }
  static constexpr int n_mass_points = 14;
  /// Fourteen points, exact to degree 5 (two orbits of four, one of six).
  static constexpr Quadrature<14> mass_rule() {
    constexpr double orbit[2][2] = {{0.09273525031089123, 0.01224884051939366}, {0.3108859192633005, 0.01878132095300264}};
    constexpr double c = 0.04550370412564964, wc = 0.007091003462846911;
    Quadrature<14> r;
    int p = 0;
    for (const auto& [a, w] : orbit)
      for (int v = 0; v < 4; ++v, ++p) {
        for (int i = 0; i < 3; ++i) r.xi[p][i] = v == i + 1 ? 1 - 3 * a : a;
        r.w[p] = w;
      }
    for (int e = 0; e < 6; ++e, ++p) {
      for (int i = 0; i < 3; ++i) r.xi[p][i] = edge[e][0] == i + 1 || edge[e][1] == i + 1 ? c : 0.5 - c;
      r.w[p] = wc;
    }
    return r;
  }
};

}  // namespace hilo
