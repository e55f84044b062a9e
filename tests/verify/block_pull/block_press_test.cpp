// SPDX-License-Identifier: GPL-3.0-or-later
// A rubber cube pressed by a fifth of its height between plates that hold it, in four steps: what moves by a law takes the rest along, so
// that no step begins with one layer of cells squeezed alone.  Elastic: 32 steps end where four do.
#include "verify/verify.hpp"

namespace hilo::test::block_press_test {
namespace {

const std::string scene = R"(
material.rubber = {kind = "neo-hookean", E = 1e6, density = 1000}
region."*" = {material = "rubber"}
motion = [{kind = "fixed", name = "bottom", on = "zmin"},
  {kind = "translation", name = "top", on = "zmax", displacement = [0, 0, -0.2], history = {t = [0, 1], value = [0, 1]}}]
time = {analysis = "static", steps = 4, end = 1}
)";

struct Press {
  Shape shape;
  double nu, most;  // iterations, without a cut but for two that the look for jumps makes of the last one; hex8 at nu .4999 took 843 and 38
                    // cuts before the first guess knew what moves by a law, 54 and 4 then
};

TEST(BlockPress, InFourStepsTakesFewIterationsAndEndsWhereManyStepsDo) {
  for (const auto& [shape, nu, most] : {Press{Shape::hex8, 0.3, 8}, Press{Shape::hex8, 0.499, 12}, Press{Shape::hex8, 0.4999, 20},
                                        Press{Shape::hex20r, 0.3, 10}, Press{Shape::hex20r, 0.499, 14}, Press{Shape::hex20r, 0.4999, 34}}) {
    SCOPED_TRACE(std::string(info(shape).name) + " " + std::to_string(nu));
    SceneCase c(scene);
    const BlockOptions o{.shape = shape, .n = {6, 6, 6}};
    c.use(block_mesh(o));
    std::vector<double> force;
    for (const int steps : {4, 16}) {
      force.push_back(c.solved(fmt::format("--set material.rubber.nu={} --set time.steps={}", nu, steps)).at("motion/top", 1)[2]);
      if (steps == 4) {
        EXPECT_LE(c.reported("newton_iterations"), most);
        EXPECT_LE(c.reported("cuts"), most > 30 ? 2 : 0);
      }
    }
    EXPECT_LT(force[0], -1e5);
    EXPECT_NEAR(force[0], force[1], 1e-6 * std::abs(force[1]));
  }
}

}  // namespace
}  // namespace hilo::test::block_press_test
