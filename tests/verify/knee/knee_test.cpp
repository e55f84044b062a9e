// SPDX-License-Identifier: GPL-3.0-or-later
// FEBio rj15: Grood and Suntay's knee.  Truth: rotations about an axis of the femur, the floating axis and one of the tibia,
// each with a slide along it, follow one another in closed form, which fixes every sign; at rest afterwards the joints carry the weight.
#include "verify/verify.hpp"

namespace hilo::test::knee_test {
namespace {

Mat3 turned(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();

TEST(Knee, FollowsTheClosedFormOfItsThreeDrivenAxes) {
  const Case c("knee");
  const Results r = c.solved();
  for (const double t : {0.0, 0.5, 1.0, 1.5}) {
    const double f = t >= 1 ? 1 : t;  // the ramp is odd about its middle
    const Mat3 R1 = turned(f * M_PI / 3, x), R2 = turned(f * M_PI / 18, y), R3 = turned(-f * M_PI / 12, z);
    const Vec3 ankle = f * 0.005 * x + R1 * (f * 0.003 * y + R2 * (-f * 0.007 * z + R3 * Vec3(0.02, 0.03, -0.4)));
    EXPECT_LT((r.at("probe/ankle", t).head<3>() - ankle).norm(), 1e-12) << t;
  }
}

TEST(Knee, AtRestCarriesTheWeightOfWhatIsBelowEachJoint) {
  const Case c("knee");
  const Results r = c.solved();
  const Mat3 R1 = turned(M_PI / 3, x), R2 = turned(M_PI / 18, y);
  // force on b in the joint's frame, carried by a
  const Vec3 rotation = R1 * R2 * frame_of_axis(z) * r.at("joint/rotation", 1.4).head<3>();
  const Vec3 abduction = R1 * frame_of_axis(y) * r.at("joint/abduction", 1.4).head<3>();
  const Vec3 flexion = frame_of_axis(x) * r.at("joint/flexion", 1.4).head<3>();
  EXPECT_LT((rotation - 3 * 9.81 * z).norm(), 1e-8) << rotation.transpose();
  EXPECT_LT((abduction - 3.2 * 9.81 * z).norm(), 1e-8) << abduction.transpose();
  EXPECT_LT((flexion - 3.4 * 9.81 * z).norm(), 1e-8) << flexion.transpose();
}

}  // namespace
}  // namespace hilo::test::knee_test
