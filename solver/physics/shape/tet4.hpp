// SPDX-License-Identifier: GPL-3.0-or-later
// Linear tetrahedron, one point: constant strain, locks in bending and near incompressibility.
#pragma once
#include "physics/shape/shape.hpp"

namespace hilo {

/// Four points, exact to degree 2.
constexpr Quadrature<4> tet_rule4() {
  constexpr double a = 0.58541019662496845446, b = 0.13819660112501051518;  // (5 + 3 sqrt 5)/20, (5 - sqrt 5)/20
  return {{{b, b, b}, {a, b, b}, {b, a, b}, {b, b, a}}, {1.0 / 24, 1.0 / 24, 1.0 / 24, 1.0 / 24}};
}

struct Tet4 {
  static constexpr Shape shape = Shape::tet4;
  static constexpr int n = 4, n_points = 1;
  static constexpr void values(const double* xi, double* N) { N[0] = 1 - xi[0] - xi[1] - xi[2], N[1] = xi[0], N[2] = xi[1], N[3] = xi[2]; }
  static constexpr void gradients(const double*, double (*dN)[3]) {
    for (int i = 0; i < 3; ++i) {
      dN[0][i] = -1;
      for (int a = 1; a < 4; ++a) dN[a][i] = a == i + 1 ? 1 : 0;
    }
  }
  static constexpr Quadrature<1> rule() { return {{{0.25, 0.25, 0.25}}, {1.0 / 6}}; }
  static constexpr int n_mass_points = 4;
  static constexpr Quadrature<4> mass_rule() { return tet_rule4(); }
};

}  // namespace hilo
