// SPDX-License-Identifier: GPL-3.0-or-later
// Abaqus and CalculiX decks: cells, sets, surfaces, materials, supports and loads survive; what is wrong is named by line.
#include <fmt/format.h>

#include <cmath>
#include <regex>

#include "import_case.hpp"
#include "model/block.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_inp_test {
namespace {

using test::vector_area;
using test::volume;
using ImportInp = test::Import;

const std::string two_cubes = R"(*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
9, 0, 0, 2
10, 1, 0, 2
11, 1, 1, 2
12, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=low
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=high
2, 5, 6, 7, 8, 9, 10, 11, 12
)";

TEST_F(ImportInp, EveryShapeKeepsItsVolume) {
  const Mesh m = imported(deck("shapes.inp"));
  ASSERT_EQ(m.n_cells(), 6);
  const double expected[] = {1. / 6, 0.5, 1, 1. / 6, 0.5, 1};
  for (std::int64_t c = 0; c < 6; ++c) {
    EXPECT_NEAR(quality(m, c).volume, expected[c], 1e-14) << info(m.shape[c]).name;
    EXPECT_EQ(m.cell_id[c], c + 1);
  }
  EXPECT_EQ(static_cast<Shape>(m.shape[5]), Shape::hex20r);
  EXPECT_EQ(m.region_name, std::vector<std::string>{"all"});
  EXPECT_EQ(m.cell_sets.at("wedge15"), std::vector<std::int64_t>{4});
  EXPECT_EQ(m.n_nodes(), 4 + 6 + 8 + 10 + 15 + 20);
}

// A deck says which integration it means; two cells that differ in nothing else keep theirs, and the faces of both are found.
TEST_F(ImportInp, ReducedIntegrationOfTwentyNodesIsKept) {
  std::string text = "*NODE\n";
  const auto nodes = test::reference_nodes(Shape::hex20);
  for (int cell = 0; cell < 2; ++cell)
    for (size_t a = 0; a < nodes.size(); ++a)
      text += fmt::format("{}, {}, {}, {}\n", 20 * cell + a + 1, nodes[a][0] + 3 * cell, nodes[a][1], nodes[a][2]);
  const int order[20] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19};
  for (const auto& [cell, type] : {std::pair{0, "C3D20"}, {1, "C3D20R"}}) {
    text += fmt::format("*ELEMENT, TYPE={}, ELSET=all\n{}", type, cell + 1);
    for (int a = 0; a < 20; ++a) text += fmt::format(",{}{}", a == 12 ? "\n" : "", 20 * cell + order[a] + 1);
    text += "\n";
  }
  text += "*SURFACE, NAME=top\n1, S2\n2, S2\n*MATERIAL, NAME=m\n*ELASTIC\n1e7, .3\n*SOLID SECTION, ELSET=all, MATERIAL=m\n";
  place.write("two.inp", text);
  const Mesh m = imported(place / "two.inp");
  ASSERT_EQ(m.n_cells(), 2);
  EXPECT_EQ(static_cast<Shape>(m.shape[0]), Shape::hex20);
  EXPECT_EQ(static_cast<Shape>(m.shape[1]), Shape::hex20r);
  EXPECT_NEAR(volume(m), 2, 1e-14);
  EXPECT_LT((vector_area(m, m.facet_sets.at("top")) - Vec3(0, 0, 2)).norm(), 1e-14);
  EXPECT_NE(out.find("1 hex20, 1 hex20r"), std::string::npos) << out;
}

