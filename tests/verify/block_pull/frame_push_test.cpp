// SPDX-License-Identifier: GPL-3.0-or-later
// Lee's frame pushed down by what moves by a law, to more than a third of its height.
#include "succeeded.hpp"
#include "verify/lee_frame.hpp"

namespace hilo::test::frame_push_test {
namespace {

/// At .2 m it passes the load at which it may give way out of its plane.
TEST(FramePush, TakesFewIterationsAndCuts) {
  Case c("block_pull");
  c.use(lee_frame());
  c.write("scene.toml", lee_frame_scene(pushed_by_a_law + "[time]\nanalysis = \"static\"\nend = 1\n"));
  std::vector<double> force;
  for (const int steps : {60, 120}) {
    const Ran ran = succeeded(c.run("hilo-solve scene.toml mesh.h5 -o run.h5 --set time.steps=" + std::to_string(steps)));
    EXPECT_EQ(c.reported("cuts"), 0) << ran.err;
    EXPECT_LE(c.reported("newton_iterations"), 3 * steps) << c.reported("newton_iterations");
    force.push_back(c.results().at("motion/push", 1)[1]);
  }
  EXPECT_NEAR(force[0], force[1], 1e-6 * std::abs(force[1]));
}

}  // namespace
}  // namespace hilo::test::frame_push_test
