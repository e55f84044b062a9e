// SPDX-License-Identifier: GPL-3.0-or-later
// A bar's law: the law of its material under uniaxial stress, in the axial Green-Lagrange strain e = (l^2/L^2 - 1)/2.
#pragma once
#include <algorithm>
#include <cmath>

namespace hilo {

struct BarState {
  double W;      // energy per reference volume          [J/m^3]
  double S;      // axial second Piola-Kirchhoff stress  [Pa]
  double slope;  // dS/de                                [Pa]
  double t;      // area over reference area             [1]
};

/// Stress of a step whose work is exactly the change of W, S (e1 - e0) = W1 - W0, and its derivative by e1.
struct BarStep {
  double S, slope;
};

/// The step of any law: the difference quotient of W, or where the step is short the mean of S by Gauss's four points, whose remainder is
/// of the eighth power of the step.
template <class M>
BarStep quotient_step(const M& material, double e0, double e1) {
  const double step = e1 - e0;
  if (std::abs(step) > 0.02 * std::min(1 + 2 * e0, 1 + 2 * e1)) {
    const BarState s0 = material.bar(e0), s1 = material.bar(e1);
    const double S = (s1.W - s0.W) / step;
    return {S, (s1.S - S) / step};
  }
  constexpr double x[4] = {-0.86113631159405258, -0.33998104358485626, 0.33998104358485626, 0.86113631159405258};
  constexpr double weight[4] = {0.34785484513745386, 0.65214515486254614, 0.65214515486254614, 0.34785484513745386};
  BarStep out{0, 0};
  for (int p = 0; p < 4; ++p) {
    const double at = (1 + x[p]) / 2;
    const BarState s = material.bar(e0 + at * step);
    out.S += weight[p] / 2 * s.S, out.slope += weight[p] / 2 * at * s.slope;
  }
  return out;
}

}  // namespace hilo
