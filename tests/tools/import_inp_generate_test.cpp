// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes and elements that a deck generates: *NGEN, *NFILL, *ELGEN give the mesh of the deck that writes them out.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "import/imported.hpp"
#include "import_case.hpp"

namespace hilo::test::import_inp_generate_test {
namespace {

class ImportInpGenerate : public test::Import {
 protected:
  Mesh read(const std::string& text) { return imported_deck("a.inp", text, "--rest all"); }
  static std::map<std::int64_t, Vec3> nodes_of(const Mesh& m) {
    std::map<std::int64_t, Vec3> nodes;
    for (size_t a = 0; a < m.X.size(); ++a) nodes[m.node_id[a]] = m.X[a];
    return nodes;
  }
};

/// A block of 3 x 2 x 2 cells, sides 3, 2 and 4: node 1 + i + 10 j + 100 k at (i, j, 2 k).
const std::string lower =
    "*NODE\n1, 0, 0, 0\n4, 3, 0, 0\n21, 0, 2, 0\n24, 3, 2, 0\n201, 0, 0, 4\n204, 3, 0, 4\n221, 0, 2, 4\n224, 3, 2, 4\n"
    "*NGEN, NSET=front\n1, 4\n*NGEN, NSET=back\n21, 24, 1\n*NFILL, NSET=floor\nfront, back, 2, 10\n";
const std::string block = lower +
                          "*NGEN, NSET=front_up\n201, 204\n*NGEN, NSET=back_up\n221, 224\n*NFILL, NSET=roof\nfront_up, back_up, 2, 10\n"
                          "*NFILL\nfloor, roof, 2, 100\n*ELEMENT, TYPE=C3D8\n1, 1, 2, 12, 11, 101, 102, 112, 111\n"
                          "*ELGEN, ELSET=block\n1, 3, 1, 1, 2, 10, 10, 2, 100, 100\n";

TEST_F(ImportInpGenerate, ABlockOfRowsAndLayersIsTheOneWrittenOut) {
  const Mesh m = read(block);
  ASSERT_EQ(m.n_cells(), 12);
  ASSERT_EQ(m.n_nodes(), 36);
  EXPECT_NEAR(volume(m), 24, 1e-12);
  const auto X = nodes_of(m);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) EXPECT_LT((X.at(1 + i + 10 * j + 100 * k) - Vec3(i, j, 2 * k)).norm(), 1e-12) << i << j << k;
  std::set<std::int64_t> ids(m.cell_id.begin(), m.cell_id.end());
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k) EXPECT_TRUE(ids.contains(1 + i + 10 * j + 100 * k));
  EXPECT_EQ(m.node_sets.at("front").size(), 4u);
  EXPECT_EQ(m.node_sets.at("floor").size(), 12u);
  EXPECT_EQ(m.node_sets.at("roof").size(), 12u);
}

// A quarter, half, three quarters and a whole turn about the centre; from (2, 0) of a circle about (1, 0) the point at angle t is
// (1 + cos t, sin t).
TEST_F(ImportInpGenerate, AnArcTurnsAboutItsCentre) {
  const std::pair<std::string, double> arcs[] = {
      {"*NODE\n1, 2, 0, 0\n5, 1, 1, 0\n*NGEN, LINE=C\n1, 5, 1, , 1., 0., 0.\n", 0.5},
      {"*NODE\n1, 2, 0, 0\n5, 1, 1, 0\n9, 1, 0, 0\n*NGEN, LINE=C\n1, 5, 1, 9\n", 0.5},
      {"*NODE\n1, 2, 0, 0\n5, 0, 0, 0\n*NGEN, LINE=C\n1, 5, 1, , 1., 0., 0., 0., 0., 1.\n", 1},
      {"*NODE\n1, 2, 0, 0\n5, 0, 0, 0\n*NGEN, LINE=C\n1, 5, 1, , 1., 0., 0., 0., 0., -1.\n", -1},
      {"*NODE\n1, 2, 0, 0\n5, 1, -1, 0\n*NGEN, LINE=C\n1, 5, 1, , 1., 0., 0., 0., 0., 1.\n", 1.5},
      {"*NODE\n1, 2, 0, 0\n5, 2, 0, 0\n*NGEN, LINE=C, SYSTEM=C\n1, 5, 1, , 1., 360., 0., 0., 0., 1.\n", 2},
  };
  for (const auto& [text, halves] : arcs) {
    SCOPED_TRACE(text);
    const auto X = nodes_of(read(text + "*ELEMENT, TYPE=T3D2, ELSET=b\n1, 1, 2\n*ELGEN, ELSET=b\n1, 4\n"));
    ASSERT_EQ(X.size(), 5u);
    for (int i = 0; i < 5; ++i) {
      const double t = halves * std::numbers::pi * i / 4;
      EXPECT_LT((X.at(i + 1) - Vec3(1 + std::cos(t), std::sin(t), 0)).norm(), 1e-12) << i;
    }
  }
  // a parabola through its middle: y = x (2 - x) of x = 2 s
  const auto X =
      nodes_of(read("*NODE\n10, 0, 0, 0\n18, 2, 0, 0\n*NGEN, LINE=P\n10, 18, 2, , 1., 1., 0.\n*ELEMENT, TYPE=T3D2\n1, 10, 12\n"
                    "*ELGEN\n1, 4, 2\n"));
  for (int i = 0; i < 5; ++i) EXPECT_LT((X.at(10 + 2 * i) - Vec3(i / 2., i / 2. * (2 - i / 2.), 0)).norm(), 1e-12) << i;
}

