// SPDX-License-Identifier: GPL-3.0-or-later
// Physical stabilisation of the one-point hexahedron: the strains its centroid does not see, held by the true moduli of bending,
// after Belytschko & Bindeman [belytschko-bindeman-1993], written in twelve quadratic strain measures so that energy-momentum is exact:
//
//   b_rA = (x n_A).(x gamma_r),   n_A mean gradients along the cell's own axes,   gamma_r = (h_r - sum_A (h_r.X_A) n_A)/8,
//   h = (yz, zx, xy, xyz) at the corners.  For direction r with p, q the other two and half-lengths a:
//   e1 = b_qp/a_p,  e2 = b_pq/a_q,  e3 = b_qq/a_p + b_pp/a_q,   U = V/6 [E/(1-nu^2)(e1^2 + e2^2 + 2 nu e1 e2) + mu e3^2],
//   and U = V/18 E (b_4A/a_A)^2 for the warping mode.  All b vanish in any homogeneous deformation: the patch test is exact.
// Moduli that differ with direction stand in for E, nu and mu in the planes of the cell (physics/bending_moduli.hpp).
#pragma once
#include <cmath>
#include <type_traits>

#include "physics/bending_moduli.hpp"
#include "physics/lane_functions.hpp"
#include "physics/solid.hpp"

namespace hilo {

/// What the hourglass measures of one cell are made of.
template <class T, class Moduli = Lame>
struct Hourglass {
  T n[3][8];      // mean gradients along the cell's axes       [1/m]
  T gamma[4][8];  // hourglass vectors                          [1]
  T half[3];      // half-lengths                               [m]
  T axes[3][3];   // the cell's axes, columns                   [1]
  T volume;       //                                            [m^3]
  BendingModuli<T, Moduli> moduli;

  Hourglass(const T* X, const Moduli& c) {
    constexpr const auto& table = stiffness_table<Hex8>;
    T g[8][3];
    auto& R = axes;
    volume = solid::point_gradients<Hex8>(0, X, g);
    for (int A = 0; A < 3; ++A) {
      for (int i = 0; i < 3; ++i) {
        R[i][A] = X[i] * table.dN[0][0][A];
        for (int a = 1; a < 8; ++a) R[i][A] += X[3 * a + i] * table.dN[0][a][A];
      }
      half[A] = root(T(R[0][A] * R[0][A] + R[1][A] * R[1][A] + R[2][A] * R[2][A]));
      for (int i = 0; i < 3; ++i) R[i][A] = R[i][A] / half[A];
    }
    nearest_rotation(R);
    moduli = {c, axes};
    for (int a = 0; a < 8; ++a)
      for (int A = 0; A < 3; ++A) n[A][a] = g[a][0] * R[0][A] + g[a][1] * R[1][A] + g[a][2] * R[2][A];
    for (int r = 0; r < 4; ++r) {
      T along[3];  // h_r . X_A
      for (int A = 0; A < 3; ++A) {
        along[A] = 0 * volume;
        for (int a = 0; a < 8; ++a) along[A] += mode(r, a) * (X[3 * a] * R[0][A] + X[3 * a + 1] * R[1][A] + X[3 * a + 2] * R[2][A]);
      }
      for (int a = 0; a < 8; ++a) gamma[r][a] = (mode(r, a) - along[0] * n[0][a] - along[1] * n[1][a] - along[2] * n[2][a]) / 8;
    }
  }

  /// Corner values of yz, zx, xy, xyz.
  static constexpr double mode(int r, int a) {
    const double* x = hex_corner[a];
    return r == 3 ? x[0] * x[1] * x[2] : x[(r + 1) % 3] * x[(r + 2) % 3];
  }

