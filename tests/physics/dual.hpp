// SPDX-License-Identifier: GPL-3.0-or-later
// A number with one directional derivative: the kernels run through it unchanged, so a derivative of theirs is exact.
#pragma once
#include <cmath>

namespace hilo::test {

struct Dual {
  double v = 0, d = 0;
  Dual() = default;
  Dual(double value, double slope = 0) : v(value), d(slope) {}
  Dual& operator+=(const Dual& b) { return v += b.v, d += b.d, *this; }
  Dual& operator-=(const Dual& b) { return v -= b.v, d -= b.d, *this; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.d * b.v + a.v * b.d}; }
  friend Dual operator/(const Dual& a, const Dual& b) { return {a.v / b.v, (a.d - a.v / b.v * b.d) / b.v}; }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
};

inline Dual log_of(const Dual& x) { return {std::log(x.v), x.d / x.v}; }
inline Dual log_of_1_and(const Dual& x) { return {std::log1p(x.v), x.d / (1 + x.v)}; }
inline Dual exp_less_1(const Dual& x) { return {std::expm1(x.v), x.d * std::exp(x.v)}; }
inline Dual root(const Dual& x) { return {std::sqrt(x.v), x.d / (2 * std::sqrt(x.v))}; }
inline Dual cube_root(const Dual& x) { return {std::cbrt(x.v), x.d / (3 * std::cbrt(x.v) * std::cbrt(x.v))}; }
/// ln(1 + r)/r and its derivative: its power series where that converges fast, else its definition in more digits than the kernel has.
inline void log_ratio(const Dual& r, Dual& L, Dual& dL) {
  long double value = 0, slope = 0;
  if (std::abs(r.v) < 0.5) {
    long double power = 1;  // (-r)^k
    for (int k = 0; k < 80; ++k, power *= -r.v) value += power / (k + 1), slope -= (k + 1) * power / (k + 2);
  } else {
    value = std::log1p(static_cast<long double>(r.v)) / r.v;
    slope = (1 / (1 + static_cast<long double>(r.v)) - value) / r.v;
  }
  L = {static_cast<double>(value), static_cast<double>(slope) * r.d};
  dL = {static_cast<double>(slope), 0};
}

}  // namespace hilo::test
