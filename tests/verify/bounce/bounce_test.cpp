// SPDX-License-Identifier: GPL-3.0-or-later
// A stop gives the energy back that it took, or the part that its restitution asks for.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::bounce_test {
namespace {

/// Heights the flights reach, z + v^2/(2 g) at their first recorded instant; free flight is exact at any step.
std::vector<double> heights(const Results& r, double floor) {
  const auto x = r.history("probe/mass");
  std::vector<double> out;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (x(i, 2) > floor && x(i, 5) >= 0 && (i == 0 || x(i - 1, 2) <= floor))
      out.push_back(x(i, 2) - floor + x(i, 5) * x(i, 5) / (2 * 9.81));
  return out;
}

// Truth: without loss a mass comes back to the height it fell from, at any step, even one that meets the stop with a single point.
TEST(Bounce, ComesBackToItsHeightForEver) {
  const Case c("bounce");
  for (const std::string step : {"1e-3", "7e-3"}) {
    const Results r = c.solved("--set time.step=" + step);
    const auto h = heights(r, 0);
    ASSERT_GE(h.size(), 4u);
    for (const double height : h) EXPECT_NEAR(height, 0.5, 1e-10);
    EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * 9.81);
    EXPECT_GE(r.history("stop/floor").col(2).minCoeff(), -1e-9) << "never a pull";
  }
}

// Truth: a restitution of e leaves e^2 of the height; the contact of 1 ms is met with 100 points.
TEST(Bounce, LeavesTheSpeedThatTheRestitutionAsks) {
  const Case c("bounce");
  for (const double e : {0.8, 0.5, 0.2}) {
    const Results r = c.solved("--set time.step=1e-5 --set time.end=0.325 --set stop.floor.stiffness=2e7 --set stop.floor.restitution=" +
                               std::to_string(e));
    const auto h = heights(r, 0);
    ASSERT_GE(h.size(), 2u);
    EXPECT_NEAR(std::sqrt(h[1] / h[0]), e, 0.01 * e) << "the weight, 0.1 % of the force of the impact, goes on through the contact";
    EXPECT_GE(r.history("stop/floor").col(2).minCoeff(), -1e-9);
    const auto d = r.history("energy").col(4).eval();
    EXPECT_GE((d.tail(d.size() - 1) - d.head(d.size() - 1)).minCoeff(), 0) << "dissipation never falls";
    EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-7 * 9.81) << "32 500 steps, each solved to 1e-10 of its forces";
  }
}

// Truth: in the end it lies still and its weight bends the stop by m g/k.
TEST(Bounce, ComesToRest) {
  const Case c("bounce");
  const Results r = c.solved("--set stop.floor.restitution=0.3 --set time.end=6");
  const auto x = r.history("probe/mass");
  EXPECT_NEAR(x(x.rows() - 1, 2), -2 * 9.81 / 2e5, 1e-6);
  EXPECT_LT(std::abs(x(x.rows() - 1, 5)), 1e-4);
}

// Truth: a rope without loss keeps the energy, pulls only when taut and only along itself.
TEST(Bounce, RopeHoldsWhatFalls) {
  const Case c("bounce");
  const Ran ran = c.solve("--quiet", "run.h5", 0, "rope");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  const auto x = r.history("probe/mass"), f = r.history("spring/rope");
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-9);
  int taut = 0;
  for (Eigen::Index i = 1; i + 1 < x.rows(); ++i) {
    const Vec3 arm = Vec3(x(i, 0), x(i, 1), x(i, 2)) - Vec3(0, 0, 1), force(f(i, 0), f(i, 1), f(i, 2));
    EXPECT_LE(force.dot(arm), 1e-9);
    if (arm.norm() < 0.59) {
      EXPECT_LT(force.norm(), 1e-9);
    }
    taut += force.norm() > 1;
  }
  EXPECT_GT(taut, 20);
}

TEST(Bounce, MistakesAreNamed) {
  const Case c("bounce");
  c.expect_mistake("'stop.floor.joint=\"gide\"'", "did you mean \"guide\"");
  c.expect_mistake("'stop.floor.kind=\"angle\"'", "no free angle");
  c.expect_mistake("stop.floor.restitution=1.5", "restitution");
  c.expect_mistake("stop.floor.upper=-0.6", "lower is not below upper");
}

