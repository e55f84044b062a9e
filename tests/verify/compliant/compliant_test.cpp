// SPDX-License-Identifier: GPL-3.0-or-later
// Joints that give way: springs along the rows of the joint.
#include "verify/verify.hpp"

namespace hilo::test {
namespace {

// Truth: let go, a mass m on k and c sinks as -m g/k (1 - exp(-d t)(cos w t + d/w sin w t)), d = c/(2 m), w^2 = k/m - d^2; the mount
// carries it.
TEST(CompliantJoint, MountSinksAsADampedOscillator) {
  const Case c("compliant");
  const Ran ran = c.solve("--quiet", "run.h5", 0, "mount");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  const double m = 40, k = 1e5, d = 400 / (2 * m), w = std::sqrt(k / m - d * d), sink = m * 9.81 / k;
  const auto x = r.history("probe/engine"), f = r.history("joint/mount");
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double t = r.t()[i], at = std::exp(-d * t), z = -sink * (1 - at * (std::cos(w * t) + d / w * std::sin(w * t)));
    EXPECT_NEAR(x(i, 2), 1 + z, 1e-3 * sink);
    EXPECT_NEAR(f(i, 2), -k * z + 400 * sink * k / m / w * at * std::sin(w * t), 2e-3 * m * 9.81) << "upwards, on the engine";
  }
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10);
}

// Truth: the stiffer the pin, the nearer the pendulum to the one on a rigid pin: the pin gives by F/k.
TEST(CompliantJoint, TendsToTheRigidJoint) {
  const Case c("compliant");
  ASSERT_EQ(c.solve("--quiet", "rigid.h5", 0, "rigid").exit, 0);
  const auto rigid = c.results("rigid.h5").history("probe/bob");
  double apart[2];
  for (int i = 0; i < 2; ++i) {
    const Results r = c.solved(i ? "--set 'joint.pin.stiffness=[1e6,1e6,1e6]'" : "--set joint.pin.stiffness=1e5");
    const auto x = r.history("probe/bob");
    apart[i] = (x.leftCols(3) - rigid.leftCols(3)).cwiseAbs().maxCoeff();
    EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_LT(apart[1], 20 * 60 / 1e6) << "the pin carries up to 3 m g = 60 N";
  EXPECT_LT(apart[1], 0.2 * apart[0]);
}

TEST(CompliantJoint, MistakesAreNamed) {
  const Case c("compliant");
  const auto says = [&](const std::string& option, const std::string& text) {
    const Ran ran = c.solve("--quiet --set " + option, "bad.h5", 2);
    EXPECT_NE(ran.err.find(text), std::string::npos) << ran.err;
  };
  says("'joint.pin.stiffness=[1,2]'", "2 numbers, not 1 or 3");
  says("'joint.pin.angular_stiffness=[1,0,1]'", "leaves a row of the joint without a spring");
  says("joint.pin.spin=3", "cannot be driven");
}

}  // namespace
}  // namespace hilo::test
