// The scene of data/turret.  What turns about the ring gains angular momentum by the torques on it alone; what the ring carries is
// m r omega^2 outwards, m r alpha against the turn and the weight, from the masses and centres of mass of the bodies in the results file;
// with a support made stiffer the bearing force comes to that of the rigid run as 1/E.
#include <cmath>

#include "verify/verify.hpp"

namespace hilo::test {
namespace {

constexpr double x_ring = -0.5;

/// The mesh of data/turret, tagged both ways in a folder of its own.
class Turret : public Workplace {
 public:
  Turret() {
    const Ran ran = run("hilo-import --quiet " + folder_ + "/turret.geo -o mesh.h5 && hilo-tag --quiet mesh.h5 " + folder_ +
                        "/tags-rigid.toml -o rigid.h5 && hilo-tag --quiet mesh.h5 " + folder_ + "/tags-flexible.toml -o flexible.h5");
    EXPECT_EQ(ran.exit, 0) << ran.err;
  }
  Results solved(const std::string& tags, const std::string& options) const {
    const Ran ran = run("hilo-solve --quiet " + folder_ + "/scene.toml " + tags + ".h5 -o run.h5 " + options);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    return Results(*this / "run.h5");
  }

 private:
  std::string folder_ = std::string(HILO_SOURCE) + "/data/turret";
};

/// Largest |sum of torques - rate of angular momentum about the ring's axis|, over the largest torque.
double torque_imbalance(const Results& r) {
  const auto p = r.history("momentum"), torque = r.history("motor/slew"), drag = r.history("friction/race");
  const auto L = [&](Eigen::Index i) { return p(i, 5) - x_ring * p(i, 1); };
  double off = 0;
  for (Eigen::Index i = 1; i + 1 < p.rows(); ++i) {
    const double rate = (L(i + 1) - L(i - 1)) / (r.t()[i + 1] - r.t()[i - 1]);
    off = std::max(off, std::abs(rate - torque(i, 5) - drag(i, 5)));
  }
  return off / torque.col(5).cwiseAbs().maxCoeff();
}

/// Largest distance of the ring's force from that of masses on circles, over the largest of these: forward, right, down.
Vec3 off_the_formula(const Results& r) {
  const auto mass = r.file().read<double>("/body/mass"), points = r.file().read<double>("/body/points");
  const auto names = r.file().read_strings("/body/name");
  double m = 0, mx = 0, my = 0;
  for (size_t b = 0; b < mass.size(); ++b)
    if (names[b] != "chassis") m += mass[b], mx += mass[b] * (points[12 * b] - x_ring), my += mass[b] * points[12 * b + 1];
  const auto force = r.history("joint/ring"), probe = r.history("probe/turret");
  const auto omega = [&](Eigen::Index i) {
    const double x = probe(i, 0) - x_ring, y = probe(i, 1);
    return (x * probe(i, 4) - y * probe(i, 3)) / (x * x + y * y);
  };
  Vec3 off = Vec3::Zero(), most = Vec3::Zero();
  for (Eigen::Index i = 1; i + 1 < probe.rows(); ++i) {
    const double w = omega(i), alpha = (omega(i + 1) - omega(i - 1)) / (r.t()[i + 1] - r.t()[i - 1]);
    const Vec3 hand(mx * w * w + my * alpha, mx * alpha - my * w * w, 9.80665 * m);
    most = most.cwiseMax(hand.cwiseAbs());
    off = off.cwiseMax((force.row(i).head<3>().transpose() - hand).cwiseAbs());
  }
  return off.cwiseQuotient(most);
}

TEST(Turret, TorqueIsTheRateOfAngularMomentumAndTheRingCarriesTheMassesOnTheirCircles) {
  const Turret turret;
  const Results coarse = turret.solved("rigid", "--set time.step=5e-3");
  const Vec3 wide = off_the_formula(coarse);
  EXPECT_LT(torque_imbalance(coarse), 1e-11);
  const Results fine = turret.solved("rigid", "");
  const Vec3 off = off_the_formula(fine);
  EXPECT_LT(torque_imbalance(fine), 1e-11);
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
    EXPECT_LT(torque_imbalance(r), 1e-9) << "Newton stops at 1e-10 of the forces";
    distance[k] = (r.history("joint/ring") - rigid).leftCols(2).cwiseAbs().maxCoeff() / rigid.leftCols(2).cwiseAbs().maxCoeff();
  }
  EXPECT_NEAR(std::log10(distance[1] / distance[0]), -1, 0.05);
  EXPECT_NEAR(std::log10(distance[2] / distance[1]), -1, 0.05);
  EXPECT_LT(distance[2], 3e-5) << "steel";
}

}  // namespace
}  // namespace hilo::test
