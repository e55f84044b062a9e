// SPDX-License-Identifier: GPL-3.0-or-later
// Rolling and knife edges against closed forms, and against the equations of motion of a disc.
#include "model/scene.hpp"
#include "verify/verify.hpp"

namespace hilo::test::rolling_test {
namespace {

Vec3 place(const Eigen::MatrixXd& x, Eigen::Index i) { return {x(i, 0), x(i, 1), x(i, 2)}; }

// Truth: the centre of a homogeneous ball on a turntable of speed W runs round a circle at 2 W/7, in its own place and at its own speed.
TEST(Rolling, BallOnATurntableRunsRoundACircle) {
  const Case c("rolling");
  const double w = 2.0 * 2 / 7;
  const auto error = [&](const std::string& options) {
    EXPECT_EQ(c.solve("--quiet " + options, "run.h5", 0, "turntable").exit, 0);
    const auto x = c.results().history("probe/ball");
    const auto t = c.results().t();
    double worst = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 v0(0, 0.1, 0),
          exact = Vec3(0.3, 0, 0.1) + (std::sin(w * t[i]) * v0 + (1 - std::cos(w * t[i])) * Vec3::UnitZ().cross(v0)) / w;
      worst = std::max(worst, (place(x, i) - exact).norm());
    }
    return worst;
  };
  const double e4 = error("--set time.step=0.02"), e2 = error("--set time.step=0.01"), e1 = error("--set time.step=0.005");
  EXPECT_LT(e1, 1e-4);
  EXPECT_GT(std::log2(e4 / e2), 1.95);
  EXPECT_GT(std::log2(e2 / e1), 1.95);
  const std::string ga = "--set 'time.integrator=\"generalized-alpha\"' ";
  EXPECT_GT(std::log2(error(ga + "--set time.step=0.01") / error(ga + "--set time.step=0.005")), 1.9);
}

/// A thin disc that rolls: (J + m (r^2 I - r r^T)) w' = -w x J w - m r x (w x r') - m r x g with the arm r(e) to the contact, e' = w x e,
/// c' = -w x r; from m v' = F + m g, (J w)' = r x F.
struct Disc {
  double m = 1, radius = 0.5, Ja = 0.125, Jt = 0.0625;
  using State = Eigen::Matrix<double, 9, 1>;  // c, e, w
  Vec3 arm(const Vec3& e) const { return -radius * (Vec3::UnitZ() - e.z() * e).normalized(); }
  State rate(const State& s) const {
    const Vec3 e = s.segment<3>(3), w = s.tail<3>(), de = w.cross(e), n = Vec3::UnitZ(), p = n - e.z() * e, dp = -de.z() * e - e.z() * de;
    const Vec3 r = arm(e), dr = -radius * (dp - p * (p.dot(dp) / p.squaredNorm())) / p.norm(), g(0, 0, -9.81);
    const Mat3 J = Jt * Mat3::Identity() + (Ja - Jt) * e * e.transpose();
    const Mat3 A = J + m * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    State d;
    d << -w.cross(r), de, A.inverse() * (-w.cross(J * w) - m * r.cross(w.cross(dr)) - m * r.cross(g));
    return d;
  }
  State step(const State& s, double h) const {
    const State a = rate(s), b = rate(s + h / 2 * a), c = rate(s + h / 2 * b), d = rate(s + h * c);
    return s + h / 6 * (a + 2 * b + 2 * c + d);
  }
};

// Truth: the disc's equations of motion by RK4 (1e-4 s, converged to 1e-10), and its energy, which no-slip leaves alone at any step.
TEST(Rolling, CoinFollowsItsEquationsOfMotion) {
  const Case c("rolling");
  Disc disc;
  Disc::State s;
  s << 0, 0, 0.4, 0, 0.8, 0.6, 0.5, 6, 1;
  for (int i = 0; i < 20000; ++i) s = disc.step(s, 1e-4);
  const Vec3 exact = s.head<3>();
  double error[2];
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(c.solve(std::string("--quiet --set time.step=") + (k ? "1e-3" : "2e-3"), "run.h5", 0, "coin").exit, 0);
    const Results r = c.results();
    const auto x = r.history("probe/coin"), e = r.history("energy");
    error[k] = (place(x, x.rows() - 1) - exact).norm();
    EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * (e(0, 0) + e(0, 2)));
    EXPECT_LT(r.history("constraint").maxCoeff(), 1e-12);
  }
  EXPECT_LT(error[1], 1e-3);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1);
}

