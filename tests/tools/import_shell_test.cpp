// SPDX-License-Identifier: GPL-3.0-or-later
// Shells of decks that become solid-shells by --thicken; what has no clear pair of nodes is refused by name.
#include "model/thin_regions.hpp"
#include "shell_case.hpp"

namespace hilo::test::import_shell_test {
namespace {

using namespace shell_decks;

TEST_F(ImportShell, WhatHasNoClearPairsIsRefused) {
  refused_deck("arch.geo", arch, "-o a.h5", 2, "arch.geo: no volume to mesh (the geometry holds points, curves or surfaces only)");
  refused("arch.geo -o a.h5 --thickness 0", 1, "--thickness must be positive (see hilo-import --help)");
  refused("arch.geo -o a.h5 --thickness 0.1 --order 2", 1, "--thickness makes linear shells (leave --order away)");
  const std::string quads = "*ELEMENT, TYPE=S4, ELSET=P\n",
                    rest = "*MATERIAL, NAME=M\n*ELASTIC\n1e9, .3\n*SHELL SECTION, ELSET=P, MATERIAL=M\n.1\n",
                    nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,0,1,0\n5,1,1,0\n6,2,1,0\n7,1,0,1\n8,1,1,1\n9,1,0,-1\n10,1,1,-1\n";
  refused_deck("apart.inp",
               nodes +
                   "11,.5,0,0\n12,.5,.5,0\n13,0,.5,0\n14,.5,0,0\n15,.5,-.5,0\n16,0,-.5,0\n17,0,-1,0\n"
                   "*ELEMENT, TYPE=S6, ELSET=P\n1,1,2,4,11,12,13\n2,2,1,17,14,16,15\n" +
                   rest,
               "-o a.h5 --thicken", 2,
               "apart.inp: element 2: nodes 11 and 14 stand in the middle of one edge (--merge-nodes, where they are one)");
  const std::string plate =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nCQUAD4,1,7,1,2,3,4\nMAT1,1,2.1+11,,.3,7850.\n";
  refused_deck(
      "membrane.bdf", plate + "PSHELL,7,1,.1\n", "-o a.h5 --thicken", 2,
      "membrane.bdf: element 1: PSHELL with another material in bending, or none is no plate of one material (leave them as they are: "
      "regions that are rigid)");
  refused_deck(
      "soft.bdf", plate + "PSHELL,7,1,.1,1,.5\n", "-o a.h5 --thicken", 2,
      "soft.bdf: element 1: PSHELL with 12I/T^3 other than 1, or MID4 is no plate of one material (leave them as they are: regions "
      "that are "
      "rigid)");
}

/// A strip 10 x 1 x 0.1 along x, clamped at x = 0, with 2 N along z at its end: tip P L^3/(3 E I), and what shear adds.
constexpr double strip_tip = 2. * 1000 / (3 * 1e9 * 1e-3 / 12) + 2. * 10 / (5. / 6 * 0.5e9 * 0.1);

TEST_F(ImportShell, AClampedDeckOfS4BendsAsItsBeam) {
  std::string nodes = "*NODE\n", cells = "*ELEMENT, TYPE=S4R, ELSET=STRIP\n";
  for (int i = 0; i <= 20; ++i) nodes += fmt::format("{},{},0,0\n{},{},1,0\n", 2 * i + 1, i / 2., 2 * i + 2, i / 2.);
  for (int i = 0; i < 20; ++i) {
    const int a = 2 * i + 1;
    cells += i % 2 ? fmt::format("{},{},{},{},{}\n", i + 1, a, a + 2, a + 3, a + 1)
                   : fmt::format("{},{},{},{},{}\n", i + 1, a, a + 1, a + 3, a + 2);
  }
  imported_deck("strip.inp",
                nodes + cells +
                    "*NSET, NSET=ROOT\n1,2\n*NSET, NSET=END\n41,42\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,0.\n*DENSITY\n1000\n"
                    "*SHELL SECTION, ELSET=STRIP, MATERIAL=M\n.1\n*BOUNDARY\nROOT,1,6\n*STEP\n*STATIC\n*CLOAD\nEND,3,1.\n*END STEP\n",
                "--thicken --scene-out scene.toml");
  expect_said("20 quadrangles became solid-shells, 42 nodes pairs");
  place.write("scene.toml", text_of(place / "scene.toml") + "\n[[probe]]\nname = \"END\"\non = \"END\"\n");
  succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
  EXPECT_NEAR(way("END").z() / strip_tip, 1, 2e-3);
}

/// The strip in 10 fields of 1 x 1, its elements by this function of the field and of the node at (2 i, 2 j) halves; loads at its end.
void write_strip(const Workplace& place, const std::function<std::string(int, const std::function<int(int, int)>&)>& field, bool middles) {
  std::string text = "*NODE\n";
  const auto node = [](int i, int j) { return 3 * i + j + 1; };
  std::set<int> used;
  std::string cells;
  for (int k = 0; k < 10; ++k) cells += field(k, [&](int i, int j) { return used.insert(node(2 * k + i, j)), node(2 * k + i, j); });
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 2; ++j)
      if (used.contains(node(i, j))) text += fmt::format("{},{},{},0\n", node(i, j), i / 2., j / 2.);
  const char* middle = middles ? ",2" : "";
  place.write("strip.inp", text + cells + "*NSET, NSET=ROOT\n1,3" + middle + "\n*NSET, NSET=END\n61,63\n" +
                               (middles ? "*NSET, NSET=MID\n62\n" : "") +
                               "*ELSET, ELSET=STRIP\nT,Q\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,0.\n*DENSITY\n1000\n"
                               "*SHELL SECTION, ELSET=STRIP, MATERIAL=M\n.1\n*BOUNDARY\nROOT,1,6\n*STEP\n*STATIC\n*CLOAD\n" +
                               (middles ? "END,3,.3333333333\nMID,3,1.3333333333\n" : "END,3,1.\n") + "*END STEP\n");
}

// Triangles, triangles beside quadrangles and both with mid-side nodes: all become quadrangles that share the deck's nodes.
TEST_F(ImportShell, TrianglesAndMidSideNodesBendAsTheBeam) {
  const auto solved_tip = [&] {
    place.write("scene.toml", text_of(place / "scene.toml") + "\n[[probe]]\nname = \"END\"\non = \"END\"\n");
    const auto ran = succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
    return ran.exit == 0 ? way("END").z() / strip_tip : 0.;
  };
  const std::string t = "*ELEMENT, TYPE=S3, ELSET=T\n", q = "*ELEMENT, TYPE=S4, ELSET=Q\n";
  write_strip(
      place,
      [&](int k, const auto& n) {
        return k % 2 ? q + fmt::format("{},{},{},{},{}\n", 100 + k, n(0, 0), n(2, 0), n(2, 2), n(0, 2))
                     : t + fmt::format("{},{},{},{}\n{},{},{},{}\n", 2 * k + 1, n(0, 0), n(2, 0), n(2, 2), 2 * k + 2, n(0, 0), n(2, 2),
                                       n(0, 2));
      },
      false);
  const Mesh mixed = imported("strip.inp", "--thicken --scene-out scene.toml");
  EXPECT_EQ(mixed.n_cells(), 5 * 6 + 5 * 4);
  EXPECT_NEAR(volume(mixed), 1, 1e-12);
  expect_said("15 surfaces have triangles or mid-side nodes among them: 50 quadrangles");
  const double linear = solved_tip();
  EXPECT_NEAR(linear, 1, 0.005);
  write_strip(
      place,
      [&](int k, const auto& n) {
        return k % 2 ? "*ELEMENT, TYPE=S8R, ELSET=Q\n" + fmt::format("{},{},{},{},{},{},{},{},{}\n", 100 + k, n(0, 0), n(2, 0), n(2, 2),
                                                                     n(0, 2), n(1, 0), n(2, 1), n(1, 2), n(0, 1))
                     : "*ELEMENT, TYPE=S6, ELSET=T\n" + fmt::format("{},{},{},{},{},{},{}\n{},{},{},{},{},{},{}\n", 2 * k + 1, n(0, 0),
                                                                    n(2, 0), n(2, 2), n(1, 0), n(2, 1), n(1, 1), 2 * k + 2, n(0, 0),
                                                                    n(2, 2), n(0, 2), n(1, 1), n(1, 2), n(0, 1));
      },
      true);
  EXPECT_EQ(imported("strip.inp", "--thicken --scene-out scene.toml").n_nodes(), 2 * (63 + 10)) << "a centre of each, middles of the deck";
  const double quadratic = solved_tip();
  std::printf("tip of the beam's: S3 and S4 %.4f, S6 and S8R %.4f\n", linear, quadratic);
  EXPECT_NEAR(quadratic, linear, 2e-3) << "the same quadrangles, the load on three nodes instead of two";
}

TEST_F(ImportShell, AClampedDeckOfCquad4BendsAsItsBeam) {
  const Mesh m = imported_deck("strip.bdf", cquad4_strip("SPC1,1,123456,1,2\n"), "--thicken --scene-out scene.toml");
  std::string end;
  for (const auto& [name, set] : m.facet_sets)
    if (std::abs(m.X[m.facet_nodes(set[0])[0]].x() - 10) < 1e-9 && set.size() == 1) end = name;
  ASSERT_NE(end, "");
  place.write("scene.toml", text_of(place / "scene.toml") + "\n[[probe]]\nname = \"end\"\non = \"" + end + "\"\n");
  succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
  EXPECT_NEAR(way("end").z() / strip_tip, 1, 2e-3);
}

// T1 to T4, as numbers, as shares of the property's and of triangles: a strip whose thickness falls to half from root to end.  Volume,
// centre, and what a force at its end does: the integral of P (L - x)^2/(E I(x)).
TEST_F(ImportShell, ThicknessesAtCornersTaperAStrip) {
  const double L = 10, h = .1, P = 2, E = 1e9;
  double tip = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = (i + .5) * L / 1000;
    tip += P * (L - x) * (L - x) / (E * std::pow(h * (1 - x / 20), 3) / 12) * L / 1000;
  }
  const std::string plain = cquad4_strip("SPC1,1,123456,1,2\n");
  for (const std::string form : {"numbers", "shares", "triangles"}) {
    std::string deck;
    std::istringstream lines(plain);
    for (std::string line; std::getline(lines, line);) {
      int e = 0, n[4];
      if (std::sscanf(line.c_str(), "CQUAD4,%d,7,%d,%d,%d,%d", &e, n, n + 1, n + 2, n + 3) != 5) {
        deck += line + "\n";
        continue;
      }
      const auto t = [&](int grid) { return (form == "shares" ? 1 : h) * (1 - (grid - 1) / 2 / 40.); };
      if (form == "triangles")
        for (const auto& [id, a, b, c] : {std::array{e, n[0], n[1], n[2]}, std::array{100 + e, n[0], n[2], n[3]}})
          deck += fmt::format("CTRIA3,{},7,{},{},{},,,,+\n+,,,{:.6f},{:.6f},{:.6f}\n", id, a, b, c, t(a), t(b), t(c));
      else
        deck +=
            line + fmt::format(",,,+\n+,,{},{:.6f},{:.6f},{:.6f},{:.6f}\n", form == "shares" ? 1 : 0, t(n[0]), t(n[1]), t(n[2]), t(n[3]));
    }
    place.write("strip.bdf", deck);
    succeeded(place.run("hilo-import --quiet strip.bdf -o rigid.h5"));
    const auto moments = read_thin_regions(place / "rigid.h5").at(0).moments;
    EXPECT_NEAR(moments[0], .75 * h * L, 1e-7) << form;
    EXPECT_NEAR(moments[1], h * (L * L / 2 - L * L * L / 60), 1e-6) << form;
    const Mesh m = imported("strip.bdf", "--thicken --scene-out scene.toml");
    double across = 0;
    EXPECT_NEAR(volume(m), .75 * h * L, 1e-6) << form;
    for (const Vec3& X : m.X) across = std::max(across, std::abs(std::abs(X.z()) - h / 2 * (1 - X.x() / 20)));
    EXPECT_LT(across, 1e-6) << form;
    EXPECT_TRUE(m.block.empty()) << form << ": it is one sheet";
    place.write("scene.toml",
                text_of(place / "scene.toml") +
                    "\n[set.end]\nkind = \"box\"\nlow = [9.99, -1, -1]\nhigh = [10.01, 2, 1]\n[[probe]]\nname = \"end\"\non = \"end\"\n");
    succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
    std::printf("%s: %.4f\n", form.c_str(), way("end").z() / tip);
    EXPECT_NEAR(way("end").z() / tip, 1, form == "triangles" ? 1e-2 : 5e-3) << form;
  }
  const std::string head = plain.substr(0, plain.find("CQUAD4"));
  for (const auto& [entry, why] : {std::pair{"CQUAD4,1,7,1,3,4,2,,,+\n+,,,.1,-.1,.1,.1\n", "CQUAD4 1: T2 -0.1 is not above 0"},
                                   std::pair{"CQUAD4,1,7,1,3,4,2,,,+\n+,,2,.1\n", "CQUAD4 1: TFLAG 2 is neither 0 nor 1"}}) {
    place.write("bad.bdf", head + entry);
    expect_end(place.run("hilo-import bad.bdf -o bad.h5"), 2, why);
  }
}

