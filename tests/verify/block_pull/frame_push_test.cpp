// SPDX-License-Identifier: GPL-3.0-or-later
// Lee's frame pushed down by what moves by a law, to more than a third of its height.
#include "verify/lee_frame.hpp"

namespace hilo::test::frame_push_test {
namespace {

/// At .2 m it passes the load at which it may give way out of its plane.
TEST(FramePush, TakesFewIterationsAndCuts) {
  SceneCase c(lee_frame_scene(pushed_by_a_law + "[time]\nanalysis = \"static\"\nend = 1\n"));
  c.use(lee_frame());
  std::vector<double> force;
  for (const int steps : {60, 120}) {
    force.push_back(c.solved("--set time.steps=" + std::to_string(steps)).at("motion/push", 1)[1]);
    EXPECT_EQ(c.reported("cuts"), 0);
    EXPECT_LE(c.reported("newton_iterations"), 3 * steps) << c.reported("newton_iterations");
  }
  EXPECT_NEAR(force[0], force[1], 1e-6 * std::abs(force[1]));
}

}  // namespace
}  // namespace hilo::test::frame_push_test
