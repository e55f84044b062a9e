// SPDX-License-Identifier: GPL-3.0-or-later
// Start positions that the scene draws apart are put together, velocities follow the drive, and what cannot be put together is named.
#include <Eigen/Geometry>

#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::assembly_test {
namespace {

// Exact: the crank stands at 30 degrees and turns at 1 rad/s; the other pin is where the circles of coupler and rocker meet.
TEST(Assembly, PutsAFourBarWhereItsDriveWantsIt) {
  const Case c("assembly");
  const Ran ran = c.solve();
  EXPECT_NE(ran.err.find("start positions changed by up to"), std::string::npos) << ran.err;
  EXPECT_GT(c.reported("position_change"), 0.2);
  const Results r = c.results();
  for (const double t : {0.0, 0.1}) {
    const double theta = 0.5235987755982988 + t;
    const auto low = r.at("probe/low", t), high = r.at("probe/high", t);
    const Vec3 exact = 0.5 * Vec3(std::cos(theta), 0, std::sin(theta));
    EXPECT_LT((low.head<3>() - exact).norm(), 1e-12) << t;
    EXPECT_LT((low.segment<3>(3) - Vec3(-exact[2], 0, exact[0])).norm(), 1e-6) << "velocity at t = " << t;
    EXPECT_NEAR((high.head<3>() - low.head<3>()).norm(), 1.2, 1e-12);
    EXPECT_NEAR((high.head<3>() - Vec3(0.8, 0, 1.2)).norm(), 0.3, 1e-12);
    EXPECT_NEAR((high.head<3>() - low.head<3>()).dot(high.segment<3>(3) - low.segment<3>(3)), 0, 1e-6);
    EXPECT_LT(high[0], 0.8) << "the branch it was drawn in";
  }
  EXPECT_LT(c.reported("energy_balance"), 1e-11);
}

// Exact: the nearest place on the sphere of radius 6 is along the ray.
TEST(Assembly, MovesAsLittleAsTheMassesSay) {
  const Case c("assembly");
  const Results r = c.solved("", "run.h5", "rod");
  EXPECT_LT((r.at("probe/ball", 0).head<3>() - 6 * Vec3(0.6, 0.8, 0)).norm(), 1e-9);
  EXPECT_NEAR(c.reported("position_change"), 1, 1e-9);
}

// Exact: nothing but the joint asks the beam to move, so it turns as a whole and stays free of stress; the mass norm alone would shear the
// cells next to the joint.
TEST(Assembly, TurnsAnElasticBeamAsAWhole) {
  SceneCase c(solid(2e9, 0.3, 1000) +
              axial("revolute", "motor", "ground", "xmin", {0, 0.025, 0.025}, {0, -1, 0}, "angle = 0.5\nhistory = 1") +
              in_time(0.01, 1e-3));
  const Mesh mesh = block_mesh({.n = {12, 1, 1}, .high = {1, 0.05, 0.05}});
  c.use(mesh);
  const Results r = c.solved("--set output.interval=0.01");
  const Vec3 at(0, 0.025, 0.025);
  const Mat3 R = Eigen::AngleAxisd(0.5, -Vec3::UnitY()).toRotationMatrix();
  const auto u = r.field("displacement", r.steps().front());
  for (size_t i = 0; i < mesh.X.size(); ++i) EXPECT_LT((mesh.X[i] + u[i] - at - R * (mesh.X[i] - at)).norm(), 1e-4) << "node " << i;
  EXPECT_LT(r.history("energy")(0, 1), 1e-9 * 2e9 * 0.0025) << "elastic energy against E V";
}

/// A door on two hinges, of which one begins at 0.2 rad: five rows are redundant from the start.
TEST(Assembly, OfRedundantJoints) {
  const Vec3 axis = Vec3(-0.6, 0.7, 0.3).normalized(), com(0.12, -0.01, 0.27), at = 0.1 * axis;
  const std::string door =
      body("door", 2, com, {0.07, 0.07, 0.05}) +
      axial("revolute", "hinge", "ground", "door", {0, 0, 0}, axis, "angle = 0.2\nhistory = {t = [0, 1], value = [1, 1]}") + probe("door") +
      in_time(1e-2, 1e-3);
  const Vec3 exact = Eigen::AngleAxisd(0.2, axis) * com;
  for (const std::string& more : {std::string(), axial("revolute", "other", "ground", "door", at, axis)}) {
    SceneCase c(door + more);
    EXPECT_LT((c.solved().at("probe/door", 0).head<3>() - exact).norm(), 1e-10) << more;
  }
}

TEST(Assembly, NamesTheJointThatCannotBeClosed) {
  const Case c("assembly");
  std::string scene = text_of(c.source("rod.toml"));
  c.write("scene.toml", scene + joint("spherical", "hook", "ground", "ball", {3, 4.5, 0}) +
                            joint("spherical", "other hook", "ground", "ball", {3, 3.5, 0}));
  expect_end(c.run("hilo-solve --quiet scene.toml -o run.h5"), 2, "the joints cannot be put together at the start: joint \"");
  EXPECT_FALSE(std::filesystem::exists(c / "run.h5"));
}

}  // namespace
}  // namespace hilo::test::assembly_test
