// SPDX-License-Identifier: GPL-3.0-or-later
// A free body falls by v t + g t^2/2, exactly under the mid-point rule (constant acceleration), rigid or flexible.  FEBio dy01/dy05 is the
// same with unit acceleration and 1 s: 0.5.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::free_fall_test {
namespace {

const std::string falls = "gravity = [1, 2, -9.81]\n" + solid(2e11, 0.3, 7800, "block") + initial("block", "velocity = [3, -1, 2]") +
                          probe("all", "block") + in_time(1, 0.01) + "[output]\ninterval = 0.25\n";

class FreeFall : public testing::TestWithParam<std::tuple<Shape, Fidelity>> {};
INSTANTIATE_TEST_SUITE_P(
    EveryShape, FreeFall,
    testing::Combine(testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20, Shape::hex20r),
                     testing::Values(Fidelity::nonlinear, Fidelity::rigid)),
    [](const auto& p) { return std::string(hilo::info(std::get<0>(p.param)).name) + "_" + std::string(word(std::get<1>(p.param))); });

TEST_P(FreeFall, EveryNodeFallsAsGalileiSays) {
  const auto [shape, fidelity] = GetParam();
  SceneCase c(falls);
  c.use(block_mesh({.shape = shape,
                    .n = {2, 1, 1},
                    .high = {0.4, 0.2, 0.1},
                    .map =
                        [](const Vec3& x) {
                          return Vec3(x + 0.02 * Vec3(scatter(std::lround(100 * x[0])), scatter(std::lround(77 * x[1])),
                                                      scatter(std::lround(99 * x[2] + 7 * x[0]))));
                        }}),
        {fidelity});
  const Results r = c.solved();
  const Vec3 v(3, -1, 2), g(1, 2, -9.81);
  for (const std::string& step : r.steps()) {
    const double t = r.field_time(step);
    const auto u = r.field("displacement", step), w = r.field("velocity", step), a = r.field("acceleration", step);
    for (size_t i = 0; i < u.size(); ++i) {
      ASSERT_LT((u[i] - t * v - t * t / 2 * g).norm(), 1e-12) << "t = " << t;
      ASSERT_LT((w[i] - v - t * g).norm(), 1e-9) << "round-off in modes of 1e5 rad/s";
      ASSERT_LT((a[i] - g).norm(), 1e-7);
    }
    if (fidelity == Fidelity::nonlinear) {
      EXPECT_LT(r.table("/field/" + step + "/von_mises").maxCoeff(), 1e-12 * 2e11) << "no strain, no stress";
    }
  }
}

// Truth: an accelerometer in free fall feels nothing; at rest on the ground it feels +1 g upward.
TEST(FreeFallSensor, FeelsNothing) {
  const std::string seat = "[[sensor]]\nname = \"seat\"\non = \"block\"\n";
  SceneCase c(falls + seat);
  c.use(block_mesh({}), {Fidelity::rigid});
  EXPECT_LT(c.solved().history("sensor/seat").cwiseAbs().maxCoeff(), 1e-9);
  c.write("scene.toml", falls + seat + joint("fixed", "bolt", "ground", "block", Vec3::Zero()));
  const auto felt = c.solved("--set gravity=[0,0,-9.80665]").history("sensor/seat");
  for (Eigen::Index i = 0; i < felt.rows(); ++i) ASSERT_LT((felt.row(i).transpose() - Vec3(0, 0, 1)).norm(), 1e-9) << "row " << i;
}

// Truth: axes cannot be told about a line; those of an edge stay as drawn, and a line says so.
TEST(FreeFallSensor, OnAnEdgeHasAxesThatStay) {
  SceneCase c(solid(2e9, 0.3, 1000, "block") + initial("block", "spin = [0, 10, 0]\nabout = [0, 0, 0]") +
              "[set.edge]\nkind = \"box\"\nlow = [0.9, -9, -0.1]\nhigh = [9, 9, 0.1]\n[[sensor]]\nname = \"edge\"\non = \"edge\"\n"
              "[[sensor]]\nname = \"face\"\non = \"xmax\"\n" +
              probe("edge") + in_time(0.1, 2e-3));
  c.use(block_mesh({}), {Fidelity::nonlinear});
  const Ran ran = c.solve();
  EXPECT_NE(ran.err.find("sensor \"edge\": the nodes of \"edge\" lie on a line"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find("sensor \"face\""), std::string::npos) << ran.err;
  const Results r = c.results();
  EXPECT_LT((r.history("sensor/edge") - r.history("probe/edge").rightCols(3) / g0).cwiseAbs().maxCoeff(), 1e-12);
}

// What is not where it was asked for, and not turned as it was asked for, is told.
TEST(FreeFallSensor, AWayToTheNearestNodeAndATiltThatIsDroppedAreTold) {
  SceneCase c(
      solid(2e9, 0.3, 1000, "block") + "[[probe]]\nname = \"far\"\non = \"xmax\"\nat = [1, 4, 0]\n" +
      "[[probe]]\nname = \"near\"\non = \"xmax\"\nat = [1, 0.6, 0.6]\n" +
      "[[sensor]]\nname = \"tilted\"\non = \"xmax\"\nx = [1, 0, 0.5]\n[[sensor]]\nname = \"right\"\non = \"xmax\"\nx = [1, 0, 0.01]\n" +
      in_time(1e-3, 1e-3));
  c.use(block_mesh({}), {Fidelity::nonlinear});
  const Ran ran = c.solve();
  EXPECT_NE(ran.err.find("probe \"far\": the nearest node of \"xmax\" is 3 m away, at (1, 1, 0)"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find("probe \"near\""), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("sensor \"tilted\": x is 26.6 degrees off the plane normal to z"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find("sensor \"right\""), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::free_fall_test