/// Free over 0.1 m to either side at 1 m/s, beyond it a spring of 10 000 N/m on 1 kg: half a wave of pi/100 s.
double between_springs(double t) {
  constexpr double half = 3.14159265358979324 / 100;
  double s = std::fmod(t, 2 * (0.2 + half));
  if (s <= 0.1) return s;
  if ((s -= 0.1) <= half) return 0.1 + std::sin(100 * s) / 100;
  if ((s -= half) <= 0.2) return 0.1 - s;
  if ((s -= 0.2) <= half) return -0.1 - std::sin(100 * s) / 100;
  return s - half - 0.1;
}

// Exact.  In some stages nothing presses, in others of the same step all does.
TEST(Bounce, BetweenTwoSpringsGoesOnWhereStagesMeetTheGap) {
  const Case c("bounce");
  c.write("gap.toml", body("ball", 1, Vec3::Zero(), Vec3::Ones()) + initial("ball", "velocity = [1, 0, 0]") +
                          axial("prismatic", "rail", "ground", "ball", Vec3::Zero(), Vec3::UnitX()) +
                          spring("curve", "gap", "ground", "ball",
                                 "at_a = [-1, 0, 0]\nat_b = [0, 0, 0]\nextension = [-0.2, -0.1, 0.1, 0.2]\nforce = [-1000, 0, 0, 1000]") +
                          in_time(2, 4e-3));
  for (const std::string method : {"radau", "gauss"})
    for (const double step : {1e-2, 5e-3, 4e-3, 1e-3}) {
      SCOPED_TRACE(fmt::format("{} {}", method, step));
      succeeded(c.run(fmt::format("hilo-solve --quiet gap.toml -o run.h5 --set time.integrator={} --set time.step={}", method, step)));
      const Results r = c.results();
      const auto x = r.history("coordinate/rail");
      for (Eigen::Index i = 0; i < x.rows(); ++i) ASSERT_NEAR(x(i, 0), between_springs(r.t()[i]), 500 * step * step) << r.t()[i];
    }
}

// Truth: a stop and a contact press or do nothing, also where the run ends in the step in which they let go (half a wave is 9.93 ms).
TEST(Bounce, NothingPullsWhereARunEndsAsItLetsGo) {
  const Case c("bounce");
  const std::string ball = body("ball", 1, {0, 0, 0.05}, {1e-3, 1e-3, 1e-3}) + initial("ball", "velocity = [0, 0, -1]");
  c.write("stop.toml",
          ball + spring("stop", "buffer", "ground", "ball", "at_a = [0, 0, -0.95]\nat_b = [0, 0, 0.05]\nlower = 1\nstiffness = 1e5") +
              in_time(0.01, 2e-4));
  c.write("plane.toml", ball +
                            "[[obstacle]]\nkind = \"sphere\"\nname = \"skin\"\non = \"ball\"\nat = [0, 0, 0.05]\nradius = 0.05\n"
                            "[[obstacle]]\nkind = \"plane\"\nname = \"floor\"\n"
                            "[[contact]]\nname = \"touch\"\na = \"floor\"\nb = \"skin\"\nstiffness = 1e5\nfriction = 0.3\n" +
                            in_time(0.01, 2e-4));
  for (const std::string end : {"0.01", "0.0102", "0.012"}) {
    succeeded(c.run("hilo-solve --quiet stop.toml -o run.h5 --set time.end=" + end));
    const auto pushed = c.results().history("spring/buffer").col(2).eval();
    EXPECT_GE(pushed.minCoeff(), 0) << end;
    EXPECT_LT(pushed[pushed.size() - 1], 16) << end << ": of 316 N at most";
    succeeded(c.run("hilo-solve --quiet plane.toml -o run.h5 --set time.end=" + end));
    const auto pressed = c.results().history("contact/touch");
    EXPECT_GE(pressed.col(7).minCoeff(), 0) << end;
    EXPECT_LT(pressed(pressed.rows() - 1, 7), 16) << end;
    EXPECT_GE(pressed.col(2).minCoeff(), 0) << end;
  }
}

}  // namespace
}  // namespace hilo::test::bounce_test
