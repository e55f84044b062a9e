// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/beam_arc.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace hilo {
namespace {

/// A number with its derivative by c at the second end.
struct Dual {
  double v = 0, d = 0;
};
Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.d + b.d}; }
Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.d - b.d}; }
Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.v * b.d + a.d * b.v}; }
Dual operator/(const Dual& a, const Dual& b) { return {a.v / b.v, (a.d - (a.v / b.v) * b.d) / b.v}; }
Dual operator*(double a, const Dual& b) { return {a * b.v, a * b.d}; }
Dual operator-(double a, const Dual& b) { return {a - b.v, -b.d}; }
Dual operator+(double a, const Dual& b) { return {a + b.v, b.d}; }

Dual horner(const std::array<double, arc::n_terms>& co, const Dual& x) {
  Dual b{co.back()};
  for (int n = arc::n_terms - 2; n >= 0; --n) b = co[n] + x * b;
  return b;
}

Dual far_f(const Dual& c) {
  const double root = 1 - c.v * c.v, f = std::acos(c.v) / std::sqrt(root);
  return {f, (c.v * f - 1) / root * c.d};
}
Dual far_k(const Dual& c) { return (1 - 0.5 * (far_f(c) * (1 + c))) / (1 - c * c); }
Dual slope_f(const Dual& c) { return ((-1.0) * (1 - c * far_f(c))) / (1 - c * c); }
Dual slope_k(const Dual& c) { return (2.0 * (c * far_k(c)) - 0.5 * (slope_f(c) * (1 + c) + far_f(c))) / (1 - c * c); }

/// One of the two functions, by its series, its closed form and the slope of this.
struct Function {
  const std::array<double, arc::n_terms>& series;
  Dual (*far)(const Dual&);
  Dual (*slope)(const Dual&);
  Dual at(const Dual& c) const { return 1 - c.v < arc::series ? horner(series, 1 - c) : far(c); }
  /// Its divided difference: by the slope at two points of Gauss where the difference would cancel.
  Dual quotient(const Dual& c0, const Dual& c1) const {
    constexpr double near = 1e-3;
    if (std::abs(c1.v - c0.v) >= near) return (at(c1) - at(c0)) / (c1 - c0);
    const Dual mean = 0.5 * (c0 + c1), gauss = (0.5 / std::sqrt(3.0)) * (c1 - c0);
    return 0.5 * (slope(mean + gauss) + slope(mean - gauss));
  }
};
const Function f_of_c{arc::by_x.f, far_f, slope_f}, k_of_c{arc::by_x.k, far_k, slope_k};

arc::Measures<double> measures_of(const SpringLaw::Values& e) { return {{e[0], e[1], e[2]}, e[3], {e[4], e[5], e[6]}}; }

using Matrix = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
Eigen::Map<const Matrix> matrix_of(const arc::ArcStiffness<double>& s) { return Eigen::Map<const Matrix>(&s.C[0][0]); }

}  // namespace

arc::TurnFunctions<double> arc::far_turning(double c0, double c1) {
  const Dual start{c0, 0}, end{c1, 1};
  const Dual f1 = f_of_c.at(end), k1 = k_of_c.at(end), df = f_of_c.quotient(start, end), dk = k_of_c.quotient(start, end);
  return {f_of_c.at(start).v, k_of_c.at(start).v, f1.v, k1.v, f1.d, k1.d, df.v, dk.v, df.d, dk.d};
}

ArcStrain arc_strain(const arc::Measures<double>& e) {
  ArcStrain x;
  arc::strain(e, x.data());
  return x;
}

ArcStrain arc_rate(const arc::Measures<double>& e, const arc::Measures<double>& de) {
  ArcStrain x;
  arc::strain_rates<double>(e, de, x.data(), nullptr, nullptr);
  return x;
}

arc::ArcStiffness<double> arc_stiffness(const arc::Measures<double>& e, const std::array<Mat6, 4>& C, const TwistedFibres& fibres) {
  const ArcStrain at_length_one = arc_strain(e);
  const double L = at_length_one.head<3>().norm();
  const ArcStrain reference = at_length_one / L;
  Mat6 Z = Mat6::Zero();
  Z.topLeftCorner<3, 3>() = Z.bottomRightCorner<3, 3>() = skew(Vec3(reference.tail<3>()));
  Z.bottomLeftCorner<3, 3>() = skew(Vec3::UnitZ());
  Mat6 compliance = Mat6::Zero();
  for (size_t k = 0; k < C.size(); ++k) {
    const Mat6 at = Mat6::Identity() - L * (along_arc[k].t - 0.5) * Z;  // forces and moments here of those in the middle
    compliance += along_arc[k].weight * at.transpose() * C[k].inverse() * at;
  }
  const Mat6 stiff = compliance.inverse();
  arc::ArcStiffness<double> out;
  Eigen::Map<Matrix>(&out.C[0][0]) = 0.5 * (stiff + stiff.transpose());
  std::copy_n(fibres.counts_as.data(), 3, out.by_twist);
  out.fibres = fibres.known ? 1 : 0, out.warp = fibres.stiffness;
  arc::fibre_strain(out, reference.data(), out.reference);
  out.length = L;
  return out;
}

Mat6 arc_tangent(const arc::ArcStiffness<double>& of, const ArcStrain& x) {
  const ArcStrain strain = x / of.length;
  double A[6][6] = {}, none[7] = {};
  arc::add_fibre_slopes(of, strain.data(), strain.data(), arc::fibre_slopes(of, strain.data()), none, 1., 0., A);
  return Eigen::Map<const Matrix>(&A[0][0]);
}

double arc_energy(const arc::ArcStiffness<double>& of, const ArcStrain& x) {
  using Fibres = Eigen::Matrix<double, 7, 1>;
  const ArcStrain strain = x / of.length;
  Fibres h;
  arc::fibre_strain(of, strain.data(), h.data());
  h -= Eigen::Map<const Fibres>(of.reference);
  return of.length / 2 * (h.head<6>().dot(matrix_of(of) * h.head<6>()) + of.warp * h[6] * h[6]);
}

double arc_taken(const arc::ArcStiffness<double>& of, const ArcStrain& x0, const ArcStrain& x1, const ArcStrain& recalled) {
  const ArcStrain change = x1 - x0;
  return (matrix_of(of) * (change - recalled)).dot(change) / of.length;
}

double ArcLaw::turn(const arc::Measures<double>& e) { return std::acos(std::clamp((e.t - 1) / 2, -1.0, 1.0)); }

void ArcLaw::add(const Values& e0, const Values& e1, double elastic, double rate, Response& out) const {
  arc::Resultants<double> r;
  double s[n_measures], D[n_measures][n_measures];
  arc::respond(of_, measures_of(e0), measures_of(e1), elastic, rate, static_cast<const double*>(nullptr),
               static_cast<const double*>(nullptr), r, s, D);
  for (int i = 0; i < n_measures; ++i) {
    out.s[i] += s[i];
    for (int j = 0; j < n_measures; ++j) out.D[i][j] += D[i][j];
  }
  const Eigen::Map<const ArcStrain> x0(r.x0), x1(r.x1);
  if (elastic != 0) out.energy += arc_energy(of_, x1);
  if (rate != 0) out.dissipated += Eigen::Map<const ArcStrain>(r.n).dot(x1 - x0);
}

void ArcLaw::elastic(const Values& e0, const Values& e1, Response& out) const { add(e0, e1, 1, 0, out); }

void ArcLaw::viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const {
  if (beta_ > 0) add(r0, r1, 0, beta_ / step.h, out);
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