  /// u_A = x n_A, h_r = x gamma_r and b_rA = u_A . h_r.
  void measure(const T* x, T u[3][3], T h[4][3], T b[4][3]) const {
    for (int i = 0; i < 3; ++i) {
      for (int A = 0; A < 3; ++A) {
        u[A][i] = x[i] * n[A][0];
        for (int a = 1; a < 8; ++a) u[A][i] += x[3 * a + i] * n[A][a];
      }
      for (int r = 0; r < 4; ++r) {
        h[r][i] = x[i] * gamma[r][0];
        for (int a = 1; a < 8; ++a) h[r][i] += x[3 * a + i] * gamma[r][a];
      }
    }
    for (int r = 0; r < 4; ++r)
      for (int A = 0; A < 3; ++A) b[r][A] = u[A][0] * h[r][0] + u[A][1] * h[r][1] + u[A][2] * h[r][2];
  }

  /// t_rA = dU/db_rA, linear in b.
  void conjugate(const T b[4][3], T t[4][3]) const {
    for (int r = 0; r < 4; ++r)
      for (int A = 0; A < 3; ++A) t[r][A] = 0 * volume;
    const T k = volume / 3;
    for (int r = 0; r < 3; ++r) {
      const int p = (r + 1) % 3, q = (r + 2) % 3;
      const T e1 = b[q][p] / half[p], e2 = b[p][q] / half[q], e3 = b[q][q] / half[p] + b[p][p] / half[q];
      T s[3];
      moduli.plane(r, e1, e2, e3, s);
      t[q][p] += k * s[0] / half[p];
      t[p][q] += k * s[1] / half[q];
      t[q][q] += k * s[2] / half[p];
      t[p][p] += k * s[2] / half[q];
    }
    for (int A = 0; A < 3; ++A) t[3][A] = k * (moduli.young(A) / 3) * b[3][A] / (half[A] * half[A]);
  }

  /// Higham's iteration R <- (R + R^-T)/2 from nearly orthonormal columns.
  static void nearest_rotation(T R[3][3]) {
    for (int it = 0; it < 8; ++it) {
      T cof[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
          cof[i][j] = R[i1][j1] * R[i2][j2] - R[i1][j2] * R[i2][j1];
        }
      const T det = R[0][0] * cof[0][0] + R[0][1] * cof[0][1] + R[0][2] * cof[0][2];
      T change = 0 * det;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const T by = (cof[i][j] / det - R[i][j]) / 2;
          R[i][j] += by, change += by * by;
        }
      if constexpr (std::is_same_v<T, double>)
        if (change < 1e-24) return;  // it converges quadratically
    }
  }
};

