// SPDX-License-Identifier: GPL-3.0-or-later
// Three equal parallel cranks and a coupler without gravity.  Kinetic energy depends on the rate alone, so the cranks turn at 3 rad/s
// without end.  The coupler, 2 kg on a circle of 1 m, is held by 2 x 9 = 18 N along the cranks, in equal shares by the symmetry of
// minimum-norm reactions.
#include "verify/verify.hpp"

namespace hilo::test::parallelogram_test {
namespace {

TEST(Parallelogram, RunsWithRedundantRevolutesAndSaysSo) {
  const Case c("parallelogram");
  const Ran ran = c.solve();
  ASSERT_EQ(ran.exit, 0);
  EXPECT_NE(ran.err.find("7 of 30 joint rows are redundant"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("minimum-norm"), std::string::npos);
  EXPECT_NE(text_of(c / "run.json").find("\"redundant_rows\": 7"), std::string::npos);
  const Results r = c.results();
  // 4 bodies have 24 freedoms and the mechanism one: rank 23 of 30
  const auto e = r.history("energy");
  for (Eigen::Index i = 0; i < e.rows(); ++i) ASSERT_NEAR(e(i, 0), e(0, 0), 1e-10 * e(0, 0));
  EXPECT_LT(r.history("constraint").maxCoeff(), 1e-10) << "dropped rows too";
  // phase error of the mid-point rule: a step turns by 2 atan(omega h/2), relative (omega h)^2/12 = 3e-6
  const Vec3 tip = r.at("probe/B0", 10).head<3>();
  EXPECT_LT((tip - Vec3(std::sin(30.), std::cos(30.), 0)).norm(), 30 * 4e-6);
}

// The one of stability.md B4, links of 1, 2 and 1 m: 3 of its 20 rows are redundant in every position, and what is dropped stays kept.
TEST(Parallelogram, OfTheCatalogueKeepsItsDroppedRowsToRoundOff) {
  const Case c("parallelogram");
  const Ran ran = succeeded(c.run("hilo-solve '" + std::string(HILO_SOURCE) + "/data/stability/scenes/parallelogram.toml' -o b4.h5"));
  EXPECT_NE(ran.err.find("3 of 20 joint rows are redundant"), std::string::npos) << ran.err;
  EXPECT_LT(c.results("b4.h5").history("constraint").maxCoeff(), 1e-12);
}

TEST(Parallelogram, ReactionsAddUpToTheCentripetalForce) {
  const Case c("parallelogram");
  const Results r = c.solved("--set time.end=2");
  for (double t : {0.5, 1.0, 1.5}) {
    Vec3 sum = Vec3::Zero();
    const Vec3 along = r.at("probe/B0", t).head<3>();  // from A0 = origin
    for (int i = 0; i < 3; ++i) {
      const auto row = r.at("body/crank" + std::to_string(i), t);
      // joint frame carried by the crank: inertial axes at the start, turned with the crank
      const double angle = std::atan2(along.x(), along.y());
      const Mat3 frame = Eigen::AngleAxisd(-angle, Vec3::UnitZ()).toRotationMatrix() * frame_of_axis(Vec3::UnitZ());
      const Vec3 force = frame * r.at("joint/B" + std::to_string(i), t).head<3>();
      EXPECT_LT((force + 6 * along).norm(), 1e-3) << i << ": " << force.transpose();
      sum += force;
    }
    EXPECT_LT((sum + 18 * along).norm(), 1e-3) << "t = " << t << ": " << sum.transpose();
  }
}

TEST(Parallelogram, OverconstrainedRunIsTheSameMotionAsAWellPosedOne) {
  const Case c("parallelogram");
  const Results r = c.solved("--set time.end=1");
  // only one crank holds the coupler by a revolute, the second by a distance: no redundant row is left in the plane
  std::string scene = text_of(c.source("scene.toml"));
  for (const char* name : {"A2", "B2", "B1"}) {
    const auto at = scene.find("[[joint]]\nkind = \"revolute\"\nname = \"" + std::string(name) + "\"");
    ASSERT_NE(at, std::string::npos);
    const auto end = scene.find("\n\n", at);
    scene.erase(at, end + 2 - at);
  }
  const auto crank2 = scene.find("[[body]]\nname = \"crank2\"");
  scene.erase(crank2, scene.find("\n\n", crank2) + 2 - crank2);
  const auto initial2 = scene.find("[[initial]]\non = [\"crank2\"]");
  scene.erase(initial2, scene.find("\n\n", initial2) + 2 - initial2);
  const auto crank1 = scene.find("[[body]]\nname = \"crank1\"");
  scene.erase(crank1, scene.find("\n\n", crank1) + 2 - crank1);
  const auto initial1 = scene.find("[[initial]]\non = [\"crank1\"]");
  scene.erase(initial1, scene.find("\n\n", initial1) + 2 - initial1);
  const auto a1 = scene.find("[[joint]]\nkind = \"revolute\"\nname = \"A1\"");
  scene.erase(a1, scene.find("\n\n", a1) + 2 - a1);
  scene += "\n[[joint]]\nkind = \"distance\"\nname = \"rod\"\na = \"ground\"\nb = \"coupler\"\nat_a = [1, 0, 0]\nat_b = [1, 1, 0]\n";
  c.write("scene.toml", scene);
  const Ran ran = succeeded(c.run("hilo-solve scene.toml --set time.end=1 -o posed.h5"));
  EXPECT_EQ(ran.err.find("redundant"), std::string::npos) << ran.err;
  EXPECT_LT((c.results("posed.h5").at("probe/B0", 1).head<3>() - r.at("probe/B0", 1).head<3>()).norm(), 1e-6);
}

}  // namespace
}  // namespace hilo::test::parallelogram_test
