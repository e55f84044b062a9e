// SPDX-License-Identifier: GPL-3.0-or-later
// Compressible neo-Hookean solid.   W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2,   C = I + 2E, J^2 = det C
#pragma once
#include "physics/lane_functions.hpp"
#include "physics/material/dilatation.hpp"
#include "physics/material/material.hpp"

namespace hilo {

struct NeoHookean {
  static constexpr std::string_view name = "neo-hookean", meaning = "compressible neo-Hookean solid";
  static std::vector<Param> keys() { return {young, poisson}; }
  static NeoHookean make(const MaterialValues& v) { return {lame(v.number("E"), v.number("nu"))}; }
  using Bulk = LogOfDet;
  static constexpr double soft_below = 0;
  static constexpr std::string_view soft_because = "";
  Lame c;

  Lame linear() const { return c; }
  NeoHookean with_lambda(double lambda) const { return {{lambda, c.mu}}; }

  template <class T>
  T energy(const T e[6]) const {
    const T log_J = log_of_1_and(volume::swelling(e)) / 2;  // tr E - ln J is small beside both
    return c.mu * (e[0] + e[1] + e[2] - log_J) + c.lambda / 2 * log_J * log_J;
  }

  /// Discrete gradient in partitioned form: det C1 - det C0 = A : (C1 - C0) with A = cof(C_mean) + cof(C1 - C0)/12, so
  /// S = mu I + k ln(1 + r)/(r D0) A,  k = -mu + lambda (ln D0 + ln D1)/4,  r = (D1 - D0)/D0,  gives S:(E1 - E0) = W1 - W0.
  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    T M[6], A[6], cof1[6], D0 = 0 * e0[0], D1 = D0;
    volume::over_step(e0, e1, M, A, cof1, D0, D1);
    const T dD = 2 * (A[0] * (e1[0] - e0[0]) + A[1] * (e1[1] - e0[1]) + A[2] * (e1[2] - e0[2]) + A[3] * (e1[3] - e0[3]) +
                      A[4] * (e1[4] - e0[4]) + A[5] * (e1[5] - e0[5]));
    const T k = -c.mu + c.lambda / 4 * (log_of(D0) + log_of(D1));
    T L = D0, dL = D0;
    log_ratio(T(dD / D0), L, dL);
    const T phi = k * L / D0;
    for (int i = 0; i < 3; ++i) s[i] = c.mu + phi * A[i], s[i + 3] = phi * A[i + 3];
    if (!D) return;
    // dS = psi A (cof C1 : dC1) + phi dA,  dA = dcof(mean/2 + step/12)[dC1],  dC1 = 2 dE1
    const T psi = (c.lambda / 4 / D1) * L / D0 + k * dL / (D0 * D0);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[i][j] += 2 * psi * A[i] * cof1[j];
    volume::add_cofactor_slope(M, T(2 * phi), D);
  }

  /// a = 1 + 2 e,  mu (t - 1) + lambda (ln a/2 + ln t) = 0,  S = mu (a - t)/a     (dW/dt = 0, 2 dW/da)
  BarState bar(double e) const {
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
  BarStep bar_step(double e0, double e1) const { return quotient_step(*this, e0, e1); }
};

}  // namespace hilo
