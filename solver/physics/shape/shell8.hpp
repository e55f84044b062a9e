// SPDX-License-Identifier: GPL-3.0-or-later
// Solid-shell of eight nodes: the trilinear hexahedron with the strains of physics/shell.hpp.  Nodes 0 to 3 lie on one face of the shell,
// 4 to 7 across its thickness from them.
#pragma once
#include "base/shell_shape.hpp"
#include "physics/shape/hex8.hpp"

namespace hilo {

struct Shell8 : Hex8 {
  static constexpr Shape shape = shell8;
  static constexpr int n_points = 8;
  static constexpr Quadrature<8> rule() { return hex_rule<2>(); }
};

/// The same cell with four points across its thickness, for laws that flow: what has yielded is not linear across it.
struct Shell8Full : Shell8 {
  static constexpr int n_points = 16;
  static constexpr Quadrature<16> rule() {
    constexpr double z[4] = {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522};
    constexpr double w[4] = {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737};
    Quadrature<16> r;
    for (int p = 0; p < 16; ++p) {
      r.xi[p][0] = p % 2 == 0 ? -gauss2 : gauss2, r.xi[p][1] = p / 2 % 2 == 0 ? -gauss2 : gauss2, r.xi[p][2] = z[p / 4];
      r.w[p] = w[p / 4];
    }
    return r;
  }
};

}  // namespace hilo
