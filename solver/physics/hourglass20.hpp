// SPDX-License-Identifier: GPL-3.0-or-later
// Physical stabilisation of the hexahedron of 20 nodes with 2 x 2 x 2 points: the six modes that its points do not see,
//
//   u = t_x x (y^2 - 1/3)/|t_x|^2 - t_y y (x^2 - 1/3)/|t_y|^2   and the same times z,   for the three pairs (x, y) of the cell's axes,
//
// are held by a share of the energy they would have if integrated in full.  t_A = dx/dxi_A at the centroid, h(m) = the vector that
// multiplies the monomial m of xi, less what a homogeneous deformation gives of it:
//
//   c = (t_x.h(x y^2) - t_y.h(x^2 y))/2,   c' = (t_x.h(x y^2 z) - t_y.h(x^2 y z))/2,   U = (k c^2 + k' c'^2)/2
//   k = s 4/45 V E (1/L_x^4 + 1/L_y^4),   k' = s 4/135 V (E/L_x^4 + E/L_y^4 + mu/(L_x L_z)^2 + mu/(L_y L_z)^2),   L_A = |t_A| of the
//   reference
//
// (4/45 is the mean of (y^2 - 1/3)^2; half the difference is the part that 2 x 2 x 2 points do not see: they see t_x.h + t_y.h as a shear.)
// Each c is a quadratic form of positions, so its discrete gradient is that at the mid-point and energy-momentum stays exact.  All c vanish
// where the cell is deformed homogeneously (patch test) and where positions are complete quadratics of xi: bending of flat and curved walls
// is left alone, unlike with points added [belytschko-bindeman-1993, for the idea on eight nodes].
#pragma once
#include "physics/shape/hex20r.hpp"
#include "physics/solid.hpp"

namespace hilo {

/// Share s of the full energy.  docs/elements.md has the figures it was chosen by.
inline constexpr double hourglass20_share = 0.1;

/// What the hourglass measures of one cell are made of; mode (z, w) is that of the pair beside axis z, times z^w.
template <class T>
struct Hourglass20 {
  T cubic[3][3][20];  // [x][y]: of x y^2, x != y           [1]
  T quartic[3][20];   // [y]: of x y^2 z                    [1]
  T stiffness[3][2];  // k and k'                           [N/m^3]
  static constexpr Quadrature<1> middle{{{0, 0, 0}}, {8}};
  static constexpr Tabulated<Hex20, 1> centre{middle};

  Hourglass20(const T* X, const Lame& c) {
    T g[20][3], L2[3];
    const T volume = 8 * solid::reference_gradients<20>(centre.dN[0], X, g);
    for (int A = 0; A < 3; ++A) {
      T t[3];
      tangent(A, X, t);
      L2[A] = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    }
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x)
        if (x != y)
          less_homogeneous(
              X, g, [&](int a) { return second(a, y) * coordinate(a, x); }, cubic[x][y]);
      less_homogeneous(
          X, g, [&](int a) { return second(a, y) * coordinate(a, (y + 1) % 3) * coordinate(a, (y + 2) % 3); }, quartic[y]);
    }
    const double E = c.mu * (3 * c.lambda + 2 * c.mu) / (c.lambda + c.mu);
    const T scale = (hourglass20_share * 4 / 45) * volume;
    for (int z = 0; z < 3; ++z) {
      const T Lx = L2[(z + 1) % 3], Ly = L2[(z + 2) % 3], normal = E / (Lx * Lx) + E / (Ly * Ly);
      stiffness[z][0] = scale * normal;
      stiffness[z][1] = scale / 3 * (normal + c.mu / (Lx * L2[z]) + c.mu / (Ly * L2[z]));
    }
  }

  /// Local coordinate of a node.
  static constexpr double coordinate(int a, int i) {
    return a < 8 ? hex_corner[a][i] : (hex_corner[Hex20::edge[a - 8][0]][i] + hex_corner[Hex20::edge[a - 8][1]][i]) / 2;
  }
  /// What of N_a is quadratic in y is second (1 + c_x x)(1 + c_z z) y^2, but for terms of x^2 and z^2.
  static constexpr double second(int a, int y) { return a < 8 ? 1. / 8 : coordinate(a, y) == 0 ? -1. / 4 : 0; }
  /// t_A of positions x.
  static void tangent(int A, const T* x, T t[3]) {
    for (int i = 0; i < 3; ++i) {
      t[i] = x[i] * centre.dN[0][0][A];
      for (int a = 1; a < 20; ++a) t[i] += x[3 * a + i] * centre.dN[0][a][A];
    }
  }
  static void product(const T* gamma, const T* x, T h[3]) {
    for (int i = 0; i < 3; ++i) {
      h[i] = x[i] * gamma[0];
      for (int a = 1; a < 20; ++a) h[i] += x[3 * a + i] * gamma[a];
    }
  }
  /// gamma_a = m_a - (sum_b m_b X_b).grad N_a
  template <class Monomial>
  static void less_homogeneous(const T* X, const T (*g)[3], const Monomial& m, T* gamma) {
    T h[3];
    for (int i = 0; i < 3; ++i) {
      h[i] = X[i] * m(0);
      for (int a = 1; a < 20; ++a) h[i] += X[3 * a + i] * m(a);
    }
    for (int a = 0; a < 20; ++a) gamma[a] = m(a) - (h[0] * g[a][0] + h[1] * g[a][1] + h[2] * g[a][2]);
  }

  /// The vectors of x y^2 z^w and of x^2 y z^w.
  const T* one(int z, int w) const { return w ? quartic[(z + 2) % 3] : cubic[(z + 1) % 3][(z + 2) % 3]; }
  const T* two(int z, int w) const { return w ? quartic[(z + 1) % 3] : cubic[(z + 2) % 3][(z + 1) % 3]; }

  /// t_A, h of `one` and of `two`, and the measures of a configuration.
  struct State {
    T t[3][3], one[3][2][3], two[3][2][3], c[3][2];
  };
  State measure(const T* x) const {
    State s;
    for (int A = 0; A < 3; ++A) tangent(A, x, s.t[A]);
    for (int z = 0; z < 3; ++z)
      for (int w = 0; w < 2; ++w) {
        product(one(z, w), x, s.one[z][w]);
        product(two(z, w), x, s.two[z][w]);
        const T *tx = s.t[(z + 1) % 3], *ty = s.t[(z + 2) % 3], *h = s.one[z][w], *k = s.two[z][w];
        s.c[z][w] = (tx[0] * h[0] + tx[1] * h[1] + tx[2] * h[2] - ty[0] * k[0] - ty[1] * k[1] - ty[2] * k[2]) / 2;
      }
    return s;
  }
  /// dc/dx of mode (z, w), (20 x 3).
  void gradient(const State& s, int z, int w, T* B) const {
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    const T *u = one(z, w), *v = two(z, w);
    for (int a = 0; a < 20; ++a)
      for (int i = 0; i < 3; ++i)
        B[3 * a + i] =
            (centre.dN[0][a][x] * s.one[z][w][i] + u[a] * s.t[x][i] - centre.dN[0][a][y] * s.two[z][w][i] - v[a] * s.t[y][i]) / 2;
  }
};

