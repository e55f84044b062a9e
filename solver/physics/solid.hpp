// Total Lagrangian solid: residual, tangent and energy of one cell (or of as many as T has lanes) over a step.
//
//   E = (F^T F - I)/2,   f_a = int F_w S grad N_a dV,   F_w = (1 - w) F0 + w F1
//   K_ab = d f_a / d x1_b = int B_w,a^T D B_1,b + w (grad N_a . S grad N_b) I dV,   D = dS/dE1
//
// With w = 1/2 the stress is a discrete gradient, S.(E1 - E0) = W1 - W0: E is quadratic in x, so B_mid (x1 - x0) = E1 - E0 and the work
// of f over the step is exactly the change of W [simo-tarnow-1992].  Otherwise it is S((1 - w) E0 + w E1); w = 1 is the end point.
// Rate terms act as stress: S += viscous C (E1 - E0).
#pragma once
#include <type_traits>

#include "physics/anisotropic.hpp"
#include "physics/material/point_step.hpp"
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
  double viscous;     // factor of C (E1 - E0): beta/h + chi/2      [1]
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
};

/// A law whose points have a state.
template <class M>
concept Remembers = requires {
  M::n_state;
};

namespace solid {

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

/// Stress, slope, state and energies of point p under a law that remembers: lane by lane, in a function of the law's own.
template <class M, class T>
inline void step_point(const M& law, const SolidCall<T>& c, int p, const T& w, const T e0[6], const T e1[6], T s[6], T (*D)[6]) {
  constexpr int lanes = sizeof(T) / sizeof(double), n = M::n_state;
  const auto get = [](const T& x, int lane) { return reinterpret_cast<const double*>(&x)[lane]; };
  const auto put = [](T& x, int lane, double value) { reinterpret_cast<double*>(&x)[lane] = value; };
  for (int l = 0; l < lanes; ++l) {
    double start[6], end[6], before[n], after[n], stress[6], slope[36];
    for (int i = 0; i < 6; ++i) start[i] = get(e0[i], l), end[i] = get(e1[i], l);
    for (int i = 0; i < n; ++i) before[i] = get(c.h0[p * n + i], l);
    PointStep step{start, end, before, c.elapsed, c.weight == 0.5, c.mean};
    if (c.elastic != 0 && (c.f || c.K)) step.s = stress, step.D = D ? slope : nullptr;
    if (c.h1) step.h1 = after;
    law.respond(step);
    for (int i = 0; i < 6 && step.s; ++i) {
      put(s[i], l, stress[i]);
      for (int j = 0; j < 6 && step.D; ++j) put(D[i][j], l, slope[6 * i + j]);
    }
    for (int i = 0; i < n && c.h1; ++i) put(c.h1[p * n + i], l, after[i]);
    if (c.energy) put(*c.energy, l, get(*c.energy, l) + get(w, l) * step.energy);
    if (c.elastic != 0 && c.dissipated) put(*c.dissipated, l, get(*c.dissipated, l) + get(w, l) * step.dissipated);
  }
}

/// Contribution of integration point p of weight w [m^3] (already times det).
template <int n, class Material, class T>
inline void add_point(const Material& material, const SolidCall<T>& c, const T (*g)[3], const T& w, [[maybe_unused]] int p = 0) {
  T F0[3][3], F1[3][3], Fm[3][3], e0[6], e1[6], s[6], D[6][6];
  gradient<n>(c.x0, g, F0);
  gradient<n>(c.x1, g, F1);
  green_lagrange(F0, e0);
  green_lagrange(F1, e1);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) Fm[i][j] = (1 - c.weight) * F0[i][j] + c.weight * F1[i][j];
  for (int i = 0; i < 6; ++i) {
    s[i] = 0 * w;
    for (int j = 0; j < 6; ++j) D[i][j] = 0 * w;
  }
  if constexpr (Remembers<Material>) {
    if (c.elastic != 0 || c.energy) step_point(material, c, p, w, e0, e1, s, c.K ? D : nullptr);
  } else if (c.elastic != 0) {
    if (c.weight == 0.5) {
      material.stress(e0, e1, s, c.K ? D : nullptr);
    } else {
      T e[6];
      for (int i = 0; i < 6; ++i) e[i] = (1 - c.weight) * e0[i] + c.weight * e1[i];
      material.stress(e, e, s, c.K ? D : nullptr);  // D holds half the derivative: that by the second argument
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) D[i][j] *= 2 * c.weight;
    }
  }
  if (c.viscous != 0) {
    T rate[6], q[6];
    for (int i = 0; i < 6; ++i) rate[i] = e1[i] - e0[i];
    if constexpr (Directed<Material>)
      material.moduli.stress(rate, q);
    else
      linear_stress(c.linear, rate, q);
    for (int i = 0; i < 6; ++i) {
      s[i] += c.viscous * q[i];
      if (c.dissipated) *c.dissipated += w * c.viscous * q[i] * rate[i];
    }
    if (c.K) {
      if constexpr (Directed<Material>)
        material.moduli.add_tangent(c.viscous, D);
      else
        add_linear_tangent(c.linear, c.viscous, D);
    }
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
