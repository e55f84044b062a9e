// SPDX-License-Identifier: GPL-3.0-or-later
// FEBio ri01: with lambda = 0 the block stretches uniformly, l - 1/l = 0.1, so the rigid body moves by 4 (l - 1) =
// 0.2049969.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::block_pull_test {
namespace {

BlockOptions block() {
  const BlockOptions o{.n = {8, 2, 2}, .low = {-2, 0, 0}, .high = {2, 1, 1}};
  return o;
}
constexpr double exact = 4 * (0.05 + 1.001249219725039 - 1);  // l = 0.05 + sqrt(0.05^2 + 1)

const std::string rubber = "kind = \"neo-hookean\"", pulled = solid(1, 0, 1, "block", rubber) + held("xmin") +
                                                              force("pull", "plate", {0.05, 0, 0}) + probe("plate") + in_steps(2);

TEST(BlockPull, BodyFixedToTheEndFaceMovesByTheClosedForm) {
  EXPECT_NEAR(exact, 0.2049969, 1e-7);
  SceneCase c(pulled + body("plate", 1, {2, 0.5, 0.5}, {1, 1, 1}) + joint("fixed", "glue", "plate", "xmax", {2, 0.5, 0.5}));
  c.use(block_mesh(block()));
  const Results r = c.solved();
  EXPECT_NEAR(r.at("probe/plate", 1)[0] - 2, exact, 1e-8);
  EXPECT_LT((r.at("joint/glue", 1).head<3>() - Vec3(0.05, 0, 0)).norm(), 1e-9) << "the glue carries the force on to b";
  EXPECT_LT((r.at("motion/xmin xyz", 1).head<3>() - Vec3(-0.05, 0, 0)).norm(), 1e-9);
}

TEST(BlockPull, RigidRegionThatSharesTheFaceMovesByTheClosedForm) {
  SceneCase c(pulled + solid(1, 0, 1, "plate", rubber));
  BlockOptions o = block();
  o.n[0] = 9, o.high[0] = 2.5;
  o.regions = {"block", "plate"};
  o.region_of = [](const Vec3& x) { return x[0] > 2 ? 1 : 0; };
  for (const Shape shape : {Shape::hex8, Shape::hex20, Shape::tet10, Shape::wedge15, Shape::wedge6, Shape::tet4}) {
    o.shape = shape;
    c.use(block_mesh(o), {Fidelity::nonlinear, Fidelity::rigid});
    EXPECT_NEAR(c.solved().at("probe/plate", 1)[0] - 2.25, exact, 1e-6) << info(shape).name;
  }
}

}  // namespace
}  // namespace hilo::test::block_pull_test
