// SPDX-License-Identifier: GPL-3.0-or-later
// Moduli of what bends along the axes of a cell (physics/hourglass.hpp): in the plane p, q of two axes, with no stress across it,
// s = Q (e_pp, e_qq, 2 e_pq), and Young's modulus along one axis.
#pragma once
#include "physics/anisotropic.hpp"

namespace hilo {

template <class T, class Moduli>
struct BendingModuli;

template <class T>
struct BendingModuli<T, Lame> {
  double E = 0, nu = 0, mu = 0;
  BendingModuli() = default;
  BendingModuli(const Lame& c, const T (&)[3][3]) : nu(c.lambda / (2 * (c.lambda + c.mu))), mu(c.mu) { E = 2 * mu * (1 + nu); }
  void plane(int, const T& e1, const T& e2, const T& e3, T s[3]) const {
    const double plane = E / (1 - nu * nu);
    s[0] = plane * (e1 + nu * e2), s[1] = plane * (e2 + nu * e1), s[2] = mu * e3;
  }
  double young(int) const { return E; }
  /// The other strains along the cell's axes where plane r has these.
  void across(int r, const T e[3], T out[6]) const {
    for (int i = 0; i < 6; ++i) out[i] = 0 * e[0];
    out[(r + 1) % 3] = e[0], out[(r + 2) % 3] = e[1], out[3 + r] = e[2], out[r] = -nu / (1 - nu) * (e[0] + e[1]);
  }
};

template <class T>
struct BendingModuli<T, Anisotropic> {
  T compliance[6][6];  // along the cell's axes
  T in_plane[3][3][3];
  BendingModuli() = default;
  BendingModuli(const Anisotropic& c, const T (&axes)[3][3]) {
    T Q[3][3], M[6][6], half[6][6];
    for (int i = 0; i < 3; ++i)
      for (int A = 0; A < 3; ++A) Q[A][i] = axes[i][A];
    strain_turn(Q, M);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        half[i][j] = M[i][0] * c.compliance[0][j];
        for (int k = 1; k < 6; ++k) half[i][j] += M[i][k] * c.compliance[k][j];
      }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        compliance[i][j] = half[i][0] * M[j][0];
        for (int k = 1; k < 6; ++k) compliance[i][j] += half[i][k] * M[j][k];
      }
    for (int r = 0; r < 3; ++r) {
      const int at[3] = {(r + 1) % 3, (r + 2) % 3, 3 + r};
      const auto s = [&](int i, int j) -> const T& { return compliance[at[i % 3]][at[j % 3]]; };
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) in_plane[r][i][j] = s(j + 1, i + 1) * s(j + 2, i + 2) - s(j + 1, i + 2) * s(j + 2, i + 1);
      const T det = s(0, 0) * in_plane[r][0][0] + s(0, 1) * in_plane[r][1][0] + s(0, 2) * in_plane[r][2][0];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) in_plane[r][i][j] = in_plane[r][i][j] / det;
    }
  }
  void plane(int r, const T& e1, const T& e2, const T& e3, T s[3]) const {
    for (int i = 0; i < 3; ++i) s[i] = in_plane[r][i][0] * e1 + in_plane[r][i][1] * e2 + in_plane[r][i][2] * e3;
  }
  T young(int A) const { return 1 / compliance[A][A]; }
  void across(int r, const T e[3], T out[6]) const {
    T s[3];
    plane(r, e[0], e[1], e[2], s);
    for (int i = 0; i < 6; ++i)
      out[i] = compliance[i][(r + 1) % 3] * s[0] + compliance[i][(r + 2) % 3] * s[1] + compliance[i][3 + r] * s[2];
  }
};

}  // namespace hilo
