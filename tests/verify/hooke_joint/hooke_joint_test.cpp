// SPDX-License-Identifier: GPL-3.0-or-later
// FEBio rj13: Hooke's joint between shafts at 30 degrees, tan(out) = tan(in) cos 30 with the driving yoke normal to the plane
// of the shafts, tan(in)/cos 30 with it in the plane.
#include "verify/verify.hpp"

namespace hilo::test::hooke_joint_test {
namespace {

/// Angle of the output shaft from a point of it at unit distance from its axis.
double output_angle(const Results& r, double t) {
  const double s = 0.5, k = std::sqrt(0.75);
  const Vec3 d = r.at("probe/arm", t).head<3>() - Vec3(s, 0, k);
  return std::atan2(d.y(), d.dot(Vec3(k, 0, -s))) * 180 / M_PI;
}

TEST(HookeJoint, TransmitsTheAngleOfItsYokeNormalToThePlane) {
  const Case c("hooke_joint");
  const Results r = c.solved();
  for (const double in : {30, 45, 60})
    EXPECT_NEAR(output_angle(r, in / 90), std::atan(std::tan(in * M_PI / 180) * std::cos(M_PI / 6)) * 180 / M_PI, 1e-6) << in;
}

TEST(HookeJoint, TransmitsTheAngleOfItsYokeInThePlane) {
  const Case c("hooke_joint");
  const Results r = c.solved("--set joint.cross.axis=[1,0,0] --set joint.cross.x=[0,1,0]");
  for (const double in : {30, 45, 60})
    EXPECT_NEAR(output_angle(r, in / 90), std::atan(std::tan(in * M_PI / 180) / std::cos(M_PI / 6)) * 180 / M_PI, 1e-6) << in;
}

}  // namespace
}  // namespace hilo::test::hooke_joint_test
