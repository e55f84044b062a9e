// SPDX-License-Identifier: GPL-3.0-or-later
// A bar without loads follows the rotation of its end as a rigid body: x = at + R (X - at), and Green's strain of a rotation is zero.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::turned_bar_test {
namespace {

class TurnedBar : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(EveryShape, TurnedBar,
                         testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20,
                                         Shape::hex20r),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

TEST_P(TurnedBar, FollowsWithoutStress) {
  for (const std::string law : {"stvk", "neo-hookean"}) {
    SceneCase c(solid(2e11, 0.3, 7800, "block", "kind = \"" + law + "\"") +
                motion("rotation", "hand", "xmin", "at = [0.2, -0.1, 0.3]\naxis = [1, 2, -0.5]\nangle = 2") + in_steps(8));
    const Mesh m = block_mesh({.shape = GetParam(), .n = {3, 1, 1}, .high = {1, 0.2, 0.1}});
    c.use(m);
    const Results r = c.solved();
    const auto u = r.field("displacement");
    const Vec3 at(0.2, -0.1, 0.3);
    const Mat3 R = Eigen::AngleAxisd(2, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
    for (size_t a = 0; a < u.size(); ++a) ASSERT_LT((m.X[a] + u[a] - at - R * (m.X[a] - at)).norm(), 1e-9);
    EXPECT_LT(r.table("/field/" + r.steps().back() + "/von_mises").maxCoeff(), 1e-9 * 2e11);
    EXPECT_LT(r.at("motion/hand", 1).norm(), 1e-9 * 2e11 * 0.02);
  }
}

}  // namespace
}  // namespace hilo::test::turned_bar_test
