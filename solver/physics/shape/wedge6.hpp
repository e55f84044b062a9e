// SPDX-License-Identifier: GPL-3.0-or-later
// Linear wedge, six points.
#pragma once
#include "physics/shape/shape.hpp"

namespace hilo {

/// Three points in the triangle, Q along the axis in [-1, 1].
template <int Q>
constexpr Quadrature<3 * Q> wedge_rule() {
  Quadrature<3 * Q> r;
  const double x[3] = {Q == 2 ? -gauss2 : -gauss3, Q == 2 ? gauss2 : 0, gauss3};
  const double tri[3][2] = {{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}};
  for (int k = 0, p = 0; k < Q; ++k)
    for (int j = 0; j < 3; ++j, ++p) {
      r.xi[p][0] = tri[j][0], r.xi[p][1] = tri[j][1], r.xi[p][2] = x[k];
      r.w[p] = (Q == 2 ? 1 : gauss3_w[k]) / 6;
    }
  return r;
}

struct Wedge6 {
  static constexpr Shape shape = Shape::wedge6;
  static constexpr int n = 6, n_points = 6;
  static constexpr void values(const double* xi, double* N) {
    const double L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};
    for (int a = 0; a < 6; ++a) N[a] = L[a % 3] * (1 + (a < 3 ? -1 : 1) * xi[2]) / 2;
  }
  static constexpr void gradients(const double* xi, double (*dN)[3]) {
    const double L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};
    constexpr double dL[3][2] = {{-1, -1}, {1, 0}, {0, 1}};
    for (int a = 0; a < 6; ++a) {
      const double s = a < 3 ? -1 : 1, z = (1 + s * xi[2]) / 2;
      dN[a][0] = dL[a % 3][0] * z, dN[a][1] = dL[a % 3][1] * z, dN[a][2] = L[a % 3] * s / 2;
    }
  }
  static constexpr Quadrature<6> rule() { return wedge_rule<2>(); }
  static constexpr int n_mass_points = 6;
  static constexpr Quadrature<6> mass_rule() { return wedge_rule<2>(); }
};

}  // namespace hilo