// Truth: a = g sin/(1 + J/(m r^2)): 2/3 of g sin for a disc, 5/7 for a ball; the contact holds the rest back.
TEST(Rolling, DownASlopeADiscTakesTwoThirdsAndABallFiveSevenths) {
  const Case c("rolling");
  const double down = 5.886;
  for (const bool ball : {false, true}) {
    const std::string option = ball ? " --set 'body.roller.inertia=[0.032,0.032,0.032]'" : "";
    EXPECT_EQ(c.solve("--quiet" + option, "run.h5", 0, "incline").exit, 0);
    const Results r = c.results();
    const auto x = r.history("probe/roller"), f = r.history("joint/contact");
    const double a = down * (ball ? 5.0 / 7 : 2.0 / 3);
    EXPECT_NEAR(x(x.rows() - 1, 0), a / 2, 1e-9);
    EXPECT_NEAR(f(x.rows() / 2, 0), -2 * (down - a), 1e-8);
    EXPECT_NEAR(f(x.rows() / 2, 2), 2 * 7.848, 1e-6);
    EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * 2 * down);
  }
}

// Truth: turning at w the edge makes the cycloid x = g sin/(2 w^2) sin^2 w t, y = g sin/(2 w^2) (w t - sin(2 w t)/2): it slides along, not
// down.
TEST(Rolling, KnifeEdgeOnASlopeRunsAlongACycloid) {
  const Case c("rolling");
  const double w = 3, A = 5.886 / (2 * w * w);
  const auto error = [&](const std::string& step) {
    EXPECT_EQ(c.solve("--quiet --set time.step=" + step, "run.h5", 0, "sleigh").exit, 0);
    const Results r = c.results();
    const auto x = r.history("probe/sleigh");
    double worst = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const double t = r.t()[i];
      const Vec3 exact(A * std::pow(std::sin(w * t), 2), A * (w * t - std::sin(2 * w * t) / 2), 0);
      worst = std::max(worst, (place(x, i) - exact).norm());
    }
    EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * 10);
    return worst;
  };
  const double coarse = error("4e-3"), fine = error("2e-3");
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05);
}

// Truth: every method keeps its order with rows of velocities, Radau IIA its fifth.
TEST(Rolling, EveryMethodKeepsItsOrderOnTheCycloid) {
  const Case c("rolling");
  const double w = 3, A = 5.886 / (2 * w * w);
  const auto error = [&](const std::string& method, const std::string& step) {
    EXPECT_EQ(
        c.solve("--quiet --set time.end=1 --set 'time.integrator=\"" + method + "\"' --set time.step=" + step, "run.h5", 0, "sleigh").exit,
        0);
    const Eigen::VectorXd x = c.results().at("probe/sleigh", 1);
    return (x.head<3>() - Vec3(A * std::pow(std::sin(w), 2), A * (w - std::sin(2 * w) / 2), 0)).norm();
  };
  for (const std::string method : {"mid-point", "generalized-alpha", "newmark", "hht", "wbz", "U0", "V0", "bathe", "bdf2"})
    EXPECT_GT(std::log2(error(method, "0.01") / error(method, "0.005")), 1.95) << method;
  EXPECT_GT(std::log2(error("radau", "0.04") / error("radau", "0.02")), 4.5);
}