// Three lengths in ratio 1/2: 4, 2, 1 of 7 towards the second bound; by twos: 2, 2, 1, 1 of 6.
TEST_F(ImportInpGenerate, ABiasIsTheRatioOfNeighbouringLengths) {
  const std::string ends = "*NODE, NSET=a\n1, 0, 0, 0\n*NODE, NSET=b\n9, 84, 0, 0\n";
  const auto bars = [](int n) { return fmt::format("*ELEMENT, TYPE=T3D2\n1, 1, 2\n*ELGEN\n1, {}\n", n); };
  auto X = nodes_of(read(ends + "*NFILL, BIAS=2\na, b, 3\n" + bars(2)));
  EXPECT_NEAR(X.at(2).x(), 48, 1e-12);
  EXPECT_NEAR(X.at(3).x(), 72, 1e-12);
  X = nodes_of(read(ends + "*NFILL, BIAS=.5\na, b, 3\n" + bars(2)));
  EXPECT_NEAR(X.at(2).x(), 12, 1e-12);
  EXPECT_NEAR(X.at(3).x(), 36, 1e-12);
  X = nodes_of(read(ends + "*NFILL, BIAS=2, TWO STEP\n1, 9, 4\n" + bars(3)));
  EXPECT_NEAR(X.at(2).x(), 28, 1e-12);
  EXPECT_NEAR(X.at(3).x(), 56, 1e-12);
  EXPECT_NEAR(X.at(4).x(), 70, 1e-12);
}

// Sets are gone through by number, UNSORTED ones as they stand.
TEST_F(ImportInpGenerate, BoundsAreSortedUnlessTheDeckSaysUnsorted) {
  const std::string ends = "*NODE\n2, 1, 0, 0\n1, 0, 0, 0\n21, 0, 2, 0\n22, 1, 2, 0\n*NSET, NSET=a\n2, 1\n";
  const std::string bars = "*ELEMENT, TYPE=T3D2\n1, 11, 1\n2, 12, 2\n";
  auto X = nodes_of(read(ends + "*NSET, NSET=b\n22, 21\n*NFILL\na, b, 2, 10\n" + bars));
  EXPECT_LT((X.at(11) - Vec3(0, 1, 0)).norm() + (X.at(12) - Vec3(1, 1, 0)).norm(), 1e-12);
  X = nodes_of(read(ends + "*NSET, NSET=b, UNSORTED\n22, 21\n*NFILL\na, b, 2, 10\n" + bars));
  EXPECT_LT((X.at(11) - Vec3(.5, 1, 0)).norm() + (X.at(12) - Vec3(.5, 1, 0)).norm(), 1e-12);
}

