// SPDX-License-Identifier: GPL-3.0-or-later
// Friction in joints: the decelerations, decrements and creeps of Coulomb's law.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::friction_test {
namespace {

constexpr double g = 9.81;

// Truth: going up, v falls at g (sin 30 + mu cos 30); tanh(v/1e-3) is 1 to 1e-8 while v > 10 slip velocities.
TEST(Friction, BlockOnAnInclineDecelerates) {
  const Case c("friction");
  const Results r = c.solved();
  const auto x = r.history("probe/block"), f = r.history("friction/rub");
  const double a = g * (0.5 + 0.25 * std::sqrt(3) / 2);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double t = r.t()[i];
    EXPECT_NEAR(x.row(i).segment(3, 3).norm(), 2 - a * t, 1e-9);
    EXPECT_NEAR(x.row(i).head(3).norm(), 2 * t - a * t * t / 2, 1e-9);
    EXPECT_NEAR(f(i, 2), -0.25 * 3 * g * std::sqrt(3) / 2, 1e-6) << "on the block, down the guide";
  }
  const auto e = r.history("energy");
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * e.col(0).maxCoeff());
  EXPECT_NEAR(e(e.rows() - 1, 4), 0.25 * 3 * g * std::sqrt(3) / 2 * x.row(x.rows() - 1).head(3).norm(), 1e-8);
}

// Truth: where mu > tan 30 it stays, as a creep at slip_velocity artanh(tan 30/mu).
TEST(Friction, BlockSticksAsACreepOfTheStatedVelocity) {
  const Case c("friction");
  const Results r = c.solved("--set friction.rub.coefficient=0.8 --set time.end=1.5 --set time.step=2e-3");
  const auto x = r.history("probe/block");
  EXPECT_NEAR(x.row(x.rows() - 1).segment(3, 3).norm(), 1e-3 * std::atanh(std::tan(M_PI / 6) / 0.8), 1e-8);
  EXPECT_LT(x(x.rows() - 1, 5), 0) << "downwards";
}

// Truth: from one turning point to the next the brake takes M (theta_n + theta_n+1) of the height m g l (cos theta_n+1 - cos theta_n).
TEST(Friction, PendulumLosesTheSameTorqueEverySwing) {
  const Case c("friction");
  const Ran ran = c.solve("--quiet", "run.h5", 0, "pendulum");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  const auto x = r.history("probe/bob");
  std::vector<double> top{M_PI / 2};
  const auto angle = [&](Eigen::Index i) { return std::atan2(x(i, 0), -x(i, 2)); };
  for (Eigen::Index i = 1; i + 1 < x.rows(); ++i) {
    const double b = angle(i - 1), at = angle(i), n = angle(i + 1);
    if ((at - b) * (n - at) < 0) top.push_back(std::abs(at + (n - b) * (n - b) / (16 * (at - (n + b) / 2))));  // vertex of the parabola
  }
  ASSERT_GE(top.size(), 5u);
  const double M = 0.5 * 0.02 * 20, mgl = 2 * g * 0.5;
  for (size_t k = 0; k + 1 < top.size(); ++k)
    EXPECT_NEAR(mgl * (std::cos(top[k + 1]) - std::cos(top[k])), M * (top[k] + top[k + 1]), 2e-5 * mgl) << k;
  const auto e = r.history("energy");
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * mgl);
}

// Truth: friction pressed by the reaction of the same step keeps the second order of the method.
TEST(Friction, PressedByTheReactionIsOfSecondOrder) {
  const Case c("friction");
  const auto last = [&](const std::string& method, const std::string& step) {
    c.solve("--quiet --set 'time.integrator=\"" + method +
                "\"' --set friction.brake.reaction=true --set friction.brake.slip_velocity=0.02 --set time.end=0.5 --set time.step=" + step,
            "run.h5", 0, "pendulum");
    const auto x = c.results().history("probe/bob");
    return Vec3(x(x.rows() - 1, 0), x(x.rows() - 1, 1), x(x.rows() - 1, 2));
  };
  for (const std::string method : {"energy-momentum", "generalized-alpha", "bathe"}) {
    const Vec3 a = last(method, "4e-3"), b = last(method, "2e-3"), d = last(method, "1e-3");
    EXPECT_NEAR(std::log2((b - a).norm() / (d - b).norm()), 2, 0.05) << method;
  }
}

// Truth: with p = pitch/(2 pi), L^2 = p^2 + r^2 and N the thread's force, m p alpha = -m g + N + mu N p/L and J alpha = -N (p - mu r^2/L).
TEST(Friction, NutRunsDownAScrew) {
  const Case c("friction");
  ASSERT_EQ(c.solve("--quiet", "run.h5", 0, "screw").exit, 0);
  const Results r = c.results();
  const auto x = r.history("probe/nut");
  const double m = 2, J = 0.01, p = 0.01, rim = 0.02, mu = 0.15, L = std::hypot(p, rim);
  const double N = m * g / (1 + mu * p / L + m * p * (p - mu * rim * rim / L) / J), alpha = -N * (p - mu * rim * rim / L) / J;
  EXPECT_NEAR(x(x.rows() - 1, 2), p * (-5 + alpha / 2), 1e-3 * p * 5);
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * 5);
}

// Truth: J dw/dt = -mu m g r, whatever w: the spin falls along a line.
TEST(Friction, TopInABallJointSpinsDownAlongALine) {
  const Case c("friction");
  ASSERT_EQ(c.solve("--quiet", "run.h5", 0, "ball").exit, 0);
  const auto x = c.results().history("probe/rim");
  const auto t = c.results().t();
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    EXPECT_NEAR(x.row(i).segment(3, 3).norm(), 0.1 * (12 - 0.2 * 2 * g * 0.01 / 0.01 * t[i]), 1e-4);
}

// Two equal bearings of a shaft bear half of its weight each, and only their rows say how much of it friction gets: told by name.
TEST(Friction, OfRedundantJointsIsTold) {
  const Workplace w;
  const std::string bearing = "axis = [1, 0, 0]";
  w.write("scene.toml", "gravity = [0, 0, -10]\n" + body("d", 2, Vec3::Zero(), {0.1, 0.1, 0.1}) +
                            joint("revolute", "A", "ground", "d", {0.5, 0, 0}, bearing) +
                            joint("revolute", "B", "ground", "d", {-0.5, 0, 0}, bearing) +
                            "[[friction]]\nname = \"f\"\njoint = \"B\"\ncoefficient = 0.1\nradius = 0.1\n" + in_time(0.1, 0.01));

  const std::string told = ": friction \"f\": how much of the force joint \"B\" takes is not determined";
  const Ran both = w.run("hilo-solve scene.toml -o run.h5");
  EXPECT_EQ(both.exit, 0) << both.err;
  EXPECT_NE(both.err.find(told), std::string::npos) << both.err;
  EXPECT_EQ(w.run("hilo-solve scene.toml -o run.h5 --set friction.f.reaction=false --set friction.f.preload=10").err.find(told),
            std::string::npos);
}

TEST(Friction, MistakesAreNamed) {
  const Case c("friction");
  c.expect_mistake("'friction.rub.joint=\"giude\"'", "did you mean \"guide\"");
  c.expect_mistake("'joint.guide.kind=\"cylindrical\"'", "needs a radius");
  c.expect_mistake("'joint.guide.kind=\"in-line\"'", "no friction in a joint of kind in-line");
  c.expect_mistake("friction.rub.slip_velocity=0", "slip_velocity");
}

}  // namespace
}  // namespace hilo::test::friction_test
