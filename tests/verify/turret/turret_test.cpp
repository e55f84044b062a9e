// SPDX-License-Identifier: GPL-3.0-or-later
// The scene of data/turret.  What turns about the ring gains angular momentum by the torques on it alone; what the ring carries is
// m r omega^2 outwards, m r alpha against the turn and the weight, from the masses and centres of mass of the bodies in the results file
// (truth.py); with a support made stiffer the bearing force comes to that of the rigid run as 1/E.
#include "verify/truth.hpp"

namespace hilo::test::turret_test {
namespace {

/// The mesh of data/turret, tagged both ways in a folder of its own.
class Turret : public Workplace {
 public:
  Turret() {
    succeeded(run("hilo-import --quiet " + folder_ + "/turret.geo --trust -o mesh.h5 && hilo-tag --quiet mesh.h5 " + folder_ +
                  "/tags-rigid.toml -o rigid.h5 && hilo-tag --quiet mesh.h5 " + folder_ + "/tags-flexible.toml -o flexible.h5"));
  }
  Results solved(const std::string& tags, const std::string& options) const {
    succeeded(run("hilo-solve --quiet " + folder_ + "/scene.toml " + tags + ".h5 -o run.h5 " + options));
    if (tags == "rigid") {
      EXPECT_EQ(run("hilo-show --json run.h5 > bodies.json").exit, 0);
    }
    return Results(*this / "run.h5");
  }
  /// Time, torque on the turret [N m], force on its ring forward, right and down [N], at every row of the last run but the first and last.
  Eigen::MatrixXd by_hand() const {
    return truth_table(*this,
                       "hilo-post series run.h5 momentum probe.turret -o motion.csv && " + folder_ + "/truth.py bodies.json motion.csv");
  }

 private:
  std::string folder_ = std::string(HILO_SOURCE) + "/data/turret";
};

/// Largest |sum of torques - rate of angular momentum about the ring's axis|, over the largest torque.
double torque_imbalance(const Results& r, const Eigen::MatrixXd& hand) {
  const Eigen::VectorXd torque = r.history("motor/slew").col(5) + r.history("friction/race").col(5);
  return (hand.col(1) - torque.segment(1, hand.rows())).cwiseAbs().maxCoeff() / torque.cwiseAbs().maxCoeff();
}

/// Largest distance of the ring's force from that of masses on circles, over the largest of these: forward, right, down.
Vec3 off_the_formula(const Results& r, const Eigen::MatrixXd& hand) {
  const Eigen::MatrixXd force = r.history("joint/ring").block(1, 0, hand.rows(), 3), circles = hand.rightCols(3);
  const Vec3 off = (force - circles).cwiseAbs().colwise().maxCoeff(), most = circles.cwiseAbs().colwise().maxCoeff();
  return off.cwiseQuotient(most);
}

TEST(Turret, TorqueIsTheRateOfAngularMomentumAndTheRingCarriesTheMassesOnTheirCircles) {
  const Turret turret;
  const Results coarse = turret.solved("rigid", "--set time.step=5e-3");
  const Eigen::MatrixXd coarse_hand = turret.by_hand();
  const Vec3 wide = off_the_formula(coarse, coarse_hand);
  EXPECT_LT(torque_imbalance(coarse, coarse_hand), 1e-11);
  const Results fine = turret.solved("rigid", "");
  const Eigen::MatrixXd hand = turret.by_hand();
  const Vec3 off = off_the_formula(fine, hand);
  EXPECT_LT(torque_imbalance(fine, hand), 1e-11);
  EXPECT_LT(off[0], 1e-4) << "centrifugal";
  EXPECT_LT(off[1], 1e-6) << "tangential";
  EXPECT_LT(off[2], 1e-10) << "weight";
  EXPECT_NEAR(wide[0] / off[0], 4, 0.1) << "second order in the step";
}

TEST(Turret, TheBearingForceOfAStifferSupportComesToTheRigidOneAsOneOverE) {
  const Turret turret;
  const std::string span = "--set time.step=5e-3 --set time.end=0.5 --set output.interval=0.5 ";
  const auto rigid = turret.solved("rigid", span).history("joint/ring");
  double distance[3];
  for (int k = 0; k < 3; ++k) {
    const Results r = turret.solved("flexible", span + "--set material.support_steel.E=2.05e" + std::to_string(9 + k));
    EXPECT_LT(torque_imbalance(r, turret.by_hand()), 1e-9) << "Newton stops at 1e-10 of the forces";
    distance[k] = (r.history("joint/ring") - rigid).leftCols(2).cwiseAbs().maxCoeff() / rigid.leftCols(2).cwiseAbs().maxCoeff();
  }
  EXPECT_NEAR(std::log10(distance[1] / distance[0]), -1, 0.05);
  EXPECT_NEAR(std::log10(distance[2] / distance[1]), -1, 0.05);
  EXPECT_LT(distance[2], 3e-5) << "steel";
}

}  // namespace
}  // namespace hilo::test::turret_test
