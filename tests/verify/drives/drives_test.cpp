// SPDX-License-Identifier: GPL-3.0-or-later
// Driven joints: the course is kept to round-off, the reaction is what the motion asks for, the work is accounted for.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::drives_test {
namespace {

constexpr double g = 9.81;

/// The ramp w(s) = 35 s^4 - 84 s^5 + 70 s^6 - 20 s^7 over two seconds, and its second derivative by time.
double ramp(double t) {
  const double s = std::min(t / 2, 1.0);
  return s * s * s * s * (35 + s * (-84 + s * (70 - 20 * s)));
}
double ramp_acceleration(double t) {
  const double s = std::min(t / 2, 1.0);
  return 420 * s * s * (1 - s) * (1 - s) * (1 - 2 * s) / 4;
}

// Exact: moment J_0 theta'' + m g l cos(theta) about the axis, J_0 = J + m l^2; the angle 7 is more than a turn.
TEST(DrivenRevolute, FollowsItsAngleWithTheMomentItTakes) {
  for (const std::string method : {"energy-momentum", "generalized-alpha", "mid-point", "U0", "radau"}) {
    const Case c("drives");
    const Results r = c.solved("--set time.integrator=" + method);
    for (const double t : {0.4, 1.0, 1.3, 1.9, 2.4}) {
      const double theta = 7 * ramp(t);
      EXPECT_LT((r.at("probe/arm", t).head<3>() - 0.5 * Vec3(std::cos(theta), 0, std::sin(theta))).norm(), 1e-12) << method << " " << t;
      const double moment = (0.2 + 2 * 0.25) * 7 * ramp_acceleration(t) + 2 * g * 0.5 * std::cos(theta);
      EXPECT_NEAR(r.at("joint/motor", t)[5], moment, 2e-3) << method << " t = " << t;
    }
    if (method == "energy-momentum") {
      EXPECT_LT(c.reported("energy_balance"), 1e-12) << "work of the drive";
    }
  }
}

// Exact: force m (g + z'').
TEST(DrivenPrismatic, LiftsWithTheForceItTakes) {
  const Case c("drives");
  const Results r = c.solved("", "run.h5", "lift");
  for (const double t : {0.3, 1.2, 2.2}) {
    EXPECT_NEAR(r.at("probe/lift", t)[2], 1.5 * ramp(t), 1e-13);
    EXPECT_NEAR(r.at("joint/rope", t)[2], 3 * (g + 1.5 * ramp_acceleration(t)), 1e-4);
  }
  EXPECT_LT(c.reported("energy_balance"), 1e-12);
}

// Exact: a velocity is integrated from its history; here v = 1.5 w(t), whose integral over the ramp of two seconds is 1.5 x 1.
TEST(DrivenPrismatic, IntegratesAVelocity) {
  const Case c("drives");
  std::string scene = text_of(c.source("lift.toml"));
  scene.replace(scene.find("displacement ="), 12, "velocity");
  c.write("scene.toml", scene);
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results r = c.results();
  EXPECT_NEAR(r.at("probe/lift", 2)[2], 1.5, 1e-13);
  EXPECT_NEAR(r.at("probe/lift", 2.5)[2], 2.25, 1e-13);
  EXPECT_NEAR(r.at("probe/lift", 2.5)[5], 1.5, 1e-5) << "velocity";
}

// Truth: where the rate of a drive jumps, the velocities jump with it: m v^2/2 comes from the drive as an impulse, and nothing rings after
// it.
TEST(DrivenPrismatic, TakesAKinkOfItsCourseAsABlow) {
  const Case c("drives");
  const Results r = c.solved("--set 'joint.rope.history={t = [0, 1, 2], value = [0, 0, 1]}'", "run.h5", "lift");
  EXPECT_NEAR(r.at("probe/lift", 1.5)[2], 0.75, 1e-13);
  EXPECT_NEAR(r.at("probe/lift", 1.5)[5], 1.5, 1e-9);
  EXPECT_NEAR(r.at("probe/lift", 1.501)[5], 1.5, 1e-9);
  EXPECT_NEAR(r.at("joint/rope", 1.5)[2], 3 * g, 1e-6);
  EXPECT_LT(c.reported("energy_balance"), 1e-11);
}

/// A wheel of 1 kg m^2 that a motor turns at 3000 rpm from the start, against a brake of 20 N m.
std::string braked_wheel(double step) {
  return body("wheel", 1, Vec3::Zero(), {0.6, 0.6, 1}) +
         axial("revolute", "motor", "ground", "wheel", Vec3::Zero(), Vec3::UnitZ(), "spin = 314.1592653589793") +
         load("torque", "brake", "wheel", "torque = [0, 0, -20]") + in_time(0.02, step);
}

// Exact: the motor bears the moment of the brake, and the wheel has its speed, in every row.  With 20 steps a turn a chord misses the rate
// of the law by 0.8 %: a start that is as fast as the law alternates about it by 5000 N m.
TEST(DrivenRevolute, ThatBeginsAtSpeedBearsItsMomentInEveryRow) {
  const Case c("drives");
  for (const std::string method : {"energy-momentum", "mid-point", "gauss"})
    for (const double step : {2e-4, 1e-3}) {
      SCOPED_TRACE(method + " " + std::to_string(step));
      c.write("wheel.toml", braked_wheel(step));
      succeeded(c.run("hilo-solve --quiet wheel.toml -o run.h5 --set time.integrator=" + method));
      const auto moment = c.results().history("joint/motor").col(5);
      EXPECT_LT((moment.array() - 20).abs().maxCoeff(), step < 1e-3 ? 1e-3 : 0.6);
      EXPECT_NEAR(moment[moment.size() - 1], 20, 1e-2);
      EXPECT_LT((c.results().history("energy").col(0).array() / (0.5 * 314.1592653589793 * 314.1592653589793) - 1).abs().maxCoeff(), 1e-7);
      if (method == "energy-momentum") {
        EXPECT_LT(c.reported("energy_balance"), 1e-12) << "work of the drive";
      }
    }
}

// Truth: gauss at a fifth of the step; momenta of what floats stay, and the error is of second order.
TEST(DrivenRevolute, OfAFloatingWheelKeepsMomentaAndItsMomentIsOfSecondOrder) {
  const Case c("drives");
  c.write("floating.toml", body("hull", 5, {0.1, 0.2, 0}, {0.6, 0.5, 0.8}) + body("wheel", 1, {0.4, 0, 0.1}, {0.02, 0.02, 0.03}) +
                               body("tail", 0.5, {-0.6, 0, 0.1}, {0.02, 0.02, 0.03}) +
                               initial("hull", "spin = [1, 2, 3]\nvelocity = [1, 0, 0]") +
                               axial("revolute", "motor", "hull", "wheel", {0.4, 0.05, 0.1}, {0.3, 0.2, 1}, "spin = 100") +
                               axial("revolute", "hinge", "hull", "tail", {-0.3, 0, 0.1}, {0, 1, 0}) + in_time(0.2, 1e-3));
  const auto solved = [&](const std::string& how) {
    succeeded(c.run("hilo-solve --quiet floating.toml -o run.h5 " + how));
    return c.results();
  };
  const Results truth = solved("--set time.integrator=gauss --set time.step=2e-4");
  for (const std::string method : {"energy-momentum", "mid-point"}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const Results r = solved("--set time.integrator=" + method + " --set time.step=" + (k ? "5e-4" : "1e-3"));
      const auto momentum = r.history("momentum");
      EXPECT_LT((momentum.rowwise() - momentum.row(0)).cwiseAbs().maxCoeff(), 1e-12) << method;
      error[k] = 0;
      for (int i = 1; i <= 200; ++i) {
        const double t = 1e-3 * i;
        error[k] = std::max(error[k], std::abs(r.at("joint/motor", t)[5] - truth.at("joint/motor", t)[5]));
      }
    }
    EXPECT_LT(error[0], 0.02) << method << ", of 4 N m";
    EXPECT_GT(error[0] / error[1], 3.5) << method;
  }
}

