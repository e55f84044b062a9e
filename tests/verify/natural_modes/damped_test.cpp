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
  for (const double x : {1., 2.})
    scene += axial("prismatic", fmt::format("g{}", x), "ground", fmt::format("m{}", x), {x, 0, 0}, Vec3::UnitX());
  scene += spring("axial", "k1", "ground", "m1", "at_a = [0, 0, 0]\nat_b = [1, 0, 0]\nstiffness = 4000") +
           spring("axial", "k2", "m1", "m2", "at_a = [1, 0, 0]\nat_b = [2, 0, 0]\nstiffness = 3000\ndamping = 100") + probe("p1", "m1");
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
  const std::string scene = body("mass", 3, {0, 0, 0}, {1, 1, 1}) +
                            axial("prismatic", "guide", "ground", "mass", Vec3::Zero(), Vec3::UnitZ()) +
                            bushing("s", "mass", Vec3::Zero(), {0, 0, 1200}, "damping = [0, 0, 300]");
  const auto found = modes(scene, 1);
  EXPECT_NEAR(found(0, 0), std::sqrt(400.) / (2 * pi), 1e-8);
  EXPECT_NEAR(found(0, 1), 300 / (2 * std::sqrt(1200. * 3)), 1e-8);
  const auto falls =
      modes("gravity = [0, 0, 9.81]\n" + body("arm", 2, {0, 0, -0.5}, {0.1, 0.2, 0.15}) + pin("pin", "ground", "arm", Vec3::Zero()) +
                spring("torsion", "d", "ground", "arm", "axis = [0, 1, 0]\nstiffness = 0\ndamping = 2"),
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
  const auto f = modes(steel + held("xmin") + bushing("d", "xmax", {1, 0.0075, 0.005}, Vec3::Zero(), "damping = [0, 0, 8]"), 2);
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

// A row of masses between springs, a third of them on strong dampers, which couple the modes asked for to many above them.
TEST_F(NaturalModes, StrongDampersCoupleThoseAskedForToManyOthers) {
  constexpr int n = 150, wanted = 30;
  constexpr double dampers[] = {0, 0, 30, 0, 0, 4};
  const auto mass = [](int i) { return 1 + 0.1 * (i % 7); };
  std::string scene;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n), K = Eigen::MatrixXd::Zero(n, n);
  A.topRightCorner(n, n).setIdentity();
  const auto link = [&](const std::string& name, const std::string& a, const std::string& b, double x, double k, double c) {
    scene += spring("bushing", name, a, b, fmt::format("at = [{}, 0, 0]\nstiffness = [0, 0, {}]\ndamping = [0, 0, {}]", x, k, c));
  };
  for (int i = 0; i < n; ++i) {
    const double c = dampers[i % 6];
    scene += body(fmt::format("b{}", i), mass(i), {double(i), 0, 0}, {1, 1, 1}) +
             axial("prismatic", fmt::format("j{}", i), "ground", fmt::format("b{}", i), {double(i), 0, 0}, Vec3::UnitZ());
    link(fmt::format("s{}", i), "ground", fmt::format("b{}", i), i, 10 * (i + 1), c);
    K(i, i) += 10 * (i + 1), A(n + i, n + i) = -c / mass(i);
    if (i == 0) continue;
    link(fmt::format("t{}", i), fmt::format("b{}", i - 1), fmt::format("b{}", i), i - 0.5, 1e4, 0);
    K(i, i) += 1e4, K(i - 1, i - 1) += 1e4, K(i, i - 1) -= 1e4, K(i - 1, i) -= 1e4;
  }
  for (int i = 0; i < n; ++i) A.row(n + i).head(n) = -K.row(i) / mass(i);
  const Eigen::VectorXcd truth = A.eigenvalues();
  const auto found = modes(scene, wanted);
  for (int j = 0; j < found.rows(); ++j) {  // the root of the product of a pair, and its damping ratio
    double nearest = 1e300;
    for (const auto& p : truth)
      nearest =
          std::min(nearest, std::abs(std::abs(p) / (2 * pi) - found(j, 0)) / found(j, 0) + std::abs(-p.real() / std::abs(p) - found(j, 1)));
    EXPECT_LT(nearest, 1e-6) << found(j, 0) << " Hz, " << found(j, 1);
  }
}

