// SPDX-License-Identifier: GPL-3.0-or-later
// Moduli that differ with direction, and how they turn: strains and stresses are six numbers (material/voigt.hpp).
#pragma once
#include <Eigen/LU>

#include "base/math.hpp"
#include "physics/material/voigt.hpp"

namespace hilo {

/// M of e' = M e for E' = Q E Q^T.
template <class T>
inline void strain_turn(const T Q[3][3], T M[6][6]) {
  constexpr int I[6] = {0, 1, 2, 1, 0, 0}, J[6] = {0, 1, 2, 2, 2, 1};
  for (int k = 0; k < 6; ++k)
    for (int m = 0; m < 6; ++m) {
      const int i = I[k], j = J[k], a = I[m], b = J[m];
      M[k][m] = m < 3 ? T(Q[i][a] * Q[j][a]) : T((Q[i][a] * Q[j][b] + Q[i][b] * Q[j][a]) / 2);
      if (k >= 3) M[k][m] = 2 * M[k][m];
    }
}

/// S = C e and e = compliance S, in the axes of the model.
struct Anisotropic {
  double C[6][6], compliance[6][6];  // [Pa], [1/Pa]

  Anisotropic() = default;
  /// From the compliance in the material's own axes, the columns of R.
  Anisotropic(const Mat6& own, const Mat3& R) {
    double Q[3][3], M[6][6];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) Q[i][j] = R(i, j);
    strain_turn(Q, M);
    const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> turn(M[0]);
    const Mat6 turned = turn * own * turn.transpose(), stiffness = turned.inverse();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) C[i][j] = (stiffness(i, j) + stiffness(j, i)) / 2, compliance[i][j] = turned(i, j);
  }

  template <class T>
  void stress(const T e[6], T s[6]) const {
    for (int i = 0; i < 6; ++i) {
      s[i] = C[i][0] * e[0];
      for (int j = 1; j < 6; ++j) s[i] += C[i][j] * e[j];
    }
  }
  template <class T>
  void add_tangent(double factor, T D[6][6]) const {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[i][j] += factor * C[i][j];
  }
  /// The isotropic moduli of the mean compliance over all directions (Reuss), the softer of the two usual means.
  Lame near_isotropic() const {
    const auto& s = compliance;
    const double diagonal = s[0][0] + s[1][1] + s[2][2], off = s[0][1] + s[0][2] + s[1][2], shear = s[3][3] + s[4][4] + s[5][5];
    const double K = 1 / (diagonal + 2 * off), mu = 15 / (4 * diagonal - 4 * off + 3 * shear);
    return {K - 2 * mu / 3, mu};
  }
};

/// A law whose moduli differ with direction.
template <class M>
concept Directed = requires(const M& law) {
  law.moduli.compliance;
};

/// Moduli at small strain: Lame's, or all of them.
template <class M>
inline auto moduli_of(const M& law) {
  if constexpr (Directed<M>)
    return law.moduli;
  else
    return law.linear();
}

}  // namespace hilo