// A quarter of a clamped square under a force in its middle, in CTRIA3: 0.00560 P a^2/D [timoshenko-1959].  Nodes between the supports of
// symmetry and the corners, which are held in more, are held as on both sides.
TEST_F(ImportShell, AQuarterOfAPlateOfCtria3HasTheSymmetryOfTheWhole) {
  const int n = 8;
  const auto grid = [&](int i, int j) { return i * (n + 1) + j + 1; };
  std::string deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,2.1+11,,.3,7850.\nPSHELL,7,1,.01,1,,1\n";
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      deck += fmt::format("GRID,{},,{:.5f},{:.5f},0.\n", grid(i, j), 0.5 * i / n, 0.5 * j / n);
      if (i == n || j == n) deck += fmt::format("SPC1,1,123456,{}\n", grid(i, j));
      if (i == 0) deck += fmt::format("SPC1,1,156,{}\n", grid(i, j));
      if (j == 0) deck += fmt::format("SPC1,1,246,{}\n", grid(i, j));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      deck += fmt::format("CTRIA3,{},7,{},{},{}\nCTRIA3,{},7,{},{},{}\n", 2 * (i * n + j) + 1, grid(i, j), grid(i + 1, j),
                          grid(i + 1, j + 1), 2 * (i * n + j) + 2, grid(i, j), grid(i + 1, j + 1), grid(i, j + 1));
  const Mesh m = imported_deck("plate.bdf", deck + "FORCE,2,1,,25.,0.,0.,1.\nENDDATA\n", "--thicken --scene-out scene.toml");
  EXPECT_EQ(m.n_cells(), 3 * 2 * n * n);
  std::set<std::int64_t> held;
  const std::string scene = text_of(place / "scene.toml");
  const auto take = [&](const std::string& name) {
    if (m.node_sets.contains(name)) held.insert(m.node_sets.at(name).begin(), m.node_sets.at(name).end());
    if (m.facet_sets.contains(name))
      for (const Facet& f : m.facet_sets.at(name))
        for (const auto a : m.facet_nodes(f)) held.insert(a);
  };
  for (size_t at = scene.find("[[motion]]"); at != scene.npos; at = scene.find("[[motion]]", at + 1)) {
    const size_t from = scene.find("on = \"", at) + 6;
    take(scene.substr(from, scene.find('"', from) - from));
  }
  for (std::int64_t a = 0; a < m.n_nodes(); ++a)
    if (m.X[a].x() * m.X[a].y() * (0.5 - m.X[a].x()) * (0.5 - m.X[a].y()) < 1e-12) {
      EXPECT_TRUE(held.contains(a)) << m.X[a].transpose();
    }
  place.write("scene.toml", scene +
                                "\n[set.middle]\nkind = \"ball\"\nat = [0, 0, 0]\nradius = 0.006\n[[probe]]\nname = \"middle\"\non = "
                                "\"middle\"\n");
  succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
  const double share = way("middle").z() / (0.0056 * 100 * 12 * (1 - 0.09) / (2.1e11 * 1e-6));
  std::printf("middle %.4f of Timoshenko's\n", share);
  EXPECT_NEAR(share, 1, 0.02);
}