// Truth: the axle turns at its own rate, w = 1/s, and its middle rolls ahead with v' = a cos(w t), a = m g/(m + 2 J/r^2).  That one wheel
// does not slip along the axle the other and the bearings say already, but no method says so exactly.
TEST(Rolling, AnAxleOfTwoWheelsYawsByAnyMethod) {
  const Case c("rolling");
  const double v0 = 0.5, a = 9 * 2.9 / (9 + 2 * 0.01 / 0.01);
  const Vec3 exact(v0 * std::sin(1) + a / 2 * std::pow(std::sin(1), 2), v0 * (1 - std::cos(1)) + a * (0.5 - std::sin(2) / 4), 0.1);
  const auto error = [&](const std::string& method, const std::string& step) {
    const Ran ran = c.solve("--quiet --set 'time.integrator=\"" + method + "\"' --set time.step=" + step, "run.h5", 0, "axle");
    EXPECT_EQ(ran.exit, 0) << method << ran.err;
    return ran.exit ? 1 : (c.results().at("probe/axle", 1).head<3>() - exact).norm();
  };
  for (const std::string& method : choices("time", "integrator")) {
    const double coarse = error(method, "0.02"), fine = error(method, "0.01");
    std::printf("%s: %.2g m, %.2g m\n", method.c_str(), coarse, fine);
    EXPECT_LT(fine, 0.03) << method;
    EXPECT_TRUE(std::log2(coarse / fine) > 1.9 || fine < 1e-10) << method;
  }
}

// Truth: a start that slips is projected onto rolling, J and m deciding how: w = w0 J/(J + m r^2) for a spin w0 alone.
// A wheel of radius r that F pulls against a spring kx at its centre, and kt about its axle, comes to rest at x = F/(kx + kt/r^2), however
// far it has rolled.  A load step of a whole turn had let it slip by three times that.
TEST(Rolling, AtRestAWheelIsWhereItsTurnSays) {
  const Case c("rolling");
  c.write("scene.toml", R"(body = [{name = "w", mass = 1, com = [0, 0, 0.1], inertia = [0.01, 0.02, 0.01]}]
joint = [{kind = "rolling", name = "c", b = "w", at = [0, 0, 0.1], axis = [0, 0, 1], x = [1, 0, 0], radius = 0.1, axle = [0, 1, 0]},
         {kind = "planar", name = "p", b = "w", at = [0, 0, 0.1], axis = [0, 1, 0]}]
spring = [{kind = "torsion", name = "t", b = "w", axis = [0, 1, 0], stiffness = 0.5},
          {kind = "bushing", name = "b", b = "w", at = [0, 0, 0.1], stiffness = [20, 0, 0]}]
load = [{kind = "force", name = "f", on = "w", force = [7, 0, 0]}]
probe = [{name = "w", on = "w"}]
[time]
end = 1e-4
step = 1e-4
)");
  for (const char* analysis : {"--set 'time.analysis=\"static\"' ", "--set 'time.start=\"equilibrium\"' "})
    for (const double F : {1., 7., 28., 2 * 3.14159 * 7, 60., 110.}) {  // one of them a whole turn
      const Results r = c.solved(analysis + fmt::format("--set load.f.force=[{},0,0]", F));
      const auto x = r.history("probe/w");
      EXPECT_NEAR(x(x.rows() - 1, 0) / (F / 70), 1, 6e-4) << analysis << F;
    }
}

TEST(Rolling, StartThatSlipsIsMadeToRoll) {
  const Case c("rolling");
  const Ran ran = c.solve("--quiet", "run.h5", 0, "slipping");
  ASSERT_EQ(ran.exit, 0);
  const auto x = c.results().history("probe/roller");
  EXPECT_NEAR(x(0, 3), 9 * 0.04 / (0.04 + 2 * 0.04) * 0.2, 1e-12);
}

TEST(Rolling, MistakesAreNamed) {
  const Case c("rolling");
  c.expect_mistake("'joint.contact.axle=[0,0,1]'", "axle is parallel to the axis", "incline");
  c.expect_mistake("joint.contact.radius=0", "radius", "incline");
  c.expect_mistake("'joint.edge.edge=[0,0,2]'", "edge is parallel to the axis", "sleigh");
}

}  // namespace
}  // namespace hilo::test::rolling_test