// Pyramids, beams and springs are copied as cells are; each of two instances has its own.
TEST_F(ImportInpGenerate, EveryKindOfElementIsCopied) {
  const std::string part =
      "*PART, NAME=p\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, .5, .5, 1\n11, 2, 0, 0\n12, 3, 0, 0\n"
      "13, 3, 1, 0\n14, 2, 1, 0\n15, 2.5, .5, 1\n*ELEMENT, TYPE=C3D5, ELSET=e\n1, 1, 2, 3, 4, 5\n"
      "*ELGEN, ELSET=e\n1, 2, 10\n*END PART\n";
  const Mesh m = read(
      part +
      "*ASSEMBLY, NAME=a\n*INSTANCE, NAME=i, PART=p\n*END INSTANCE\n*INSTANCE, NAME=j, PART=p\n9., 0., 0.\n*END INSTANCE\n*END ASSEMBLY\n");
  EXPECT_EQ(m.n_cells(), 8);
  EXPECT_NEAR(volume(m), 4 / 3., 1e-12);

  imported_deck("s.inp",
                lower +
                    "*ELEMENT, TYPE=SPRINGA, ELSET=s\n7, 1, 11\n*ELGEN, ELSET=s\n7, 3, 1, 2\n*SPRING, ELSET=s\n\n100.\n"
                    "*ELEMENT, TYPE=B31, ELSET=b\n1, 1, 2\n*ELGEN, ELSET=b\n1, 3\n*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n"
                    "*BEAM SECTION, ELSET=b, MATERIAL=m, SECTION=RECT\n.1, .1\n0, 0, 1\n*ELEMENT, TYPE=B31, ELSET=b\n50, 11, "
                    "12\n*ELGEN, ELSET=b\n50, 3\n",
                "--scene-out s.toml");
  const std::string scene = test::text_of(place / "s.toml");
  for (const char* name : {"SPRINGA_7", "SPRINGA_9", "SPRINGA_11", "B31_1", "B31_2", "B31_3", "B31_50", "B31_52"})
    EXPECT_NE(scene.find(fmt::format("\"{}\"", name)), std::string::npos) << name << scene;
}

// A cell moved, turned and moved again, and its image in a plane, a line and a point.
TEST_F(ImportInpGenerate, CopiesAreMovedTurnedAndReflected) {
  const std::string cube =
      "*NODE, NSET=n\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 2\n6, 1, 0, 2\n7, 1, 1, 2\n8, 0, 1, 2\n"
      "*ELEMENT, TYPE=C3D8, ELSET=e\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";
  const auto cell = [](const char* old) {
    return fmt::format("*ELCOPY, OLD SET={}, ELEMENT SHIFT=10, SHIFT NODES=100, NEW SET=more\n", old);
  };
  Mesh m = read(cube + "*NCOPY, OLD SET=n, CHANGE NUMBER=100, SHIFT, MULTIPLE=2, NEW SET=c\n5., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n" +
                cell("e") + cell("more"));
  EXPECT_EQ(m.n_cells(), 3);
  EXPECT_NEAR(volume(m), 6, 1e-12);
  EXPECT_EQ(m.node_sets.at("c").size(), 16u);
  auto X = nodes_of(m);
  EXPECT_LT((X.at(102) - Vec3(0, 6, 0)).norm(), 1e-12);   // (1, 0, 0) moved to 6, turned
  EXPECT_LT((X.at(202) - Vec3(-6, 5, 0)).norm(), 1e-12);  // (0, 6, 0) once more
  for (const auto& [how, image] : {std::pair{"MIRROR\n3., 0., 0., 3., 1., 0.\n3., 0., 1.\n", Vec3(5, 1, 2)},
                                   {"LINE\n3., 0., 0., 3., 0., 1.\n", Vec3(5, -1, 2)},
                                   {"POINT\n3., 0., 0.\n", Vec3(5, -1, -2)}}) {
    X = nodes_of(read(cube + "*NCOPY, OLD SET=n, CHANGE NUMBER=100, REFLECT=" + how + "*ELEMENT, TYPE=T3D2\n9, 101, 107\n"));
    EXPECT_LT((X.at(107) - image).norm(), 1e-12) << how;
  }
}