// Grids of no element, and grids that are merged, leave a support on its own node.
TEST_F(ImportShell, ASupportStaysWithItsNode) {
  const std::string pinned = "SPC1,1,123,41,42\nSPC1,1,123456,1,2\n";
  std::string unused, twins;
  for (int i = 0; i < 6; ++i) unused += fmt::format("GRID,{},,{}.,0.,0.\n", 900 + i, -5 - i);
  twins = "GRID,901,,0.,0.,0.\nGRID,902,,.5,0.,0.\nGRID,903,,.5,1.,0.\nGRID,904,,0.,1.,0.\nCQUAD4,900,7,901,902,903,904\n";
  const auto check = [&](const std::string& deck, const std::string& options = "") {
    const Mesh m = imported(deck, "--thicken " + options);
    ASSERT_EQ(m.block_name, (std::vector<std::string>{"grid_41", "grid_42"})) << "hinges";
    EXPECT_LT((m.block_at[0] - Vec3(10, 0, 0)).norm(), 1e-12);
    EXPECT_LT((m.block_at[1] - Vec3(10, 1, 0)).norm(), 1e-12);
    for (size_t a = 0; a < m.block.size(); ++a)
      if (m.block[a] >= 0) {
        EXPECT_NEAR((m.X[a] - m.block_at[static_cast<size_t>(m.block[a])]).norm(), 0.05, 1e-12);
      }
    EXPECT_EQ(std::ranges::count(m.block, 0), 2);
  };
  place.write("alone.bdf", cquad4_strip(pinned));
  check("alone.bdf");
  place.write("unused.bdf", cquad4_strip(unused + pinned));
  check("unused.bdf");
  // the four twins lie before the strip's nodes, which lose four of theirs
  std::string apart = cquad4_strip(twins + pinned);
  apart.replace(apart.find("CQUAD4,1,7,1,3,4,2\n"), 19, "");
  place.write("twins.bdf", apart);
  check("twins.bdf", "--merge-nodes 1e-6");
  EXPECT_EQ(imported_deck("clamped.bdf", cquad4_strip(unused + "SPC1,1,123456,1,2\n"), "--thicken").n_cells(), 20);
}

