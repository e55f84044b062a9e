// SPDX-License-Identifier: GPL-3.0-or-later
// What moves by a law: a body, a set of a flexible part or single components of its nodes have the position, velocity and acceleration of
// the law from the first step on, at kinks and behind them, with every integrator; what moves them is measured and its work accounted for.
#include "verify/motions/motions.hpp"

namespace hilo::test::motions_test {
namespace {

// Exact: the cart has 1 m/s and the energy of it throughout; the bob follows as x = 1 + t - sin(10 t)/10, and the hand that moves the cart
// feels 10 sin(10 t) N.
TEST_F(Motions, OfABodyHaveItsSpeedFromTheFirstStepWithEveryIntegrator) {
  write("scene.toml", cart("{t = [0, 1], value = [0, 1]}"));
  for (const std::string& kind : integrators()) {
    SCOPED_TRACE(kind);
    const Results r = solved(with(kind));
    const auto x = r.history("probe/cart"), bob = r.history("probe/bob"), energy = r.history("energy"), force = r.history("motion/drive");
    for (Eigen::Index i = 0; i < r.t().size(); ++i) {
      const double t = r.t()[i];
      EXPECT_NEAR(x(i, 0), t, 1e-14);
      EXPECT_NEAR(x(i, 3), 1, 1e-14);
      EXPECT_NEAR(x(i, 6), 0, 1e-10);
      EXPECT_NEAR(energy(i, 0), 0.5 + bob(i, 3) * bob(i, 3) / 2, 1e-13);
      EXPECT_NEAR(bob(i, 0), 1 + t - std::sin(10 * t) / 10, 1e-3);
      EXPECT_NEAR(force(i, 0), 10 * std::sin(10 * t), 0.15);
    }
    expect_words(err, "motion \"drive\" changes its speed by 1 m/s at once: an impulse that does work of 0.5 J");
    EXPECT_NE(text_of(*this / "run.json").find("\"impulses\": {\"count\": 1, \"work\": 0.5}"), std::string::npos);
    if (kind == "energy-momentum" || kind == "mid-point" || kind == "gauss") {
      EXPECT_LT(reported("energy_balance"), 1e-13);
    }
  }
}

// Exact: where the speed jumps, at instants between the steps of the run, it jumps once, by m (v1^2 - v0^2)/2, and the steps end there.
TEST_F(Motions, TakeAKinkAtAnOddTimeAsABlow) {
  write("scene.toml", cart("{t = [0, 0.0537, 0.0791, 1], value = [0, 0, 0.0508, 0.0508]}"));
  for (const std::string& kind : integrators())
    for (const std::string steps : {"", " --set time.tolerance=1e-4"}) {
      SCOPED_TRACE(kind + steps);
      const Results r = solved(with(kind) + steps);
      const auto x = r.history("probe/cart");
      for (Eigen::Index i = 0; i < r.t().size(); ++i) {
        const double t = r.t()[i], speed = t > 0.0537 + 1e-12 && t < 0.0791 + 1e-12 ? 2 : 0;
        EXPECT_NEAR(x(i, 3), speed, 1e-12) << t;
        EXPECT_NEAR(x(i, 6), 0, 1e-8) << t;
        const double s = t - 0.0537, d = t - 0.0791;  // the bob is a sum of two such waves
        const double bob = 1 + (s > 0 ? 2 * (s - std::sin(10 * s) / 10) : 0) - (d > 0 ? 2 * (d - std::sin(10 * d) / 10) : 0);
        EXPECT_NEAR(r.history("probe/bob")(i, 0), bob, 2e-3) << t;
      }
      EXPECT_LT((r.t().array() - 0.0537).abs().minCoeff(), 1e-15);
      EXPECT_LT((r.t().array() - 0.0791).abs().minCoeff(), 1e-15);
      if (kind == "energy-momentum") {
        EXPECT_LT(reported("energy_balance"), 1e-13);
      }
    }
}

// Invariant: the same motion a little later gives the same answer a little later.
TEST_F(Motions, DoNotAskWhenTheyStart) {
  write("scene.toml", cart("{t = [0, 1], value = [0, 1]}"));
  const Results now = solved("--set time.end=0.1");
  write("scene.toml", cart("{t = [0.05, 1.05], value = [0, 1]}"));
  const Results later = solved();
  for (const double t : {0.01, 0.04, 0.1}) {
    EXPECT_LT((now.at("probe/bob", t).tail(6) - later.at("probe/bob", t + 0.05).tail(6)).norm(), 1e-10) << t;
    EXPECT_LT((now.at("motion/drive", t) - later.at("motion/drive", t + 0.05)).norm(), 1e-10) << t;
  }
}

// Exact: nothing to change at the start, the pin pulls with m w^2 r = 1 N along the crank, the hand holds 1 + 0.5 N.
TEST_F(Motions, LeaveAVelocityGivenBesideThemAsItIs) {
  write("scene.toml", crank("{t = [0, 1], value = [0, 1]}") + "[[initial]]\non = [\"bob\"]\nvelocity = [0, 1, 0]\n");
  for (const std::string& kind : integrators()) {
    SCOPED_TRACE(kind);
    const Results r = solved(with(kind));
    EXPECT_EQ(err.find("initial velocities changed"), std::string::npos) << err;
    EXPECT_LT(reported("velocity_change"), 1e-14);
    for (Eigen::Index i = 0; i < r.t().size(); ++i) {
      const double t = r.t()[i];
      const Vec3 along(std::cos(t), std::sin(t), 0), pin = r.history("joint/pin").row(i).head<3>(),
                                                     hand = r.history("motion/drive").row(i).head<3>(),
                                                     v = r.history("probe/crank").row(i).segment<3>(3);
      EXPECT_LT((v - 0.5 * Vec3(-std::sin(t), std::cos(t), 0)).norm(), 1e-14);
      // a transverse force of first order dies out behind the start where accelerations are constrained
      EXPECT_NEAR(pin[0], -1, 5e-3) << t;
      EXPECT_NEAR(hand.dot(along), -1.5, 5e-3) << t;
      EXPECT_LT(pin.tail<2>().norm(), 0.04) << t;
    }
  }
}

// Exact: m a, with the centripetal and the tangential part, about any axis and over more than a turn; of second order in the step for all,
// of a higher one for Radau.
TEST_F(Motions, AreMovedByMassTimesAcceleration) {
  const std::string scene = R"(body = [{name = "free", mass = 1, com = [0, 0, 0], inertia = [1, 1, 1]},
  {name = "arm", mass = 2, com = [0.5, 0.2, 0.1], inertia = [0.3, 0.2, 0.4]}]
motion = [{kind = "rotation", name = "drive", on = "arm", at = [0, 0, 1], axis = [1, 2, 2], angle = 9, history = {t = [0, 1], value = [
    0, 1], interpolation = "smoother"}}]
probe = [{name = "arm", on = "arm"}]
time = {end = 1, step = 0.01}
)";
  write("scene.toml", scene);
  const Vec3 axis = Vec3(1, 2, 2) / 3, arm(0.5, 0.2, -0.9);
  const auto exact = [&](double t) {  // position, velocity, acceleration
    const double s = t, w = s * s * s * s * (35 + s * (-84 + s * (70 - 20 * s))), dw = 140 * s * s * s * (1 - s) * (1 - s) * (1 - s),
                 ddw = 420 * s * s * (1 - s) * (1 - s) * (1 - 2 * s);
    const Vec3 r = Eigen::AngleAxisd(9 * w, axis) * arm, spin = 9 * dw * axis;
    Eigen::Matrix<double, 9, 1> x;
    x << Vec3(r + Vec3::UnitZ()), spin.cross(r), (9 * ddw * axis).cross(r) + spin.cross(spin.cross(r));
    return x;
  };
  for (const std::string& kind : integrators()) {
    SCOPED_TRACE(kind);
    double error[2] = {};
    for (int fine = 0; fine < 2; ++fine) {
      const Results r = solved(with(kind) + (fine ? "--set time.step=0.005" : ""));
      for (const double t : {0.3, 0.5, 0.7}) {
        EXPECT_LT((r.at("probe/arm", t).head<6>() - exact(t).head<6>()).norm(), 1e-12) << t;
        error[fine] = std::max(error[fine], (r.at("motion/drive", t).head<3>() - 2 * exact(t).tail<3>()).norm());
      }
    }
    EXPECT_LT(error[1], 2) << "of 700 N";
    EXPECT_LT(error[1], 0.3 * error[0] + 1e-10);
    if (kind == "energy-momentum" || kind == "mid-point" || kind == "gauss") {
      EXPECT_LT(reported("energy_balance"), 1e-13);
    }
  }
}

}  // namespace
}  // namespace hilo::test::motions_test
