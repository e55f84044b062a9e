// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic (serendipity) wedge of 15 nodes, nine points.
#pragma once
#include "physics/shape/wedge6.hpp"

namespace hilo {

struct Wedge15 {
  static constexpr Shape shape = Shape::wedge15;
  static constexpr int n = 15, n_points = 9;

  static constexpr void values(const double* xi, double* N) {
    double unused[15][3];
    evaluate(xi, N, unused);
  }
  static constexpr void gradients(const double* xi, double (*dN)[3]) {
    double unused[15];
    evaluate(xi, unused, dN);
  }
  static constexpr Quadrature<9> rule() { return wedge_rule<3>(); }
  static constexpr int n_mass_points = 18;
  /// Six points in the triangle (degree 4), three along the axis.
  static constexpr Quadrature<18> mass_rule() {
    constexpr double orbit[2][2] = {{0.445948490915965, 0.223381589678011 / 2}, {0.091576213509771, 0.109951743655322 / 2}};
    constexpr double x[3] = {-gauss3, 0, gauss3};
    Quadrature<18> r;
    int p = 0;
    for (int k = 0; k < 3; ++k)
      for (const auto& [a, w] : orbit)
        for (int v = 0; v < 3; ++v, ++p) {
          r.xi[p][0] = v == 1 ? 1 - 2 * a : a, r.xi[p][1] = v == 2 ? 1 - 2 * a : a, r.xi[p][2] = x[k];
          r.w[p] = w * gauss3_w[k];
        }
    return r;
  }

 private:
  /// Corner L (1 + s z)(2L - 2 + s z)/2, mid-side of a triangle edge 2 L_i L_j (1 + s z), mid-side of the axis L (1 - z^2).
  static constexpr void evaluate(const double* xi, double* N, double (*dN)[3]) {
    const double L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]}, z = xi[2];
    constexpr double dL[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
    for (int a = 0; a < 6; ++a) {
      const double s = a < 3 ? -1 : 1, l = L[a % 3];
      N[a] = l * (1 + s * z) * (2 * l - 2 + s * z) / 2;
      for (int i = 0; i < 2; ++i) dN[a][i] = dL[a % 3][i] * (1 + s * z) * (4 * l - 2 + s * z) / 2;
      dN[a][2] = l * s * (2 * l - 1 + 2 * s * z) / 2;
    }
    for (int e = 0; e < 6; ++e) {
      const double s = e < 3 ? -1 : 1;
      const int i = e % 3, j = (e + 1) % 3;
      N[6 + e] = 2 * L[i] * L[j] * (1 + s * z);
      for (int k = 0; k < 2; ++k) dN[6 + e][k] = 2 * (dL[i][k] * L[j] + L[i] * dL[j][k]) * (1 + s * z);
      dN[6 + e][2] = 2 * L[i] * L[j] * s;
    }
    for (int a = 0; a < 3; ++a) {
      N[12 + a] = L[a] * (1 - z * z);
      for (int k = 0; k < 2; ++k) dN[12 + a][k] = dL[a][k] * (1 - z * z);
      dN[12 + a][2] = -2 * z * L[a];
    }
  }
};

}  // namespace hilo