/// Adds the stabilisation to f, K, energy and dissipated (conventions of SolidCall).
template <class T, class Moduli>
inline void add_hourglass(const Moduli& moduli, const SolidCall<T>& call) {
  const Hourglass<T, Moduli> hg(call.X, moduli);
  T xm[24], u1[3][3], h1[4][3], b0[4][3], b1[4][3], um[3][3], hm[4][3], t[4][3], unused[4][3];
  for (int i = 0; i < 24; ++i) xm[i] = (1 - call.weight) * call.x0[i] + call.weight * call.x1[i];
  hg.measure(call.x0, u1, h1, b0);
  hg.measure(xm, um, hm, unused);
  hg.measure(call.x1, u1, h1, b1);
  T s[4][3], step[4][3], rate[4][3], from[4][3];
  for (int r = 0; r < 4; ++r)
    for (int A = 0; A < 3; ++A) from[r][A] = b0[r][A];
  if (call.viscous != 0)
    solid::add_recalled<12>(call, &from[0][0], [&](const T* x, T* to) {
      T u[3][3], h[4][3], b[4][3];
      hg.measure(x, u, h, b);
      for (int r = 0; r < 4; ++r)
        for (int A = 0; A < 3; ++A) to[3 * r + A] = b[r][A];
    });
  for (int r = 0; r < 4; ++r)
    for (int A = 0; A < 3; ++A)
      s[r][A] = call.elastic * ((1 - call.weight) * b0[r][A] + call.weight * b1[r][A]) + call.viscous * (b1[r][A] - from[r][A]);
  hg.conjugate(s, t);
  if (call.energy || call.dissipated) {
    T t1[4][3];
    hg.conjugate(b1, t1);
    for (int r = 0; r < 4; ++r)
      for (int A = 0; A < 3; ++A) step[r][A] = b1[r][A] - from[r][A];
    hg.conjugate(step, rate);
    for (int r = 0; r < 4; ++r)
      for (int A = 0; A < 3; ++A) {
        if (call.energy) *call.energy += t1[r][A] * b1[r][A] / 2;
        if (call.dissipated) *call.dissipated += call.viscous * rate[r][A] * (b1[r][A] - b0[r][A]);
      }
  }
  if (call.f)
    for (int a = 0; a < 8; ++a)
      for (int r = 0; r < 4; ++r)
        for (int A = 0; A < 3; ++A)
          for (int i = 0; i < 3; ++i) call.f[3 * a + i] += t[r][A] * (hg.n[A][a] * hm[r][i] + hg.gamma[r][a] * um[A][i]);
  if (!call.K) return;
  const double slope = call.elastic * call.weight + call.viscous;
  T DB[12][24];  // rows: d t_rA, with the map b -> t applied
  for (int b = 0; b < 8; ++b)
    for (int j = 0; j < 3; ++j) {
      T db[4][3], dt[4][3];
      for (int r = 0; r < 4; ++r)
        for (int A = 0; A < 3; ++A) db[r][A] = slope * (hg.n[A][b] * h1[r][j] + hg.gamma[r][b] * u1[A][j]);
      hg.conjugate(db, dt);
      for (int r = 0; r < 4; ++r)
        for (int A = 0; A < 3; ++A) DB[3 * r + A][3 * b + j] = dt[r][A];
    }
  if (call.before) {  // the stress that the last correction foresaw (solid::foresee)
    T u[3][3], h[4][3], du[3][3], dh[4][3], b[4][3];
    hg.measure(call.before, u, h, b);
    hg.measure(call.along, du, dh, unused);
    for (int r = 0; r < 4; ++r)
      for (int A = 0; A < 3; ++A) {
        for (int i = 0; i < 3; ++i) b[r][A] += u[A][i] * dh[r][i] + du[A][i] * h[r][i];
        s[r][A] = call.elastic * ((1 - call.weight) * b0[r][A] + call.weight * b[r][A]) + call.viscous * (b[r][A] - from[r][A]);
      }
    hg.conjugate(s, t);
  }
  for (int a = 0; a < 8; ++a) {
    T along[4], across[3];  // geometric: w t_rA (n_A gamma_r^T + gamma_r n_A^T) I
    for (int r = 0; r < 4; ++r) along[r] = (t[r][0] * hg.n[0][a] + t[r][1] * hg.n[1][a] + t[r][2] * hg.n[2][a]) * call.weight;
    for (int A = 0; A < 3; ++A)
      across[A] = (t[0][A] * hg.gamma[0][a] + t[1][A] * hg.gamma[1][a] + t[2][A] * hg.gamma[2][a] + t[3][A] * hg.gamma[3][a]) * call.weight;
    for (int b = 0; b < 8; ++b) {
      T geometric = across[0] * hg.n[0][b] + across[1] * hg.n[1][b] + across[2] * hg.n[2][b];
      for (int r = 0; r < 4; ++r) geometric += along[r] * hg.gamma[r][b];
      for (int i = 0; i < 3; ++i) call.K[(3 * a + i) * 24 + 3 * b + i] += geometric;
    }
    for (int i = 0; i < 3; ++i) {
      T Bm[12];
      for (int r = 0; r < 4; ++r)
        for (int A = 0; A < 3; ++A) Bm[3 * r + A] = hg.n[A][a] * hm[r][i] + hg.gamma[r][a] * um[A][i];
      T* row = call.K + (3 * a + i) * 24;
      for (int j = 0; j < 24; ++j) {
        T v = Bm[0] * DB[0][j];
        for (int k = 1; k < 12; ++k) v += Bm[k] * DB[k][j];
        row[j] += v;
      }
    }
  }
}

}  // namespace hilo
