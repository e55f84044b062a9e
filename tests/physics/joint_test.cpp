// SPDX-License-Identifier: GPL-3.0-or-later
// Joints: every measure is of degree two, so its mid-point gradient is an exact discrete gradient, and every kind has its own number of
// rows.
#include <Eigen/QR>

#include "physics/connectors.hpp"

namespace hilo::test::joint_test {
namespace {

class Joint : public testing::TestWithParam<std::string> {
 protected:
  const Config made_at = somewhere(3);
  const hilo::Joint c = joint(GetParam(), made_at);
  ConnectorGradient g, h;
};
INSTANTIATE_TEST_SUITE_P(EveryKind, Joint, testing::ValuesIn(joint_kinds()), [](const auto& p) {
  std::string name = p.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// Truth: e(q + tau z) is of degree two in tau, so the central difference is exact at any tau.
TEST_P(Joint, GradientIsTheDerivativeOfItsMeasures) {
  const Config q = somewhere(20);
  gradient(c, q, g);
  for (int k = 0; k < 12; ++k) {
    const Vec12 z = Vec12::Unit(k);
    for (int m = 0; m < c.n_rows(); ++m) EXPECT_NEAR(g.G(m, k), (c.value(m, moved(q, z, 0.5)) - c.value(m, moved(q, z, -0.5))), 1e-13);
  }
}

// Truth: for a quadratic e, e(q1) - e(q0) = de(mid)(q1 - q0), here over a finite step with large rotations.
TEST_P(Joint, MidPointGradientTimesTheStepIsTheChangeOfItsMeasures) {
  for (int seed = 0; seed < 5; ++seed) {
    const Config q0 = somewhere(200 + 30 * seed), q1 = somewhere(400 + 30 * seed);
    gradient(c, middle(q0, q1), g);
    const Vec12 z = increment(q0, q1);
    for (int m = 0; m < c.n_rows(); ++m) {
      const double change = c.value(m, q1) - c.value(m, q0);
      EXPECT_NEAR(g.G.row(m).head<12>().dot(z), change, 1e-12 * (1 + z.norm()) * (1 + g.G.row(m).norm()));
    }
  }
}

// Truth: G(q_left)^T s is of degree two in q1, so its central difference is exact.
TEST_P(Joint, SecondDerivativeTermIsTheDerivativeOfTheForces) {
  const double s[6] = {1.3, -0.4, 2.1, 0.8, -1.1, 0.6};
  const Config q0 = somewhere(60), q1 = somewhere(90);
  for (const double slope : {0.5, 1.0}) {
    const auto left_of = [&](const Config& q) { return slope == 0.5 ? middle(q0, q) : q; };
    gradient(c, left_of(q1), g), gradient(c, q1, h);
    ConnectorMatrix K = ConnectorMatrix::Zero(12, 12);
    add_geometric(c, g, h, s, slope, K);
    const Eigen::Map<const Eigen::VectorXd> s_(s, c.n_rows());
    for (int k = 0; k < 12; ++k) {
      ConnectorGradient p, m;
      gradient(c, left_of(moved(q1, Vec12::Unit(k), 0.5)), p), gradient(c, left_of(moved(q1, Vec12::Unit(k), -0.5)), m);
      const Vec12 exact = (p.G.topRows(c.n_rows()) - m.G.topRows(c.n_rows())).leftCols<12>().transpose() * s_;
      EXPECT_LT((K.col(k) - exact).norm(), 1e-12) << "column " << k;
    }
  }
}

// Truth: a joint takes away 6 - f motions, f those that the kind leaves free.
TEST_P(Joint, HasAsManyIndependentRowsAsItTakesAwayMotions) {
  const std::map<std::string, int> rows{{"fixed", 6},     {"spherical", 3}, {"revolute", 5},         {"cylindrical", 4},
                                        {"prismatic", 5}, {"universal", 4}, {"distance", 1},         {"planar", 3},
                                        {"in-plane", 1},  {"in-line", 2},   {"constant-velocity", 4}};
  gradient(c, made_at, g);
  EXPECT_EQ(c.n_rows(), rows.at(GetParam()));
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(g.G.topRows(c.n_rows()).leftCols<12>().transpose());
  qr.setThreshold(1e-6);
  EXPECT_EQ(qr.rank(), rows.at(GetParam()));
}

/// Relative motions of b against a that the joint leaves free, as (point stays, turn, shift) in inertial axes at the start.
struct Free {
  Vec3 turn, shift;
};
std::vector<Free> free_motions(const std::string& kind) {
  const Mat3 f = some_frame();
  const Vec3 axis = f.col(2), none = Vec3::Zero(), in_plane = 0.9 * f.col(0) - 1.4 * f.col(1), any(0.3, 1.1, -0.7);
  if (kind == "spherical") return {{Vec3(0.3, 1.1, -0.7), none}};
  if (kind == "revolute") return {{1.3 * axis, none}};
  if (kind == "cylindrical") return {{-0.8 * axis, 1.7 * axis}};
  if (kind == "prismatic") return {{none, -2.2 * axis}};
  if (kind == "planar") return {{-0.8 * axis, in_plane}};
  if (kind == "in-plane") return {{any, in_plane}};
  if (kind == "in-line") return {{any, 1.7 * axis}};
  if (kind == "constant-velocity") return {{in_plane, none}};
  return {{none, none}};
}

Config carried(const Config& q, const Vec3& turn_b, const Vec3& shift_b, const Vec3& about) {
  Config out = q;
  const Mat3 Q = turn(Vec3(0.9, -0.4, 0.7)), B = turn(turn_b);
  const Vec3 t(1, 2, -3);
  for (int b = 1; b < 3; ++b) {
    Vec3 c = q.c[b];
    Mat3 R = q.R[b];
    if (b == 2) c = about + B * (c - about) + shift_b, R = B * R;
    out.c[b] = Q * c + t, out.R[b] = Q * R;
  }
  return out;
}

// Truth: whatever the common motion of a and b, a relative motion that the kind allows keeps all rows at zero, and the reactions of
// the finite step to it do no work on the pair.
TEST_P(Joint, ReactionDoesNoWorkAlongTheFreeMotion) {
  for (const Free& f : free_motions(GetParam())) {
    const Config q1 = carried(made_at, f.turn, f.shift, joint_point);
    for (int m = 0; m < c.n_rows(); ++m) EXPECT_NEAR(c.value(m, q1), 0, 1e-14) << "row " << m;
    gradient(c, middle(made_at, q1), g);
    const Vec12 z = increment(made_at, q1);
    for (int m = 0; m < c.n_rows(); ++m) EXPECT_NEAR(g.G.row(m).head<12>().dot(z), 0, 1e-12) << "row " << m;
  }
}

// Truth: motions that the kind forbids change a row.
TEST_P(Joint, ForbiddenMotionsAreSeen) {
  const Mat3 f = some_frame();
  std::vector<Free> forbidden;
  for (int i = 0; i < 3; ++i) {
    const std::string& kind = GetParam();
    if (kind == "distance") continue;
    const bool along = i == 2;
    const bool slides = kind == "planar" || kind == "in-plane"                              ? !along
                        : kind == "cylindrical" || kind == "prismatic" || kind == "in-line" ? along
                                                                                            : false;
    const bool turns = kind == "spherical" || kind == "in-plane" || kind == "in-line" ||
                       ((kind == "revolute" || kind == "cylindrical" || kind == "planar") && along) || (kind == "universal" && i != 1) ||
                       (kind == "constant-velocity" && !along);
    if (!slides) forbidden.push_back({Vec3::Zero(), 0.1 * f.col(i)});
    if (!turns) forbidden.push_back({0.1 * f.col(i), Vec3::Zero()});
  }
  if (GetParam() == "distance") forbidden.push_back({Vec3::Zero(), 0.1 * (other_point - joint_point).normalized()});
  for (const Free& m : forbidden) {
    const Config q = carried(made_at, m.turn, m.shift, joint_point);
    double seen = 0;
    for (int r = 0; r < c.n_rows(); ++r) seen = std::max(seen, std::abs(c.value(r, q)));
    EXPECT_GT(seen, 0.05) << m.turn.transpose() << " " << m.shift.transpose();
  }
}

// Truth: -G_b^T s as a force at the joint point: its power on any motion of b is that of the rows.
TEST_P(Joint, ForceOnBHasThePowerOfItsRows) {
  const double s[6] = {1.3, -0.4, 2.1, 0.8, -1.1, 0.6};
  const Config q = somewhere(33);
  gradient(c, q, g);
  const Vec6 f = force_on_b(c, g, s, q);
  const Vec3 u(0.3, -1, 0.2), w(0.7, 0.1, -0.5), arm = q.R[2] * c.point_b;
  double rows = 0;
  for (int m = 0; m < c.n_rows(); ++m) rows -= s[m] * (g.G.block<1, 3>(m, 6).dot(u) + g.G.block<1, 3>(m, 9).dot(w));
  EXPECT_NEAR(f.head<3>().dot(u + w.cross(arm)) + f.tail<3>().dot(w), rows, 1e-13);
}

// Truth: the axis of the universal joint in a and the cross arm of b stay at a right angle: the Hooke joint.
TEST(UniversalJoint, LetsTheTwoShaftsTurnTogetherAsAHookeJoint) {
  const Config q = somewhere(3);
  const hilo::Joint c = joint("universal", q);
  const Mat3 f = some_frame();
  Config turned = q;  // b turns about x of b and then about the axis of a: both arms of the cross
  const Mat3 B = turn(0.7 * f.col(2)) * turn(-0.4 * f.col(0));
  turned.c[2] = joint_point + B * (q.c[2] - joint_point), turned.R[2] = B * q.R[2];
  for (int m = 0; m < c.n_rows(); ++m) EXPECT_NEAR(c.value(m, turned), 0, 1e-14);
}

TEST(JointOnANode, PullsTheNodeAlongTheLine) {
  const Config q = somewhere(8);
  const hilo::Joint c = make_joint({.kind = "distance", .a = {1, -1}, .b = {-1, 0}, .at = joint_point, .at_b = q.x[0]}, q);
  ConnectorGradient g;
  gradient(c, q, g);
  const Vec3 along = 2 * (q.x[0] - joint_point);
  EXPECT_LT((g.G.block<1, 3>(0, 6).transpose() - along).norm(), 1e-14);
  EXPECT_LT((g.G.block<1, 3>(0, 0).transpose() + along).norm(), 1e-14);
}

}  // namespace
}  // namespace hilo::test::joint_test
