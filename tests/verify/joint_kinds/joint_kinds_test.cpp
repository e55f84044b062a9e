// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms of single joints: planar, in-plane, in-line, screw, gear, rack, weighted sum.
#include <numbers>

#include "verify/verify.hpp"

namespace hilo::test::joint_kinds_test {
namespace {

using std::numbers::pi;
constexpr double g = 9.81;

/// Angle about z of b - a in the plane.
double angle_of(const Vec3& d) { return std::atan2(d[1], d[0]); }

// Exact: x = x0 + v t + g sin(30) t^2/2 down the slope, the plane carries m g cos(30), the spin about the normal stays.  The mid-point
// rule is exact for constant forces.
TEST(PlanarJoint, SlidesDownItsPlaneAndCarriesTheNormalForce) {
  for (const std::string kind : {"planar", "in-plane"}) {
    const Case c("joint_kinds");
    const Results r = c.solved("--set joint.guide.kind=" + kind, "run.h5", "plane");
    const Vec3 slope(std::cos(pi / 6), 0, -std::sin(pi / 6)), start(0.3, 0.2, 0.1);
    for (double t : {0.3, 1.0})
      EXPECT_LT((r.at("probe/puck", t).head<3>() - (start + Vec3(0, 0.7, 0) * t + slope * g * 0.5 * t * t / 2)).norm(), 1e-12) << kind;
    const auto f = r.history("joint/guide");
    Eigen::Matrix<double, 1, 6> exact;
    exact << 0, 0, 2 * g * std::cos(pi / 6), 0, 0, 0;
    for (Eigen::Index i = 0; i < f.rows(); ++i) ASSERT_LT((f.row(i) - exact).norm(), 1e-9) << kind << " row " << i;
    EXPECT_LT(c.reported("energy_balance"), 1e-12);
  }
}

// Exact: along the slope g sin(30), the sideways velocity is taken by the line at the start; the spin is free.
TEST(InLineJoint, SlidesDownItsLine) {
  const Case c("joint_kinds");
  const Results r = c.solved(
      "--set joint.guide.kind=in-line --set 'joint.guide.axis=[0.8660254037844386, 0, -0.5]' --set "
      "'joint.guide.x=[0.5, 0, 0.8660254037844386]'",
      "run.h5", "plane");
  const Vec3 slope(std::cos(pi / 6), 0, -std::sin(pi / 6)), start(0.3, 0.2, 0.1);
  EXPECT_LT((r.at("probe/puck", 1).head<3>() - (start + slope * g * 0.5 / 2)).norm(), 1e-12);
  Eigen::Matrix<double, 6, 1> exact;
  exact << 2 * g * std::cos(pi / 6), 0, 0, 0, 0, 0;
  EXPECT_LT((r.at("joint/guide", 0.5) - exact).norm(), 1e-9);
  EXPECT_NEAR(c.reported("velocity_change"), 0.7, 1e-12);
}

// Exact: z'' = -g/(1 + J (2 pi/p)^2/m), the screw carries m (g + z'') and turns the nut with J theta''.  It makes 3.9 turns.
TEST(ScrewJoint, RunsDownWithItsInertia) {
  const Case c("joint_kinds");
  const Results r = c.solved("", "run.h5", "screw");
  const double k = 2 * pi / 0.1, a = -g / (1 + 0.03 * k * k / 2);
  for (double t : {0.5, 1.0}) EXPECT_NEAR(r.at("probe/nut", t)[2], a * t * t / 2, 1e-6 * t * t) << "second order in the angle of a step";
  const auto f = r.at("joint/screw", 0.5);
  EXPECT_NEAR(f[2], 2 * (g + a), 1e-5);
  EXPECT_NEAR(f[5], 0.03 * a * k, 1e-6);
  EXPECT_LT(f.head<2>().norm() + f.segment<2>(3).norm(), 1e-9);
  EXPECT_LT(c.reported("energy_balance"), 1e-11);
  EXPECT_LT(c.reported("constraint_violation"), 1e-13);
}

// Exact: alpha = tau/(J_a + ratio^2 J_b); the mesh turns b with J_b ratio alpha.
TEST(GearJoint, SharesTheTorqueByTheRatio) {
  const Case c("joint_kinds");
  const Results r = c.solved("", "run.h5", "gear");
  const double alpha = 1 / (0.1 + 4 * 0.02);
  for (double t : {0.2, 1.0, 2.0}) {
    const Vec3 a = r.at("probe/rim", t).head<3>(), b = r.at("probe/small rim", t).head<3>() - Vec3(0.3, 0, 0);
    const double step_of_b = 2 * alpha * t * 1e-3;  // relative error of an angle by the mid-point rule: (omega h)^2/12
    EXPECT_NEAR(std::remainder(angle_of(a) - alpha * t * t / 2, 2 * pi), 0, alpha * t * t / 2 * step_of_b * step_of_b / 12 + 1e-9) << t;
    EXPECT_NEAR(std::remainder(angle_of(b) + 2 * angle_of(a), 2 * pi), 0, 1e-12) << "the ratio of the angles holds to round-off";
  }
  const auto f = r.at("joint/mesh", 1);
  EXPECT_LT(f.head<3>().norm(), 1e-12);
  EXPECT_NEAR(f[5], -2 * 0.02 * alpha, 1e-5);
  EXPECT_LT(c.reported("energy_balance"), 1e-11);
}

// Exact: the planet's angle is (1 + 2) times that of the arm; nothing drives or brakes them, so both turn at constant rates.
TEST(GearJoint, OnAMovingCarrierMakesAPlanet) {
  const Case c("joint_kinds");
  const Results r = c.solved("", "run.h5", "planet");
  for (double t : {1.0, 5.0}) {
    const Vec3 centre = r.at("probe/centre", t).head<3>(), rim = r.at("probe/rim", t).head<3>();
    EXPECT_NEAR(std::remainder(angle_of(centre) - 2 * t, 2 * pi), 0, 1e-4) << t;
    EXPECT_NEAR(std::remainder(angle_of(rim - centre) - 3 * angle_of(centre), 2 * pi), 0, 1e-12) << t;
  }
  EXPECT_LT(c.reported("energy_balance"), 1e-12);
  EXPECT_NEAR(c.reported("velocity_change"), 0, 1e-12) << "2, 0.6 and 6 are consistent";
}

// Exact: z'' = -g/(1 + J/(m r^2)); the teeth push the rack up with m (g + z'').
TEST(RackJoint, FallsWithThePinionsInertia) {
  const Case c("joint_kinds");
  const Results r = c.solved("", "run.h5", "rack");
  const double a = -g / (1 + 0.015 / (2 * 0.01));
  for (double t : {0.5, 1.0}) {
    const double z = r.at("probe/rack", t)[2];
    const double step = a * t / 0.1 * 1e-3;  // angle of the pinion in a step
    EXPECT_NEAR(z, 0.5 + a * t * t / 2, -a * t * t / 2 * step * step / 12);
    const Vec3 rim = r.at("probe/rim", t).head<3>();  // turning positively about y takes x to -z
    EXPECT_NEAR(std::remainder(std::atan2(-rim[2], rim[0]) - (0.5 - z) / 0.1, 2 * pi), 0, 1e-12);
  }
  EXPECT_LT(c.reported("energy_balance"), 1e-11);
}

// Exact: z_i'' = -g + lambda f_i/m_i with lambda = g sum f/sum(f^2/m), and the rope pulls b with lambda.
TEST(WeightedSumJoint, HangsThreeWeightsFromOneRope) {
  const Case c("joint_kinds");
  const Results r = c.solved("", "run.h5", "tackle");
  const double lambda = g * (2 + 1 - 0.5) / (4. / 2 + 1. / 3 + 0.25 / 1);
  const struct {
    const char* name;
    double from, f, m;
  } weights[] = {{"one", 1, 2, 2}, {"two", 0.5, 1, 3}, {"three", 0.2, -0.5, 1}};
  for (const auto& w : weights) {
    const double a = -g + lambda * w.f / w.m;
    for (double t : {0.3, 1.0}) EXPECT_NEAR(r.at(std::string("probe/") + w.name, t)[2], w.from + a * t * t / 2, 1e-11) << w.name;
  }
  EXPECT_NEAR(r.at("joint/rope", 0.5)[2], lambda, 1e-9);
  EXPECT_LT(c.reported("energy_balance"), 1e-12);
  EXPECT_LT(c.reported("constraint_violation"), 1e-12);
}

// Exact by energy: along the arm m l omega^2 + m g sin(theta) with omega^2 = 2 m g l sin(theta)/(m l^2 + J), across it m g cos(theta) J/(m
// l^2 + J).
TEST(Reactions, AreToldInTheAxesOfTheGroundOfABodyOrOfB) {
  const Case c("joint_kinds");
  const double m = 2, J = 0.1, t = 0.5;
  const auto solved = [&](const std::string& axes) { return c.solved("--set joint.pivot.reactions=" + axes, "run.h5", "swing"); };
  const Results in_bob = solved("bob"), on_ground = solved("ground"), on_b = solved("b");
  const Vec3 x = in_bob.at("probe/bob", t).head<3>();
  const double theta = std::atan2(-x[2], x[0]), square = 2 * m * g * std::sin(theta) / (m + J);
  ASSERT_GT(theta, 0.5);
  const Vec3 exact(-(m * square + m * g * std::sin(theta)), 0, m * g * std::cos(theta) * J / (m + J));
  EXPECT_LT((in_bob.at("joint/pivot", t).head<3>() - exact).norm(), 1e-3) << in_bob.at("joint/pivot", t).transpose();
  const Vec3 along = x.normalized(), up(-along[2], 0, along[0]);
  EXPECT_LT((on_ground.at("joint/pivot", t).head<3>() - exact[0] * along - exact[2] * up).norm(), 1e-3);
  const auto b = on_b.at("joint/pivot", t);  // its third axis is the pivot's
  EXPECT_NEAR(b.head<2>().norm(), exact.norm(), 1e-3);
  EXPECT_NEAR(b[2], 0, 1e-9);
  EXPECT_NEAR(on_ground.at("joint/pivot", t).head<3>().norm(), exact.norm(), 1e-3);
}

}  // namespace
}  // namespace hilo::test::joint_kinds_test
