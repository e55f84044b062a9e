// SPDX-License-Identifier: GPL-3.0-or-later
// Torque on a free body: about a principal axis J omega = M t, the energy is M^2 t^2/(2 J); about any axis the work is the gain of kinetic
// energy.
#include "verify/verify.hpp"

namespace hilo::test::torque_test {
namespace {

TEST(Torque, SpinsABodyUpAboutItsPrincipalAxis) {
  const Case c("torque");
  for (const char* follower : {"false", "true"}) {
    const Results r = c.solved(std::string("--set load.torque.follower=") + follower);
    const auto e = r.history("energy"), l = r.history("momentum");
    for (Eigen::Index i = 0; i < e.rows(); ++i) {
      const double t = r.t()[i];
      EXPECT_NEAR(e(i, 0), 25 * t * t / 8, 2e-3 * (1e-3 + e(i, 0))) << "omega h up to 0.025: second order";
      EXPECT_NEAR(e(i, 0), e(i, 3), 1e-11 * (1 + e(i, 3))) << "work of the torque";
      // angular momentum about the centre: M t, exactly in the inertial frame
      EXPECT_NEAR(l(i, 5), 5 * t, 1e-10);
    }
  }
}

TEST(Torque, WorkIsTheGainOfKineticEnergyWhileTheBodyTumbles) {
  const Case c("torque");
  for (const char* follower : {"false", "true"}) {
    const Results r = c.solved(std::string("--set load.torque.torque=[3,-7,4] --set load.torque.follower=") + follower);
    const auto e = r.history("energy");
    EXPECT_GT(e(e.rows() - 1, 0), 10);
    EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-11 * e.col(0).maxCoeff());
  }
  // a constant inertial torque: the angular momentum about the centre is M t, whatever the motion
  const Results r = c.solved("--set load.torque.torque=[3,-7,4]");
  const auto l = r.history("momentum");
  for (Eigen::Index i = 0; i < l.rows(); ++i) ASSERT_LT((l.row(i).tail<3>().transpose() - r.t()[i] * Vec3(3, -7, 4)).norm(), 1e-10);
}

}  // namespace
}  // namespace hilo::test::torque_test
