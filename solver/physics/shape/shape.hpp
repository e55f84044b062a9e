// SPDX-License-Identifier: GPL-3.0-or-later
// What a shape offers: its nodes, shape functions and integration rule, all usable at compile time.
//
//   struct S { static constexpr Shape shape;                                            its number in mesh files
//              static constexpr int n, n_points;
//              static constexpr void values(const double* xi, double* N);          N_a(xi)            (n)
//              static constexpr void gradients(const double* xi, double (*dN)[3]); dN_a/dxi_i         (n x 3)
//              static constexpr Quadrature<n_points> rule();                       stiffness
//              static constexpr int n_mass_points; ... mass_rule(); }              exact for N_a N_b where dX/dxi is constant
//
// Node order is VTK's.  The rules are those under which the element has no zero-energy mode but the rigid ones.
#pragma once
#include "base/shape.hpp"

namespace hilo {

/// Points and weights on a reference cell; the weights sum to its volume.
template <int P>
struct Quadrature {
  double xi[P][3]{};
  double w[P]{};
};

/// Shape functions and their gradients at the points of a rule, made at compile time.
template <class S, int P>
struct Tabulated {
  double dN[P][S::n][3]{};
  double N[P][S::n]{};
  double w[P]{};
  explicit constexpr Tabulated(const Quadrature<P>& rule) {
    for (int p = 0; p < P; ++p) {
      S::values(rule.xi[p], N[p]);
      S::gradients(rule.xi[p], dN[p]);
      w[p] = rule.w[p];
    }
  }
};

inline constexpr double gauss2 = 0.57735026918962576451;  // 1/sqrt(3)
inline constexpr double gauss3 = 0.77459666924148337704;  // sqrt(3/5)
inline constexpr double gauss3_w[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

/// Tensor rule of Q points an axis on [-1, 1]^3, Q = 1, 2, 3.
template <int Q>
constexpr Quadrature<Q * Q * Q> hex_rule() {
  Quadrature<Q * Q * Q> r;
  const double x[3] = {Q == 1 ? 0 : Q == 2 ? -gauss2 : -gauss3, Q == 2 ? gauss2 : 0, gauss3};
  for (int k = 0, p = 0; k < Q; ++k)
    for (int j = 0; j < Q; ++j)
      for (int i = 0; i < Q; ++i, ++p) {
        r.xi[p][0] = x[i], r.xi[p][1] = x[j], r.xi[p][2] = x[k];
        r.w[p] = Q == 1 ? 8 : Q == 2 ? 1 : gauss3_w[i] * gauss3_w[j] * gauss3_w[k];
      }
  return r;
}

/// Tables of the stiffness and of the mass rule of a shape.
template <class S>
inline constexpr Tabulated<S, S::n_points> stiffness_table{S::rule()};
template <class S>
inline constexpr Tabulated<S, S::n_mass_points> mass_table{S::mass_rule()};

}  // namespace hilo