TEST_F(ImportInp, FacesOfEveryShapeHaveTheAreaAndOutwardNormalOfTheManual) {
  const Mesh m = imported(deck("shapes.inp"));
  const auto area = [&](const std::string& name) {
    return m.facet_sets.count(name) ? vector_area(m, m.facet_sets.at(name)) : Vec3(9, 9, 9);
  };
  const std::pair<const char*, Vec3> expected[] = {
      {"tet S1", {0, 0, -.5}},   {"tet S2", {0, -.5, 0}},
      {"tet S3", {.5, .5, .5}},  {"tet S4", {-.5, 0, 0}},
      {"wedge S1", {0, 0, -.5}}, {"wedge S2", {0, 0, .5}},
      {"wedge S3", {0, -1, 0}},  {"wedge S4", {1, 1, 0}},
      {"wedge S5", {-1, 0, 0}},  {"hex S1", {0, 0, -1}},
      {"hex S2", {0, 0, 1}},     {"hex S3", {0, -1, 0}},
      {"hex S4", {1, 0, 0}},     {"hex S5", {0, 1, 0}},
      {"hex S6", {-1, 0, 0}},    {"quadratic", Vec3(0, -.5, 0) + Vec3(1, 1, 0) + Vec3(-1, 0, 0)}};
  for (const auto& [name, a] : expected) EXPECT_LT((area(name) - a).norm(), 1e-14) << name;
  // the free faces of a whole element set close around it
  ASSERT_TRUE(m.facet_sets.count("skin"));
  EXPECT_EQ(m.facet_sets.at("skin").size(), 6u);
  EXPECT_LT(area("skin").norm(), 1e-14);
  EXPECT_EQ(m.node_sets.at("tip").size(), 2u);
}

TEST_F(ImportInp, GenerateAndSetsOfSetsNameTheirNodes) {
  const Mesh m = imported(deck("loads.inp"), "--units mm-t-s");
  const auto ids = [&](const std::string& set) {
    std::vector<std::int64_t> v;
    for (const auto a : m.node_sets.at(set)) v.push_back(m.node_id[a]);
    return v;
  };
  EXPECT_EQ(ids("left"), (std::vector<std::int64_t>{1, 6, 11, 16}));
  EXPECT_EQ(ids("ends"), (std::vector<std::int64_t>{1, 5, 6, 10, 11, 15, 16, 20}));
  EXPECT_EQ(m.cell_sets.at("last"), std::vector<std::int64_t>{3});
}

TEST_F(ImportInp, UnitsConvertEverythingTheDeckCarries) {
  const Mesh m = imported(deck("loads.inp"), "--units mm-t-s --scene-out scene.toml");
  EXPECT_NEAR(volume(m), 4 * 0.01 * 0.01 * 0.01, 1e-18);
  EXPECT_NEAR(m.region_data[0].E, 2.1e11, 1e-1);
  EXPECT_NEAR(m.region_data[0].density, 7850, 1e-9);
  EXPECT_DOUBLE_EQ(m.region_data[0].nu, 0.3);

  const Scene s = Scene::load(place / "scene.toml");
  EXPECT_LT((s.table("scene").vector3("gravity") - Vec3(0, 0, -9.81)).norm(), 1e-12);
  ASSERT_EQ(s.entries("material").size(), 1u);
  EXPECT_EQ(s.entries("material")[0].name, "steel alloy");
  EXPECT_NEAR(s.entries("material")[0].number("E"), 2.1e11, 1e-1);
  EXPECT_NEAR(s.entries("material")[0].number("density"), 7850, 1e-9);
}

