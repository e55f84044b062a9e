// SPDX-License-Identifier: GPL-3.0-or-later
// Redundant rows of mechanisms too large for one dense matrix.
#include "dynamics/scenes.hpp"

namespace hilo::test {
namespace {

// Truth: 2 n + 1 rods have 12 n + 6 degrees of freedom, 3 n + 1 revolutes 15 n + 5 rows, and the mechanism moves in one way.  The rank is
// 12 n + 5, which leaves 3 n rows too many; the rows kept hold the others.
TEST(Redundancy, EveryLoopOfALongRowOfFourBarsHasThreeRowsTooMany) {
  constexpr int n = 320;  // 1922 rows in the plane, 2883 out of it
  const Workplace w;
  std::string scene = "gravity = [0, -9.81, 0]\n[time]\nend = 0.02\nstep = 0.01\n";
  const auto pin = [&](const std::string& name, const std::string& a, const std::string& b, const Vec3& at) {
    scene += joint("revolute", name, a, b, at, "axis = [0, 0, 1]\n");
  };
  for (int i = 0; i <= n; ++i) {
    const std::string crank = "c" + std::to_string(i), rod = "k" + std::to_string(i), before = "c" + std::to_string(i - 1);
    scene += body(crank, 1, {1. * i, 0.5, 0}, {0.08, 1e-4, 0.08});
    scene += "[[initial]]\non = [\"" + crank + "\"]\nspin = [0, 0, -1]\nabout = [" + std::to_string(i) + ", 0, 0]\n";
    pin("A" + std::to_string(i), "ground", crank, {1. * i, 0, 0});
    if (i == 0) continue;
    scene += body(rod, 1, {i - 0.5, 1, 0}, {1e-4, 0.08, 0.08}) + "[[initial]]\non = [\"" + rod + "\"]\nvelocity = [1, 0, 0]\n";
    pin("L" + std::to_string(i), before, rod, {i - 1., 1, 0});
    pin("R" + std::to_string(i), crank, rod, {1. * i, 1, 0});
  }
  w.write("row.toml", scene);
  const Ran ran = w.run("hilo-solve --quiet row.toml -o run.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const std::string json = text_of(w / "run.json");
  EXPECT_NE(json.find("\"joint_rows\": " + std::to_string(5 * (3 * n + 1))), std::string::npos);
  EXPECT_NE(json.find("\"redundant_rows\": " + std::to_string(3 * n) + ","), std::string::npos) << json;
  const Store run = Store::open(w / "run.h5");
  for (const double violation : run.read<double>("/history/constraint")) EXPECT_LT(violation, 1e-12);
}

}  // namespace
}  // namespace hilo::test
