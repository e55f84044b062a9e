// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/beam_arc.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace hilo {
namespace {

constexpr int nm = ArcLaw::n_measures;

/// A number with its derivatives by the measures at the end of the step.
struct Dual {
  double v = 0;
  Eigen::Matrix<double, nm, 1> d = Eigen::Matrix<double, nm, 1>::Zero();
};
Dual constant(double v) { return {v}; }
Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.d + b.d}; }
Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.d - b.d}; }
Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.v * b.d + b.v * a.d}; }
Dual operator/(const Dual& a, const Dual& b) { return {a.v / b.v, (a.d - (a.v / b.v) * b.d) / b.v}; }
Dual operator*(double a, const Dual& b) { return {a * b.v, a * b.d}; }
Dual operator-(double a, const Dual& b) { return {a - b.v, -b.d}; }

using Dual3 = std::array<Dual, 3>;
Dual3 operator+(const Dual3& a, const Dual3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Dual3 operator-(const Dual3& a, const Dual3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Dual3 operator*(const Dual& s, const Dual3& a) { return {s * a[0], s * a[1], s * a[2]}; }
Dual3 operator*(double s, const Dual3& a) { return {s * a[0], s * a[1], s * a[2]}; }
Dual dot(const Dual3& a, const Dual3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Dual3 cross(const Dual3& a, const Dual3& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }

// f and k as power series in x = 1 - c below `series`, in closed form above
constexpr int n_terms = 26;
constexpr double series = 0.3, near = 1e-3;
struct Series {
  std::array<double, n_terms> f{};
  std::array<double, n_terms - 1> k{};
  constexpr Series() {
    f[0] = 1;
    for (int n = 1; n < n_terms; ++n) f[n] = f[n - 1] * n / (2 * n + 1);
    for (int i = 0; i < n_terms - 1; ++i) {  // of q(x)/(2 - x)
      double half = 0.5;
      for (int j = i; j >= 0; --j, half /= 2) k[i] += (f[j] / 2 - f[j + 1]) * half;
    }
  }
};
constexpr Series by_x;

template <class Coefficients>
Dual horner(const Coefficients& co, const Dual& x) {
  Dual b = constant(co.back());
  for (int n = static_cast<int>(co.size()) - 2; n >= 0; --n) b = constant(co[n]) + x * b;
  return b;
}
/// (q(x1) - q(x0))/(x1 - x0) without cancellation.
template <class Coefficients>
Dual divided(const Coefficients& co, const Dual& x0, const Dual& x1) {
  Dual b = constant(co.back()), d = constant(0);
  for (int n = static_cast<int>(co.size()) - 2; n >= 0; --n) d = b + x1 * d, b = constant(co[n]) + x0 * b;
  return d;
}

Dual far_f(const Dual& c) {
  const double root = 1 - c.v * c.v, f = std::acos(c.v) / std::sqrt(root);
  return {f, (c.v * f - 1) / root * c.d};
}
Dual far_k(const Dual& c) { return (1 - 0.5 * (far_f(c) * (1 - (-1.0) * c))) / (1 - c * c); }
Dual slope_f(const Dual& c) { return ((-1.0) * (1 - c * far_f(c))) / (1 - c * c); }
Dual slope_k(const Dual& c) {
  const Dual f = far_f(c), one_and_c = 1 - (-1.0) * c;
  return (2.0 * (c * far_k(c)) - 0.5 * (slope_f(c) * one_and_c + f)) / (1 - c * c);
}

/// One of the two functions: its value, and its divided difference by c.
template <class Coefficients>
Dual value(const Coefficients& co, Dual (*far)(const Dual&), const Dual& c) {
  return 1 - c.v < series ? horner(co, 1 - c) : far(c);
}
template <class Coefficients>
Dual quotient(const Coefficients& co, Dual (*far)(const Dual&), Dual (*slope)(const Dual&), const Dual& c0, const Dual& c1) {
  if (1 - c0.v < series && 1 - c1.v < series) return (-1.0) * divided(co, 1 - c0, 1 - c1);
  if (std::abs(c1.v - c0.v) >= near) return (value(co, far, c1) - value(co, far, c0)) / (c1 - c0);
  const Dual mean = 0.5 * (c0 + c1), gauss = (0.5 / std::sqrt(3.0)) * (c1 - c0);
  return 0.5 * (slope(mean + gauss) + slope(mean - gauss));
}
Dual f_of(const Dual& c) { return value(by_x.f, far_f, c); }
Dual k_of(const Dual& c) { return value(by_x.k, far_k, c); }

/// Measures of an end of the step.
struct End {
  Dual3 a, p, w, b;  // w = a x p, b = a x w
  Dual c, f, k;
  explicit End(const SpringLaw::Values& e, bool varies) {
    std::array<Dual, nm> x;
    for (int m = 0; m < nm; ++m) {
      x[m].v = e[m];
      if (varies) x[m].d[m] = 1;
    }
    a = {x[0], x[1], x[2]}, p = {x[4], x[5], x[6]};
    c = 0.5 * (x[3] - constant(1));
    f = f_of(c), k = k_of(c), w = cross(a, p), b = cross(a, w);
  }
  /// L times the strains.
  std::array<Dual, 6> strain() const {
    const Dual3 g = p - 0.5 * (f * w) + k * b, K = f * a;
    return {g[0], g[1], g[2], K[0], K[1], K[2]};
  }
};

using Strain = ArcLaw::Strain;
Strain values(const std::array<Dual, 6>& e) { return Strain(e[0].v, e[1].v, e[2].v, e[3].v, e[4].v, e[5].v); }

/// Adds D^T (n, m), D the discrete gradient of L times the strains.
void add_forces(const End& e0, const End& e1, const std::array<Dual, 6>& resultants, Response& out) {
  const Dual3 N{resultants[0], resultants[1], resultants[2]}, M{resultants[3], resultants[4], resultants[5]};
  const Dual3 a = 0.5 * (e0.a + e1.a), p = 0.5 * (e0.p + e1.p), w = 0.5 * (e0.w + e1.w), b = 0.5 * (e0.b + e1.b);
  const Dual f = 0.5 * (e0.f + e1.f), k = 0.5 * (e0.k + e1.k);
  const Dual df = quotient(by_x.f, far_f, slope_f, e0.c, e1.c), dk = quotient(by_x.k, far_k, slope_k, e0.c, e1.c);
  const Dual3 aN = cross(a, N);
  const Dual3 by_a = 0.5 * (f * cross(N, p)) + k * (cross(w, N) - cross(p, aN)) + f * M;
  const Dual3 by_p = N + 0.5 * (f * aN) + k * cross(a, aN);
  const Dual by_t = 0.5 * (dk * dot(b, N) - 0.5 * (df * dot(w, N)) + df * dot(a, M));
  const std::array<Dual, nm> s{by_a[0], by_a[1], by_a[2], by_t, by_p[0], by_p[1], by_p[2]};
  for (int i = 0; i < nm; ++i) {
    out.s[i] += s[i].v;
    for (int j = 0; j < nm; ++j) out.D[i][j] += s[i].d[j];
  }
}

/// C x, with derivatives.
std::array<Dual, 6> times(const ArcLaw::Stiffness& C, const std::array<Dual, 6>& x) {
  std::array<Dual, 6> out;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) out[i] = out[i] + C(i, j) * x[j];
  return out;
}

}  // namespace

ArcLaw::ArcLaw(const Values& e, const Stiffness& C, double beta) : beta_(beta) {
  const Strain at_length_one = hilo::values(End(e, false).strain());
  L_ = at_length_one.head<3>().norm();
  ref_ = at_length_one / L_;
  Stiffness Z = Stiffness::Zero();
  Z.topLeftCorner<3, 3>() = Z.bottomRightCorner<3, 3>() = skew(Vec3(ref_.tail<3>()));
  Z.bottomLeftCorner<3, 3>() = skew(Vec3::UnitZ());
  const Stiffness F = C.inverse();
  C_ = (F + L_ * L_ / 12 * Z.transpose() * F * Z).inverse();
  C_ = (0.5 * (C_ + C_.transpose())).eval();
}

double ArcLaw::turn(const Values& e) { return std::acos(std::clamp((e[3] - 1) / 2, -1.0, 1.0)); }

void ArcLaw::elastic(const Values& r0, const Values& r1, Response& out) const {
  const End e0(r0, false), e1(r1, true);
  const std::array<Dual, 6> x0 = e0.strain(), x1 = e1.strain();
  std::array<Dual, 6> mean;
  for (int i = 0; i < 6; ++i) mean[i] = (0.5 / L_) * (x0[i] + x1[i]) - constant(ref_[i]);
  add_forces(e0, e1, times(C_, mean), out);
  const Strain strain = hilo::values(x1) / L_ - ref_;
  out.energy += L_ / 2 * strain.dot(C_ * strain);
}

ArcLaw::Strain ArcLaw::strain(const Values& e) { return hilo::values(End(e, false).strain()); }

void ArcLaw::resist(const Values& r0, const Values& r1, double factor, const Strain& recalled, Response& out) const {
  const End e0(r0, false), e1(r1, true);
  const std::array<Dual, 6> x0 = e0.strain(), x1 = e1.strain();
  std::array<Dual, 6> change;
  for (int i = 0; i < 6; ++i) change[i] = (factor / L_) * (x1[i] - x0[i] - constant(recalled[i]));
  const std::array<Dual, 6> resultants = times(C_, change);
  add_forces(e0, e1, resultants, out);
  out.dissipated += hilo::values(resultants).dot(hilo::values(x1) - hilo::values(x0));
}

void add_arc_measures(Connector& c, const Config& q, const Vec3& at_a, const Mat3& frame_a, const Vec3& at_b, const Mat3& frame_b) {
  const int from = c.add_point(0, q, at_a), to = c.add_point(1, q, at_b);
  std::array<int, 3> A, B;
  for (int i = 0; i < 3; ++i) A[i] = c.add_direction(0, q, frame_a.col(i)), B[i] = c.add_direction(1, q, frame_b.col(i));
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    c.add_measure({{Term::dot, A[k], B[j], 0, 0.5}, {Term::dot, A[j], B[k], 0, -0.5}});
  }
  c.add_measure({{Term::dot, A[0], B[0]}, {Term::dot, A[1], B[1]}, {Term::dot, A[2], B[2]}});
  for (int i = 0; i < 3; ++i) c.add_measure({{Term::slide, A[i], from, to}});
}

}  // namespace hilo
