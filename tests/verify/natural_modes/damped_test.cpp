// SPDX-License-Identifier: GPL-3.0-or-later
// Modes that dampers couple, against closed forms: complex ones, and those that creep.
#include <complex>

#include "verify/natural_modes/natural_modes.hpp"

namespace hilo::test::damped_test {
namespace {

// Two masses with a damper between them: the quadratic pencil of 2 x 2 by its own complex arithmetic here.
TEST_F(NaturalModes, WithADamperThatCouplesThemAreComplex) {
  using C = std::complex<double>;
  const double m1 = 2, m2 = 3, k1 = 4000, k2 = 3000, c = 100;
  std::string scene = body("m1", m1, {1, 0, 0}, {1, 1, 1}) + body("m2", m2, {2, 0, 0}, {1, 1, 1});
  for (const char* name : {"1", "2"})
    scene += std::string("[[joint]]\nkind = \"prismatic\"\nname = \"g") + name + "\"\nb = \"m" + name + "\"\nat = [" + name +
             ", 0, 0]\naxis = [1, 0, 0]\n";
  scene +=
      "[[spring]]\nkind = \"axial\"\nname = \"k1\"\nb = \"m1\"\nat_a = [0, 0, 0]\nat_b = [1, 0, 0]\nstiffness = 4000\n"
      "[[spring]]\nkind = \"axial\"\nname = \"k2\"\na = \"m1\"\nb = \"m2\"\nat_a = [1, 0, 0]\nat_b = [2, 0, 0]\nstiffness = 3000\ndamping "
      "= 100\n[[probe]]\nname = \"p1\"\non = \"m1\"\n";
  const auto found = modes(scene, 2);
  ASSERT_EQ(found.rows(), 2);
  const auto pencil = [&](C s) {
    const C a = m1 * s * s + c * s + k1 + k2, b = -c * s - k2, d = m2 * s * s + c * s + k2;
    return std::pair{a * d - b * b, d};
  };
  for (int j = 0; j < 2; ++j) {
    const double w = 2 * pi * found(j, 0), zeta = found(j, 1);
    const C s(-zeta * w, w * std::sqrt(1 - zeta * zeta));
    EXPECT_LT(std::abs(pencil(s).first), 1e-6 * std::norm(s) * std::norm(s) * m1 * m2) << "a pole of the pencil";
  }
  // both pairs, not one twice: the sum and the product of the four poles (Vieta, of det = m1 m2 s^4 + c (m1 + m2) s^3 + ... + k1 k2)
  const auto w = [&](int j) { return 2 * pi * found(j, 0); };
  EXPECT_NEAR(2 * found(0, 1) * w(0) + 2 * found(1, 1) * w(1), c * (1 / m1 + 1 / m2), 1e-6 * c);
  EXPECT_NEAR(w(0) * w(0) * w(1) * w(1) / (k1 * k2 / (m1 * m2)), 1, 1e-6);
  int n = 0;
  for (const Answer& a : answers(work.run("hilo-post response run.h5 --force p1.x --from 1 --to 20 --points 60"))) {
    const auto [det, d] = pencil(C(0, 2 * pi * a.f));
    EXPECT_LT(std::abs(std::polar(a.size, a.phase * pi / 180) * det / d - 1.0), 1e-6) << a.f;
    ++n;
  }
  EXPECT_EQ(n, 60);
}

// Beyond critical damping, and upside down: real poles in pairs.
TEST_F(NaturalModes, ThatCreepHaveRatiosAboveOne) {
  const std::string scene =
      body("mass", 3, {0, 0, 0}, {1, 1, 1}) +
      "[[joint]]\nkind = \"prismatic\"\nname = \"guide\"\nb = \"mass\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n"
      "[[spring]]\nkind = \"bushing\"\nname = \"s\"\nb = \"mass\"\nat = [0, 0, 0]\nstiffness = [0, 0, 1200]\ndamping = [0, 0, 300]\n";
  const auto found = modes(scene, 1);
  EXPECT_NEAR(found(0, 0), std::sqrt(400.) / (2 * pi), 1e-8);
  EXPECT_NEAR(found(0, 1), 300 / (2 * std::sqrt(1200. * 3)), 1e-8);
  const auto falls = modes("gravity = [0, 0, 9.81]\n" + body("arm", 2, {0, 0, -0.5}, {0.1, 0.2, 0.15}) +
                               "[[joint]]\nkind = \"revolute\"\nname = \"pin\"\nb = \"arm\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\n"
                               "[[spring]]\nkind = \"torsion\"\nname = \"d\"\nb = \"arm\"\naxis = [0, 1, 0]\nstiffness = 0\ndamping = 2\n",
                           1);
  const double J = 0.2 + 2 * 0.25, g = 2 * 9.81 * 0.5;
  EXPECT_NEAR(-falls(0, 0) * 2 * pi, (-2 + std::sqrt(4 + 4 * J * g)) / (2 * J), 1e-6);
}

// A cantilever with a damper at its tip, by the beam's own equation.  Its modes without damping do not span the shape: what the equations
// leave on all unknowns tells so, and the span grows.
TEST_F(NaturalModes, OfACantileverWithADamperAtItsTip) {
  using C = std::complex<double>;
  use(beam({1, 0.015, 0.01}, 30));
  const double EI = 2e11 * 0.015 * std::pow(0.01, 3) / 12, rho_A = 8000 * 0.015 * 0.01, c = 8;
  const auto f = modes(steel +
                           "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n[[spring]]\nkind = \"bushing\"\nname = \"d\"\nb "
                           "= \"xmax\"\nat = [1, 0.0075, 0.005]\nstiffness = [0, 0, 0]\ndamping = [0, 0, 8]\n",
                       2);
  // w = A (cosh bx - cos bx) + B (sinh bx - sin bx), b^4 = -rho A s^2/(E I); no moment at the tip, and its shear is the damper's force
  const auto left = [&](C s) {
    const C b = std::pow(-rho_A * s * s / EI, 0.25), ch = std::cosh(b), sh = std::sinh(b), co = std::cos(b), si = std::sin(b);
    const C A = -(sh + si), B = ch + co;
    return EI * b * b * b * (A * (sh - si) + B * (ch + co)) - c * s * (A * (ch - co) + B * (sh - si));
  };
  C s(-5, 50);
  for (int i = 0; i < 100; ++i) {
    const C d = 1e-6 * s;
    s -= left(s) * d / (left(s + d) - left(s));
  }
  EXPECT_LT(s.real(), 0);
  EXPECT_NEAR(f(0, 0) * 2 * pi / std::abs(s), 1, 2e-3);
  EXPECT_NEAR(f(0, 1) / (-s.real() / std::abs(s)), 1, 5e-3);
}

}  // namespace
}  // namespace hilo::test::damped_test
