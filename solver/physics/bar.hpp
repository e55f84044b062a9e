// A bar's law: the law of its material under uniaxial stress, in the axial Green-Lagrange strain e = (l^2/L^2 - 1)/2.
//
//   St. Venant-Kirchhoff:  S = Y e, lateral stretch squared t = 1 - 2 nu e (kept above 0.01, where the law has no area left)
//   neo-Hookean:           a = 1 + 2 e,  mu (t - 1) + lambda (ln a/2 + ln t) = 0,  S = mu (a - t)/a     (dW/dt = 0, 2 dW/da)
#pragma once
#include "physics/solid_kernel.hpp"

namespace hilo {

struct BarState {
  double W;      // energy per reference volume          [J/m^3]
  double S;      // axial second Piola-Kirchhoff stress  [Pa]
  double slope;  // dS/de                                [Pa]
  double t;      // area over reference area             [1]
};
BarState bar_state(Law law, const Lame& c, double e);

/// Stress of a step whose work is exactly the change of W, S (e1 - e0) = W1 - W0, and its derivative by e1.
struct BarStep {
  double S, slope;
};
BarStep bar_step(Law law, const Lame& c, double e0, double e1);

/// Two-node bar of constant section area, consistent mass; one cell at a time.
KernelFunction bar_kernel(Law law);

}  // namespace hilo
