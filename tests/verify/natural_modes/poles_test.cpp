// SPDX-License-Identifier: GPL-3.0-or-later
// Poles of strong dampers, of dampers on what has no mass, and of what spins, against small dense quadratic problems and closed forms.
#include <Eigen/Dense>
#include <complex>
#include <random>

#include "verify/natural_modes/natural_modes.hpp"

namespace hilo::test::poles_test {
namespace {

using C = std::complex<double>;
using Matrix = Eigen::MatrixXd;

/// s of det(s^2 M + s C + K) = 0, M diagonal; what has no mass is to have damping: C_aa y_a' = -K_a y - C_ab y_b'.
std::vector<C> poles_of(const Matrix& M, const Matrix& damping, const Matrix& K) {
  std::vector<Eigen::Index> a, b, all;
  for (Eigen::Index i = 0; i < M.rows(); ++i) (M(i, i) > 0 ? b : a).push_back(i), all.push_back(i);
  const auto n = std::ssize(all), na = std::ssize(a), nb = std::ssize(b);
  Matrix A = Matrix::Zero(n + nb, n + nb), rates(n, n + nb);  // of positions and of velocities of the masses; y' by these
  rates.setZero();
  for (Eigen::Index j = 0; j < nb; ++j) rates(b[static_cast<size_t>(j)], n + j) = 1;
  Matrix push(n, n + nb);  // forces that positions and velocities of the masses need
  push << K(all, all), damping(all, b);
  if (na > 0) rates(a, Eigen::all) = -damping(a, a).llt().solve(Matrix(push(a, Eigen::all)));
  A.topRows(n) = rates;
  for (Eigen::Index j = 0; j < nb; ++j) {
    const Eigen::Index i = b[static_cast<size_t>(j)];
    A.row(n + j) = -(K.row(i) * Matrix::Identity(n, n + nb) + damping.row(i) * rates) / M(i, i);
  }
  const Eigen::VectorXcd s = A.eigenvalues();
  std::vector<C> out;
  for (const C& x : s)
    if (x.imag() >= 0) out.push_back(x);
  return out;
}
double away(const std::vector<C>& truth, const C& s) {
  double nearest = 1e300;
  for (const C& p : truth) nearest = std::min(nearest, std::abs(p - s) / std::abs(p));
  return nearest;
}
/// What a row of the table says: one pole that swings, two that creep, or one.
std::vector<C> said(double f, double zeta) {
  const double w = 2 * pi * f;
  if (zeta == 1) return {-w};
  if (zeta < 1) return {C(-zeta * w, w * std::sqrt(1 - zeta * zeta))};
  const double fast = -w * (zeta + std::sqrt(zeta * zeta - 1));
  return {w * w / fast, fast};
}

/// Masses on rails in a row, between springs and dampers; of those without mass there is no inertia.
struct Row {
  std::string scene;
  Matrix M, C, K;
  int masses = 0;
  explicit Row(int n) : M(Matrix::Zero(n, n)), C(M), K(M) {}
  void mass(int i, double m) {
    const std::string name = fmt::format("b{}", i);
    scene +=
        m > 0 ? body(name, m, {double(i), 0, 0}, {1, 1, 1}) : fmt::format("[[body]]\nname = \"{}\"\nmass = 0\ncom = [{}, 0, 0]\n", name, i);
    scene += axial("prismatic", "rail of " + name, "ground", name, {double(i), 0, 0}, Vec3::UnitX());
    M(i, i) = m, masses += m > 0;
  }
  /// Between a and b; a = -1: the ground.
  void link(int a, int b, double k, double c) {
    scene +=
        spring("axial", fmt::format("s{} {} {}", a, b, std::ssize(scene)), a < 0 ? "ground" : fmt::format("b{}", a), fmt::format("b{}", b),
               fmt::format("at_a = [{}, {}, 0]\nat_b = [{}, 0, 0]\nstiffness = {:.17g}\ndamping = {:.17g}", a < 0 ? b - 1 : a, 0, b, k, c));
    for (auto [X, x] : {std::pair{&K, k}, std::pair{&C, c}}) {
      (*X)(b, b) += x;
      if (a >= 0) (*X)(a, a) += x, (*X)(a, b) -= x, (*X)(b, a) -= x;
    }
  }
};

class Poles : public NaturalModes {};

// A spring and a damper in series beside a spring, the place between them without mass: m s^2 + k1 + k2 c s/(k2 + c s) = 0.
TEST_F(Poles, OfADamperInSeriesWithASpring) {
  for (const double c : {10., 100., 1000.}) {
    Row row(2);
    row.mass(0, 1), row.mass(1, 0);
    row.link(-1, 0, 1e4, 0), row.link(0, 1, 2e4, 0), row.link(-1, 1, 0, c);
    const auto found = modes(row.scene, 2);
    ASSERT_EQ(found.rows(), 1);
    const C s = said(found(0, 0), found(0, 1)).front();
    EXPECT_LT(std::abs(s * s + 1e4 + 2e4 * c * s / (2e4 + c * s)), 1e-7 * std::norm(s)) << c;
    if (c == 1000) {
      EXPECT_NEAR(found(0, 0), 27.526, 1e-3);
      EXPECT_NE(ran.err.find("creep"), std::string::npos) << ran.err;
    }
  }
}

// A damper so strong that what it stands at creeps, while what hangs on that swings.
TEST_F(Poles, ThatCreepLeaveThoseThatSwing) {
  Row row(2);
  row.mass(0, 20), row.mass(1, 0.5);
  row.link(0, 1, 3e6, 0), row.link(-1, 1, 2e6, 4e4);
  const auto truth = poles_of(row.M, row.C, row.K);
  for (const int wanted : {1, 2}) {
    const auto found = modes(row.scene, wanted);
    ASSERT_EQ(found.rows(), wanted);
    EXPECT_LT((found.col(1).array() - 0.0964).abs().minCoeff(), 1e-3) << found;
    for (int j = 0; j < wanted; ++j)
      for (const C& s : said(found(j, 0), found(j, 1))) EXPECT_LT(away(truth, s), 1e-6) << s;
    EXPECT_EQ(ran.err.find("creep") != std::string::npos, wanted == 1) << ran.err;
  }
}

// Chains of masses, some of them zero, with dampers from next to none to far more than critical ones: all that is listed is true, and all
// that swings is listed.
TEST_F(Poles, OfChainsAreThoseOfTheirMatrices) {
  std::mt19937 random(7);
  const auto any = [&](double low, double high) { return low * std::pow(high / low, std::uniform_real_distribution(0., 1.)(random)); };
  const auto often = [&](double share) { return std::uniform_real_distribution(0., 1.)(random) < share; };
  for (int run = 0; run < 30; ++run) {
    const int n = 2 + run % 6;
    Row row(n);
    for (int i = 0; i < n; ++i) row.mass(i, i > 0 && often(0.3) ? 0 : any(0.1, 10));
    for (int i = 0; i < n; ++i) {
      row.link(i - 1, i, any(1e3, 1e5), row.M(i, i) == 0 || often(0.4) ? any(0.1, 1e5) : 0);
      if (often(0.3)) row.link(-1, i, any(1e3, 1e5), often(0.5) ? any(0.1, 1e5) : 0);
    }
    const auto truth = poles_of(row.M, row.C, row.K);
    const std::ptrdiff_t swing = std::ranges::count_if(truth, [](const C& x) { return x.imag() > 1e-9 * std::abs(x); });
    for (const int wanted : {row.masses, (row.masses + 1) / 2}) {
      const auto found = modes(row.scene, wanted);
      ASSERT_EQ(found.rows(), wanted) << run;
      EXPECT_LT(found.col(8).maxCoeff(), 1e-5);
      for (int j = 0; j < wanted; ++j)
        for (const C& s : said(found(j, 0), found(j, 1))) EXPECT_LT(away(truth, s), 1e-6) << run << ": " << s << "\n" << found;
      if (wanted == row.masses) {
        EXPECT_EQ((found.col(1).array() < 1).count(), swing) << run << "\n" << found;
      }
    }
  }
}

// A cantilever whose tip a strong damper all but holds, by the beam's own equation: a pair that creeps, and one that swings as if pinned.
TEST_F(Poles, OfACantileverWithAStrongDamperAtItsTip) {
  use(beam({1, 0.015, 0.01}, 30));
  const double EI = 2e11 * 0.015 * std::pow(0.01, 3) / 12, rho_A = 8000 * 0.015 * 0.01, c = 300;
  const auto left = [&](C s) {  // w = A (cosh bx - cos bx) + B (sinh bx - sin bx), b^4 = -rho A s^2/(E I)
    const C b = std::pow(-rho_A * s * s / EI, 0.25), ch = std::cosh(b), sh = std::sinh(b), co = std::cos(b), si = std::sin(b);
    const C A = -(sh + si), B = ch + co;
    return (EI * b * b * b * (A * (sh - si) + B * (ch + co)) - c * s * (A * (ch - co) + B * (sh - si))) / (b * b * b);
  };
  std::vector<C> truth;
  for (C s : {C(-16, 0), C(-1185, 0), C(-78, 413)}) {
    for (int i = 0; i < 100; ++i) {
      const C d = 1e-6 * s;
      s -= left(s) * d / (left(s + d) - left(s));
    }
    truth.push_back(s);
  }
  for (const int wanted : {2, 4, 6}) {
    const auto found =
        modes(steel + held("xmin") + bushing("d", "xmax", {1, 0.0075, 0.005}, Vec3::Zero(), "damping = [0, 0, 300]"), wanted);
    std::vector<C> all;
    for (int j = 0; j < found.rows(); ++j)
      for (const C& s : said(found(j, 0), found(j, 1))) all.push_back(s);
    for (const C& s : truth)
      if (wanted > 2 || s.imag() == 0) {
        EXPECT_LT(away(all, s), 1e-2) << wanted << ": " << s << "\n" << found;
      }
  }
}

// A disc on a shaft spring between journals with little mass or none on strong dampers; across the spin 10 x'' + k (x - y) = 0 and
// m y'' + c y' + k (2 y - x) = 0 whatever the spin is.
TEST_F(Poles, OfADiscBetweenDampedJournals) {
  const double k = 1e6;
  for (const auto& [m, c] : {std::pair{0., 1e3}, std::pair{0., 1e4}, std::pair{1e-6, 1e4}, std::pair{1., 1e4}}) {
    Eigen::Matrix2d K, M = Eigen::Vector2d(10, m).asDiagonal(), D = Eigen::Vector2d(0, c).asDiagonal();
    K << k, -k, -k, 2 * k;
    std::vector<C> truth;
    for (const C& s : poles_of(M, D, K))
      if (std::abs(s.imag()) > 1e-3) truth.push_back({s.real(), std::abs(s.imag())});
    for (const double spin : {0., 300.}) {
      const std::string scene =
          body("disc", 10, {0, 0, 0}, {0.2, 0.1, 0.1}) +
          (m > 0 ? body("journal", m, {0, 0, 0}, Vec3::Constant(1e-3 * m))
                 : std::string("[[body]]\nname = \"journal\"\nmass = 0\ncom = [0, 0, 0]\n")) +
          axial("planar", "plane", "ground", "journal", {0, 0, 0}, {1, 0, 0}) +
          axial("in-plane", "along", "ground", "disc", {0, 0, 0}, {1, 0, 0}) +
          spring("bushing", "shaft", "journal", "disc",
                 "at = [0, 0, 0]\naxis = [1, 0, 0]\nstiffness = [1e6, 1e6, 0]\nangular_stiffness = [1e4, 1e4, 0]") +
          spring("bushing", "film", "ground", "journal",
                 fmt::format(
                     "at = [0, 0, 0]\naxis = [1, 0, 0]\nstiffness = [1e6, 1e6, 0]\ndamping = [{0}, {0}, 0]\nangular_stiffness = [0, 0, "
                     "1e3]\nangular_damping = [0, 0, {1}]",
                     c, 1e-2 * c)) +
          (spin > 0 ? initial("disc", fmt::format("spin = [{}, 0, 0]", spin)) : "");
      const auto found = modes(scene, 6);
      for (const C& s : truth) {
        int copies = 0;  // along y and z
        for (int j = 0; j < found.rows(); ++j) copies += away({s}, said(found(j, 0), found(j, 1)).front()) < 1e-6;
        EXPECT_EQ(copies, 2) << m << " " << c << " " << spin << ": " << s << "\n" << found;
      }
    }
  }
}

// Damping that turns along drives forward whirl above its critical speed: with c = beta k, m s^2 + c (s - i spin) + k = 0.
// Fast modes of the light shaft, which this damping lets creep, hide nothing.
TEST_F(Poles, OfADampedShaftWithADisc) {
  const double beta = 1e-4, spin = 200, k = 48 * 2e11 * pi * std::pow(0.01, 4) / 64;
  const auto found = modes(
      "[material.s]\nE = 2e11\nnu = 0.3\ndensity = 1\n[section.c]\nkind = \"circle\"\ndiameter = 0.01\n[beam.w]\npoints = [[0, 0, 0], [1, "
      "0, "
      "0]]\ncells = [8]\nsection = \"c\"\nmaterial = \"s\"\ndamping = 1e-4\nfidelity = \"nonlinear\"\n" +
          body("d", 1, {0.5, 0, 0}, {2e-3, 1e-3, 1e-3}) + joint("spherical", "l", "ground", "w.0", {0, 0, 0}) +
          axial("in-line", "r", "ground", "w.end", {1, 0, 0}, {1, 0, 0}) + joint("fixed", "f", "w.4", "d", {0.5, 0, 0}) +
          "[[initial]]\non = [\"w.*\", \"d\"]\nspin = [200, 0, 0]\nabout = [0, 0, 0]\n",
      8);
  for (const double sign : {-1., 1.}) {
    const C c(beta * k, 0), s = (-c + sign * std::sqrt(c * c - 4.0 * (k - C(0, spin) * c))) / 2.0;
    const double f = std::abs(s) / (2 * pi), zeta = -s.real() / std::abs(s);
    double nearest = 1e300;
    for (int j = 0; j < found.rows(); ++j) nearest = std::min(nearest, std::abs(found(j, 0) / f - 1) + std::abs(found(j, 1) - zeta));
    EXPECT_LT(nearest, 2e-3) << f << " Hz, " << zeta << "\n" << found;
  }
}

}  // namespace
}  // namespace hilo::test::poles_test
