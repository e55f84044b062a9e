// SPDX-License-Identifier: GPL-3.0-or-later
// A number with N derivatives.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace hilo {

template <int N>
struct Jet {
  using Slope = Eigen::Matrix<double, 1, N>;
  double v = 0;
  Slope d = Slope::Zero();
  Jet() = default;
  Jet(double value) : v(value) {}
  Jet(double value, const Slope& slope) : v(value), d(slope) {}
  friend Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d}; }
  friend Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d}; }
  friend Jet operator-(const Jet& a) { return {-a.v, -a.d}; }
  friend Jet operator*(const Jet& a, const Jet& b) { return {a.v * b.v, a.d * b.v + a.v * b.d}; }
  friend Jet operator/(const Jet& a, const Jet& b) { return {a.v / b.v, (a.d - a.v / b.v * b.d) / b.v}; }
  friend Jet sqrt(const Jet& a) {
    const double root = std::sqrt(a.v);
    return {root, root > 0 ? Slope(a.d / (2 * root)) : Slope(Slope::Zero())};
  }
};
inline double value(double x) { return x; }
template <int N>
double value(const Jet<N>& x) {
  return x.v;
}

/// Its derivatives times f; nothing where there are none.
inline void slow_down(double&, double) {}
template <int N>
void slow_down(Jet<N>& x, double f) {
  x.d *= f;
}

/// Three of them.
template <class T>
struct Triple {
  T x[3];
  T& operator[](int i) { return x[i]; }
  const T& operator[](int i) const { return x[i]; }
  friend Triple operator+(const Triple& a, const Triple& b) { return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}}; }
  friend Triple operator-(const Triple& a, const Triple& b) { return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}}; }
  friend Triple operator*(const T& f, const Triple& a) { return {{f * a[0], f * a[1], f * a[2]}}; }
  friend T dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  friend Triple cross(const Triple& a, const Triple& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
  }
};
template <class T>
Triple<T> triple(const Eigen::Vector3d& a) {
  return {{T(a[0]), T(a[1]), T(a[2])}};
}
template <class T>
Eigen::Vector3d values(const Triple<T>& a) {
  return {value(a[0]), value(a[1]), value(a[2])};
}

}  // namespace hilo
