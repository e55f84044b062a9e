// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/material/ogden.hpp"

#include <algorithm>
#include <cmath>

#include "physics/material/principal_axes.hpp"

namespace hilo {
namespace {

/// x^p[a, b] = (b^p - a^p)/(b - a) = a^(p - 1) expm1(p ln(1 + d))/d,  d = (b - a)/a.
double first_difference(double a, double b, double p) {
  const double d = (b - a) / a;
  return std::pow(a, p - 1) * (d == 0 ? p : std::expm1(p * std::log1p(d)) / d);
}

/// x^p[a, b, c], about the mean m of the three where they are close: m^(p - 2) sum_n binomial(p, n + 2) h_n, h_n the complete symmetric
/// polynomials of x/m - 1.
double second_difference(double a, double b, double c, double p) {
  if (a > c) std::swap(a, c);
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  const double m = (a + b + c) / 3;
  if (c - a > 0.01 * m) return (first_difference(b, c, p) - first_difference(a, b, p)) / (c - a);
  const double u = (a - m) / m, v = (b - m) / m, w = (c - m) / m;
  double power[3] = {1, 1, 1}, factor = p * (p - 1) / 2, sum = factor;
  for (int n = 1; n < 9; ++n) {
    power[0] *= u, power[1] = power[0] + v * power[1], power[2] = power[1] + w * power[2];
    factor *= (p - n - 1) / (n + 2);
    sum += factor * power[2];
  }
  return std::pow(m, p - 2) * sum;
}

Mat3 tensor(const double v[6], double shear) {
  Mat3 m;
  m << v[0], shear * v[5], shear * v[4], shear * v[5], v[1], shear * v[3], shear * v[4], shear * v[3], v[2];
  return m;
}
Vec6 six(const Mat3& m) {
  Vec6 v;
  v << m(0, 0), m(1, 1), m(2, 2), (m(1, 2) + m(2, 1)) / 2, (m(0, 2) + m(2, 0)) / 2, (m(0, 1) + m(1, 0)) / 2;
  return v;
}

/// Principal axes and values of C.
struct Principal {
  Mat3 axes;
  Vec3 c, log_c;
  double log_D = 0;
  explicit Principal(const double e[6]) {
    Vec3 values;
    principal_axes(tensor(e, 0.5), axes, values);
    for (int i = 0; i < 3; ++i) c[i] = 1 + 2 * values[i], log_c[i] = std::log1p(2 * values[i]), log_D += log_c[i];
  }
};

}  // namespace

double Ogden::energy_at(const double e[6]) const {
  const Principal at(e);
  const double J_less_1 = std::expm1(at.log_D / 2);
  double W = K / 2 * J_less_1 * J_less_1;
  for (const Term& t : terms) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += std::expm1(t.alpha / 2 * (at.log_c[i] - at.log_D / 3));
    W += 2 * t.mu / (t.alpha * t.alpha) * sum;
  }
  return W;
}

void Ogden::step(const double e0[6], const double e1[6], double s[6], double* slope) const {
  const Principal zero(e0), one(e1);
  const Mat3 &N = one.axes, &M0 = zero.axes, P = N.transpose() * M0;
  double M[6], cof1[6], D0, D1, vq, vq_1;
  Vec6 A;
  volume::over_step(e0, e1, M, A.data(), cof1, D0, D1);
  SquareOfDet::quotient(D0, D1, vq, vq_1);
  double on_A = 2 * K * vq, on_A_1 = 2 * K * vq_1;  // S = ... + on_A A;  _1: by D1
  Vec6 S = Vec6::Zero(), by_D = Vec6::Zero();       // by_D: dS/dD1 besides
  Mat3 by_trace = Mat3::Zero();                     // d(on_A)/dC1 besides that by D1
  double G2[3][3][3] = {};                          // second differences, all terms
  for (const Term& t : terms) {
    const double p = t.alpha / 2, r = -p / 3, w = 4 * t.mu / (t.alpha * t.alpha);
    const double f = (std::exp(r * zero.log_D) + std::exp(r * one.log_D)) / 2, fq = first_difference(D0, D1, r);
    double sum = 0;
    Mat3 first;
    for (int i = 0; i < 3; ++i) {
      sum += (std::pow(one.c[i], p) + std::pow(zero.c[i], p)) / 2;
      for (int j = 0; j < 3; ++j) first(i, j) = first_difference(one.c[i], zero.c[j], p) * P(i, j);
    }
    const Vec6 G = six(N * first * M0.transpose());
    S += w * f * G, on_A += w * sum * fq;
    if (!slope) continue;
    by_D += w / 2 * r * std::exp((r - 1) * one.log_D) * G;
    on_A_1 += w * sum * second_difference(D1, D1, D0, r);
    for (int i = 0; i < 3; ++i) {
      by_trace += w * fq / 2 * p * std::pow(one.c[i], p - 1) * N.col(i) * N.col(i).transpose();
      for (int k = i; k < 3; ++k)
        for (int j = 0; j < 3; ++j) {
          G2[i][k][j] += w * f * second_difference(one.c[i], one.c[k], zero.c[j], p);
          G2[k][i][j] = G2[i][k][j];
        }
    }
  }
  S += on_A * A;
  std::copy(S.data(), S.data() + 6, s);
  if (!slope) return;
  double cofactor_part[6][6] = {};
  volume::add_cofactor_slope(M, 2 * on_A, cofactor_part);
  for (int q = 0; q < 6; ++q) {
    double unit[6] = {};
    unit[q] = 1;
    const Mat3 x = 2 * tensor(unit, 0.5), local = N.transpose() * x * N;
    Mat3 second;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        second(i, j) = local(i, 0) * G2[i][0][j] * P(0, j) + local(i, 1) * G2[i][1][j] * P(1, j) + local(i, 2) * G2[i][2][j] * P(2, j);
    const double dD = 2 * cof1[q];
    const Vec6 column = six(N * second * M0.transpose()) + dD * (by_D + on_A_1 * A) + by_trace.cwiseProduct(x).sum() * A;
    for (int i = 0; i < 6; ++i) slope[6 * i + q] = column[i] + cofactor_part[i][q];
  }
}

}  // namespace hilo
