// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of bars of one law (physics/bar.hpp).
#pragma once
#include <cmath>

#include "physics/solid_kernel.hpp"

namespace hilo {

template <class M>
void run_bar(const KernelCall& k) {
  const M& law = *static_cast<const M*>(k.law);
  const double w = k.weight;
  double d0[3], d1[3], dm[3], L2 = 0, l0 = 0, l1 = 0;
  for (int i = 0; i < 3; ++i) {
    const double D = k.X[3 + i] - k.X[i];
    d0[i] = k.x0[3 + i] - k.x0[i], d1[i] = k.x1[3 + i] - k.x1[i], dm[i] = (1 - w) * d0[i] + w * d1[i];
    L2 += D * D, l0 += d0[i] * d0[i], l1 += d1[i] * d1[i];
  }
  const double L = std::sqrt(L2), e0 = (l0 / L2 - 1) / 2, e1 = (l1 / L2 - 1) / 2;
  BarStep step{0, 0};
  if (k.elastic != 0 && w == 0.5) {
    step = law.bar_step(e0, e1);
  } else if (k.elastic != 0) {
    const BarState s = law.bar((1 - w) * e0 + w * e1);
    step = {s.S, w * s.slope};
  }
  double from = e0;
  if (k.past[0]) {
    const auto strain = [&](const double* x) {
      double l = 0;
      for (int i = 0; i < 3; ++i) l += (x[3 + i] - x[i]) * (x[3 + i] - x[i]);
      return (l / L2 - 1) / 2;
    };
    const double one = strain(k.past[0]), two = strain(k.past[1]);
    from += k.recall[0] * (e0 - one) + k.recall[1] * (one - two);
  }
  const double rate = k.viscous * young_of(law.linear()), S = k.area * (k.elastic * step.S + rate * (e1 - from)),
               D = k.area * (k.elastic * step.slope + rate);
  double S_K = S;  // of the strain that the last correction foresaw (solid::foresee)
  if (k.before && k.K) {
    double e = -L2;
    for (int i = 0; i < 3; ++i) {
      const double d = k.before[3 + i] - k.before[i];
      e += d * (d + 2 * (k.along[3 + i] - k.along[i]));
    }
    e /= 2 * L2;
    S_K = k.area * rate * (e - from);
    if (k.elastic != 0) S_K += k.area * k.elastic * (w == 0.5 ? law.bar_step(e0, e).S : law.bar((1 - w) * e0 + w * e).S);
  }
  if (k.energy) *k.energy = k.area * L * law.bar(e1).W;
  if (k.dissipated) *k.dissipated = k.area * L * rate * (e1 - from) * (e1 - e0);
  if (k.least_det) *k.least_det = 1;
  const double m = k.density * k.area * L / 6;
  for (int a = 0; a < 2; ++a)
    for (int i = 0; i < 3; ++i) {
      if (k.f) k.f[3 * a + i] = (a ? 1 : -1) * S * dm[i] / L + (k.a ? m * (k.a[i] + k.a[3 + i] + k.a[3 * a + i]) : 0);
      for (int b = 0; b < 2 && k.K; ++b)
        for (int j = 0; j < 3; ++j)
          k.K[(3 * a + i) * 6 + 3 * b + j] = (a == b ? 1 : -1) * (D * dm[i] * d1[j] / (L * L2) + (i == j ? w * S_K / L : 0)) +
                                             (k.a && i == j ? k.mass_slope * m * (a == b ? 2 : 1) : 0);
    }
}

/// Null where a law has no bars.
template <class M>
constexpr KernelFunction bar_of() {
  if constexpr (requires(const M& law) { law.bar(0.0); }) return run_bar<M>;
  return nullptr;
}
}  // namespace hilo
