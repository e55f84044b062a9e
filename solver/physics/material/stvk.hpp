// SPDX-License-Identifier: GPL-3.0-or-later
// St. Venant-Kirchhoff solid.   W = lambda/2 (tr E)^2 + mu E:E,   S = lambda tr(E) I + 2 mu E
#pragma once
#include "physics/material/dilatation.hpp"
#include "physics/material/material.hpp"

namespace hilo {

struct StVenantKirchhoff {
  static constexpr std::string_view name = "stvk", meaning = "St. Venant-Kirchhoff: small or moderate strain, large rotation";
  static std::vector<Param> keys() { return {young, poisson}; }
  static StVenantKirchhoff make(const MaterialValues& v) { return {lame(v.number("E"), v.number("nu"))}; }
  using Bulk = SquareOfTrace;
  // A bar of stretch l carries S l = Y l (l^2 - 1)/2, which falls from l = 1/sqrt 3 on: it softens, and inverts without resistance.
  static constexpr double soft_below = 0.58;
  static constexpr std::string_view soft_because =
      "a St. Venant-Kirchhoff material softens and turns inside out without resistance (kind = \"neo-hookean\" stiffens)";
  Lame c;

  Lame linear() const { return c; }
  StVenantKirchhoff with_lambda(double lambda) const { return {{lambda, c.mu}}; }

  /// Energy per reference volume [J/m^3].
  template <class T>
  T energy(const T e[6]) const {
    T s[6];
    linear_stress(c, e, s);
    T w = 0 * e[0];
    for (int i = 0; i < 6; ++i) w += s[i] * e[i] / 2;
    return w;
  }
  /// Discrete gradient: S = C (e0 + e1)/2, so S.(e1 - e0) = W1 - W0 exactly [simo-tarnow-1992].
  /// D = dS/de1 is added to when given.
  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    T mean[6];
    for (int i = 0; i < 6; ++i) mean[i] = (e0[i] + e1[i]) / 2;
    linear_stress(c, mean, s);
    if (D) add_linear_tangent(c, 0.5, D);
  }

  /// S = Y e, lateral stretch squared t = 1 - 2 nu e, kept above 0.01, where the law has no area left.
  BarState bar(double e) const {
    const double Y = young_of(c), nu = c.lambda / (2 * (c.lambda + c.mu));
    return {Y * e * e / 2, Y * e, Y, std::max(1 - 2 * nu * e, 0.01)};
  }
  BarStep bar_step(double e0, double e1) const {
    const double Y = young_of(c);
    return {Y * (e0 + e1) / 2, Y / 2};
  }
};

}  // namespace hilo