// What turns a beam that is a cell is left out by name beside --thicken too: pairs of nodes are of shells alone.
TEST_F(ImportShell, SupportsThatHoldRigidBeamsFromTurningAreNamed) {
  imported_deck("beam.bdf",
                "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,1.+9,,0.,1000.\nPSHELL,7,1,.1,1,,1\nPBAR,8,1,.01,1.-5,1.-5\n"
                "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\n"
                "CQUAD4,1,7,1,2,3,4\nCBAR,2,8,5,6,0.,0.,1.\nSPC1,1,123456,1,4\nSPC1,1,123456,5\nFORCE,2,6,,1.,0.,0.,1.\nENDDATA\n",
                "--thicken --rigid-beams --scene-out scene.toml");
  expect_said("turns and moments of grids of shells and beams (1, beam.bdf:18)");
  EXPECT_NE(text_of(place / "scene.toml").find("card = \"turns and moments of grids of shells and beams\""), std::string::npos);
  imported_deck("beam.inp",
                "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n*ELEMENT, TYPE=S4, ELSET=P\n1,1,2,3,4\n"
                "*ELEMENT, TYPE=B31, ELSET=R\n2,5,6\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,.3\n*DENSITY\n1000\n"
                "*SHELL SECTION, ELSET=P, MATERIAL=M\n.1\n*BEAM SECTION, ELSET=R, MATERIAL=M, SECTION=RECT\n.1,.1\n0,0,1\n"
                "*BOUNDARY\n1,1,6\n4,1,6\n5,1,6\n*STEP\n*STATIC\n*CLOAD\n6,5,1.\n*END STEP\n",
                "--thicken --rigid-beams --scene-out scene.toml");
  expect_said("turns and moments of nodes of shells and beams (2, beam.inp:25)");
}

}  // namespace
}  // namespace hilo::test::import_shell_test
