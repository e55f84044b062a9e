// SPDX-License-Identifier: GPL-3.0-or-later
// The first and the last row of what belongs to the inside of steps: forces of an unbalanced rotor, and of states of rest.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::end_rows_test {
namespace {

/// 1 kg on a hinge along z, 0.1 m off, 0.02 kg m^2 about it.
std::string rotor(const std::string& drive = "") {
  return body("a", 1, {0.1, 0, 0}, {0.01, 0.01, 0.01}) + joint("revolute", "j", "ground", "a", Vec3::Zero(), "axis = [0, 0, 1]\n" + drive);
}

// Truth: m r w^2 = 1000 N throughout, in 20 steps a turn.  The first row is that of the start; the last one of methods whose forces belong
// to the middle of steps is extrapolated along a parabola, which is off by the fourth order in size.
TEST(EndRows, OfAnUnbalancedRotor) {
  const Workplace w;
  w.write("scene.toml", rotor("spin = 100\n") + in_time(0.0628318530717958, 0.003141592653589793));

  const std::vector<std::pair<std::string, double>> methods{
      {"gauss", 1e-3}, {"energy-momentum", 16}, {"mid-point", 16}, {"radau", 8}, {"generalized-alpha", 40}};
  for (const auto& [method, last] : methods) {
    succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 --set 'time.integrator=\"" + method + "\"'"));
    const auto f = Results(w / "run.h5").history("joint/j");
    EXPECT_NEAR(f.row(0).head(3).norm(), 1000, 1e-6) << method;
    EXPECT_NEAR(f.row(f.rows() - 1).head(3).norm(), 1000, last) << method;
  }
}

// Truth: w = 10 + 100 t about a hinge 0.1 m off, which then holds m r w^2 and m r dw/dt.  Nothing rings after the start or after a jump of
// the load: a fourth of the error at half the step, in all rows.
TEST(EndRows, FollowedByWhatDoesNotRing) {
  const Workplace w;
  w.write("scene.toml",
          rotor() +
              "[[initial]]\non = [\"a\"]\nspin = [0, 0, 10]\nabout = [0, 0, 0]\n[[load]]\nkind = \"torque\"\nname = \"t\"\non = \"a\"\n"
              "torque = [0, 0, 2]\nhistory = {t = [0, 0.02, 0.02, 1], value = [1, 1, 3, 3]}\n" +
              in_time(0.04, 1e-3));

  for (const std::string method : {"generalized-alpha", "hht", "wbz", "energy-momentum"}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const double h = 1e-3 / (1 << k);
      succeeded(w.run(fmt::format("hilo-solve --quiet scene.toml -o run.h5 --set 'time.integrator=\"{}\"' --set time.step={}", method, h)));
      const auto f = Results(w / "run.h5").history("joint/j");
      error[k] = 0;
      for (Eigen::Index i = 0; i < f.rows(); ++i) {
        const double t = h * double(i), past = std::max(0., t - 0.02), speed = 10 + 100 * t + 200 * past,
                     rate = i * h > 0.02 - 1e-9 ? 300 : 100;
        error[k] = std::max(error[k], std::abs(f.row(i).head(3).norm() - 0.1 * std::hypot(speed * speed, rate)));
      }
    }
    EXPECT_LT(error[0], 0.03) << method;
    EXPECT_GT(error[0] / error[1], 3.3) << method;
  }
}

// Truth: the same bits as in one run, also at the former end, where the force jumps from 10 to -20 N.
TEST(EndRows, AtAJumpWhereTheRunHadEnded) {
  const Workplace w;
  w.write("scene.toml", body("a", 1, Vec3::Zero(), {1, 1, 1}) +
                            force("f", "a", {10, 0, 0}, "history = {t = [0, 0.01, 0.01, 1], value = [1, 1, -2, -2]}") + probe("a") +
                            in_time(0.02, 1e-3));

  for (const std::string method : {"energy-momentum", "generalized-alpha"}) {
    const std::string by = "hilo-solve --quiet scene.toml --checkpoint 5steps --set 'time.integrator=\"" + method + "\"' ";
    succeeded(w.run(by + "-o whole.h5"));
    succeeded(w.run(by + "-o run.h5 --set time.end=0.01"));
    succeeded(w.run("hilo-solve --quiet --restart run.h5 --set time.end=0.02"));
    const auto whole = Results(w / "whole.h5").history("probe/a"), again = Results(w / "run.h5").history("probe/a");
    EXPECT_EQ((whole - again).cwiseAbs().maxCoeff(), 0) << method;
    EXPECT_NEAR(whole(10, 6), -20, 1e-9) << method;
  }
}

}  // namespace
// Truth: in row 0 of modes, a state of rest, of statics and of buckling springs and stops have the forces of their laws at the angle told
// there, and joints those that balance them.
TEST(EndRows, OfAStateOfRest) {
  const Workplace w;
  const auto pendulum = [](double height) {
    return "gravity = [0, 0, -9.80665]\n" + body("p", 3, {0, 0, height}, {0.2, 0.3, 0.1}) +
           axial("revolute", "j", "ground", "p", Vec3::Zero(), {0, 1, 0}, "reactions = \"ground\"");
  };
  const auto wound = [](const std::string& name, double stiffness, double angle) {
    return spring("torsion", name, "ground", "p", fmt::format("axis = [0, 1, 0]\nstiffness = {}\nangle = {}", stiffness, angle));
  };
  const auto solve = [&](const std::string& scene) {
    w.write("scene.toml", scene);
    succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5"));
    return Results(w / "run.h5");
  };
  const Results modes = solve(pendulum(0.7) + wound("k", 30, 0.05) +
                              "[[stop]]\nkind = \"angle\"\nname = \"s\"\njoint = \"j\"\nupper = 0.1\nstiffness = 20\n" +
                              "[time]\nanalysis = \"modes\"\nmodes = 1\nstart = \"equilibrium\"\n");
  const double angle = modes.history("coordinate/j")(0, 1);
  EXPECT_GT(angle, 0.11);
  EXPECT_NEAR(modes.history("joint/j")(0, 2), 3 * 9.80665, 1e-6);
  EXPECT_NEAR(modes.history("spring/k")(0, 4), -30 * (angle - 0.05), 1e-6);
  EXPECT_NEAR(modes.history("stop/s").row(0).tail(3).norm(), 20 * (angle - 0.1), 1e-6);
  const Results steps = solve(pendulum(-0.7) + wound("k", 5, 0.3) + "[time]\nanalysis = \"static\"\nsteps = 2\n");
  EXPECT_NEAR(steps.history("spring/k")(0, 4), 5 * 0.3, 1e-9);
  const Results shapes = solve(pendulum(0.7) + wound("k", 15, 0.1) + wound("l", 15, -0.1) + "[time]\nanalysis = \"buckling\"\nmodes = 1\n");
  EXPECT_NEAR(shapes.history("spring/k")(0, 4), 15 * 0.1, 1e-9);
  EXPECT_NEAR(shapes.history("spring/l")(0, 4), -15 * 0.1, 1e-9);
}

}  // namespace hilo::test::end_rows_test
