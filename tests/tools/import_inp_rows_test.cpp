// SPDX-License-Identifier: GPL-3.0-or-later
// *EQUATION of equal displacements, *TRANSFORM, DCOUP3D, *RIGID BODY without a reference node, *PARAMETER; cells that the nodes on their
// edges turn inside out; msh 1.  Truth: forces and extensions of a bar by hand.
#include <algorithm>
#include <cmath>
#include <map>

#include "import_case.hpp"
#include "model/block.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_inp_rows_test {
namespace {

/// A bar of two cubes of 1 m along x, held at its foot: E = 1e9 Pa; node 100 is of no cell.
const std::string bar =
    "*NODE\n1, 0, 0, 0\n2, 0, 1, 0\n3, 0, 1, 1\n4, 0, 0, 1\n5, 1, 0, 0\n6, 1, 1, 0\n7, 1, 1, 1\n8, 1, 0, 1\n9, 2, 0, 0\n10, 2, 1, 0\n"
    "11, 2, 1, 1\n12, 2, 0, 1\n100, 2, .5, .5\n*ELEMENT, TYPE=C3D8, ELSET=bar\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 5, 6, 7, 8, 9, 10, 11, 12\n"
    "*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=head, GENERATE\n9, 12\n"
    "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n*SOLID SECTION, ELSET=bar, MATERIAL=m\n";
const std::string held = "*BOUNDARY\nfoot, 1, 3\n", statics = "*STEP\n*STATIC\n", end = "*END STEP\n";

class ImportInpRows : public test::Import {
 protected:
  /// Displacement at the end of the node with this number in the deck [m].
  Vec3 moved(std::int64_t id) const {
    const Store run = Store::open(place / "run.h5");
    const auto u = run.read<double>("/field/" + run.list("/field").back() + "/displacement");
    const auto ids = Store::open(place / "out.h5").read<std::int64_t>("/mesh/nodes/id");
    const auto row = static_cast<size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
    return {u.at(3 * row), u.at(3 * row + 1), u.at(3 * row + 2)};
  }
  Vec3 foot() const {
    const auto all = Store::open(place / "run.h5").read<double>("/history/motion/foot");
    return {all[all.size() - 6], all[all.size() - 5], all[all.size() - 4]};
  }
};

// Truth: the sum of two displacements is that of the node that stands for it, though it lies on theirs.
TEST_F(ImportInpRows, ANodeOnAnotherStandsForItsSum) {
  const std::string stands = "*NODE\n101, 2, 0, 0\n*EQUATION\n3\n9, 1, 1., 9, 2, 1., 101, 1, -1.\n";
  solve(bar + stands + held + statics + "*BOUNDARY\n101, 1, 1, 1e-5\n" + end);
  EXPECT_NEAR(moved(9).x() + moved(9).y(), 1e-5, 1e-9);
}

// Truth: all of the end moves by F L/(E A), whichever of its nodes, or of the node that they follow, is pulled with F.
TEST_F(ImportInpRows, EqualDisplacementsMoveTogether) {
  const std::string tie = "*EQUATION\n2\nhead, 1, 1., 100, 1, -1.\n",
                    two = "*EQUATION\n2\n10, 1, 2., 9, 1, -2.\n2\n11, 1, 1.,\n10, 1, -1.\n2\n12, 1, 1., 10, 1, -1.\n";
  for (const std::string& text :
       {bar + held + tie + statics + "*CLOAD\n100, 1, 4e3\n" + end, bar + held + two + statics + "*CLOAD\n9, 1, 4e3\n" + end,
        bar + held + tie + statics + "*CLOAD\n11, 1, 1e3\n100, 1, 3e3\n" + end}) {
    solve(text);
    EXPECT_EQ(err.find("not read"), std::string::npos) << err;
    for (const int node : {9, 10, 11, 12}) EXPECT_NEAR(moved(node).x(), 4e3 * 2 / 1e9, 1e-5 * 8e-6) << node << text;
    EXPECT_NEAR(foot().x(), -4e3, 1e-4);
  }
}

// Truth: E A u/L; held, as if the end were.
TEST_F(ImportInpRows, ANodeThatOthersFollowMayBeMovedOrHeld) {
  const std::string tie = "*EQUATION\n2\nhead, 1, 1., 100, 1, -1.\n";
  solve(bar + held + tie + statics + "*BOUNDARY\n100, 1, 1, 1e-5\n" + end);
  EXPECT_NEAR(foot().x(), -5e3, .1);
  solve(bar + held + tie + "*BOUNDARY\n100, 1, 1\n" + statics + "*CLOAD\n5, 1, 1.\n6, 1, 1.\n7, 1, 1.\n8, 1, 1.\n" + end);
  EXPECT_NEAR(foot().x(), -2, 1e-6);  // half of 4 N at the middle
  solve(bar + held + "*EQUATION\n1\nhead, 1, 2.\n" + statics + "*CLOAD\n5, 1, 1.\n6, 1, 1.\n7, 1, 1.\n8, 1, 1.\n" + end);
  EXPECT_NEAR(foot().x(), -2, 1e-6);
}

// Truth: mass times acceleration; density times area times square of the speed times the integral of the radius; half of it by an
// amplitude.
TEST_F(ImportInpRows, GravityOnAPartAndCentrifugalForcesPull) {
  solve(bar + held + statics + "*DLOAD\n2, GRAV, 3., 1., 0., 0.\n" + end);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  EXPECT_LT((foot() - Vec3(-3000, 0, 0)).norm(), 1e-2) << foot().transpose();
  solve("*AMPLITUDE, NAME=half\n0., .5, 9., .5\n" + bar + held + statics + "*DLOAD, AMPLITUDE=half\nbar, GRAV, 3., 1., 0., 0.\n" + end);
  EXPECT_LT((foot() - Vec3(-3000, 0, 0)).norm(), 1e-2) << foot().transpose();
  solve(bar + held + statics + "*DLOAD\nbar, CENTRIF, 9., 0., .5, 0., 0., 0., 2.\n" + end);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  EXPECT_LT((foot() - Vec3(-1000 * 9 * 2, 0, 0)).norm(), 1e-1) << foot().transpose();
  solve(bar + held + statics + "*DLOAD\n2, CENTRIF, 9., 0., 0., 0., 0., 0., 1.\n" + end);  // x from 1 to 2, y from 0 to 1
  EXPECT_LT((foot() - Vec3(-1000 * 9 * 1.5, -1000 * 9 * .5, 0)).norm(), 1e-1) << foot().transpose();
}

// The same of a Nastran file: the top of a cube of 1 m rises as one, whichever grid is pulled.
TEST_F(ImportInpRows, AnMpcOfEqualDisplacementsMovesGridsTogether) {
  imported_deck("a.bdf",
                "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nMPC = 5\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\n"
                "GRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\n"
                "PSOLID,1,1\nMAT1,1,1.+9,,0.,1000.\nSPC1,1,123,1,2,3,4\nFORCE,2,7,,4.+3,0.,0.,1.\n"
                "MPC,5,5,3,1.,7,3,-1.\nMPC,5,6,3,-3.,7,3,3.\nMPC,5,8,3,1.,5,3,-1.\nENDDATA\n",
                "--quiet --scene-out s.toml");
  EXPECT_EQ(err, "");
  succeeded(place.run("hilo-solve --quiet s.toml -o run.h5"), test::text_of(place / "s.toml"));
  for (const int node : {5, 6, 7, 8}) EXPECT_NEAR(moved(node).z(), 4e-6, 1e-10) << node;
}

TEST_F(ImportInpRows, AnotherSubcaseMayBeTaken) {
  place.write("a.bdf",
              "SOL 101\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 2\nSUBCASE 4\nLOAD = 3\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n"
              "GRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\n"
              "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nMAT1,1,1.+9,,0.,1000.\nSPC1,1,123,1,2,3,4\nFORCE,2,7,,4.,1.,0.,0.\n"
              "FORCE,3,7,,5.,0.,0.,1.\nENDDATA\n");
  for (const auto& [option, force] : {std::pair{"", Vec3(4, 0, 0)}, {"--subcase 1", Vec3(4, 0, 0)}, {"--subcase 4", Vec3(0, 0, 5)}}) {
    imported("a.bdf", std::string("--quiet --scene-out s.toml ") + option);
    const Scene scene = Scene::load(place / "s.toml");
    const auto& loads = scene.entries("load");
    ASSERT_EQ(loads.size(), 1u) << option;
    EXPECT_EQ(loads[0].vector3("force"), force) << option;
  }
  refused("a.bdf -o b.h5 --subcase 2", 1, "--subcase 2: there is none (subcases: 1, 4)");
  refused_deck("a.inp", bar, "-o b.h5 --subcase 2", 1, "--subcase is for a Nastran file, a.inp is none");
}

/// Rods of 1 m from the ground to nodes 1, 3, 5, 7, stiffness i * 1e8 N/m, pulled by 100, 200, -100, 400 N, and the displacements that are
/// least in energy under sum f u = 0.
const std::array<double, 4> pulls{100, 200, -100, 400};
std::array<double, 4> rods_under(const std::array<double, 4>& f) {
  double a = 0, b = 0;
  for (size_t i = 0; i < 4; ++i)
    a += f[i] * pulls[i] / (1e8 * static_cast<double>(i + 1)), b += f[i] * f[i] / (1e8 * static_cast<double>(i + 1));
  std::array<double, 4> u{};
  for (size_t i = 0; i < 4; ++i) u[i] = (pulls[i] - a / b * f[i]) / (1e8 * static_cast<double>(i + 1));
  return u;
}

// Truth: the closed form above, of two, three and four terms; the last by way of a node of no cell, u8 = -(f u)/3, that nothing holds.
TEST_F(ImportInpRows, EquationsOfAnyFactorsHold) {
  std::string rods = "*NODE\n100, 9, 9, 9\n", loads = "*CLOAD\n";
  for (int i = 0; i < 4; ++i) {
    const std::string y = std::to_string(i), a = std::to_string(2 * i + 1), b = std::to_string(2 * i + 2);
    rods += a + ", 1, " + y + ", 0\n" + b + ", 0, " + y + ", 0\n";
    loads += a + ", 1, " + std::to_string(pulls[static_cast<size_t>(i)]) + "\n";
  }
  for (int i = 0; i < 4; ++i) {
    const std::string k = std::to_string(i + 1), a = std::to_string(2 * i + 1), b = std::to_string(2 * i + 2);
    rods += "*ELEMENT, TYPE=T3D2, ELSET=r" + k + "\n" + k + ", " + b + ", " + a + "\n*SOLID SECTION, ELSET=r" + k + ", MATERIAL=m\n" + k +
            "e-3\n";
    rods += "*BOUNDARY\n" + b + ", 1, 3\n" + a + ", 2, 3\n";
  }
  rods += "*MATERIAL, NAME=m\n*ELASTIC\n1e11, 0.\n*DENSITY\n1000.\n";
  const struct {
    const char* equation;
    std::array<double, 4> f;
  } cases[] = {{"2\n1, 1, 1., 3, 1, 2.\n", {1, 2, 0, 0}},
               {"3\n1, 1, 1., 3, 1, 2., 5, 1, -3.\n", {1, 2, -3, 0}},
               {"4\n1, 1, 1., 3, 1, 2., 5, 1, -3., 7, 1, .5\n", {1, 2, -3, .5}},
               {"5\n1, 1, 1., 3, 1, 1.\n5, 1, -3., 7, 1, .5, 3, 1, 1.\n", {1, 2, -3, .5}},
               {"2\n1, 1, 1., 100, 2, -1.\n4\n100, 2, 1., 3, 1, 2., 5, 1, -3., 7, 1, .5\n", {1, 2, -3, .5}}};
  for (const auto& c : cases) {
    solve(rods + "*EQUATION\n" + c.equation + statics + loads + end);
    EXPECT_EQ(err.find("not read"), std::string::npos) << err;
    const auto u = rods_under(c.f);
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(moved(static_cast<std::int64_t>(2 * i + 1)).x(), u[i], 1e-5 * 4e-6) << i << c.equation;
  }
}

// The same of a Nastran file, with a continuation.
TEST_F(ImportInpRows, AnMpcOfAnyFactorsHolds) {
  std::string text = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nMPC = 5\nBEGIN BULK\nMAT1,1,1.+11,,0.,1000.\n";
  for (int i = 0; i < 4; ++i) {
    const std::string y = std::to_string(i) + ".", a = std::to_string(2 * i + 1), b = std::to_string(2 * i + 2), k = std::to_string(i + 1);
    text += "GRID," + a + ",,1.," + y + ",0.\nGRID," + b + ",,0.," + y + ",0.\nCROD," + k + "," + k + "," + b + "," + a + "\nPROD," + k +
            ",1," + k + ".-3\nSPC1,1,123," + b + "\nSPC1,1,23," + a + "\nFORCE,2," + a + ",," +
            std::to_string(pulls[static_cast<size_t>(i)]) + ",1.,0.,0.\n";
  }
  imported_deck("a.bdf", text + "MPC,5,1,1,1.,3,1,2.,\n,,5,1,-3.,7,1,.5\nENDDATA\n", "--quiet --scene-out s.toml");
  EXPECT_EQ(err, "");
  succeeded(place.run("hilo-solve --quiet s.toml -o run.h5"), test::text_of(place / "s.toml"));
  const auto u = rods_under({1, 2, -3, .5});
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(moved(static_cast<std::int64_t>(2 * i + 1)).x(), u[i], 1e-5 * 4e-6) << i;
}

// Truth: E A/L u + F(u) = 2e4 N with F = 1e4 + 2e3 (u - 1e-5)/9e-5 beyond 1e-5 m; the spring is pressed where the bar is pulled.
TEST_F(ImportInpRows, ASpringByATable) {
  const double slope = 2e3 / 9e-5, u = (2e4 - 1e4 + slope * 1e-5) / (5e8 + slope);
  std::string with = bar;
  with.insert(with.find("*ELEMENT"), "200, 3, 0, 0\n");
  solve(with + held + "*EQUATION\n2\nhead, 1, 1., 100, 1, -1.\n*ELEMENT, TYPE=SPRINGA, ELSET=s\n900, 9, 200\n" +
        "*SPRING, NONLINEAR, ELSET=s\n\n-1.2e4, -1e-4\n-1e4, -1e-5\n0., 0.\n1., 1.\n*BOUNDARY\n200, 1, 6\n" + statics +
        "*CLOAD\n100, 1, 2e4\n" + end);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  EXPECT_NEAR(moved(9).x(), u, 1e-4 * u);
  EXPECT_NEAR(moved(11).x(), u, 1e-4 * u);
}

// Truth: the volume of a pyramid, a third of height times base; sets that name it have both of its halves.
TEST_F(ImportInpRows, PyramidsAreTwoTetrahedraEach) {
  const std::string
      points = "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, .5, .5, 3\n*ELEMENT, TYPE=C3D5, ELSET=p\n7, 1, 2, 3, 4, 5\n",
      rest =
          "*NSET, NSET=all, ELSET=p\n*ELSET, ELSET=again\n7\n*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*SOLID SECTION, "
          "ELSET=p, MATERIAL=m\n";
  const Mesh m = imported_deck("a.inp", points + rest);
  EXPECT_NEAR(test::volume(m), 1, 1e-12);
  EXPECT_EQ(test::cells_of(m, "p"), 2);
  EXPECT_EQ(m.node_sets.at("all").size(), 5U);
  EXPECT_EQ(m.cell_sets.at("again").size(), 2U);
  expect_said("1 pyramids are two tetrahedra each");
  refused_deck("a.inp", points + "*SURFACE, NAME=s\np, S1\n" + rest, "-o b.h5", 2,
               "a.inp:10: element 7 is a pyramid, whose faces by number are not read (a surface of element sets)");
  EXPECT_NEAR(
      test::volume(imported_deck("a.bdf",
                                 "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,.5,.5,3.\n"
                                 "CPYRAM,7,1,1,2,3,4,5\nPSOLID,1,1\nMAT1,1,1.+9,,0.\nENDDATA\n")),
      1, 1e-12);
}

// Truth: as of CENTRIF above: 2 rho A omega^2, omega of RFORCE in turns per second.
TEST_F(ImportInpRows, RforceTurnsTheWhole) {
  imported_deck("a.bdf",
                "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,0.,1.,0.\nGRID,3,,0.,1.,1.\nGRID,4,,0.,0.,1.\n"
                "GRID,5,,2.,0.,0.\nGRID,6,,2.,1.,0.\nGRID,7,,2.,1.,1.\nGRID,8,,2.,0.,1.\nGRID,9,,0.,.5,0.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\n"
                "PSOLID,1,1\nMAT1,1,1.+9,,0.,1000.\nSPC1,1,123,1,2,3,4\nRFORCE,2,9,,.25,0.,0.,2.\nENDDATA\n",
                "--scene-out s.toml");
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  succeeded(place.run("hilo-solve --quiet s.toml -o run.h5"), test::text_of(place / "s.toml"));
  const double omega = 2 * std::acos(-1) * .5;
  const Store run = Store::open(place / "run.h5");
  Vec3 sum = Vec3::Zero();
  for (const std::string& name : run.list("/history/motion")) {
    const auto all = run.read<double>("/history/motion/" + name);
    sum += Vec3(all[all.size() - 6], all[all.size() - 5], all[all.size() - 4]);
  }
  EXPECT_LT((sum - Vec3(-1000 * 2 * omega * omega, 0, 0)).norm(), 1e-2) << sum.transpose();
}

TEST_F(ImportInpRows, OtherEquationsAreTold) {
  for (const char* equation : {"2\n9, 4, 1., 10, 4, -1.", "3\n9, 1, 1., 10, 11, -1., 11, 1, 1."}) {
    imported_deck("a.inp", bar + held + "*EQUATION\n" + equation + "\n" + statics + end, "--scene-out s.toml");
    EXPECT_NE(err.find("not read: *EQUATION "), std::string::npos) << equation << err;
  }
}

// Truth: the same bar and load in its own axes, turned by 30 degrees about z; *TRANSFORM says which way the supports look.
TEST_F(ImportInpRows, SupportsAndForcesInAxesOfATransform) {
  const Mat3 turn = Eigen::AngleAxisd(std::acos(-1) / 6, Vec3::UnitZ()).toRotationMatrix();
  std::string nodes = "*NODE\n";
  for (int i = 0; i < 12; ++i) {
    const Vec3 x = turn * Vec3(i / 4, i % 4 == 1 || i % 4 == 2, i % 4 > 1);
    nodes += std::to_string(i + 1) + ", " + std::to_string(x.x()) + ", " + std::to_string(x.y()) + ", " + std::to_string(x.z()) + "\n";
  }
  const std::string rest = bar.substr(bar.find("*ELEMENT"));
  // held along the bar alone at its foot, with one edge and one corner against the other motions
  const std::string tripod = "*BOUNDARY\nfoot, 1\n1, 2\n4, 2\n1, 3\n2, 3\n";
  solve(nodes + rest + "*NSET, NSET=all, GENERATE\n1, 12\n*TRANSFORM, NSET=all\n.8660254, .5, 0., -.5, .8660254, 0.\n" + tripod + statics +
        "*CLOAD\nhead, 1, 1e3\n" + end);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  for (const int node : {9, 11})
    EXPECT_LT((moved(node) - turn * Vec3(4e3 * 2 / 1e9, 0, 0)).norm(), 1e-5 * 8e-6) << node << ": " << moved(node).transpose();
}

// Truth: radial forces on the ends of a cross cancel; the axes of a cylinder at each node.
TEST_F(ImportInpRows, AxesOfACylinderAreThoseAtEachNode) {
  const Mesh m = imported_deck(
      "a.inp",
      bar + held + "*TRANSFORM, NSET=head, TYPE=C\n0., .5, .5, 1., .5, .5\n" + statics + "*CLOAD\nhead, 1, 3.\nhead, 3, 1.\n" + end,
      "--scene-out s.toml");
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  Vec3 sum = Vec3::Zero();
  double outward = 0;
  const Scene scene = Scene::load(place / "s.toml");
  for (const Entry& load : scene.entries("load"))
    for (const auto a : m.nodes_of(load.text("on"), "")) {
      sum += load.vector3("force");
      outward += load.vector3("force").dot((m.X[a] - Vec3(2, .5, .5)).normalized());
    }
  EXPECT_LT((sum - Vec3(4, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(outward, 12, 1e-12);
}

// Truth: the share of a node is w F/W and what the moment asks; in the middle of four it is a quarter each.
TEST_F(ImportInpRows, ADistributingCouplingElementSharesItsForce) {
  const std::string element = "*ELEMENT, TYPE=DCOUP3D, ELSET=dc\n50, 100\n";
  solve(bar + element + "*DISTRIBUTING COUPLING, ELSET=dc\nhead, 1.\n" + held + statics + "*CLOAD\n100, 1, 4e3\n" + end);
  EXPECT_NEAR(foot().x(), -4e3, 1e-4);
  for (const int node : {9, 10, 11, 12}) EXPECT_NEAR(moved(node).x(), 8e-6, 1e-10) << node;
  imported_deck("a.inp", bar + element + held + statics + end);
  expect_said("*ELEMENT, TYPE=DCOUP3D without a value");
}

// Truth: the second cell is rigid, so that the first alone lengthens: F/(E A) of 1 m.
TEST_F(ImportInpRows, ARigidBodyNeedsNoReferenceNode) {
  solve(bar + "*NSET, NSET=rigid, GENERATE\n5, 12\n*RIGID BODY, NSET=rigid\n" + held + statics + "*CLOAD\nhead, 1, 1e3\n" + end);
  for (const int node : {5, 9, 12}) EXPECT_NEAR(moved(node).x(), 4e-6, 1e-10) << node;
}

// Truth: the numbers by hand.
TEST_F(ImportInpRows, ParametersStandForNumbers) {
  const std::string values =
      "*PARAMETER\n# of the bar\nlong = 2.\nF = -(1 + 2)**2*1e2/long + 2**-1 # 449.5 below zero\nn=3*3\nangle = sin(radians(30))\n";
  const Mesh m =
      imported_deck("a.inp", values + bar + held + statics + "*CLOAD\n<n>, 1, <F>\n10, 2, < angle >\n" + end, "--scene-out s.toml");
  std::map<std::int64_t, Vec3> force;
  const Scene scene = Scene::load(place / "s.toml");
  for (const Entry& load : scene.entries("load"))
    for (const auto a : m.nodes_of(load.text("on"), ""))
      force.try_emplace(m.node_id[a], Vec3::Zero()).first->second += load.vector3("force");
  EXPECT_NEAR(force.at(9).x(), -449.5, 1e-10);
  EXPECT_NEAR(force.at(10).y(), .5, 1e-15);
  for (const auto& [line, message] :
       {std::pair{"a = 1/2", "a.inp:2: *PARAMETER: a division of whole numbers with a rest in \" 1/2\" (write the numbers out)"},
        {"a = b + 1", "a.inp:2: *PARAMETER: no parameter \"b\" so far in \" b + 1\" (write the numbers out)"},
        {"a = 'x'", "a.inp:2: *PARAMETER: a number is missing in \" 'x'\" (write the numbers out)"}}) {
    refused_deck("a.inp", std::string("*PARAMETER\n") + line + "\n" + bar, "-o b.h5", 2, message);
  }
  place.write("a.inp", "*PARAMETER\na = 1\n" + bar + held + statics + "*CLOAD\n9, 1, <A>\n" + end);
  expect_end(place.run("hilo-import a.inp -o b.h5"), 2, "no parameter \"A\" so far (*PARAMETER gives it before)");
}

// Truth: a cube of 1 m; one node on an edge stands so far inside that a corner is inside out.
TEST_F(ImportInpRows, NodesOnEdgesThatTurnACellInsideOutAreStraightened) {
  const auto reference = test::reference_nodes(Shape::hex20);
  std::string text = "*NODE\n";
  for (size_t a = 0; a < reference.size(); ++a) {
    Vec3 x(reference[a][0], reference[a][1], reference[a][2]);
    if (a == 8) x.x() -= .8 * (x - Vec3(reference[0][0], reference[0][1], reference[0][2])).norm();
    text += std::to_string(a + 1) + ", " + std::to_string(x.x()) + ", " + std::to_string(x.y()) + ", " + std::to_string(x.z()) + "\n";
  }
  text += "*ELEMENT, TYPE=C3D20, ELSET=all\n1";
  for (int a = 0; a < 20; ++a) text += (a == 12 ? ",\n" : ", ") + std::to_string(a + 1);
  const Mesh m = imported_deck("a.inp", text + "\n");
  const Vec3 size = Vec3(reference[6][0], reference[6][1], reference[6][2]) - Vec3(reference[0][0], reference[0][1], reference[0][2]);
  EXPECT_NEAR(volume(m), size.prod(), 1e-12);
  expect_said("1 cells that the nodes on their edges turned inside out have straight edges");
}

// A part of one cube, three times: as it is, moved along x, and moved and turned by 90 degrees about z.  Its sets, sections and supports
// are those of each instance.  Truth: places by hand; a pull on the face of the second does not reach the third.
TEST_F(ImportInpRows, InstancesOfPartsHaveNumbersAndNamesOfTheirOwn) {
  const std::string parts =
      "*PART, NAME=cube\n*NODE\n1, 0, 0, 0\n2, 0, 1, 0\n3, 0, 1, 1\n4, 0, 0, 1\n5, 2, 0, 0\n6, 2, 1, 0\n7, 2, 1, 1\n8, 2, 0, 1\n"
      "*ELEMENT, TYPE=C3D8, ELSET=all\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=both\nfoot, 7\n"
      "*SURFACE, NAME=end\nall, S2\n*SOLID SECTION, ELSET=all, MATERIAL=m\n*END PART\n"
      "*PART, NAME=unused\n*NODE\n1, 0, 0, 0\n*END PART\n";
  const std::string assembly =
      "*ASSEMBLY, NAME=a\n*INSTANCE, NAME=A-1, PART=cube\n*END INSTANCE\n*INSTANCE, NAME=B-1, PART=cube\n10., 0., 0.\n*END INSTANCE\n"
      "*INSTANCE, NAME=C-1, PART=CUBE\n0., 5., 0.\n0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n"
      "*NODE\n1, 20., 0., 0.\n*NSET, NSET=feet\nA-1.foot, B-1.foot, C-1.foot\n*NSET, NSET=tip, INSTANCE=B-1\n7\n*NSET, NSET=tips\nC-1.7, "
      "tip\n"
      "*ELSET, ELSET=_top, INSTANCE=C-1\n1\n*SURFACE, NAME=top\n_top, S2\n*END ASSEMBLY\n";
  const std::string rest =
      "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n*BOUNDARY\nfeet, 1, 3\n*STEP\n*STATIC\n*CLOAD\ntip, 1, 1.\nA-1.8, 2, 3.\n"
      "*DSLOAD\nB-1.end, P, -4e3\n*END STEP\n";
  solve(parts + assembly + rest);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  const Mesh m = read_mesh_file(place / "out.h5").mesh;
  EXPECT_EQ(m.n_cells(), 3);
  EXPECT_NEAR(volume(m), 6, 1e-12);
  const auto mean = [&](const std::string& set) {
    Vec3 sum = Vec3::Zero();
    const auto nodes = m.nodes_of(set, "");
    for (const auto a : nodes) sum += m.X[a] / static_cast<double>(nodes.size());
    return sum;
  };
  EXPECT_LT((mean("A-1.foot") - Vec3(0, .5, .5)).norm(), 1e-12);
  EXPECT_LT((mean("B-1.foot") - Vec3(10, .5, .5)).norm(), 1e-12);
  EXPECT_LT((mean("C-1.foot") - Vec3(-5.5, 0, .5)).norm(), 1e-12);  // (0, 5.5) turned
  EXPECT_EQ(m.nodes_of("C-1.both", "").size(), 5u);
  EXPECT_EQ(m.nodes_of("feet", "").size(), 12u);
  EXPECT_LT((mean("tip") - Vec3(12, 1, 1)).norm(), 1e-12);
  EXPECT_LT((mean("tips") - (Vec3(12, 1, 1) + Vec3(-6, 2, 1)) / 2).norm(), 1e-12);
  EXPECT_LT((vector_area(m, m.facet_sets.at("top")) - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_EQ(cells_of(m, "B-1.all"), 1);
  EXPECT_NEAR(moved(2'000'000'005).x(), 4e3 * 2 / 1e9, 1e-8);  // and what the tip's 1 N does
  EXPECT_EQ(moved(3'000'000'005).norm(), 0);
  EXPECT_GT(moved(1'000'000'008).y(), 0);
}

TEST_F(ImportInpRows, Msh1IsRead) {
  const Mesh m =
      imported_deck("a.msh",
                    "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$ENDNOD\n$ELM\n3\n1 4 7 1 4 1 2 3 4\n2 4 8 2 4 2 3 4 5\n"
                    "3 2 9 3 3 1 3 2\n$ENDELM\n");
  EXPECT_EQ(cells_of(m, "volume_7"), 1);
  EXPECT_EQ(cells_of(m, "volume_8"), 1);
  EXPECT_NEAR(volume(m), 1. / 6 + 1. / 3, 1e-14);
  ASSERT_TRUE(m.facet_sets.contains("surface_9"));
  EXPECT_LT((vector_area(m, m.facet_sets.at("surface_9")) - Vec3(0, 0, -.5)).norm(), 1e-14);
  refused_deck("a.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n1\n1 4 7 1 3 1 2 3\n$ENDELM\n", "-o b.h5", 2,
               "a.msh:7: a Tetrahedron 4 of 3 nodes");
}

}  // namespace
}  // namespace hilo::test::import_inp_rows_test
