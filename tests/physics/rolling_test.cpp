// SPDX-License-Identifier: GPL-3.0-or-later
// Velocity rows: what slips, what does not, and that their forces do no work.
#include "physics/rolling.hpp"

#include "physics/connectors.hpp"

namespace hilo::test::rolling_test {
namespace {

hilo::Joint rolling(const std::string& kind, const Config& q) {
  JointPlace j{.kind = kind == "knife-edge" ? kind : "rolling", .a = {1, -1}, .b = {2, -1}, .at = joint_point, .at_b = joint_point};
  j.frame = some_frame();
  j.ratio = 0.3;
  if (kind != "ball") j.axis_b = (some_frame() * Vec3(0.8, 0.5, kind == "disc" ? 0.4 : 0)).normalized();
  return make_joint(j, q);
}

class VelocityRow : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(EveryKind, VelocityRow, testing::Values("ball", "disc", "knife-edge"), [](const auto& p) {
  std::string name = p.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// Truth: over a mid-point step the increment of the unknowns (translation, Cayley vector) times the rows is the slip: forces A^T lambda of
// rows that hold do no work, for finite turns.
TEST_P(VelocityRow, RowsTimesTheIncrementAreTheSlipOfAMidPointStep) {
  const double h = 0.1;
  const Config q0 = somewhere(3);
  const hilo::Joint c = rolling(GetParam(), q0);
  Config q1 = q0;
  for (int b = 1; b < 3; ++b) q1.c[b] += 0.1 * scattered(7 * b), q1.R[b] = turn(0.8 * scattered(11 * b)) * q0.R[b];
  Config v = q0;
  for (size_t b = 0; b < v.c.size(); ++b) v.c[b] = (q1.c[b] - q0.c[b]) / h, v.R[b] = (q1.R[b] - q0.R[b]) / h;
  const Slip slip(c, middle(q0, q1), &v);
  const Eigen::Vector2d along = slip.A * increment(q0, q1);
  for (int r = 0; r < slip.n; ++r) EXPECT_NEAR(along[r], h * slip.value[r], 1e-14);
}

// Truth: the change is the derivative, by central differences of step 1e-5.
TEST_P(VelocityRow, ChangeIsTheDerivative) {
  Config q = somewhere(3);
  const hilo::Joint c = rolling(GetParam(), q);
  Config v = q, dq = q, dv = q;
  for (int b = 0; b < 3; ++b) {
    const Mat3 any = skew(scattered(b)) + 0.1 * scattered(b + 40) * scattered(b + 50).transpose();
    q.R[b] = (Mat3::Identity() + 0.05 * any) * q.R[b];  // as between two turned triads
    v.c[b] = scattered(b + 3), v.R[b] = skew(scattered(b + 6)) * q.R[b];
    dq.c[b] = scattered(b + 9), dq.R[b] = skew(scattered(b + 12)) * q.R[b];
    dv.c[b] = scattered(b + 15), dv.R[b] = skew(scattered(b + 18)) * v.R[b];
  }
  const auto at = [&](double tau) {
    Config p = q, w = v;
    for (int b = 0; b < 3; ++b) {
      p.c[b] += tau * dq.c[b], p.R[b] += tau * dq.R[b];
      w.c[b] += tau * dv.c[b], w.R[b] += tau * dv.R[b];
    }
    return Slip(c, p, &w);
  };
  const Slip::Change d = Slip(c, q, &v).change({dq.c[1], dv.c[1], dq.R[1], dv.R[1]}, {dq.c[2], dv.c[2], dq.R[2], dv.R[2]});
  const Slip up = at(1e-5), down = at(-1e-5);
  for (int r = 0; r < up.n; ++r) {
    EXPECT_NEAR(d.value[r], (up.value[r] - down.value[r]) / 2e-5, 1e-8);
    for (int k = 0; k < 12; ++k) EXPECT_NEAR(d.A(r, k), (up.A(r, k) - down.A(r, k)) / 2e-5, 1e-8);
  }
}

// Truth: b spinning about its contact on a resting plane rolls: nothing slips.
TEST_P(VelocityRow, SpinningAboutTheContactIsRolling) {
  const Config q = somewhere(3);
  const hilo::Joint c = rolling(GetParam(), q);
  const Mat3 frame = some_frame();
  Vec3 contact = joint_point, w = frame.col(2);
  if (std::string(GetParam()) != "knife-edge") {
    const Vec3 axle = std::string(GetParam()) == "ball" ? Vec3::Zero() : Vec3((frame * Vec3(0.8, 0.5, 0.4)).normalized());
    contact -= 0.3 * (frame.col(2) - frame.col(2).dot(axle) * axle).normalized();
    w = Vec3(1, -2, 0.7);
  }
  Config v = q;
  for (int b = 0; b < 3; ++b) v.c[b].setZero(), v.R[b].setZero();
  v.c[2] = w.cross(q.c[2] - contact), v.R[2] = skew(w) * q.R[2];
  const Slip slip(c, q, &v);
  for (int r = 0; r < slip.n; ++r) EXPECT_NEAR(slip.value[r], 0, 1e-14);
}

// Truth: a disc of radius r tilted to the angle b from upright has its centre at r cos b.
TEST(Rolling, DiscKeepsItsRimOnThePlane) {
  const Config q = somewhere(3);
  const hilo::Joint c = rolling("disc", q);
  const Vec3 n = some_frame().col(2), axle = (some_frame() * Vec3(0.8, 0.5, 0.4)).normalized();
  const auto height = [&](const Vec3& e) { return 0.3 * std::sqrt(1 - std::pow(n.dot(e), 2)); };
  for (int seed = 0; seed < 10; ++seed) {
    Config p = q;
    const Mat3 B = turn(0.6 * scattered(seed));
    p.R[2] = B * q.R[2];
    const Vec3 centre = joint_point + (height(B * axle) - height(axle)) * n + some_frame().col(0) * scatter(seed + 90);
    p.c[2] = centre + B * (q.c[2] - joint_point);
    double g[max_rows];
    c.row_values(c.values(p), g);
    EXPECT_NEAR(g[0], 0, 1e-14);
  }
}

}  // namespace
}  // namespace hilo::test::rolling_test
