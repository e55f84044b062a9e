// SPDX-License-Identifier: GPL-3.0-or-later
// The account of energy in load steps: of a spring that a force, a weight or a moved end stretches.  Truth: F x/2.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::static_work_test {
namespace {

TEST(StaticWork, IsThatOfTheMeanForce) {
  const std::string moved = body("cart", 1, Vec3::Zero(), Vec3::Ones()) + body("hand", 1, Vec3::Zero(), Vec3::Ones()) +
                            axial("prismatic", "rail", "ground", "cart", Vec3::Zero(), Vec3::UnitX()) +
                            axial("prismatic", "drive", "ground", "hand", Vec3::Zero(), Vec3::UnitX(),
                                  "displacement = 0.1\nhistory = {t = [0, 1], value = [0, 1]}") +
                            spring("bushing", "soft", "ground", "cart", "at = [0, 0, 0]\nstiffness = [100, 0, 0]") +
                            spring("bushing", "grip", "hand", "cart", "at = [0, 0, 0]\nstiffness = [1e9, 0, 0]");
  for (const std::string& scene : {pushed_cart(10), moved})
    for (const std::string analysis : {"static", "path"})
      for (const int steps : {1, 4}) {
        if (analysis == "path" && scene == moved) continue;
        const Workplace w;
        w.write("scene.toml", scene + in_steps(steps, "", analysis));
        succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5"));
        const Eigen::MatrixXd energy = Results(w / "run.h5").history("energy");
        const Eigen::VectorXd end = energy.row(energy.rows() - 1);
        EXPECT_NEAR(end[3], 0.5, 1e-6) << analysis << ", " << steps << " steps: " << scene;
        EXPECT_NEAR(end[5], 0, 1e-6) << analysis << ", " << steps << " steps";
      }
}

}  // namespace
}  // namespace hilo::test::static_work_test
