// SPDX-License-Identifier: GPL-3.0-or-later
// Large deflection of a slender solid.  Published (Sze, Liu, Lo 2004): U = 3.286, W = 6.698; Reissner
// beam: 3.28946, 6.70011.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::elastica_test {
namespace {

void expect_tip(Shape shape, int along, const std::string& law) {
  SceneCase c(solid(1.2e6, 0, 1, "block", "kind = \"" + law + "\"") + held("xmin") + force("shear", "xmax", {0, 0, 4}) +
              probe("tip", "xmax") + in_steps(10));
  c.use(block_mesh({.shape = shape, .n = {along, 1, 1}, .high = {10, 1, 0.1}}));
  const Results r = c.solved();
  const Vec3 u = r.at("probe/tip", 1).head<3>() - Vec3(10, 0.5, 0.05);
  EXPECT_NEAR(-u[0], 3.28946, 0.005 * 3.28946) << info(shape).name << " " << law;
  EXPECT_NEAR(u[2], 6.70011, 0.005 * 6.70011) << info(shape).name << " " << law;
  EXPECT_NEAR(-u[0], 3.286, 0.005 * 3.286);
  EXPECT_NEAR(u[2], 6.698, 0.005 * 6.698);
  EXPECT_NEAR(u[1], 0, 1e-8);
  // the clamp carries the force and its moment about its own centre: P (L - U)
  const auto reaction = r.at("motion/xmin xyz", 1);
  EXPECT_LT((reaction.head<3>() + Vec3(0, 0, 4)).norm(), 1e-6);
  EXPECT_NEAR(reaction[4], 4 * (10 + u[0]), 0.01);
}

TEST(Elastica, OfOnePointHexahedraIsWithinHalfAPercent) { expect_tip(Shape::hex8, 40, "stvk"); }
TEST(Elastica, OfNeoHookeanHexahedraIsWithinHalfAPercent) { expect_tip(Shape::hex8, 40, "neo-hookean"); }
TEST(Elastica, OfQuadraticHexahedraIsWithinHalfAPercent) { expect_tip(Shape::hex20, 40, "stvk"); }

}  // namespace
}  // namespace hilo::test::elastica_test
