#include "physics/bar.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {

namespace {

double young(const Lame& c) { return c.mu * (3 * c.lambda + 2 * c.mu) / (c.lambda + c.mu); }

template <Law law>
void run_bar(const KernelCall& k) {
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
    step = bar_step(law, k.c, e0, e1);
  } else if (k.elastic != 0) {
    const BarState s = bar_state(law, k.c, (1 - w) * e0 + w * e1);
    step = {s.S, w * s.slope};
  }
  const double rate = k.viscous * young(k.c), S = k.area * (k.elastic * step.S + rate * (e1 - e0)),
               D = k.area * (k.elastic * step.slope + rate);
  if (k.energy) *k.energy = k.area * L * bar_state(law, k.c, e1).W;
  if (k.dissipated) *k.dissipated = k.area * L * rate * (e1 - e0) * (e1 - e0);
  if (k.least_det) *k.least_det = 1;
  const double m = k.density * k.area * L / 6;
  for (int a = 0; a < 2; ++a)
    for (int i = 0; i < 3; ++i) {
      if (k.f) k.f[3 * a + i] = (a ? 1 : -1) * S * dm[i] / L + (k.a ? m * (k.a[i] + k.a[3 + i] + k.a[3 * a + i]) : 0);
      for (int b = 0; b < 2 && k.K; ++b)
        for (int j = 0; j < 3; ++j)
          k.K[(3 * a + i) * 6 + 3 * b + j] = (a == b ? 1 : -1) * (D * dm[i] * d1[j] / (L * L2) + (i == j ? w * S / L : 0)) +
                                             (k.a && i == j ? k.mass_slope * m * (a == b ? 2 : 1) : 0);
    }
}

}  // namespace

BarState bar_state(Law law, const Lame& c, double e) {
  if (law == Law::stvk) {
    const double Y = young(c), nu = c.lambda / (2 * (c.lambda + c.mu));
    return {Y * e * e / 2, Y * e, Y, std::max(1 - 2 * nu * e, 0.01)};
  }
  const double a = 1 + 2 * e, half = std::log(a) / 2;
  // in y = ln t: mu (exp(y) - 1) + lambda (half + y) = 0, whose left side is convex and rising: Newton's method converges
  double y = -c.lambda / (c.lambda + c.mu) * half;
  for (int it = 0; it < 60; ++it) {
    const double step = (c.mu * std::expm1(y) + c.lambda * (half + y)) / (c.mu * std::exp(y) + c.lambda);
    y -= step;
    if (!(std::abs(step) > 1e-15 * (1 + std::abs(y)))) break;
  }
  const double t = std::exp(y), log_J = half + y, dt = -c.lambda / (2 * a) / (c.mu + c.lambda / t);
  return {c.mu / 2 * (2 * e + 2 * std::expm1(y)) - c.mu * log_J + c.lambda / 2 * log_J * log_J, c.mu * (a - t) / a,
          2 * c.mu * (t / (a * a) - dt / a), t};
}

BarStep bar_step(Law law, const Lame& c, double e0, double e1) {
  const double step = e1 - e0;
  if (law == Law::stvk) {
    const double Y = young(c);
    return {Y * (e0 + e1) / 2, Y / 2};
  }
  if (std::abs(step) > 0.02 * std::min(1 + 2 * e0, 1 + 2 * e1)) {
    const BarState s0 = bar_state(law, c, e0), s1 = bar_state(law, c, e1);
    const double S = (s1.W - s0.W) / step;
    return {S, (s1.S - S) / step};
  }
  // the mean of S over a short step, by Gauss's four points: the remainder is of the eighth power of the step
  constexpr double x[4] = {-0.86113631159405258, -0.33998104358485626, 0.33998104358485626, 0.86113631159405258};
  constexpr double weight[4] = {0.34785484513745386, 0.65214515486254614, 0.65214515486254614, 0.34785484513745386};
  BarStep out{0, 0};
  for (int p = 0; p < 4; ++p) {
    const double at = (1 + x[p]) / 2;
    const BarState s = bar_state(law, c, e0 + at * step);
    out.S += weight[p] / 2 * s.S, out.slope += weight[p] / 2 * at * s.slope;
  }
  return out;
}

KernelFunction bar_kernel(Law law) { return law == Law::stvk ? run_bar<Law::stvk> : run_bar<Law::neo_hookean>; }

}  // namespace hilo
