// SPDX-License-Identifier: GPL-3.0-or-later
// Statics and the start from equilibrium: what turns inside out is refused, and what nothing holds is told by name.
#include "dynamics/scenes.hpp"

namespace hilo::test::held_test {
namespace {

const std::string soft =
                      "[material.soft]\nkind = \"neo-hookean\"\nE = 1e5\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"soft\"\n",
                  weight = "gravity = [0, 0, -9.81]\n", statics = "[time]\nanalysis = \"static\"\nsteps = 2\n",
                  at_rest = "[time]\nstart = \"equilibrium\"\nend = 0.01\nstep = 0.01\n",
                  clamp = "[[motion]]\nkind = \"fixed\"\nname = \"clamp\"\non = \"zmin\"\n";

std::string hold(const std::string& kind, const std::string& more = "") {
  return joint(kind, "hold", "ground", "zmin", {0.5, 0.5, 0}, more);
}

class Held : public testing::Test {
 protected:
  Held() { write_mesh(place / "block.h5", block_mesh({.n = {3, 3, 3}}), {"test"}); }
  /// Exit code and message of a run.
  Ran run(const std::string& scene, const std::string& mesh = "block.h5") {
    place.write("scene.toml", "mesh = \"" + mesh + "\"\n" + scene);
    return place.run("hilo-solve --quiet scene.toml -o run.h5");
  }
  void expect_refused(const std::string& scene, const std::string& words, const std::string& mesh = "block.h5") {
    std::filesystem::remove(place / "run.h5");
    const Ran ran = run(scene, mesh);
    EXPECT_EQ(ran.exit, 2) << scene << ran.err;
    EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
    EXPECT_FALSE(std::filesystem::exists(place / "run.h5"));
  }
  Workplace place;
};

/// A block pressed to three times its height below its foot: at a third of the way it has no thickness; before that its cells buckle.
TEST_F(Held, CellsThatTurnInsideOutStopAStaticAnalysisWhereTheyDo) {
  expect_end(run(weight + soft + clamp +
                 "[[motion]]\nkind = \"translation\"\nname = \"push\"\non = \"zmax\"\ndisplacement = [0, 0, -3]\nhistory = {t = [0, "
                 "1], value = [0, 1]}\n[time]\nend = 1\nanalysis = \"static\"\nsteps = 10\n"),
             3, "a cell");
  EXPECT_LT(number_of(place, "run.json", "t"), 1. / 3);
  EXPECT_GT(number_of(place, "run.json", "t"), 0.2);
  EXPECT_GT(number_of(place, "run.json", "least_det_F"), 0);
}

TEST_F(Held, AStaticPartThatMayMoveOrTurnIsToldByName) {
  expect_refused(weight + soft + statics, "region \"block\" is free to move and to turn in every direction");
  expect_refused(weight + soft + clamp + "components = [\"z\"]\n" + statics,
                 "region \"block\" is free to move along (1, 0, 0) and to move along (0, 1, 0) and to turn about (0, 0, 1)");
  expect_refused(weight + soft + hold("revolute", "axis = [0, 1, 0]\n") + statics,
                 "region \"block\" is free to turn about (0, 1, 0) through (0.5, 0.5, 0)");
  expect_refused(weight + soft + hold("prismatic", "axis = [1, 0, 1]\n") + statics,
                 "region \"block\" is free to move along (0.7071, 0, 0.7071)");
  expect_refused(weight + soft + hold("spherical") + statics, "free to turn about (1, 0, 0) through (0.5, 0.5, 0) and to turn about");
  expect_refused(weight + soft + clamp + body("stone", 1, {0, 0, 3}, {1, 1, 1}) + statics,
                 "body \"stone\" is free to move and to turn in every direction");
}

TEST_F(Held, OneOfSeveralPartsOrAHingeBetweenCellsIsToldByName) {
  Mesh m;  // two bricks that share an edge, a third by itself
  for (const Vec3& low : {Vec3(0, 0, 0), Vec3(1, 0, 1), Vec3(5, 0, 0)})
    for (int k = 0; k < 8; ++k) {
      const Vec3 x = low + Vec3((k & 1) ^ (k >> 1 & 1), k >> 1 & 1, k >> 2);
      auto it = std::find_if(m.X.begin(), m.X.end(), [&](const Vec3& y) { return (x - y).norm() < 1e-9; });
      if (it == m.X.end()) m.X.push_back(x), m.node_id.push_back(m.n_nodes()), it = m.X.end() - 1;
      m.nodes.push_back(it - m.X.begin());
    }
  m.region_name = {"low", "high", "far"}, m.region_data.resize(3);
  for (int c = 0; c < 3; ++c)
    m.shape.push_back(static_cast<std::uint8_t>(Shape::hex8)), m.offset.push_back(8 * (c + 1)), m.region.push_back(c),
        m.cell_id.push_back(c);
  add_node_set(m, "foot", [](const Vec3& x) { return x[2] < 1e-9 && x[0] < 1.5; });
  add_node_set(m, "far foot", [](const Vec3& x) { return x[2] < 1e-9 && x[0] > 1.5; });
  write_mesh(place / "bricks.h5", m, {"test"});
  const std::string foot = "[[motion]]\nkind = \"fixed\"\nname = \"foot\"\non = \"foot\"\n",
                    far_foot = "[[motion]]\nkind = \"fixed\"\nname = \"far foot\"\non = \"far foot\"\n";
  expect_refused(weight + soft + foot + statics,
                 "region \"high\" is free to turn about (0, 1, 0) through (1, 0.5, 1); region \"far\" is free to move and to turn in every "
                 "direction",
                 "bricks.h5");
  expect_refused(weight + soft + far_foot + statics, "region \"low\" is free to move and to turn in every direction; region \"high\" is",
                 "bricks.h5");
}

TEST_F(Held, WhatSpringsHoldIsHeld) {
  const std::string mount =
      "[[spring]]\nkind = \"bushing\"\nname = \"mount\"\nb = \"zmin\"\nat = [0.5, 0.5, 0]\nstiffness = [1e4, 1e4, 1e4]\n";
  EXPECT_EQ(run(weight + soft + mount + "angular_stiffness = [1e4, 1e4, 1e4]\n" + statics).exit, 0);
  expect_refused(weight + soft + mount + "angular_stiffness = [1e4, 1e4, 0]\n" + statics,
                 "free to turn about (0, 0, 1) through (0.5, 0.5, ");
}

TEST_F(Held, AStartFromEquilibriumNeedsOne) {
  expect_refused(weight + soft + at_rest, "has no equilibrium");
  expect_refused(weight + soft + hold("prismatic", "axis = [1, 0, 1]\n") + at_rest,
                 "free to move along (0.7071, 0, 0.7071), and its weight");
  EXPECT_EQ(run(weight + soft + hold("revolute", "axis = [0, 1, 0]\n") + at_rest).exit, 0) << "it hangs, or stands";
  EXPECT_EQ(run(weight + soft + hold("prismatic", "axis = [1, 0, 0]\n") + at_rest).exit, 0) << "nothing pushes it along";
  expect_end(run(weight + soft + hold("screw", "axis = [0, 0, 1]\npitch = 0.4\n") + at_rest), 3,
             "region \"block\" is free to turn about (0, 0, 1)");
}

}  // namespace
}  // namespace hilo::test::held_test
