// SPDX-License-Identifier: GPL-3.0-or-later
// What a start from equilibrium says on stderr.
#include <gtest/gtest.h>

#include "../cli.hpp"

namespace hilo::test::start_told_test {
namespace {

// Exact: a bob of 1 kg stretches a spring of 100 N/m by 0.0981 m; one on 1000 N/m by a tenth of that.
TEST(StartTold, HowFarWhatMovedIsTold) {
  const Workplace place;
  place.write("a.toml", R"(gravity = [0, 0, -9.81]
[[body]]
name = "stiff"
mass = 1
com = [1, 0, 0]
inertia = [1, 1, 1]
[[body]]
name = "bob"
mass = 1
com = [0, 0, 0]
inertia = [1, 1, 1]
[[joint]]
kind = "prismatic"
name = "guide"
b = "bob"
at = [0, 0, 0]
axis = [0, 0, 1]
[[joint]]
kind = "prismatic"
name = "guide of stiff"
b = "stiff"
at = [1, 0, 0]
axis = [0, 0, 1]
[[spring]]
kind = "axial"
name = "soft spring"
b = "bob"
at_a = [0, 0, 1]
at_b = [0, 0, 0]
stiffness = 100
[[spring]]
kind = "axial"
name = "stiff spring"
b = "stiff"
at_a = [1, 0, 1]
at_b = [1, 0, 0]
stiffness = 1000
[time]
start = "equilibrium"
end = 0.01
step = 0.01
)");
  const auto ran = place.run("hilo-solve a.toml -o run.h5");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.err.find("iterations; moved: \"bob\" 0.0981 m, \"stiff\" 0.00981 m\n"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::start_told_test