// r = 2 at 90 degrees and z = 3, in axes whose x is the y of the model and whose origin is (1, 0, 0).
TEST_F(ImportInpGenerate, NodesMayBeGivenInCylindricalAndOtherAxes) {
  const std::string bars = "*ELEMENT, TYPE=T3D2\n1, 1, 2\n";
  auto X = nodes_of(read("*NODE, SYSTEM=C\n1, 2., 90., 3.\n2, 1., 0., 0.\n" + bars));
  EXPECT_LT((X.at(1) - Vec3(0, 2, 3)).norm() + (X.at(2) - Vec3(1, 0, 0)).norm(), 1e-12);
  X = nodes_of(
      read("*SYSTEM\n1., 0., 0., 1., 5., 0.\n-3., 0., 0.\n*NODE, SYSTEM=C\n1, 2., 90., 3.\n*SYSTEM\n*NODE\n2, 1., 0., 0.\n" + bars));
  EXPECT_LT((X.at(1) - Vec3(-1, 0, 3)).norm() + (X.at(2) - Vec3(1, 0, 0)).norm(), 1e-12);
}

TEST_F(ImportInpGenerate, MistakesAreNamedWithTheirPlace) {
  const std::string two = "*NODE, NSET=a\n1, 0, 0, 0\n2, 1, 0, 0\n*NODE, NSET=b\n11, 0, 1, 0\n12, 1, 1, 0\n*ELEMENT, TYPE=T3D2\n1, 1, 2\n";
  const std::pair<const char*, const char*> cases[] = {
      {"*NGEN\n1, 5\n", "a.inp:10:4: *NGEN: no node 5 so far (*NODE gives it before)"},
      {"*NGEN\n1, 9223372036854775807\n", "a.inp:10:4: *NGEN: no node 9223372036854775807 so far (*NODE gives it before)"},
      {"*NGEN\n1, 12, 2\n", "a.inp:10:8: *NGEN: steps of 2 do not lead from 1 to 12"},
      {"*NGEN\n1, 12, 0\n", "a.inp:10:8: *NGEN: steps of 0 do not lead from 1 to 12"},
      {"*NGEN\n1, 12, -1\n", "a.inp:10:8: *NGEN: steps of -1 do not lead from 1 to 12"},
      {"*NGEN\n1, 1\n", "a.inp:10:1: *NGEN: steps of 1 do not lead from 1 to 1"},
      {"*NGEN\n1, 12\n", "a.inp:10: *NGEN generates node 2, which is there at another place (number each node once)"},
      {"*NGEN, LINE=Q\n1, 12, 11\n", "a.inp:9:13: *NGEN, LINE=Q (C, an arc, or P, a parabola)"},
      {"*NGEN, SYSTEM=S\n1, 12, 11\n", "a.inp:9:15: *NGEN, SYSTEM=S is not read (RC or C, or a node as the extra point)"},
      {"*NGEN, BIAS=2\n1, 12, 11\n", "a.inp:9:1: *NGEN, BIAS=2 is not read (write the nodes out)"},
      {"*NGEN, LINE=C\n1, 12, 11\n", "a.inp:10:1: *NGEN, LINE=C has no extra point (the centre)"},
      {"*NGEN, LINE=C\n1, 12, 11, , .5, .5, 0.\n",
       "a.inp:10:1: *NGEN, LINE=C: the ends and the centre are on a line (give the normal of the arc, in fields 8 to 10)"},
      {"*NGEN, LINE=C\n1, 12, 11, , 3., 0., 0.\n",
       "a.inp:10:14: *NGEN, LINE=C: the ends are 3 and 2.23607 from the centre (an arc has one radius)"},
      {"*NGEN, LINE=C\n1, 12, 11, , .5, .5, 0., 1., 0., 0.\n", "a.inp:10:26: *NGEN, LINE=C: the normal is not that of the arc's plane"},
      {"*NFILL\na, c, 2\n", "a.inp:10:4: *NFILL: no node set \"c\" so far (did you mean \"a\"?)"},
      {"*NFILL\na, 11, 2\n", "a.inp:10: *NFILL: 2 nodes in \"a\", 1 in \"11\" (as many in both)"},
      {"*NFILL\na, b, 0\n", "a.inp:10:7: 0 intervals of *NFILL (1 to 5000000)"},
      {"*NFILL\na, b, 999999999999\n", "a.inp:10:7: 999999999999 intervals of *NFILL (1 to 5000000)"},
      {"*NFILL\na, b, 4999999\n", "a.inp:10: *NFILL generates more than 5000000 nodes and elements (is a number wrong?)"},
      {"*NFILL\na, b, 2, 0\n", "a.inp:10:10: *NFILL: a step of 0 between node numbers"},
      {"*NFILL\na, b, 3, 9000000000000000000\n", "a.inp:10:10: a step of 9000000000000000000 between numbers (is a number wrong?)"},
      {"*NFILL\na, b, 2, -1\n", "a.inp:10: *NFILL: node number 0 is not one"},
      {"*NFILL, BIAS=0\na, b, 2\n", "a.inp:9:14: *NFILL, BIAS=0 (a number above zero)"},
      {"*NFILL, BIAS=1e-30\na, b, 99\n", "a.inp:9:14: *NFILL, BIAS=1e-30, leaves no room for 99 intervals (a BIAS nearer to 1)"},
      {"*NFILL, SINGULAR=1\na, b, 2\n", "a.inp:9:1: *NFILL, SINGULAR=1 is not read (write the nodes out)"},
      {"*ELGEN\n2, 2\n", "a.inp:10:1: *ELGEN: no element 2 so far (*ELEMENT gives it before)"},
      {"*ELGEN\n1, 0\n", "a.inp:10:4: 0 elements in a row of *ELGEN (1 to 5000000)"},
      {"*ELGEN\n1, 5000, 1, 1, 5000, 1, 5000\n", "a.inp:10:16: *ELGEN generates more than 5000000 elements (is a number wrong?)"},
      {"*ELGEN\n1, 2, 1, 1, 2\n", "a.inp:10:1: *ELGEN: 2 rows, without a step of node numbers"},
      {"*ELGEN\n1, 2, 1, 0\n", "a.inp:10:1: *ELGEN generates element 1, which is there already (number each element once)"},
      {"*ELGEN\n1, 2, 1, -1\n", "a.inp:10:1: *ELGEN: element number 0 is not one"},
      {"*ELGEN\n1, 2, 7\n", "a.inp:10: element 2 names node 8, which does not exist"},
      {"*NCOPY, OLD SET=a, SHIFT\n", "a.inp:9:1: *NCOPY lacks CHANGENUMBER="},
      {"*NCOPY, OLD SET=a, CHANGE NUMBER=5\n", "a.inp:9:1: *NCOPY: SHIFT or REFLECT is due"},
      {"*NCOPY, OLD SET=aa, CHANGE NUMBER=5, SHIFT\n", "a.inp:9:17: *NCOPY: no set \"aa\" so far (did you mean \"a\"?)"},
      {"*NCOPY, OLD SET=a, CHANGE NUMBER=5, SHIFT, MULTIPLE=0\n", "a.inp:9:53: *NCOPY, MULTIPLE=0"},
      {"*NCOPY, OLD SET=a, CHANGE NUMBER=20, SHIFT, MULTIPLE=4000000\n",
       "a.inp:9: *NCOPY generates more than 5000000 nodes and elements (is a number wrong?)"},
      {"*NCOPY, OLD SET=a, CHANGE NUMBER=10, SHIFT\n1., 0., 0.\n",
       "a.inp:9: *NCOPY generates node 11, which is there at another place (number each node once)"},
      {"*NCOPY, OLD SET=a, CHANGE NUMBER=5, REFLECT=MIRROR\n0., 0., 0., 1., 0., 0.\n", "a.inp:10: *NCOPY, REFLECT=MIRROR: 6 numbers (9)"},
      {"*ELCOPY, OLD SET=q, ELEMENT SHIFT=1, SHIFT NODES=1\n", "a.inp:9:18: *ELCOPY: no set \"q\" so far"},
      {"*SYSTEM\n0., 0., 0., 1., 0., 0.\n2., 0., 0.\n", "a.inp:11: *SYSTEM: its points are on a line"},
      {"*ELGEN\n1, x\n", "a.inp:10:4: expected a whole number, found \"x\""},
  };
  for (const auto& [text, message] : cases) {
    place.write("a.inp", two + text);
    try {
      read_any(place / "a.inp", {});
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      const std::string where = e.where.substr(e.where.rfind('/') + 1);
      EXPECT_EQ(fmt::format("{}: {}{}", where, e.message, e.hint.empty() ? "" : " (" + e.hint + ")"), message);
    }
  }
}

}  // namespace
}  // namespace hilo::test::import_inp_generate_test
