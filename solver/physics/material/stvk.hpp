// St. Venant-Kirchhoff solid.   W = lambda/2 (tr E)^2 + mu E:E,   S = lambda tr(E) I + 2 mu E
#pragma once
#include "physics/material/voigt.hpp"

namespace hilo {

struct StVenantKirchhoff {
  static constexpr const char* kind = "stvk";
  Lame c;

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
};

}  // namespace hilo