// A part that rests on a stop or on a support: the restitution of either is a law of impacts, and takes nothing of a vibration.
TEST_F(NaturalModes, OnAStopTakeNoRestitution) {
  const double m = 2, k = 5000, c = 30;
  const std::string part = "gravity = [0, 0, -10]\n" + body("a", m, {0, 0, 0}, {0.01, 0.01, 0.01}) +
                           axial("prismatic", "j", "ground", "a", {0, 0, 0}, Vec3::UnitZ()) +
                           bushing("b", "a", {0, 0, 0}, {0, 0, 100}, fmt::format("damping = [0, 0, {}]", c)),
                    end = "[time]\nanalysis = \"modes\"\nstart = \"equilibrium\"\n",
                    stop = "[[stop]]\nkind = \"slide\"\nname = \"s\"\njoint = \"j\"\nlower = -0.01\nstiffness = 5000\nrestitution = 0.5\n",
                    support =
                        spring("support", "s", "ground", "a", "at = [0, 0, 0]\naxis = [0, 0, 1]\nstiffness = 5000\nrestitution = 0.5");
  const double ratio = c / (2 * std::sqrt((k + 100) * m));
  for (const std::string& on : {stop, support}) {
    work.write("scene.toml", part + on + end);
    succeeded(work.run("hilo-solve scene.toml -o run.h5"));
    const Eigen::MatrixXd found = Results(work / "run.h5").history("mode");
    EXPECT_NEAR(found(1, 0) * 2 * pi / std::sqrt((k + 100) / m), 1, 1e-5) << on;
    EXPECT_NEAR(found(1, 1) / ratio, 1, 1e-4) << on;
  }
}

// What the warning of friction that sticks names is what takes the motion: of two frictions the one that does, and none where a damper
// does.
TEST_F(NaturalModes, ThatStickNameTheFrictionThatHoldsThem) {
  const auto slide = [](const std::string& name, double at, double coefficient, double damping) {
    return body(name, 1, {at, 0, 0}, {0.01, 0.01, 0.01}) + axial("prismatic", "j" + name, "ground", name, {at, 0, 0}, Vec3::UnitZ()) +
           bushing("b" + name, name, {at, 0, 0}, {0, 0, 100}, fmt::format("damping = [0, 0, {}]", damping)) +
           fmt::format("[[friction]]\nname = \"f{0}\"\njoint = \"j{0}\"\ncoefficient = {1}\npreload = 1\nslip_velocity = 1e-3\n", name,
                       coefficient);
  };
  const auto told = [&](const std::string& scene) {
    work.write("scene.toml", scene + "[time]\nanalysis = \"modes\"\n");
    const Ran done = work.run("hilo-solve scene.toml -o run.h5");
    EXPECT_EQ(done.exit, 0) << done.err;
    return done.err;
  };
  const std::string both = told(slide("u", 0, 1e-6, 0) + slide("v", 1, 0.3, 0));
  EXPECT_EQ(both.find("friction \"fu\": at rest it is a damper"), std::string::npos) << both;
  EXPECT_NE(both.find("friction \"fv\": at rest it is a damper"), std::string::npos) << both;
  const std::string damper = told(slide("u", 0, 1e-6, 300));
  EXPECT_EQ(damper.find("at rest it is a damper"), std::string::npos) << damper;
}

// A vehicle on eight arms has 22 modes: what else the factors show of a space that is exhausted is rounding.
TEST_F(NaturalModes, AreNoMoreThanThereAre) {
  std::string scene = body("hull", 20000, {0, 0, 1}, {2e4, 5e4, 6e4});
  for (int k = 0; k < 8; ++k) {
    const double x = 1.85 - 1.3 * (k / 2), y = k % 2 ? -1.1 : 1.1;
    const std::string arm = fmt::format("arm{}", k), wheel = fmt::format("wheel{}", k);
    scene += body(arm, 104, {x + 0.2, y, 0.57}, {1, 8, 8}) + body(wheel, 152, {x, y, 0.42}, {8, 13, 8}) +
             pin("pivot of " + arm, "hull", arm, {x + 0.45, y, 0.72}) + pin("axle of " + wheel, arm, wheel, {x, y, 0.42}) +
             spring("torsion", "bar of " + arm, "hull", arm, "axis = [0, 1, 0]\nstiffness = 6e4\ndamping = 3200") +
             spring("torsion", "brake of " + wheel, arm, wheel, "axis = [0, 1, 0]\nstiffness = 1e6\ndamping = 2000") +
             bushing("tyre of " + wheel, wheel, {x, y, 0}, {1e6, 8e5, 1.5e6}, "damping = [1e4, 1e4, 1.2e4]");
  }
  for (const int wanted : {40, 100}) {
    const auto all = modes(scene, wanted);
    EXPECT_EQ(all.rows(), 6 + 8 + 8);
    EXPECT_LT(all.col(0).maxCoeff(), 60) << "Hz";
  }
}

}  // namespace
}  // namespace hilo::test::damped_test
