// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of a number that is a double, or a vector of doubles taken lane by lane.  Templates and inlined functions alone: kernels are
// compiled for several processors and share no code with other units.
#pragma once
#include <cmath>

namespace hilo {

/// One of the doubles of a vector, or the double itself.
template <class T>
inline double& lane(T& x, unsigned l) {
  return reinterpret_cast<double*>(&x)[l];
}
template <class T>
inline double lane(const T& x, unsigned l) {
  return reinterpret_cast<const double*>(&x)[l];
}

[[gnu::always_inline]] inline double log_of(double x) { return std::log(x); }
template <class V>
inline V log_of(const V& v) {
  V r;
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) r[i] = __builtin_log(v[i]);
  return r;
}

[[gnu::always_inline]] inline double log_of_1_and(double x) { return std::log1p(x); }
template <class V>
inline V log_of_1_and(const V& v) {
  V r;
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) r[i] = __builtin_log1p(v[i]);
  return r;
}

[[gnu::always_inline]] inline double exp_less_1(double x) { return std::expm1(x); }
template <class V>
inline V exp_less_1(const V& v) {
  V r;
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) r[i] = __builtin_expm1(v[i]);
  return r;
}

[[gnu::always_inline]] inline double root(double x) { return std::sqrt(x); }
template <class V>
inline V root(const V& v) {
  V r;
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) r[i] = __builtin_sqrt(v[i]);
  return r;
}

[[gnu::always_inline]] inline double cube_root(double x) { return std::cbrt(x); }
template <class V>
inline V cube_root(const V& v) {
  V r;
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) r[i] = __builtin_cbrt(v[i]);
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
template <class V>
inline void log_ratio(const V& r, V& L, V& dL) {
  for (unsigned i = 0; i < sizeof(V) / sizeof(double); ++i) {
    double l, d;
    log_ratio(static_cast<double>(r[i]), l, d);
    L[i] = l, dL[i] = d;
  }
}

}  // namespace hilo