// Truth: a guide that keeps the arm in the plane z = 0 has no room for a motor about y; a second motor at the same rate does no harm.
TEST(DrivenJoint, SaysWhichJointItCannotMove) {
  const Case c("drives");
  std::string scene = text_of(c.source("scene.toml"));
  const auto at = scene.find("angle = 7"), end = scene.find("[[probe]]");
  scene = scene.substr(0, at) + "spin = 2\n\n" + scene.substr(end);
  c.write("guided.toml", scene + "[[joint]]\nkind = \"planar\"\nname = \"table\"\nb = \"arm\"\nat = [0.5, 0, 0]\naxis = [0, 0, 1]\n");
  Ran ran = c.run("hilo-solve --quiet guided.toml -o run.h5");
  expect_end(ran, 2, "joint \"motor\" is to be driven, but joint \"table\" holds it still");
  EXPECT_FALSE(std::filesystem::exists(c / "run.h5"));
  c.write("twice.toml",
          scene + "[[joint]]\nkind = \"revolute\"\nname = \"twin\"\nb = \"arm\"\nat = [0, 1, 0]\naxis = [0, -1, 0]\nspin = 2\n");
  ran = c.run("hilo-solve --quiet twice.toml -o run.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(c.reported("redundant_rows"), 6);
  EXPECT_LT(c.reported("constraint_violation"), 1e-12);
}

TEST(DrivenJoint, RefusesACourseThatJumpsAndTwoDrives) {
  const Case c("drives");
  Ran ran = c.solve("--set 'joint.rope.history={t = [0, 1, 1, 2], value = [0, 0, 1, 1]}'", "run.h5", 2, "lift");
  EXPECT_NE(ran.err.find("the history jumps at t = 1"), std::string::npos) << ran.err;
  ran = c.solve("--set joint.rope.velocity=1", "run.h5", 2, "lift");
  EXPECT_NE(ran.err.find("both displacement and velocity"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::drives_test
