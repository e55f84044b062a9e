// SPDX-License-Identifier: GPL-3.0-or-later
// [set.NAME]: sets by place are those that the mesh would have; and what they make possible, every region at every fidelity.
#include "model/scene_sets.hpp"
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::placed_sets_test {
namespace {

Mesh beam() { return block_mesh({.n = {5, 2, 2}, .high = {1, 0.2, 0.2}}); }

size_t count(const Mesh& m, const std::string& name) { return m.node_sets.contains(name) ? m.node_sets.at(name).size() : 0; }

Mesh with_set(Mesh m, const std::string& keys) {
  add_scene_sets(Scene::parse("[set.here]\n" + keys, "scene.toml"), m);
  return m;
}

// A quarter of a pipe of radii 1 and 2, 3 long: 4 x 8 x 3 cells.
Mesh pipe() {
  return block_mesh({.n = {4, 8, 3}, .low = {1, 0, 0}, .high = {2, 1, 3}, .map = [](const Vec3& x) {
                       return Vec3(x[0] * std::cos(1.5 * x[1]), x[0] * std::sin(1.5 * x[1]), x[2]);
                     }});
}

TEST(PlacedSets, NearIsTheSmoothFaceThatAPointLiesOn) {
  const Mesh m = pipe();
  const Mesh bore = with_set(m, "kind = \"near\"\nat = [0.79, 0.6, 1.4]");
  EXPECT_EQ(bore.node_sets.at("here"), m.nodes_of("xmin", "")) << "node for node";
  EXPECT_EQ(bore.facet_sets.at("here").size(), m.facet_sets.at("xmin").size());
  const Mesh one = with_set(m, "kind = \"near\"\nat = [0.79, 0.6, 1.4]\nangle = 0.1");
  EXPECT_EQ(one.facet_sets.at("here").size(), 3u) << "facets turn by 0.19 rad: a row of three along the axis";
  EXPECT_THROW(with_set(m, "kind = \"near\"\nat = [1, 0, 1.5]"), Error) << "on the edge between two faces";
  EXPECT_THROW(with_set(m, "kind = \"near\"\nat = [0, 0, 1.5]"), Error) << "far from all of them";
}

TEST(PlacedSets, AreWhereTheirShapesAre) {
  const Mesh m = pipe();
  const Mesh bore = with_set(m, "kind = \"cylinder\"\nat = [0, 0, 7]\naxis = [0, 0, -3]\nradius = 1");
  EXPECT_EQ(bore.node_sets.at("here"), m.nodes_of("xmin", "")) << "node for node";
  EXPECT_EQ(bore.facet_sets.at("here").size(), m.facet_sets.at("xmin").size());
  EXPECT_EQ(count(with_set(m, "kind = \"cylinder\"\nat = [0, 0, 1.5]\naxis = [0, 0, 1]\nradius = 1\nlength = 1.1"), "here"), 18u);
  EXPECT_EQ(with_set(m, "kind = \"plane\"\nat = [5, 5, 3]\naxis = [0, 0, 1]").node_sets.at("here"), m.nodes_of("zmax", ""));
  EXPECT_EQ(count(with_set(m, "kind = \"plane\"\nat = [2, 0, 3]\naxis = [0, 0, 1]\nradius = 0.3"), "here"), 2u);
  EXPECT_EQ(count(with_set(m, "kind = \"ball\"\nat = [1, 0, 0]\nradius = 0.01"), "here"), 1u);
  EXPECT_EQ(count(with_set(m, "kind = \"box\"\nlow = [3, 3, 0.5]\nhigh = [-3, -3, 2.5]"), "here"), 2u * 5 * 9);
  EXPECT_FALSE(with_set(m, "kind = \"box\"\nlow = [-3, -3, 0.5]\nhigh = [3, 3, 1.5]").facet_sets.contains("here")) << "inside";
}

TEST(PlacedSets, ThatCannotBeAreRefusedWithTheirPlace) {
  const auto expect = [](const std::string& keys, const std::string& message, const std::string& name = "here") {
    Mesh m = pipe();
    try {
      add_scene_sets(Scene::parse("[set." + name + "]\n" + keys, "scene.toml"), m);
      ADD_FAILURE() << "accepted: " << keys;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
  };
  expect("kind = \"ball\"\nat = [0, 0, 0]\nradius = 0.5", "no node lies there; the nearest is 0.5 m off");
  expect("kind = \"ball\"\nat = [1, 0, 0]\nradius = 0.5\nof = [\"blok\"]",
         "scene.toml:5:1: set \"here\": no region \"blok\" (did you mean \"block\"?)");
  expect("kind = \"ball\"\nat = [1, 0, 0]\nradius = 0.5", "the mesh has a region or set \"xmin\" already", "xmin");
  expect("kind = \"plane\"\nat = [1, 0, 0]\naxis = [0, 0, 0]", "axis has length zero");
  expect("kind = \"cone\"\nat = [1, 0, 0]", "unknown kind \"cone\"");
}

/// Held at one end by a joint, pushed and pressed at others.
std::string pushed_beam(const std::string& root, const std::string& tip, const std::string& top) {
  return "gravity = [0, 0, -9.81]\n" + solid(1e7, 0.3, 1000) + axial("revolute", "hinge", "ground", root, {0, 0.1, 0.1}, {0, 1, 0}) +
         spring("axial", "stay", "ground", tip, "at_a = [1, 0.1, 1]\nat_b = [1, 0.1, 0.1]\nstiffness = 500") +
         load("pressure", "air", top, "pressure = 200") + probe("tip", tip) + in_time(0.02, 1e-3) +
         fields("\"displacement\", \"von_mises\"");
}
const std::string by_place = pushed_beam("root", "tip", "top") + R"([set]
root = {kind = "plane", at = [0, 0.1, 0.1], axis = [1, 0, 0]}
tip = {kind = "box", low = [0.99, -1, -1], high = [1.01, 1, 1]}
top = {kind = "plane", of = ["bl*"], at = [0.5, 0.1, 0.2], axis = [0, 0, 2]}
)";

// The same run by sets of the mesh.
TEST(PlacedSets, GiveTheRunOfSetsOfTheMeshBitByBitAndOnRanks) {
  for (const Fidelity fidelity : {Fidelity::nonlinear, Fidelity::linear}) {
    SceneCase c(by_place);
    c.use(beam(), {fidelity});
    const Results placed = c.solved("", "placed.h5");
    c.write("mesh.toml", pushed_beam("xmin", "xmax", "zmax"));
    const Results named = c.solved("", "mesh_sets.h5", "mesh");
    for (const std::string name : {"energy", "joint/hinge", "spring/stay"}) EXPECT_EQ(placed.history(name), named.history(name)) << name;
    EXPECT_EQ(placed.field("displacement"), named.field("displacement"));
    EXPECT_GT(placed.history("energy").col(1).maxCoeff(), 0);
    for (const int ranks : {2, 3}) {
      ASSERT_EQ(c.run(fmt::format("hilo-part --quiet tags.h5 scene.toml -n {} -o parts.h5", ranks)).exit, 0);
      succeeded(mpirun(ranks, "hilo-solve --quiet scene.toml parts.h5 -o ranks.h5", c.path()));
      const auto apart = (c.results("ranks.h5").history("probe/tip") - placed.history("probe/tip")).leftCols(3).cwiseAbs().maxCoeff();
      EXPECT_LT(apart, 1e-9) << ranks << " ranks";
    }
  }
}

TEST(PlacedSets, OfOneNodeAreRefusedOnRanks) {
  SceneCase c(by_place + "dot = {kind = \"ball\", at = [0, 0, 0], radius = 0.01}\n" + probe("dot"));
  c.use(beam(), {Fidelity::nonlinear});
  EXPECT_EQ(c.run("hilo-solve --quiet scene.toml tags.h5 -o one.h5").exit, 0);
  expect_end(mpirun(2, "hilo-solve --quiet scene.toml tags.h5 -o two.h5", c.path()), 2, "set \"dot\": a single node");
}

/// Three blocks in a row, the middle one of cells.
Mesh row_of_blocks(int across = 2) {
  return block_mesh(
      {.n = {6, across, across}, .high = {0.6, 0.2, 0.2}, .regions = {"left", "middle", "right"}, .region_of = [](const Vec3& x) {
         return x[0] < 0.2 ? 0 : x[0] < 0.4 ? 1 : 2;
       }});
}

const std::string row_scene = R"(gravity = [0, 0, -9.81]
material.m = {E = 1e7, nu = 0.3, density = 1000}
region."*" = {material = "m"}
set.ends = {kind = "plane", of = ["left", "right"], at = [0, 0.1, 0], axis = [0, 0, 1]}
set.crown = {kind = "plane", of = ["left"], at = [0, 0.1, 0.2], axis = [0, 0, 1]}
time = {end = 0.1, step = 1e-3}
)";

Ran row_run(Case& c, const std::string& more, const std::vector<Fidelity>& fidelity, int ranks = 1, int across = 2) {
  c.use(row_of_blocks(across), fidelity);
  std::ofstream(c / "row.toml") << row_scene << more;
  const std::string command = "hilo-solve row.toml tags.h5 -o run.h5";
  return ranks > 1 ? mpirun(ranks, command, c.path()) : c.run(command);
}

const std::string hinge = "[[joint]]\nkind = \"revolute\"\nname = \"hinge\"\nb = \"ends\"\nat = [0, 0.1, 0]\naxis = [0, 1, 0]\n";

TEST(PlacedSets, ThatAJointHoldsMakeRigidRegionsOneBodyAndSaySo) {
  for (const int ranks : {1, 2}) {
    Case c("placed_sets");
    const Ran ran = succeeded(row_run(c, hinge, {Fidelity::rigid, Fidelity::nonlinear, Fidelity::rigid}, ranks));
    expect_words(ran.err, "\"ends\" has nodes of the rigid regions \"left\" and \"right\", which move as one body");
    EXPECT_EQ(c.reported("bodies"), 1);
  }
}

// Both ends of a joint on what would become one body: by a set, by a region's name, and by what another joint holds.
TEST(PlacedSets, ThatWouldLockAJointAreRefused) {
  const auto joint = [](const std::string& name, const std::string& a, const std::string& b) {
    return "[[joint]]\nkind = \"revolute\"\nname = \"" + name + "\"\na = \"" + a + "\"\nb = \"" + b +
           "\"\nat = [0, 0.1, 0]\naxis = [0, 1, 0]\n";
  };
  for (const std::string& joints : {joint("pin", "crown", "ends"), joint("pin", "left", "ends"), hinge + joint("pin", "left", "right")}) {
    Case c("placed_sets");
    const Ran ran = row_run(c, joints, {Fidelity::rigid, Fidelity::nonlinear, Fidelity::rigid});
    EXPECT_EQ(ran.exit, 2) << joints;
    EXPECT_NE(ran.err.find("joint \"pin\": the rigid regions"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("it would be locked"), std::string::npos) << ran.err;
  }
}

// A linear region that moves as a whole is a rigid one.
TEST(PlacedSets, ALinearRegionHeldWholeIsHeld) {
  const std::string hold =
      "[[motion]]\nkind = \"fixed\"\nname = \"stand\"\non = \"left\"\n[[probe]]\nname = \"end\"\non = \"right\"\nat = [0.6, 0, 0]\n";
  std::vector<double> fell;
  for (const Fidelity left : {Fidelity::linear, Fidelity::rigid, Fidelity::nonlinear}) {
    Case c("placed_sets");
    succeeded(row_run(c, hold, {left, Fidelity::nonlinear, Fidelity::nonlinear}));
    fell.push_back(c.results().history("probe/end")(100, 2));
  }
  EXPECT_LT(fell[0], -5e-4);
  EXPECT_NEAR(fell[0], fell[1], 1e-12);
  EXPECT_NEAR(fell[0], fell[2], 1e-9);
}

// 81 nodes shared with nonlinear cells: their motions are polynomials, and the answer is that of nonlinear cells all the same.
TEST(PlacedSets, ManyNodesSharedWithNonlinearCellsMoveBySmoothFunctions) {
  const std::string hold =
      "[[motion]]\nkind = \"fixed\"\nname = \"stand\"\non = \"right\"\n[[probe]]\nname = \"end\"\non = \"left\"\nat = [0, 0, 0]\n";
  std::vector<double> fell;
  for (const Fidelity left : {Fidelity::linear, Fidelity::nonlinear}) {
    Case c("placed_sets");
    const Ran ran = succeeded(row_run(c, hold + "[output]\ninterval = 1\n", {left, Fidelity::nonlinear, Fidelity::rigid}, 1, 8));
    if (left == Fidelity::linear) {
      EXPECT_NE(ran.err.find("it shares 81 nodes with nonlinear cells: they move together by polynomials"), std::string::npos) << ran.err;
    }
    fell.push_back(c.results().history("probe/end")(100, 2));
  }
  EXPECT_LT(fell[1], -5e-4);
  EXPECT_NEAR(fell[0], fell[1], 2e-3 * std::abs(fell[1]));
}

// Where all is rigid and held nothing moves, and the run says so.
TEST(PlacedSets, ARunInWhichNothingCanMoveEnds) {
  for (const int ranks : {1, 2}) {
    Case c("placed_sets");
    const Ran ran = succeeded(row_run(c, "[[motion]]\nkind = \"fixed\"\nname = \"stand\"\non = \"right\"\n",
                                      {Fidelity::rigid, Fidelity::rigid, Fidelity::rigid}, ranks));
    EXPECT_NE(ran.err.find("nothing is free to move"), std::string::npos) << ran.err;
    EXPECT_TRUE(c.results().complete());
    for (const Vec3& u : c.results().field("displacement")) EXPECT_LT(u.norm(), 1e-15);
    const auto weight = c.results().history("motion/stand");
    EXPECT_NEAR(weight(weight.rows() - 1, 2), 1000 * 0.6 * 0.2 * 0.2 * 9.81, 1e-9);
  }
}

}  // namespace
}  // namespace hilo::test::placed_sets_test
