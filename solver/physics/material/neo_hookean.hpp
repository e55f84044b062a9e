// Compressible neo-Hookean solid.   W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2,   C = I + 2E, J^2 = det C
#pragma once
#include <cmath>
#include <complex>

#include "physics/material/material.hpp"

namespace hilo {

[[gnu::always_inline]] inline double log_of(double x) { return std::log(x); }
inline std::complex<double> log_of(const std::complex<double>& x) { return std::log(x); }
/// Lane by lane for a vector of doubles.
template <class V>
inline V log_of(const V& v) {
  V r;
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) r[i] = __builtin_log(v[i]);
  return r;
}
/// ln(1 + r)/r and its derivative, by series where |r| < 1e-3.
[[gnu::always_inline]] inline void log_ratio(double r, double& L, double& dL) {
  if (std::abs(r) < 1e-3) {
    L = 1 + r * (-1. / 2 + r * (1. / 3 + r * (-1. / 4 + r * (1. / 5 - r / 6))));
    dL = -1. / 2 + r * (2. / 3 + r * (-3. / 4 + r * (4. / 5 - r * 5. / 6)));
  } else {
    L = std::log1p(r) / r;
    dL = (1 / (1 + r) - L) / r;
  }
}
inline void log_ratio(const std::complex<double>& r, std::complex<double>& L, std::complex<double>& dL) {
  if (std::abs(r) < 1e-3) {
    L = 1. + r * (-1. / 2 + r * (1. / 3 + r * (-1. / 4 + r * (1. / 5 - r / 6.))));
    dL = -1. / 2 + r * (2. / 3 + r * (-3. / 4 + r * (4. / 5 - r * 5. / 6.)));
  } else {
    L = std::log(1. + r) / r;
    dL = (1. / (1. + r) - L) / r;
  }
}
template <class V>
inline void log_ratio(const V& r, V& L, V& dL) {
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) {
    double l, d;
    log_ratio(static_cast<double>(r[i]), l, d);
    L[i] = l, dL[i] = d;
  }
}

struct NeoHookean {
  static constexpr std::string_view kind = "neo-hookean", meaning = "compressible neo-Hookean solid";
  static std::vector<Param> keys() { return {young, poisson}; }
  static NeoHookean make(const MaterialValues& v) { return {lame(v.number("E"), v.number("nu"))}; }
  static constexpr Dilatation bulk = Dilatation::log_det;
  static constexpr double soft_below = 0;
  static constexpr std::string_view soft_because = "";
  Lame c;

  Lame linear() const { return c; }
  NeoHookean with_lambda(double lambda) const { return {{lambda, c.mu}}; }

  template <class T>
  T energy(const T e[6]) const {
    T C[6], A[6];
    right_cauchy_green(e, C);
    cofactor(C, A);
    const T log_J = log_of(T(determinant(C, A))) / 2;
    return c.mu * (e[0] + e[1] + e[2]) - c.mu * log_J + c.lambda / 2 * log_J * log_J;
  }

  /// Discrete gradient in partitioned form: det C1 - det C0 = A : (C1 - C0) with A = cof(C_mean) + cof(C1 - C0)/12, so
  /// S = mu I + k ln(1 + r)/(r D0) A,  k = -mu + lambda (ln D0 + ln D1)/4,  r = (D1 - D0)/D0,  gives S:(E1 - E0) = W1 - W0.
  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    T M[6], A[6], cof1[6], D0 = 0 * e0[0], D1 = D0;
    dilatation(e0, e1, M, A, cof1, D0, D1);
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
    add_cofactor_slope(M, T(2 * phi), D);
  }

  /// det C over a step: D1 - D0 = A:(C1 - C0), and the cofactor at its end; M = mean/2 + step/12 is what dA/dC1 is made of.
  template <class T>
  static void dilatation(const T e0[6], const T e1[6], T M[6], T A[6], T cof1[6], T& D0, T& D1) {
    T C0[6], C1[6], mean[6], step[6], cof0[6], cof_step[6];
    right_cauchy_green(e0, C0);
    right_cauchy_green(e1, C1);
    for (int i = 0; i < 6; ++i) mean[i] = (C0[i] + C1[i]) / 2, step[i] = C1[i] - C0[i];
    cofactor(C0, cof0);
    cofactor(C1, cof1);
    cofactor(mean, A);
    cofactor(step, cof_step);
    for (int i = 0; i < 6; ++i) A[i] += cof_step[i] / 12, M[i] = mean[i] / 2 + step[i] / 12;
    D0 = determinant(C0, cof0), D1 = determinant(C1, cof1);
  }
  /// D += f dcof(M), columns in strain form (off-diagonal variation counted once).
  template <class T>
  static void add_cofactor_slope(const T M[6], const T& f, T (*D)[6]) {
    D[0][1] += f * M[2], D[0][2] += f * M[1], D[0][3] -= f * M[3];
    D[1][0] += f * M[2], D[1][2] += f * M[0], D[1][4] -= f * M[4];
    D[2][0] += f * M[1], D[2][1] += f * M[0], D[2][5] -= f * M[5];
    D[3][0] -= f * M[3], D[3][3] -= f * M[0] / 2, D[3][4] += f * M[5] / 2, D[3][5] += f * M[4] / 2;
    D[4][1] -= f * M[4], D[4][4] -= f * M[1] / 2, D[4][3] += f * M[5] / 2, D[4][5] += f * M[3] / 2;
    D[5][2] -= f * M[5], D[5][5] -= f * M[2] / 2, D[5][3] += f * M[4] / 2, D[5][4] += f * M[3] / 2;
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

 private:
  /// Tensor entries of C = I + 2E, so e[3] = 2 E23 = C23.
  template <class T>
  static void right_cauchy_green(const T e[6], T C[6]) {
    for (int i = 0; i < 3; ++i) C[i] = 1 + 2 * e[i], C[i + 3] = e[i + 3];
  }
  template <class T>
  static void cofactor(const T m[6], T c[6]) {
    c[0] = m[1] * m[2] - m[3] * m[3];
    c[1] = m[0] * m[2] - m[4] * m[4];
    c[2] = m[0] * m[1] - m[5] * m[5];
    c[3] = m[5] * m[4] - m[0] * m[3];
    c[4] = m[5] * m[3] - m[1] * m[4];
    c[5] = m[4] * m[3] - m[2] * m[5];
  }
  template <class T>
  static T determinant(const T m[6], const T cof[6]) {
    return m[0] * cof[0] + m[5] * cof[5] + m[4] * cof[4];
  }
};

}  // namespace hilo
