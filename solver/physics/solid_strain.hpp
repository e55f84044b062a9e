// SPDX-License-Identifier: GPL-3.0-or-later
// A call of a solid cell's functions, and the strain at its points (physics/solid.hpp has the equations).
#pragma once
#include <type_traits>

#include "physics/anisotropic.hpp"
#include "physics/material/voigt.hpp"
#include "physics/shape/hex8.hpp"
#include "physics/shape/shape.hpp"

namespace hilo {

/// Arrays of one call; every T holds the value of several cells.
template <class T>
struct SolidCall {
  const T* X;         // reference positions            (n x 3)     [m]
  const T* x0;        // positions at the start of step (n x 3)     [m]
  const T* x1;        // positions at its end           (n x 3)     [m]
  double elastic;     // 1, or 0 to leave the elastic stress out
  double viscous;     // factor of C (E1 - E0 - what is recalled)   [1]
  Lame linear;        // moduli C of the rate terms and of the hourglass stiffness [Pa]
  T* f;               // internal force                 (n x 3)     [N]     or null
  T* K;               // tangent, row major             (3n x 3n)   [N/m]   or null
  T* energy;          // elastic energy at x1                       [J]     or null
  T* dissipated;      // work of the rate terms over the step       [J]     or null
  T* least_det;       // smallest det F at x1 over the points       [1]     or null
  double density;     // reference density                          [kg/m^3]
  const T* a;         // acceleration less gravity     (n x 3)      [m/s^2] or null: no inertia
  double mass_slope;  // d a / d x1, what of the mass K holds       [1/s^2]
  double weight;      // w, share of x1 in the averages             [1]
  // of laws that remember (physics/material/point_step.hpp):
  const T* h0 = nullptr;  // state at the start     (n_points x n_state)
  T* h1 = nullptr;        // state at the end       (n_points x n_state)      or null
  double elapsed = 0;     // time of the step; 0: nothing flows     [s]
  double mean = 0;        // what of lambda the mean dilatation has [Pa]
  // of Newton's last correction, for the stress of K (solid::foresee); null: none
  const T* before = nullptr;  // x1 before it                 (n x 3)     [m]
  const T* along = nullptr;   // what it was, to first order  (n x 3)     [m]
  // strains that `viscous` recalls: recall[0] (E0 - E(past[0])) + recall[1] (E(past[0]) - E(past[1])), system/stage.hpp; null: none
  const T* past[2] = {nullptr, nullptr};  // (n x 3) [m]
  double recall[2] = {0, 0};
};

/// A law whose points have a state.
template <class M>
concept Remembers = requires {
  M::n_state;
};

namespace solid {

/// Adds to m measures at the start of the step what is recalled of them; `measure(x, e)` puts those of a configuration.
template <int m, class T, class Measure>
inline void add_recalled(const SolidCall<T>& c, T* e, const Measure& measure) {
  if (!c.past[0]) return;
  T one[m], two[m];
  measure(c.past[0], one), measure(c.past[1], two);
  for (int i = 0; i < m; ++i) e[i] += c.recall[0] * (e[i] - one[i]) + c.recall[1] * (one[i] - two[i]);
}

/// Gradients of the shape functions in the reference configuration, and det(dX/dxi).
template <int n, class T>
inline T reference_gradients(const double (*dN)[3], const T* X, T (*g)[3]) {
  T J[3][3], inv[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      J[i][j] = X[i] * dN[0][j];
      for (int a = 1; a < n; ++a) J[i][j] += X[3 * a + i] * dN[a][j];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      inv[j][i] = J[i1][j1] * J[i2][j2] - J[i1][j2] * J[i2][j1];
    }
  const T det = J[0][0] * inv[0][0] + J[0][1] * inv[1][0] + J[0][2] * inv[2][0];
  const T r = 1 / det;
  for (int a = 0; a < n; ++a)
    for (int j = 0; j < 3; ++j) g[a][j] = r * (dN[a][0] * inv[0][j] + dN[a][1] * inv[1][j] + dN[a][2] * inv[2][j]);
  return det;
}

/// Gradients of the trilinear hexahedron averaged over the cell, (1/V) int grad N_a dV, and its volume [flanagan-belytschko-1981]; on a
/// bent mesh the centroid's gradients would fail the patch test.  With x = m_0 + m_1 xi + m_2 eta + m_3 zeta + p_1 eta zeta + p_2 zeta xi +
/// p_3 xi eta + w xi eta zeta the integral of x_eta x x_zeta dN_a/dxi, and its cyclic likes, is a few products of these vectors.
template <class T>
inline T mean_gradients(const T* X, T (*g)[3]) {
  T m[3][3], p[3][3], w[3];
  for (int i = 0; i < 3; ++i) {
    for (int r = 0; r < 3; ++r) m[r][i] = p[r][i] = T{};
    w[i] = T{};
    for (int a = 0; a < 8; ++a) {
      const double* c = hex_corner[a];
      const T x = X[3 * a + i] / 8;
      for (int r = 0; r < 3; ++r) m[r][i] += c[r] * x, p[r][i] += c[(r + 1) % 3] * c[(r + 2) % 3] * x;
      w[i] += c[0] * c[1] * c[2] * x;
    }
  }
  const auto add_cross = [](double f, const T* a, const T* b, T* to) {
    for (int i = 0; i < 3; ++i) to[i] += f * (a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
  };
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i) g[a][i] = T{};
  for (int r = 0; r < 3; ++r) {
    const int j = (r + 1) % 3, k = (r + 2) % 3;
    T constant[3] = {}, along_j[3] = {}, along_k[3] = {};
    add_cross(1, m[j], m[k], constant), add_cross(1. / 3, p[k], p[j], constant);
    add_cross(1. / 3, m[j], p[r], along_j), add_cross(1. / 9, p[k], w, along_j);
    add_cross(1. / 3, p[r], m[k], along_k), add_cross(1. / 9, w, p[j], along_k);
    for (int a = 0; a < 8; ++a) {
      const double* c = hex_corner[a];
      for (int i = 0; i < 3; ++i) g[a][i] += c[r] * (constant[i] + c[j] * along_j[i] + c[k] * along_k[i]);
    }
  }
  T volume = T{};
  for (int a = 1; a < 8; ++a) volume += (X[3 * a] - X[0]) * g[a][0];
  const T inverse = 1 / volume;
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i) g[a][i] *= inverse;
  return volume;
}

/// Gradients at integration point p of a cell, and the point's weight [m^3].
template <class S, class T>
inline T point_gradients(int p, const T* X, T (*g)[3]) {
  if constexpr (std::is_same_v<S, Hex8>) {
    return mean_gradients(X, g);
  } else {
    constexpr const auto& table = stiffness_table<S>;
    return table.w[p] * reference_gradients<S::n>(table.dN[p], X, g);
  }
}

/// F_ij = sum_a x_ai g_aj
template <int n, class T>
inline void gradient(const T* x, const T (*g)[3], T F[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      F[i][j] = x[i] * g[0][j];
      for (int a = 1; a < n; ++a) F[i][j] += x[3 * a + i] * g[a][j];
    }
}

/// Green-Lagrange strain of F.
template <class T>
inline void green_lagrange(const T F[3][3], T e[6]) {
  constexpr int I[6] = {0, 1, 2, 1, 0, 0}, J[6] = {0, 1, 2, 2, 2, 1};
  for (int k = 0; k < 6; ++k) {
    const T dot = F[0][I[k]] * F[0][J[k]] + F[1][I[k]] * F[1][J[k]] + F[2][I[k]] * F[2][J[k]];
    if (k < 3)
      e[k] = (dot - 1) / 2;
    else
      e[k] = dot;
  }
}

template <class T>
inline T determinant(const T F[3][3]) {
  return F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) - F[0][1] * (F[1][0] * F[2][2] - F[1][2] * F[2][0]) +
         F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
}

/// Rows of B for node gradient g: de = sum_i B[k][i] du_i.
template <class T>
inline void strain_operator(const T F[3][3], const T g[3], T B[6][3]) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) B[k][i] = F[i][k] * g[k];
    B[3][i] = F[i][1] * g[2] + F[i][2] * g[1];
    B[4][i] = F[i][0] * g[2] + F[i][2] * g[0];
    B[5][i] = F[i][0] * g[1] + F[i][1] * g[0];
  }
}

}  // namespace solid
}  // namespace hilo
