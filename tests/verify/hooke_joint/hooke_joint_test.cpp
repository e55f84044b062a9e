// SPDX-License-Identifier: GPL-3.0-or-later
// FEBio rj13: Hooke's joint between shafts at 30 degrees, tan(out) = tan(in) cos 30 with the driving yoke normal to the plane
// of the shafts, tan(in)/cos 30 with it in the plane.
#include "verify/verify.hpp"

namespace hilo::test {
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
  EXPECT_NEAR(output_angle(r, 2. / 6), 26.565051, 1e-6);
  EXPECT_NEAR(output_angle(r, 3. / 6), 40.893395, 1e-6);
  EXPECT_NEAR(output_angle(r, 4. / 6), 56.309932, 1e-6);
}

TEST(HookeJoint, TransmitsTheAngleOfItsYokeInThePlane) {
  const Case c("hooke_joint");
  const Results r = c.solved("--set joint.cross.axis=[1,0,0] --set joint.cross.x=[0,1,0]");
  EXPECT_NEAR(output_angle(r, 2. / 6), 33.690068, 1e-6);
  EXPECT_NEAR(output_angle(r, 3. / 6), 49.106605, 1e-6);
  EXPECT_NEAR(output_angle(r, 4. / 6), 63.434949, 1e-6);
}

}  // namespace
}  // namespace hilo::test
