// SPDX-License-Identifier: GPL-3.0-or-later
// Change of volume over a step, D = det C = J^2 of C = I + 2E:  D1 - D0 = A:(C1 - C0),  A = cof(C_mean) + cof(C1 - C0)/12, exactly.
//
// A law says by `Bulk` which form the volumetric part of its energy has; nearly incompressible cells take that part by their mean
// (physics/mean_dilatation.hpp).  A form is U(D) per unit of lambda and its difference quotient q = (U1 - U0)/(D1 - D0), so S = 2 lambda q
// A.
#pragma once
#include "physics/lane_functions.hpp"

namespace hilo {

/// lambda/2 (tr E)^2, a function of the trace and not of D.
struct SquareOfTrace {};
/// For laws that are never nearly incompressible.
struct NoBulk {};

/// lambda/2 (ln J)^2 = lambda/8 (ln D)^2:  q = (ln D0 + ln D1)/8 ln(1 + r)/(r D0),  r = (D1 - D0)/D0.
struct LogOfDet {
  template <class T>
  static T energy(const T& D) {
    const T l = log_of(D);
    return l * l / 8;
  }
  template <class T>
  static void quotient(const T& D0, const T& D1, T& q, T& slope) {
    T L = D0, dL = D0;
    log_ratio(T((D1 - D0) / D0), L, dL);
    const T sum = (log_of(D0) + log_of(D1)) / 8;
    q = sum * L / D0;
    slope = (L / (8 * D1) + sum * dL / D0) / D0;
  }
};

/// lambda/2 (J - 1)^2:  q = (J0 + J1 - 2)/(2 (J0 + J1)).
struct SquareOfDet {
  template <class T>
  static T energy(const T& D) {
    const T J = root(D);
    return (J - 1) * (J - 1) / 2;
  }
  template <class T>
  static void quotient(const T& D0, const T& D1, T& q, T& slope) {
    const T J1 = root(D1), sum = root(D0) + J1;
    q = (sum - 2) / (2 * sum);
    slope = 1 / (2 * J1 * sum * sum);
  }
};

namespace volume {

/// Tensor entries of C = I + 2E, so e[3] = 2 E23 = C23.
template <class T>
inline void right_cauchy_green(const T e[6], T C[6]) {
  for (int i = 0; i < 3; ++i) C[i] = 1 + 2 * e[i], C[i + 3] = e[i + 3];
}
template <class T>
inline void cofactor(const T m[6], T c[6]) {
  c[0] = m[1] * m[2] - m[3] * m[3];
  c[1] = m[0] * m[2] - m[4] * m[4];
  c[2] = m[0] * m[1] - m[5] * m[5];
  c[3] = m[5] * m[4] - m[0] * m[3];
  c[4] = m[5] * m[3] - m[1] * m[4];
  c[5] = m[4] * m[3] - m[2] * m[5];
}
template <class T>
inline T determinant(const T m[6], const T cof[6]) {
  return m[0] * cof[0] + m[5] * cof[5] + m[4] * cof[4];
}

/// det C - 1, with all its digits where the strain is small.
template <class T>
inline T swelling(const T e[6]) {
  T m[6], cof[6];
  for (int i = 0; i < 3; ++i) m[i] = 2 * e[i], m[i + 3] = e[i + 3];
  cofactor(m, cof);
  return m[0] + m[1] + m[2] + (cof[0] + cof[1] + cof[2]) + determinant(m, cof);
}

/// D at both ends of a step, A, and the cofactor at its end; M = mean/2 + step/12 is what dA/dC1 is made of.
template <class T>
inline void over_step(const T e0[6], const T e1[6], T M[6], T A[6], T cof1[6], T& D0, T& D1) {
  T C0[6], C1[6], mean[6], step[6], cof0[6], cof_step[6];
  right_cauchy_green(e0, C0);
  right_cauchy_green(e1, C1);
  for (int i = 0; i < 6; ++i) mean[i] = (C0[i] + C1[i]) / 2, step[i] = C1[i] - C0[i];
  cofactor(C0, cof0);
  cofactor(C1, cof1);
  cofactor(mean, A);
  cofactor(step, cof_step);
  for (int i = 0; i < 6; ++i) A[i] += cof_step[i] / 12, M[i] = mean[i] / 2 + step[i] / 12;
  D0 = determinant(C0, cof0), D1 = determinant(C1, cof1);
}
/// D += f dcof(M), columns in strain form (off-diagonal variation counted once).
template <class T>
inline void add_cofactor_slope(const T M[6], const T& f, T (*D)[6]) {
  D[0][1] += f * M[2], D[0][2] += f * M[1], D[0][3] -= f * M[3];
  D[1][0] += f * M[2], D[1][2] += f * M[0], D[1][4] -= f * M[4];
  D[2][0] += f * M[1], D[2][1] += f * M[0], D[2][5] -= f * M[5];
  D[3][0] -= f * M[3], D[3][3] -= f * M[0] / 2, D[3][4] += f * M[5] / 2, D[3][5] += f * M[4] / 2;
  D[4][1] -= f * M[4], D[4][4] -= f * M[1] / 2, D[4][3] += f * M[5] / 2, D[4][5] += f * M[3] / 2;
  D[5][2] -= f * M[5], D[5][5] -= f * M[2] / 2, D[5][3] += f * M[4] / 2, D[5][4] += f * M[3] / 2;
}

}  // namespace volume
}  // namespace hilo