/// Adds the stabilisation to f, K, energy and dissipated (conventions of SolidCall).
template <class T>
inline void add_hourglass20(const Lame& moduli, const SolidCall<T>& call) {
  using H = Hourglass20<T>;
  const H hg(call.X, moduli);
  T xm[60];
  for (int i = 0; i < 60; ++i) xm[i] = (1 - call.weight) * call.x0[i] + call.weight * call.x1[i];
  const auto s0 = hg.measure(call.x0), s1 = hg.measure(call.x1), sm = hg.measure(xm);
  auto from = s0;
  if (call.viscous != 0)
    solid::add_recalled<6>(call, &from.c[0][0], [&](const T* x, T* to) {
      const auto s = hg.measure(x);
      for (int i = 0; i < 6; ++i) to[i] = s.c[i / 2][i % 2];
    });
  typename H::State before;
  if (call.before) before = hg.measure(call.before);
  const double slope = call.elastic * call.weight + call.viscous;
  T side[3][20];  // [A]: sum of the stresses times the vectors that t_A is multiplied with
  for (int A = 0; A < 3; ++A)
    for (int a = 0; a < 20; ++a) side[A][a] = 0 * xm[0];
  for (int z = 0; z < 3; ++z)
    for (int w = 0; w < 2; ++w) {
      const T k = hg.stiffness[z][w], c0 = s0.c[z][w], c1 = s1.c[z][w], rate = call.viscous * (c1 - from.c[z][w]);
      const T stress = k * (call.elastic * ((1 - call.weight) * c0 + call.weight * c1) + rate);
      if (call.energy) *call.energy += k * c1 * c1 / 2;
      if (call.dissipated) *call.dissipated += k * rate * (c1 - c0);
      T Bm[60], B1[60];
      if (call.f || call.K) hg.gradient(sm, z, w, Bm);
      if (call.f)
        for (int i = 0; i < 60; ++i) call.f[i] += stress * Bm[i];
      if (!call.K) continue;
      hg.gradient(s1, z, w, B1);
      for (int i = 0; i < 60; ++i) {
        const T row = slope * k * Bm[i];
        for (int j = 0; j < 60; ++j) call.K[60 * i + j] += row * B1[j];
      }
      const int x = (z + 1) % 3, y = (z + 2) % 3;
      T c_ahead = c1;
      if (call.before) {  // what the last correction foresaw (solid::foresee)
        hg.gradient(before, z, w, B1);
        c_ahead = before.c[z][w];
        for (int i = 0; i < 60; ++i) c_ahead += B1[i] * call.along[i];
      }
      const T foreseen = k * (call.elastic * ((1 - call.weight) * c0 + call.weight * c_ahead) + call.viscous * (c_ahead - from.c[z][w]));
      const T half = call.weight / 2 * foreseen, *u = hg.one(z, w), *v = hg.two(z, w);
      for (int a = 0; a < 20; ++a) side[x][a] += half * u[a], side[y][a] -= half * v[a];
    }
  if (!call.K) return;
  for (int a = 0; a < 20; ++a)
    for (int b = 0; b < 20; ++b) {
      T geometric = 0 * xm[0];
      for (int A = 0; A < 3; ++A) geometric += H::centre.dN[0][a][A] * side[A][b] + H::centre.dN[0][b][A] * side[A][a];
      for (int i = 0; i < 3; ++i) call.K[(3 * a + i) * 60 + 3 * b + i] += geometric;
    }
}

}  // namespace hilo
