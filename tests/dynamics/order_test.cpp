// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of position, velocity, acceleration and reaction of a brick hung at its corner (stability.md, PEND3D), against RK4 on Euler's
// equations in the test itself, which has neither joints nor multipliers.
#include "dynamics/scenes.hpp"

namespace hilo::test::order_test {
namespace {

/// The far corner at t, and what a sensor there feels [g0].
std::pair<Truth, Vec3> integrate(double end) {
  const FixedPoint body{8,           {0.5, 0.1, 0.2}, Vec3(0.13333333333333333, 0.77333333333333333, 0.69333333333333333).asDiagonal(),
                        {0.5, 1, 2}, {0, 0, -9.81},   {1, 0.2, 0.4}};
  const Truth t = body.at(end, std::max(1, static_cast<int>(std::lround(end / 1e-4))));
  return {t, t.R.transpose() * (t.a - body.gravity) / g0};
}

struct Errors {
  double x, v, a, force, felt;
};

Errors errors(const Workplace& w, double t, const std::string& h, const std::string& options) {
  pend3d(w);
  succeeded(w.run("hilo-solve --quiet pend3d.toml -o run.h5 --set time.step=" + h + " " + options));
  const Results r(w / "run.h5");
  const auto p = r.at("probe/far", t);
  const auto [truth, felt] = integrate(t);
  return {(p.head<3>() - truth.x).norm(), (p.segment<3>(3) - truth.v).norm(), (p.tail<3>() - truth.a).norm(),
          (r.at("joint/corner", t).head<3>() - truth.force).norm(), (r.at("sensor/seat", t) - felt).norm()};
}

void expect_second_order(double t, const std::string& options, const Errors& limit) {
  const Workplace w;
  const Errors coarse = errors(w, t, "2e-3", options), fine = errors(w, t, "5e-4", options);
  const auto order = [](double a, double b) { return std::log2(a / b) / 2; };
  EXPECT_GT(order(coarse.x, fine.x), 1.9);
  EXPECT_GT(order(coarse.v, fine.v), 1.9);
  EXPECT_GT(order(coarse.a, fine.a), 1.8) << coarse.a << " " << fine.a;
  EXPECT_GT(order(coarse.force, fine.force), 1.8) << coarse.force << " " << fine.force;
  EXPECT_GT(order(coarse.felt, fine.felt), 1.8);
  EXPECT_LT(fine.x, limit.x);
  EXPECT_LT(fine.v, limit.v);
  EXPECT_LT(fine.a, limit.a);
  EXPECT_LT(fine.force, limit.force);
  EXPECT_LT(fine.felt, limit.felt);
}

TEST(EnergyMomentum, IsOfSecondOrderInPositionVelocityAccelerationAndReaction) {
  expect_second_order(0.5, "", {1e-5, 1e-4, 1e-3, 1e-3, 1e-4});
}
TEST(EnergyMomentum, IsOfSecondOrderInTheLastRowToo) { expect_second_order(1, "", {1e-5, 1e-4, 1e-3, 3e-3, 1e-4}); }
TEST(EnergyMomentum, IsExactInTheFirstRow) {
  const Errors first = errors(Workplace(), 0, "2e-3", "");
  for (const double error : {first.x, first.v, first.a, first.force, first.felt}) EXPECT_LT(error, 1e-12);
}
// Truth: a mass under a force that jumps has the acceleration F/m from the jump on and not a mean of before and after.
TEST(Recorder, TakesTheValueAfterALoadJump) {
  const Workplace w;
  w.write("scene.toml", body("mass", 2, Vec3::Zero(), {1, 1, 1}) +
                            spring("axial", "spring", "ground", "mass", "at_a = [-3, 0, 0]\nat_b = [0, 0, 0]\nstiffness = 50") +
                            force("push", "mass", {10, 0, 0}, "history = {t = [0.5, 0.5], value = [0, 1]}") + probe("mass") +
                            in_time(1, 2e-3));
  succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results r(w / "run.h5");
  EXPECT_NEAR(r.at("probe/mass", 0.498)[6], 0, 1e-10);
  EXPECT_NEAR(r.at("probe/mass", 0.5)[6], 5, 1e-3) << "5 cos 5 (t - 0.5) to second order";
  EXPECT_NEAR(r.at("probe/mass", 0.502)[6], 5 * std::cos(0.01), 1e-3);
  EXPECT_NEAR(r.at("spring/spring", 0.6)[0], -10 * (1 - std::cos(0.5)), 1e-3);
}

// Truth: a velocity along the rod cannot be; the projection takes exactly that part away (mass norm, point mass) and says how much.
TEST(InitialVelocities, AreProjectedOnTheJointsAndTheChangeIsReported) {
  const Workplace w;
  w.write("scene.toml", "[[body]]\nname = \"bob\"\nmass = 2\ncom = [1, 0, 0]\n" +
                            axial("revolute", "pin", "ground", "bob", Vec3::Zero(), {0, 0, 1}) + initial("bob", "velocity = [0.25, 3, 0]") +
                            probe("bob") + in_time(0.1, 0.01));
  const Ran ran = succeeded(w.run("hilo-solve scene.toml -o run.h5"));
  EXPECT_NE(ran.err.find("initial velocities changed"), std::string::npos) << ran.err;
  const auto p = Results(w / "run.h5").at("probe/bob", 0);
  EXPECT_NEAR(p[3], 0, 1e-12);
  EXPECT_NEAR(p[4], 3, 1e-12);
}

// Truth: a hung scene at rest stays at rest: equilibrium of a mass on a spring is m g/k below the free length, and nothing moves
// afterwards.
TEST(Equilibrium, IsAStateTheRunStaysIn) {
  const Workplace w;
  w.write("scene.toml", "gravity = [0, 0, -9.81]\n" + body("weight", 4, {0, 0, -1}, {0.1, 0.1, 0.1}) +
                            spring("axial", "rope", "ground", "weight", "at_a = [0, 0, 0]\nat_b = [0, 0, -1]\nstiffness = 1000") +
                            probe("weight") + in_time(1, 0.01, "start = \"equilibrium\""));
  succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5"));
  const auto x = Results(w / "run.h5").history("probe/weight");
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    ASSERT_NEAR(x(i, 2), -1 - 4 * 9.81 / 1000, 1e-9);
    ASSERT_LT(x.row(i).segment(3, 3).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace hilo::test::order_test