TEST_F(ImportInp, SupportsAndLoadsBecomeSceneLinesOnTheirSets) {
  const Mesh m = imported(deck("loads.inp"), "--units mm-t-s --scene-out scene.toml");
  const Scene s = Scene::load(place / "scene.toml");
  ASSERT_EQ(s.entries("motion").size(), 2u);
  const auto& fixed = s.entries("motion")[0];
  EXPECT_EQ(fixed.kind, "fixed");
  EXPECT_EQ(fixed.text("on"), "left");
  EXPECT_EQ(fixed.texts("components"), (std::vector<std::string>{"x", "y", "z"}));
  const auto& moved = s.entries("motion")[1];
  EXPECT_EQ(moved.kind, "translation");
  EXPECT_EQ(moved.texts("components"), std::vector<std::string>{"y"});
  EXPECT_LT((moved.vector3("displacement") - Vec3(0, 5e-4, 0)).norm(), 1e-18);

  ASSERT_EQ(s.entries("load").size(), 5u);
  Vec3 force = Vec3::Zero();  // at full amplitude: 4 x (100, 0, 2) on the set, -7 on two nodes
  for (const auto& l : s.entries("load"))
    if (l.kind == "force") {
      EXPECT_TRUE(l.boolean("per_node"));
      force += static_cast<double>(m.nodes_of(l.text("on"), "test").size()) * l.vector3("force");
    }
  EXPECT_LT((force - Vec3(400, 0, 8 - 14)).norm(), 1e-12);
  // P2 of the last cube is its top, P1 of the first its bottom
  Vec3 push = Vec3::Zero();
  for (const auto& l : s.entries("load"))
    if (l.kind == "pressure") push -= l.number("pressure") * vector_area(m, m.facet_sets.at(l.text("on")));
  EXPECT_LT((push - Vec3(0, 0, (4e6 - 3e6) * 1e-4)).norm(), 1e-9);
  ASSERT_EQ(s.entries("history").size(), 1u);
  EXPECT_EQ(s.entries("history")[0].numbers("t"), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(s.table("time").text("analysis"), "static");
}

TEST_F(ImportInp, WhatIsNotReadIsListedWithItsLine) {
  imported(deck("loads.inp"), "--units mm-t-s");
  for (const char* said : {"1 nodes belong to no cell: dropped, the first is 99", "not read: *DLOAD BX (1, ", "loads.inp:40)",
                           "not read: *TEMPERATURE (1, ", "loads.inp:41)", "*NODE FILE (1, ", "a request for output",
                           "only the first step becomes scene lines", "*CLOAD in step 2 and later (1, "})
    expect_said(said);
}

TEST_F(ImportInp, ScaleChangesLengthsAlone) {
  const Mesh m = imported(deck("loads.inp"), "--scale 2 --scene-out scene.toml");
  EXPECT_NEAR(volume(m), 8 * 4000, 1e-9);
  EXPECT_DOUBLE_EQ(m.region_data[0].E, 210000);
  const Scene s = Scene::load(place / "scene.toml");
  EXPECT_DOUBLE_EQ(s.entries("motion")[1].vector3("displacement").y(), 1) << "0.5 of the deck";
}

// A velocity is no length, also where the scene has its displacement.
TEST_F(ImportInp, AVelocityThatTheDeckPrescribesIsNotScaled) {
  for (const char* type : {"DISPLACEMENT", "VELOCITY"}) {
    imported_deck("a.inp",
                  two_cubes + "*MATERIAL, NAME=m\n*ELASTIC\n1., 0.\n*DENSITY\n1.\n*SOLID SECTION, ELSET=low, MATERIAL=m\n" +
                      fmt::format("*STEP\n*DYNAMIC, DIRECT\n0.1, 1.\n*BOUNDARY, TYPE={}\n1, 1, 1, 3.\n*END STEP\n", type),
                  "--scale 1e-3 --scene-out scene.toml");
    const Scene s = Scene::load(place / "scene.toml");
    ASSERT_EQ(s.entries("motion").size(), 1u) << err;
    EXPECT_NEAR(s.entries("motion")[0].vector3("displacement").x(), *type == 'D' ? 3e-3 : 3, 1e-12) << type;
  }
}

TEST_F(ImportInp, OrderTwoKeepsVolumeAndFacesAndPutsNodesInTheMiddle) {
  const Mesh m = imported(deck("shapes.inp"), "--order 2");
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    EXPECT_GE(info(m.shape[c]).n_nodes, 10);
    EXPECT_NEAR(quality(m, c).volume, quality(m, (c + 3) % 6).volume, 1e-14);  // the unit cells of both orders
    for (size_t i = 0; i < m.cell(c).size(); ++i)                              // node for node, too
      EXPECT_LT((m.X[m.cell(c)[i]] - m.X[m.cell((c + 3) % 6)[i]] - Vec3(c < 3 ? -30 : 30, 0, 0)).norm(), 1e-14) << c << ' ' << i;
  }
  EXPECT_LT((vector_area(m, m.facet_sets.at("wedge S4")) - Vec3(1, 1, 0)).norm(), 1e-14);
  EXPECT_EQ(m.facet_nodes(m.facet_sets.at("hex S1")[0]).size(), 8u);
}

