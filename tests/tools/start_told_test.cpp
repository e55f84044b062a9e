// SPDX-License-Identifier: GPL-3.0-or-later
// What a start from equilibrium says on stderr.
#include "scene_parts.hpp"
#include "succeeded.hpp"

namespace hilo::test::start_told_test {
namespace {

// Exact: a bob of 1 kg stretches a spring of 100 N/m by 0.0981 m; one on 1000 N/m by a tenth of that.
TEST(StartTold, HowFarWhatMovedIsTold) {
  const Workplace place;
  place.write("a.toml", "gravity = [0, 0, -9.81]\n" + body("stiff", 1, {1, 0, 0}, {1, 1, 1}) + body("bob", 1, Vec3::Zero(), {1, 1, 1}) +
                            axial("prismatic", "guide", "ground", "bob", Vec3::Zero(), {0, 0, 1}) +
                            axial("prismatic", "guide of stiff", "ground", "stiff", {1, 0, 0}, {0, 0, 1}) +
                            spring("axial", "soft spring", "ground", "bob", "at_a = [0, 0, 1]\nat_b = [0, 0, 0]\nstiffness = 100") +
                            spring("axial", "stiff spring", "ground", "stiff", "at_a = [1, 0, 1]\nat_b = [1, 0, 0]\nstiffness = 1000") +
                            in_time(0.01, 0.01, "start = \"equilibrium\""));
  const auto ran = succeeded(place.run("hilo-solve a.toml -o run.h5"));
  EXPECT_NE(ran.err.find("iterations; moved: \"bob\" 0.0981 m, \"stiff\" 0.00981 m\n"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::start_told_test
