// SPDX-License-Identifier: GPL-3.0-or-later
// Mooney-Rivlin rubber [mooney-1940, rivlin-1948], compressible:
//
//   W = c10 (I1/J^(2/3) - 3) + c01 (I2/J^(4/3) - 3) + K/2 (J - 1)^2,    C = I + 2E, J^2 = D = det C,
//   I1 = tr C,  I2 = ((tr C)^2 - C:C)/2;   at small strain mu = 2 (c10 + c01) and bulk modulus K.  c01 = 0 is the neo-Hookean solid of
//   decks.
//
// Over a step each factor has an exact difference quotient: I1 changes by I : dC, I2 by (tr C_m I - C_m) : dC, D by A : dC
// (dilatation.hpp), and with a^3 = D0, b^3 = D1
//
//   1/b - 1/a = -dD/(ab (a^2 + ab + b^2)),     1/b^2 - 1/a^2 = -(a + b) dD/(a^2 b^2 (a^2 + ab + b^2))
//
// so by the rule of products, f1 g1 - f0 g0 = f_m (g1 - g0) + g_m (f1 - f0), S.(E1 - E0) = W1 - W0 without any cancellation.
#pragma once
#include "physics/lane_functions.hpp"
#include "physics/material/dilatation.hpp"
#include "physics/material/material.hpp"

namespace hilo {

struct MooneyRivlin {
  static constexpr std::string_view name = "mooney-rivlin",
                                    meaning = "rubber: Mooney and Rivlin, compressible; c01 = 0: neo-Hooke of decks";
  static std::vector<Param> keys() {
    return {{"c10", Type::number, "Pa", "!", "factor of the first invariant; shear modulus 2 (c10 + c01)"},
            {"c01", Type::number, "Pa", "0", "factor of the second invariant"},
            {"bulk", Type::number, "Pa", "!", "bulk modulus K (2/D1 of decks)", above(0)}};
  }
  static MooneyRivlin make(const MaterialValues& v) {
    const MooneyRivlin out{v.number("c10"), v.number("c01"), v.number("bulk")};
    if (!(out.c10 + out.c01 > 0)) v.refuse("c10", "c10 + c01 is half the shear modulus and must be above 0");
    return out;
  }
  using Bulk = SquareOfDet;
  static constexpr double soft_below = 0;
  static constexpr std::string_view soft_because = "";

  double c10, c01, K;  // [Pa]

  Lame linear() const { return {K - 4. / 3 * (c10 + c01), 2 * (c10 + c01)}; }
  MooneyRivlin with_lambda(double lambda) const { return {c10, c01, lambda + 4. / 3 * (c10 + c01)}; }

  template <class T>
  T energy(const T e[6]) const {
    // I1 = 3 + i1, I2 = 3 + i2, a = D^(1/3) = 1 + b: what is left of the threes has all its digits
    T m[6];
    for (int i = 0; i < 3; ++i) m[i] = 2 * e[i], m[i + 3] = e[i + 3];
    const T log_D = log_of_1_and(volume::swelling(e)), i1 = trace(m), i2 = 2 * i1 + second(m);
    const T b = exp_less_1(T(log_D / 3)), a = 1 + b, J_less_1 = exp_less_1(T(log_D / 2));
    return c10 * (i1 - 3 * b) / a + c01 * (i2 - 3 * b * (2 + b)) / (a * a) + K / 2 * J_less_1 * J_less_1;
  }

  template <class T>
  void stress(const T e0[6], const T e1[6], T s[6], T (*D)[6]) const {
    T M[6], A[6], cof1[6], D0 = 0 * e0[0], D1 = D0, C0[6], C1[6], mean[6];
    volume::over_step(e0, e1, M, A, cof1, D0, D1);
    volume::right_cauchy_green(e0, C0);
    volume::right_cauchy_green(e1, C1);
    for (int i = 0; i < 6; ++i) mean[i] = (C0[i] + C1[i]) / 2;
    const T a = cube_root(D0), b = cube_root(D1), ab = a * b, three = a * a + ab + b * b;
    const T f = (1 / a + 1 / b) / 2, g = (1 / (a * a) + 1 / (b * b)) / 2, I1 = trace(mean), I2 = (second(C0) + second(C1)) / 2;
    const T fq = -1 / (ab * three), gq = (a + b) / ab * fq;
    T vq = D0, vq_1 = D0;  // (.)_1: derivative by D1
    SquareOfDet::quotient(D0, D1, vq, vq_1);
    const T unit = 2 * (c10 * f + c01 * g * I1), on_C = -2 * c01 * g, on_A = 2 * (c10 * I1 * fq + c01 * I2 * gq + K * vq);
    for (int i = 0; i < 3; ++i) s[i] = unit + on_C * mean[i] + on_A * A[i], s[i + 3] = on_C * mean[i + 3] + on_A * A[i + 3];
    if (!D) return;
    // b_1 = 1/(3 b^2);  1/fq = -(a^3 b + a^2 b^2 + a b^3)
    const T b_1 = 1 / (3 * b * b), fq_1 = fq * fq * (a * a * a + 2 * a * ab + 3 * ab * b) * b_1;
    const T f_1 = -b_1 / (2 * b * b), g_1 = -b_1 / (b * b * b), gq_1 = (a + b) / ab * fq_1 - fq * b_1 / (b * b);
    const T unit_1 = 2 * (c10 * f_1 + c01 * g_1 * I1), on_C_1 = -2 * c01 * g_1, on_A_1 = 2 * (c10 * I1 * fq_1 + c01 * I2 * gq_1 + K * vq_1),
            tr1 = trace(C1);
    for (int i = 0; i < 6; ++i) {
      const double delta = i < 3 ? 1 : 0;
      const T by_D = delta * unit_1 + on_C_1 * mean[i] + on_A_1 * A[i], by_trace = c10 * fq * A[i] + c01 * delta * g,
              by_second = c01 * gq * A[i];
      for (int j = 0; j < 6; ++j) {  // of a function of C1 with gradient G: 2 G_j de_j
        T v = by_D * cof1[j] - by_second * C1[j];
        if (j < 3) v += by_trace + by_second * tr1;
        D[i][j] += 2 * v;
      }
      D[i][i] += (i < 3 ? 1 : 0.5) * on_C;
    }
    volume::add_cofactor_slope(M, T(2 * on_A), D);
  }

 private:
  template <class T>
  static T trace(const T C[6]) {
    return C[0] + C[1] + C[2];
  }
  template <class T>
  static T second(const T C[6]) {
    return C[0] * C[1] + C[1] * C[2] + C[2] * C[0] - C[3] * C[3] - C[4] * C[4] - C[5] * C[5];
  }
};

}  // namespace hilo