TEST_F(ImportInp, OrderTwoSharesNodesCompletesSetsAndLeavesNodalForcesAlone) {
  const Mesh m = imported(deck("loads.inp"), "--order 2 --scene-out scene.toml");
  EXPECT_EQ(m.n_nodes(), 20 + (4 * 12 - 3 * 4));  // the edges of the three faces between cells count once
  EXPECT_EQ(m.node_sets.at("left").size(), 8u);
  const Scene s = Scene::load(place / "scene.toml");
  Vec3 force = Vec3::Zero();
  for (const auto& l : s.entries("load"))
    if (l.kind == "force") force += static_cast<double>(m.nodes_of(l.text("on"), "test").size()) * l.vector3("force");
  EXPECT_LT((force - Vec3(400, 0, 8 - 14)).norm(), 1e-12);
}

TEST_F(ImportInp, CellsWithoutSectionAreARegionAndThatIsSaid) {
  EXPECT_EQ(imported_deck("a.inp", two_cubes).region_name, std::vector<std::string>{"rest"});
  expect_said(
      "2 of 2 cells are in no region, the first is cell 1: they are region \"rest\"; --rest gives it another name, --regions "
      "makes regions of element sets: low, high\n");
  refused("a.inp -o a.h5 --regions lov", 2, "a.inp: --regions: no element set \"lov\" (did you mean \"low\"?)");
  EXPECT_EQ(imported("a.inp", "--regions low").region_name, (std::vector<std::string>{"low", "rest"}));
  // a region of that name is another one
  const Mesh two = imported_deck(
      "b.inp", two_cubes + "*ELSET, ELSET=rest\n1\n*MATERIAL, NAME=m\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=rest, MATERIAL=m\n");
  EXPECT_EQ(two.region_name, (std::vector<std::string>{"rest", "rest_cells"}));
  EXPECT_TRUE(std::isnan(two.region_data[1].E));
  EXPECT_EQ(imported_deck("a.inp", two_cubes, "--regions low,high").region_name, (std::vector<std::string>{"low", "high"}));
  const Mesh m = imported("a.inp", "--regions low --rest others");
  EXPECT_EQ(m.region_name, (std::vector<std::string>{"low", "others"}));
  EXPECT_TRUE(m.cell_sets.count("high"));
  EXPECT_EQ(test::cells_of(m, "others"), 1);
}

