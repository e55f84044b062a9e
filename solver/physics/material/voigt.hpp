// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric tensors as six numbers: 11 22 33 23 13 12; strains carry 2 E_ij off the diagonal, stresses do not.
#pragma once

namespace hilo {

/// Lame parameters [Pa].
struct Lame {
  double lambda, mu;
};
constexpr Lame lame(double E, double nu) { return {E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))}; }
/// Young's modulus [Pa].
constexpr double young_of(const Lame& c) { return c.mu * (3 * c.lambda + 2 * c.mu) / (c.lambda + c.mu); }

/// s = C : e for the isotropic linear law.
template <class T>
inline void linear_stress(const Lame& c, const T e[6], T s[6]) {
  const T tr = c.lambda * (e[0] + e[1] + e[2]);
  for (int i = 0; i < 3; ++i) s[i] = tr + 2 * c.mu * e[i], s[i + 3] = c.mu * e[i + 3];
}

/// D += factor C.
template <class T>
inline void add_linear_tangent(const Lame& c, double factor, T D[6][6]) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) D[i][j] += factor * c.lambda;
    D[i][i] += factor * 2 * c.mu;
    D[i + 3][i + 3] += factor * c.mu;
  }
}

}  // namespace hilo
