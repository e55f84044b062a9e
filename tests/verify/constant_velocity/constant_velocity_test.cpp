// SPDX-License-Identifier: GPL-3.0-or-later
// A constant-velocity joint passes the angle on unchanged at any bend, where a Hooke joint gives tan(out) = tan(in) cos(30) or
// tan(in)/cos(30) (FEBio rj13).
#include <numbers>

#include "verify/verify.hpp"

namespace hilo::test::constant_velocity_test {
namespace {

using std::numbers::pi;

/// Angle about `axis`, from z towards axis x z.
double angle(const Vec3& arm, const Vec3& axis) { return std::atan2(arm.dot(axis.cross(Vec3::UnitZ())), arm[2]); }

TEST(ConstantVelocityJoint, PassesTheAngleOnUnchanged) {
  const Case c("constant_velocity");
  const Results r = c.solved();
  const Vec3 in(1, 0, 0), out(std::cos(pi / 6), 0.5, 0);
  const auto a = r.history("probe/input"), b = r.history("probe/output");
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double theta = angle(a.row(i).head<3>().transpose() - Vec3(-0.3, 0, 0), in);
    const double phi = angle(b.row(i).head<3>().transpose() - 0.3 * out, out);
    ASSERT_NEAR(std::remainder(theta - 2 * pi / 3 * r.t()[i], 2 * pi), 0, 1e-12) << "the drive, over two turns";
    ASSERT_NEAR(std::remainder(phi - theta, 2 * pi), 0, 1e-12) << "t = " << r.t()[i];
  }
}

TEST(ConstantVelocityJoint, DoesWhatAHookeJointDoesNot) {
  const Case c("constant_velocity");
  std::string scene = text_of(c.source("scene.toml"));
  const auto at = scene.find("axis_b"), end = scene.find('\n', at);
  scene.erase(at, end - at + 1);
  scene.replace(scene.find("constant-velocity"), 17, "universal");
  const auto axis = scene.find("at = [0, 0, 0]\naxis = [1, 0, 0]");
  scene.replace(axis, 31, "at = [0, 0, 0]\naxis = [0, 0, 1]\nx = [-0.5, 0.8660254037844386, 0]");  // the cross: z of a, and normal to b
  c.write("hooke.toml", scene);
  succeeded(c.run("hilo-solve --quiet hooke.toml -o run.h5"));
  const Results r = c.results();
  // arm of a: cos(in) z - sin(in) y; arm of b: cos(out) e + sin(out) z with e = (-1/2, cos 30, 0); they stay at a right angle
  const Vec3 in(1, 0, 0), out(std::cos(pi / 6), 0.5, 0);
  for (const double t : {0.25, 0.375, 0.5}) {  // 30, 45, 60 degrees
    const double theta = angle(r.at("probe/input", t).head<3>() - Vec3(-0.3, 0, 0), in);
    const double phi = angle(r.at("probe/output", t).head<3>() - 0.3 * out, out);
    EXPECT_NEAR(std::tan(phi), std::tan(theta) * std::cos(pi / 6), 1e-11) << t;
  }
}

}  // namespace
}  // namespace hilo::test::constant_velocity_test
