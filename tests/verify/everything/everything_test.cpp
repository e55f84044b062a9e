// SPDX-License-Identifier: GPL-3.0-or-later
// Balances that hold for any scene, over one that has everything: energy, E - E0 - W + D = 0, and impulse, the change of momentum is the
// time integral of weight, loads and what the ground exerts through joints, springs and motions.
#include "verify/everything/half_rigid.hpp"

namespace hilo::test::everything_test {
namespace {

TEST(Everything, EnergyIsInBalance) {
  const hilo::test::Everything c;
  const Results r = c.solved("--set solver.tolerance=1e-12");
  const auto e = r.history("energy");
  EXPECT_GT(e.col(3).cwiseAbs().maxCoeff(), 1) << "work was done";
  EXPECT_GT(e(e.rows() - 1, 4), 1) << "and dissipated";
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * e.col(0).maxCoeff());
  EXPECT_LT(r.history("constraint").maxCoeff(), 1e-11);
  EXPECT_LT(r.history("newton").maxCoeff(), 8);
}

TEST(Everything, ImpulseOfAllForcesIsTheChangeOfMomentum) {
  const hilo::test::Everything c;
  const Results r = c.solved();
  const double mass = 0.4 * 0.3 * 1.2 * 1000 + 3 + 2 + 5;
  const Vec3 constant = mass * Vec3(1, -2, -9.81) + Vec3(50, 20, -30) + 0.3 * 1.2 * Vec3(300, 100, 0);
  const auto rod = r.history("joint/rod"), mount = r.history("spring/mount"), held = r.history("motion/corner xz"),
             turned = r.history("motion/turned"), p = r.history("momentum");
  const auto& t = r.t();
  Vec3 impulse = Vec3::Zero();
  double size = 0;
  for (Eigen::Index i = 0; i + 1 < t.size(); ++i) {
    const auto force = [&](Eigen::Index k) -> Vec3 {
      return constant + Vec3((rod.row(k) + mount.row(k) + held.row(k) + turned.row(k)).head<3>().transpose());
    };
    const Vec3 mean = (force(i) + force(i + 1)) / 2;
    impulse += (t[i + 1] - t[i]) * mean, size += (t[i + 1] - t[i]) * mean.norm();
    const Vec3 change = (p.row(i + 1) - p.row(0)).head<3>().transpose();
    ASSERT_LT((impulse - change).norm(), 1e-3 * size + 1e-2) << "t = " << t[i + 1] << ": trapezoidal rule on second-order values";
  }
}

}  // namespace
}  // namespace hilo::test::everything_test
