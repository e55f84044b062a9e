// SPDX-License-Identifier: GPL-3.0-or-later
// Total Lagrangian solid: residual, tangent and energy of one cell (or of as many as T has lanes) over a step.
//
//   E = (F^T F - I)/2,   f_a = int F_w S grad N_a dV,   F_w = (1 - w) F0 + w F1
//   K_ab = d f_a / d x1_b = int B_w,a^T D B_1,b + w (grad N_a . S grad N_b) I dV,   D = dS/dE1
//
// With w = 1/2 the stress is a discrete gradient, S.(E1 - E0) = W1 - W0: E is quadratic in x, so B_mid (x1 - x0) = E1 - E0 and the work
// of f over the step is exactly the change of W [simo-tarnow-1992].  Otherwise it is S((1 - w) E0 + w E1); w = 1 is the end point.
// Rate terms act as stress: S += viscous C (E1 - E0); for dissipation less what it recalls of earlier steps.
#pragma once
#include "physics/solid_stress.hpp"

namespace hilo {
namespace solid {

/// Contribution of integration point p of weight w [m^3] (already times det).
template <int n, class Material, class T>
inline void add_point(const Material& material, const SolidCall<T>& c, const T (*g)[3], const T& w, [[maybe_unused]] int p = 0) {
  T F0[3][3], F1[3][3], Fm[3][3], e0[6], e1[6], from[6], s[6], D[6][6];
  gradient<n>(c.x0, g, F0);
  gradient<n>(c.x1, g, F1);
  green_lagrange(F0, e0);
  green_lagrange(F1, e1);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) Fm[i][j] = (1 - c.weight) * F0[i][j] + c.weight * F1[i][j];
  for (int i = 0; i < 6; ++i) {
    s[i] = 0 * w, from[i] = e0[i];
    for (int j = 0; j < 6; ++j) D[i][j] = 0 * w;
  }
  if (c.elastic != 0 || (Remembers<Material> && c.energy)) add_elastic(material, c, p, w, e0, e1, s, c.K ? D : nullptr);
  if (c.viscous != 0) {
    add_recalled<6>(c, from, [&](const T* x, T* e) {
      T F[3][3];
      gradient<n>(x, g, F);
      green_lagrange(F, e);
    });
    add_viscous(material, c, w, e0, from, e1, s, c.K ? D : nullptr, c.dissipated);
  }
  if constexpr (!Remembers<Material>)
    if (c.energy) *c.energy += w * material.energy(e1);
  if (c.least_det) {
    const T J = determinant(F1);
    *c.least_det = J < *c.least_det ? J : *c.least_det;
  }
  if (c.f) {
    T P[3][3];  // F_mid S
    for (int i = 0; i < 3; ++i) {
      P[i][0] = w * (Fm[i][0] * s[0] + Fm[i][1] * s[5] + Fm[i][2] * s[4]);
      P[i][1] = w * (Fm[i][0] * s[5] + Fm[i][1] * s[1] + Fm[i][2] * s[3]);
      P[i][2] = w * (Fm[i][0] * s[4] + Fm[i][1] * s[3] + Fm[i][2] * s[2]);
    }
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i) c.f[3 * a + i] += P[i][0] * g[a][0] + P[i][1] * g[a][1] + P[i][2] * g[a][2];
  }
  if (!c.K) return;
  if (c.before) foresee<n>(material, c, g, w, p, e0, from, e1, s, D);
  T DB[6][3 * n], Bm[n][6][3];
  for (int a = 0; a < n; ++a) {
    T B1[6][3];
    strain_operator(F1, g[a], B1);
    strain_operator(Fm, g[a], Bm[a]);
    for (int k = 0; k < 6; ++k)
      for (int i = 0; i < 3; ++i) {
        T v = D[k][0] * B1[0][i];
        for (int m = 1; m < 6; ++m) v += D[k][m] * B1[m][i];
        DB[k][3 * a + i] = w * v;
      }
  }
  for (int a = 0; a < n; ++a) {
    const T ww = w * c.weight;
    const T sg[3] = {ww * (s[0] * g[a][0] + s[5] * g[a][1] + s[4] * g[a][2]), ww * (s[5] * g[a][0] + s[1] * g[a][1] + s[3] * g[a][2]),
                     ww * (s[4] * g[a][0] + s[3] * g[a][1] + s[2] * g[a][2])};
    for (int b = 0; b < n; ++b) {
      const T geometric = sg[0] * g[b][0] + sg[1] * g[b][1] + sg[2] * g[b][2];
      for (int i = 0; i < 3; ++i) c.K[(3 * a + i) * 3 * n + 3 * b + i] += geometric;
    }
    for (int i = 0; i < 3; ++i) {
      T* row = c.K + (3 * a + i) * 3 * n;
      for (int j = 0; j < 3 * n; ++j) {
        T v = Bm[a][0][i] * DB[0][j];
        for (int k = 1; k < 6; ++k) v += Bm[a][k][i] * DB[k][j];
        row[j] += v;
      }
    }
  }
}

}  // namespace solid

/// Adds to f, K, energy, dissipated and lowers least_det; the caller clears them.
template <class S, class Material, class T>
inline void evaluate_solid(const Material& material, const SolidCall<T>& c) {
  for (int p = 0; p < S::n_points; ++p) {
    T g[S::n][3];
    const T w = solid::point_gradients<S>(p, c.X, g);
    solid::add_point<S::n>(material, c, g, w, p);
  }
}

/// Consistent mass: f_a += int rho N_a N_b dV a_b,  K_ab += mass_slope int rho N_a N_b dV I.
template <class S, class T>
inline void add_mass(const SolidCall<T>& c) {
  constexpr const auto& table = mass_table<S>;
  constexpr int n = S::n;
  T m[n][n];
  if (c.K)
    for (int a = 0; a < n; ++a)
      for (int b = 0; b <= a; ++b) m[a][b] = T{};
  for (int p = 0; p < S::n_mass_points; ++p) {
    T g[n][3], mean[3];
    const T w = table.w[p] * c.density * solid::reference_gradients<n>(table.dN[p], c.X, g);
    for (int i = 0; i < 3; ++i) {
      mean[i] = table.N[p][0] * c.a[i];
      for (int b = 1; b < n; ++b) mean[i] += table.N[p][b] * c.a[3 * b + i];
    }
    if (c.f)
      for (int a = 0; a < n; ++a)
        for (int i = 0; i < 3; ++i) c.f[3 * a + i] += w * table.N[p][a] * mean[i];
    if (c.K)
      for (int a = 0; a < n; ++a) {
        const T wa = w * (c.mass_slope * table.N[p][a]);
        for (int b = 0; b <= a; ++b) m[a][b] += wa * table.N[p][b];
      }
  }
  if (!c.K) return;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int i = 0; i < 3; ++i) c.K[(3 * a + i) * 3 * n + 3 * b + i] += b <= a ? m[a][b] : m[b][a];
}

}  // namespace hilo