TEST_F(ImportInp, ALaterSectionTakesTheCellsAndTheWholeSetIsKept) {
  const Mesh m =
      imported_deck("a.inp", two_cubes +
                                 "*ELSET, ELSET=all\nlow, high\n*MATERIAL, NAME=m\n*ELASTIC\n1, 0\n*MATERIAL, NAME=n\n*ELASTIC\n2, 0\n"
                                 "*SOLID SECTION, ELSET=all, MATERIAL=m\n*SOLID SECTION, ELSET=high, MATERIAL=n\n");
  EXPECT_EQ(m.region_name, (std::vector<std::string>{"all", "high"}));
  EXPECT_EQ(m.region, (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(m.region_data[1].E, 2);
  EXPECT_EQ(m.cell_sets.at("all_cells").size(), 2u);
  expect_said("1 of 2 cells of \"all\" belong to another region too");
  // one region over two materials would lose one of them
  refused("a.inp -o b.h5 --regions all", 2,
          "a.inp: region \"all\" holds cells of materials \"m\" and \"n\" (choose --regions within one material)");
}

TEST_F(ImportInp, OneNameForTwoKindsOfSetIsToldApart) {
  const Mesh m =
      imported_deck("a.inp", two_cubes + "*NSET, NSET=high\n9, 10\n*SURFACE, NAME=low\nlow, S1\n*NSET, NSET=low\n1, 2, 3, 4, 5, 6, 7, 8\n",
                    "--regions low,high");
  EXPECT_EQ(m.node_sets.at("high_nodes").size(), 2u);
  EXPECT_EQ(m.facet_sets.at("low_facets").size(), 1u);
  EXPECT_EQ(m.node_sets.size(), 1u) << "the node set low is the nodes of region low";
}

TEST_F(ImportInp, ASectionWithoutAMaterialIsARegionWithoutOne) {
  const Mesh m = imported_deck(
      "a.inp", two_cubes + "*MATERIAL, NAME=m\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=low\n*SOLID SECTION, ELSET=high, MATERIAL=m\n");
  EXPECT_EQ(m.region_name, (std::vector<std::string>{"low", "high"}));
  EXPECT_TRUE(std::isnan(m.region_data[0].E));
  EXPECT_EQ(m.region_data[1].E, 1);
  expect_said("not read: *SOLID SECTION without MATERIAL (1, a.inp:21)");
}

TEST_F(ImportInp, ExpansionAndTemperaturesAreToldAsLeftOut) {
  imported_deck("a.inp", two_cubes +
                             "*MATERIAL, NAME=m\n*ELASTIC\n1., 0.\n*EXPANSION\n1.2e-5\n*ELSET, ELSET=all\nlow, high\n"
                             "*SOLID SECTION, ELSET=all, MATERIAL=m\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\n1, 20.\n*STEP\n*STATIC\n"
                             "*TEMPERATURE\n1, 30.\n*END STEP\n");
  for (const char* what : {"*EXPANSION (1, ", "*INITIAL CONDITIONS, TYPE=TEMPERATURE (1, ", "*TEMPERATURE (1, "})
    expect_said(std::string("not read: ") + what);
}

// What CAE writes: a part with sets of its own, and an assembly whose sets have the same names and whose nodes the same numbers.
TEST_F(ImportInp, SetsOfPartAndAssemblyAreToldApartByTheirQualifiedNames) {
  const std::string part = "*PART, NAME=block\n" + two_cubes + "*NSET, NSET=s\n1, 2\n*ELSET, ELSET=e\n1, 2\n*SURFACE, NAME=f\ne, S1\n" +
                           "*SOLID SECTION, ELSET=e, MATERIAL=m\n*END PART\n";
  const std::string assembly =
      "*ASSEMBLY, NAME=a\n*INSTANCE, NAME=Block-1, PART=block\n*END INSTANCE\n*NODE\n1, 9., 9., 9.\n"
      "*NSET, NSET=s, INSTANCE=Block-1\n9, 10, 11, 12\n*NSET, NSET=point\n1,\n*ELSET, ELSET=e, INSTANCE=Block-1\n2\n"
      "*NSET, NSET=both\nBlock-1.s, s\n*NSET, NSET=one\nBlock-1.3\n*SURFACE, NAME=f\ne, S2\n*END ASSEMBLY\n";
  const std::string step =
      "*MATERIAL, NAME=m\n*ELASTIC\n1., 0.\n*STEP\n*STATIC\n*BOUNDARY\nBlock-1.s, 1, 3\na.s, 1\nBlock-1.3, 2\n*CLOAD\n"
      "s, 3, 1.\npoint, 3, 1.\n*DSLOAD\nf, P, 2.\nBlock-1.f, P, 3.\n*END STEP\n";
  const Mesh m = imported_deck("a.inp", part + assembly + step, "--scene-out s.toml");
  const auto ids = [&](const std::string& set) {
    std::vector<std::int64_t> v;
    for (const auto a : m.nodes_of(set, set)) v.push_back(m.node_id[a]);
    return v;
  };
  EXPECT_EQ(ids("s"), (std::vector<std::int64_t>{9, 10, 11, 12}));
  EXPECT_EQ(ids("Block-1.s"), (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(ids("both"), (std::vector<std::int64_t>{1, 2, 9, 10, 11, 12}));
  EXPECT_EQ(ids("one"), std::vector<std::int64_t>{3});
  EXPECT_EQ(m.region_name, std::vector<std::string>{"Block-1.e"});
  EXPECT_LT((vector_area(m, m.facet_sets.at("f")) - Vec3(0, 0, 1)).norm(), 1e-14);
  EXPECT_LT((vector_area(m, m.facet_sets.at("Block-1.f")) - Vec3(0, 0, -2)).norm(), 1e-14);
  const Scene s = Scene::load(place / "s.toml");
  std::map<std::string, std::string> held;
  for (const auto& e : s.entries("motion"))
    for (const auto& c : e.texts("components")) held[e.text("on")] += c;
  EXPECT_EQ(held["Block-1.s"], "xyz");
  EXPECT_EQ(held["s"], "x");
  EXPECT_EQ(held["one"] + held["support_1"], "y");
  ASSERT_EQ(s.entries("load").size(), 3u);
  EXPECT_EQ(s.entries("load")[0].text("on"), "s");
  expect_said("not read: *CLOAD on a node of no cell (1, a.inp:");
}

TEST_F(ImportInp, TrussesAreBars) {
  const Mesh m = imported_deck("a.inp",
                               "*NODE\n1,0,0,0\n2,3,4,0\n*ELEMENT,TYPE=T3D2,ELSET=rope\n1,1,2\n*MATERIAL,NAME=m\n*ELASTIC\n1e9,0\n*SOLID "
                               "SECTION,ELSET=rope,MATERIAL=m\n2.5e-4\n",
                               "--scene-out s.toml");
  EXPECT_EQ(static_cast<Shape>(m.shape[0]), Shape::bar2);
  EXPECT_DOUBLE_EQ(quality(m, 0).volume, 5);
  EXPECT_DOUBLE_EQ(Scene::load(place / "s.toml").entries("region")[0].number("area"), 2.5e-4);
}

TEST_F(ImportInp, NodesNearerThanTheToleranceBecomeOne) {
  std::string apart = two_cubes;
  apart.replace(apart.find("2, 5, 6, 7, 8, 9"), 16, "2, 25, 26, 27, 28, 9");
  apart.insert(apart.find("*ELEMENT"), "25, 0, 1e-7, 1\n26, 1, 0, 1.0000001\n27, 1, 1, 1\n28, 0, 1, 1\n");
  EXPECT_EQ(imported_deck("a.inp", apart, "--rest all").n_nodes(), 16);
  EXPECT_EQ(imported("a.inp", "--rest all --merge-nodes 1e-6").n_nodes(), 12);
  EXPECT_EQ(imported("a.inp", "--rest all --merge-nodes 1e-8").n_nodes(), 14);
  refused("a.inp -o b.h5 --rest all --merge-nodes 1.001", 2,
          "a.inp: 2 of 2 cells have no volume or name a node twice: 1, 2 (remove them from the mesh; after --merge-nodes, try a smaller "
          "distance)");
}

TEST_F(ImportInp, ZippedDecksAreReadAsTheyAre) {
  place.write("a.inp", two_cubes);
  ASSERT_EQ(place.run("gzip a.inp").exit, 0);
  EXPECT_EQ(imported("a.inp.gz", "--rest all").n_cells(), 2);
}

TEST_F(ImportInp, DataLinesMayStandInAFileOfTheirOwn) {
  const std::string head = "*NODE, NSET=all", cells = "*ELEMENT, TYPE=C3D8, ELSET=a", held = "*NSET, NSET=held",
                    steel = "*MATERIAL, NAME=m\n*ELASTIC\n2e11, .3\n*SOLID SECTION, ELSET=a, MATERIAL=m\n",
                    step = "*STEP\n*STATIC\n*BOUNDARY\nheld, 1, 3\n*CLOAD";
  const std::string nodes = "1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n", cell = "1,1,2,3,4,5,6,7,8\n",
                    foot = "1,2,3,4\n", push = "7,1,5.\n", end = "*END STEP\n";
  Mesh mesh;
  const auto scene = [&](const std::string& text) {
    mesh = imported_deck("a.inp", text, "--scene-out s.toml");
    return std::regex_replace(test::text_of(place / "s.toml"), std::regex("# .*:[0-9]+"), "");  // without places
  };
  const std::string whole = scene(head + '\n' + nodes + cells + '\n' + cell + held + '\n' + foot + steel + step + '\n' + push + end);
  const auto X = mesh.X;
  place.write("n.txt", nodes), place.write("c.txt", cell), place.write("f.txt", foot), place.write("p.txt", push);
  EXPECT_EQ(scene(head + ", INPUT=n.txt\n" + cells + ", INPUT=c.txt\n" + held + ", INPUT=f.txt\n" + steel + step + ", INPUT=p.txt\n" + end),
            whole);
  EXPECT_EQ(mesh.X, X);
  refused_deck("b.inp", head + ", INPUT=none.txt\n", "-o b.h5", 2, "b.inp:1: no file \"none.txt\"");
}

TEST_F(ImportInp, LinesOfEmptySetsAreTold) {
  imported_deck("a.inp", two_cubes + "*NSET, NSET=none\n*ELSET, ELSET=nil\n*BOUNDARY\nnone, 1\n*CLOAD\nnone, 1, 3.\n*DLOAD\nnil, P1, 3.\n",
                "--rest all --scene-out s.toml");
  for (const char* card : {"*BOUNDARY", "*CLOAD", "*DLOAD"}) expect_said(std::string("not read: ") + card + " on an empty set");
}

TEST_F(ImportInp, WrongDecksAreNamedByLineAndColumnAndLeaveNothing) {
  const struct {
    std::string text, message;
  } cases[] = {
      {"", "a.inp: an empty file"},
      {"hello\n", "a.inp: no keyword in it (an Abaqus or CalculiX deck has lines such as *NODE)"},
      {"*NODE\n1,0,0,0\n", "a.inp: no elements (a deck has *ELEMENT)"},
      {"*NODE\n1,0,x,0\n", "a.inp:2:5: expected a number, found \"x\""},
      {"*NODE\n1,0,0,0\n1,0,0,1\n", "a.inp:3:1: node 1 is given twice, at two places (number each node once)"},
      {two_cubes + "*ELEMENT, TYPE=C3D8\n2, 1, 2, 3, 4, 5, 6, 7, 8\n", "a.inp:19:1: element 2 is given twice (number each element once)"},
      {two_cubes + "*ELEMENT, TYPE=C3D8\n3, 1, 2, 3, 4, 5, 6, 7, 80\n", "a.inp:19: element 3 names node 80, which does not exist"},
      {two_cubes + "*ELEMENT, TYPE=C3D8\n3, 1, 2, 3, 4, 5, 6\n*NSET, NSET=a\n", "a.inp:19:1: element 3 has 6 of its 8 nodes"},
      {two_cubes + "*ELEMENT, TYPE=S4R, ELSET=a\n3, 1, 2, 3, 4\n",
       "a.inp:19: element 3 has no section (shells need *SHELL SECTION, beams *BEAM SECTION)"},
      {two_cubes + "*NSET, NSET=left\n1\n*NSET, NSET=a\n1, lefft\n", "a.inp:21:4: no set \"lefft\" so far (did you mean \"left\"?)"},
      {two_cubes + "*BOUNDARY\nleft, 1\n", "a.inp:19: no node set \"LEFT\""},
      {two_cubes + "*CLOAD\n77, 1, 3.\n", "a.inp:19: no node 77"},
      {two_cubes + "*SOLID SECTION, ELSET=lo, MATERIAL=m\n", "a.inp:18:23: *SOLID SECTION: no element set \"lo\" (did you mean \"low\"?)"},
      {two_cubes + "*SOLID SECTION, ELSET=low, MATERIAL=m\n", "a.inp:18:37: *SOLID SECTION: no material \"m\""},
      {two_cubes + "*MATERIAL, NAME=m\n*ELASTIC\n-1., 0.\n", "a.inp:20:1: material m: Young's modulus -1 is not positive"},
      {two_cubes + "*MATERIAL, NAME=m\n*ELASTIC\n1., 0.5\n", "a.inp:20:5: material m: Poisson's ratio 0.5 is not in (-1, 0.5)"},
      {two_cubes + "*MATERIAL, NAME=m\n*DENSITY\n-7850\n", "a.inp:20:1: material m: density -7850 is not positive"},
      {two_cubes + "*NMAP, NSET=left\n1, 2\n", "a.inp:18:1: *NMAP is not read (write the nodes out)"},
      {two_cubes + "*PART, NAME=a\n*PART, NAME=b\n", "a.inp:18: *PART without *END PART"},
      {two_cubes + "*PART, NAME=a\n*END PART\n*PART, NAME=b\n*END PART\n*END PART\n", "a.inp:22:1: *END PART without *PART"},
      {two_cubes + "*PART, NAME=a\n*END PART\n*INSTANCE, NAME=i, PART=missing\n*END INSTANCE\n*INSTANCE, NAME=j, PART=a\n*END INSTANCE\n",
       "a.inp:20:25: *INSTANCE of part \"missing\", which is not there"},
      {"*INCLUDE, INPUT=b.inp\n", "a.inp:1: no file \"b.inp\""},
      {"*INCLUDE, INPUT=a.inp\n", "a.inp:1: *INCLUDE nested more than 20 deep at \"a.inp\" (does a file include itself?)"},
  };
  for (const auto& c : cases) {
    refused_deck("a.inp", c.text, "-o a.h5 --rest all", 2, c.message);
  }
}

TEST_F(ImportInp, InvertedCellsAreNamed) {
  std::string mirrored = two_cubes;
  mirrored.replace(mirrored.find("1, 1, 2, 3, 4, 5, 6, 7, 8"), 25, "1, 5, 6, 7, 8, 1, 2, 3, 4");
  refused_deck("a.inp", mirrored, "-o a.h5 --rest all", 2,
               "a.inp: 1 of 2 cells are inverted (scaled Jacobian <= 0 at a corner): 1 (repair or remesh them; --flip turns "
               "cells that are numbered as in a mirror)");
  mirrored.replace(mirrored.find("2, 5, 6, 7, 8, 9, 10, 11, 12"), 28, "2, 9, 10, 11, 12, 5, 6, 7, 8");
  EXPECT_NEAR(test::volume(imported_deck("a.inp", mirrored, "--rest all")), 2, 1e-12);  // the deck's way of numbering
  expect_said("2 of 2 cells were numbered as in a mirror: turned");
}

TEST_F(ImportInp, ADensityThatFitsNoMaterialIsSaidAloud) {
  imported(deck("loads.inp"));
  expect_said("density of 7.85e-09 kg/m^3: is the file in mm-t-s?");
  imported(deck("loads.inp"), "--units mm-t-s");
  EXPECT_EQ(err.find("is the file in mm-t-s?"), std::string::npos) << err;
}

}  // namespace
}  // namespace hilo::test::import_inp_test
