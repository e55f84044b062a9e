// SPDX-License-Identifier: GPL-3.0-or-later
// Supports, loads, rigid elements, masses and springs of Nastran files: the scene lines that they become are run, and the answer is that of
// statics, whatever card says it.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_bdf_scene_test {
namespace {

/// A bar of four cubes of 1 m along x, E = 1 GPa, nu = 0: grids 1 to 4 at its foot, 17 to 20 at its head (4, 0..1, 0..1).
std::string bar(const std::string& density = "") {
  std::string s;
  const int y[] = {0, 1, 1, 0}, z[] = {0, 0, 1, 1};
  for (int i = 0; i < 20; ++i) s += fmt::format("GRID,{},,{}.,{}.,{}.\n", i + 1, i / 4, y[i % 4], z[i % 4]);
  for (int c = 0; c < 4; ++c) {
    s += fmt::format("CHEXA,{},1", c + 1);
    for (int a = 1; a <= 8; ++a) s += a == 7 ? fmt::format("\n,{}", 4 * c + a) : fmt::format(",{}", 4 * c + a);
    s += "\n";
  }
  return s + "PSOLID,1,1\nMAT1,1,1.+9,,0.," + density + "\n";
}
const std::string statics = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n";
const std::string foot = "SPC1,1,123,1,THRU,4\n";

class ImportBdfScene : public test::Import {
 protected:
  /// Imports and runs a deck; `not_read`: whether it says something that is told as left out.
  void run(const std::string& text, bool not_read = false, const std::string& options = "") {
    solve(text, "a.bdf", options);
    EXPECT_EQ(err.find("not read") != std::string::npos, not_read) << err;
  }
  /// Mean displacement of the head.
  Vec3 head() const {
    const Store store = Store::open(place / "run.h5");
    const auto u = store.read<double>("/field/000001/displacement");
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    Vec3 sum = Vec3::Zero();
    for (std::int64_t a = 0; a < m.n_nodes(); ++a)
      if (m.node_id[a] >= 17) sum += Vec3(u[3 * a], u[3 * a + 1], u[3 * a + 2]) / 4;
    return sum;
  }
};

// 400 N along x: u = F l/(E A) = 1.6e-6 m, whichever card says the force.
TEST_F(ImportBdfScene, EveryCardThatPullsTheHeadStretchesTheBarByTheClosedForm) {
  const std::string hub = "GRID,100,,5.,.5,.5\n";
  const std::pair<const char*, std::string> cases[] = {
      {"FORCE", "FORCE,2,17,,100.,1.,0.,0.\nFORCE,2,18,0,50.,2.,0.,0.\nFORCE,2,19,,100.,1.,0.,0.\nFORCE,2,20,,100.,1.,0.,0.\n"},
      {"FORCE twice at a grid, in a turned system",
       "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nFORCE,2,17,7,50.,0.,-1.,0.\nFORCE,2,17,7,50.,0.,-1.,0.\nFORCE,2,18,7,100.,0.,-1.,0.\n"
       "FORCE,2,19,7,100.,0.,-1.,0.\nFORCE,2,20,7,100.,0.,-1.,0.\n"},
      {"FORCE along r of a cylindrical system",  // about the axis x = 4 - 3, y = 0 for grids at y = 0, about y = 1 for the others
       "CORD2C,7,,1.,0.,0.,1.,0.,1.\n,9.,0.,0.\nCORD2C,8,,1.,1.,0.,1.,1.,1.\n,1.,9.,0.\nFORCE,2,17,7,100.,1.,0.,0.\nFORCE,2,20,7,100.,1.,0."
       ",0.\n"
       "FORCE,2,18,8,100.,1.,0.,0.\nFORCE,2,19,8,100.,1.,0.,0.\n"},
      {"FORCE1", "FORCE1,2,17,100.,13,17\nFORCE1,2,18,100.,13,17\nFORCE1,2,19,-100.,17,13\nFORCE1,2,20,100.,13,17\n"},
      {"LOAD", "LOAD,2,2.,.5,11,-3.,12\nPLOAD4,11,4,-1000.,,,,17,19\nPLOAD4,12,4,-100.,,,,18,20\n"},
      {"PLOAD4", "PLOAD4,2,4,-400.,,,,17,19\n"},
      {"PLOAD4 of equal values, on the face twice", "PLOAD4,2,4,-200.,-200.,-200.,-200.,20,18\nPLOAD4,2,4,-200.,,,,17,19\n"},
      {"PLOAD4 along a vector", "PLOAD4,2,4,400.,,,,17,19\n,0,3.,0.,0.\n"},
      {"PLOAD4 on a shell", "CQUAD4,50,9,17,18,19,20\nPLOAD4,2,50,400.\n"},
      {"PLOAD4 on a shell that looks inwards, THRU", "CQUAD4,50,9,20,19,18,17\nPLOAD4,2,50,-400.,,,,THRU,50\n"},
      {"PLOAD2", "CQUAD4,50,9,17,18,19,20\nPLOAD2,2,400.,50\n"},
      {"PLOAD", "PLOAD,2,400.,17,18,19,20\n"},
      {"RBE2", hub + "RBE2,60,100,123456,17,18,19,20\nFORCE,2,100,,400.,1.,0.,0.\n"},
      {"RBE2 THRU with an expansion of nothing", hub + "RBE2,60,100,123456,17,THRU,20,0.\nFORCE,2,100,,400.,1.,0.,0.\n"},
      {"RBE2 whose hub is a node",
       "RBE2,60,17,123,18,19,20\nFORCE,2,17,,400.,1.,0.,0.\nMOMENT,2,17,,200.,0.,1.,0.\nMOMENT,2,17,,-200.,0.,0.,1.\n"},
      {"RBARs from one node",
       "RBAR,60,17,18,123456\nRBAR,61,17,19,123456\nRBAR,62,17,20,123456\nFORCE,2,17,,400.,1.,0.,0.\nMOMENT,2,17,,200.,0.,1.,0.\n"
       "MOMENT,2,17,,-200.,0.,0.,1.\n"},
      {"RBARs in a chain, of which the last carries a grid of no cell",
       hub + "RBAR,60,17,18,123456\nRBAR,61,18,19,123456\nRBE2,62,20,123456,19,100\nFORCE,2,100,,400.,1.,0.,0.\n"},
      {"RBE3", hub + "RBE3,60,,100,123456,1.,123,17,18\n,19,20\nFORCE,2,100,,400.,1.,0.,0.\n"},
      {"RBE3 of two weights, its force beside the mean",  // the mean of weights 1, 1, 3, 3 is at z = .75
       hub + "RBE3,60,,100,123,1.,123,17,18\n,3.,123,19,20\nFORCE,2,100,,400.,1.,0.,0.\n"},
      {"RBAR from hub to hub",
       hub + "GRID,101,,6.,.5,.5\nRBE2,60,100,123456,17,18,19,20\nRBAR,61,100,101,123456\nFORCE,2,101,,400.,1.,0.,0.\n"},
      {"RBAR1s from one node",
       "RBAR1,60,17,18,123456\nRBAR1,61,17,19\nRBAR1,62,17,20,123456\nFORCE,2,17,,400.,1.,0.,0.\nMOMENT,2,17,,200.,0.,1.,0.\n"
       "MOMENT,2,17,,-200.,0.,0.,1.\n"},
      {"RBAR1 from hub to hub, with an expansion of nothing",
       hub + "GRID,101,,6.,.5,.5\nRBE2,60,100,123456,17,18,19,20\nRBAR1,61,100,101,,0.\nFORCE,2,101,,400.,1.,0.,0.\n"},
      {"RROD", hub + "GRID,101,,6.,.5,.5\nRBE2,60,100,123456,17,18,19,20\nRROD,61,100,101\nSPC,1,101,23456\nFORCE,2,101,,400.,1.,0.,0.\n"},
  };
  for (const auto& [name, text] : cases) {
    SCOPED_TRACE(name);
    run(statics + bar() + foot + text);
    if (HasFatalFailure()) return;
    EXPECT_NEAR(head().x(), 1.6e-6, 1.6e-12);
    const auto reaction = last("motion/SPC_1", 6);
    EXPECT_NEAR(reaction[0], -400, 400e-6);
    EXPECT_NEAR(std::hypot(reaction[1], reaction[2]), 0, 400e-6);
    EXPECT_NEAR(std::hypot(reaction[3], reaction[4], reaction[5]), 0, 4e-3);
  }
}

// Forces that only warp the head move nothing where it is rigid.
TEST_F(ImportBdfScene, RigidElementsThatShareANodeKeepItsTurn) {
  const std::string warp = "FORCE,2,17,,100.,1.,0.,0.\nFORCE,2,18,,-100.,1.,0.,0.\nFORCE,2,19,,100.,1.,0.,0.\nFORCE,2,20,,-100.,1.,0.,0.\n";
  for (const char* rigid : {"RBAR,60,17,18,123456\nRBAR,61,17,19,123456\nRBAR,62,17,20,123456\n",
                            "RBAR,60,17,18,123456\nRBAR,61,18,19,123456\nRBAR,62,19,20,123456\n",
                            "RBE2,60,17,123,18\nRBE2,61,17,123456,19\nRBE2,62,17,123,20\n"}) {
    SCOPED_TRACE(rigid);
    run(statics + bar() + foot + warp + rigid);
    if (HasFatalFailure()) return;
    for (const double u : Store::open(place / "run.h5").read<double>("/field/000001/displacement")) EXPECT_NEAR(u, 0, 1e-15);
  }
}

// A hub outside the head's axis: the foot answers with the moment of statics, for a force, a moment, a mass under gravity.
TEST_F(ImportBdfScene, WhatHangsOnAHubIsInBalanceAtTheFoot) {
  const std::string hub = "GRID,100,,5.,2.,.5\n";
  const std::string end = "GRID,101,,6.,2.,.5\n";
  const std::string rbe2 = hub + "RBE2,60,100,123456,17,18,19,20\n", rbe3 = hub + "RBE3,60,,100,123456,1.,123,17,18\n,19,20\n";
  const struct {
    const char* name;
    std::string text;
    Vec3 force, moment;  // on the bar, about the foot's centre (0, .5, .5)
  } cases[] = {
      {"RBE2, force", rbe2 + "FORCE,2,100,,10.,0.,0.,1.\n", {0, 0, 10}, {15, -50, 0}},
      {"RBE3, force", rbe3 + "FORCE,2,100,,10.,0.,0.,1.\n", {0, 0, 10}, {15, -50, 0}},
      {"RBE2, moment", rbe2 + "MOMENT,2,100,,10.,1.,2.,3.\n", {0, 0, 0}, {10, 20, 30}},
      {"RBE3, moment", rbe3 + "MOMENT,2,100,,10.,1.,2.,3.\n", {0, 0, 0}, {10, 20, 30}},
      {"RBAR1, force at its second grid", rbe2 + end + "RBAR1,61,100,101,123456\nFORCE,2,101,,10.,0.,0.,1.\n", {0, 0, 10}, {15, -60, 0}},
      {"RBAR1 of displacements, whose second grid does not turn",  // held whole it would bear a part of the moment
       rbe2 + end + "RBAR1,61,100,101,123\nSPC1,1,456,101\nFORCE,2,101,,10.,0.,0.,1.\n",
       {0, 0, 10},
       {15, -60, 0}},
      {"RBE2, mass beside its grid", rbe2 + "CONM2,70,100,,3.,1.,0.,0.\nGRAV,2,,5.,0.,0.,-2.\n", {0, 0, -30}, {-45, 180, 0}},
      {"RBE2, mass at a point", rbe2 + "CONM2,70,100,-1,3.,6.,2.,.5\nGRAV,2,,5.,0.,0.,-2.\n", {0, 0, -30}, {-45, 180, 0}},
      {"two masses at a grid",
       rbe2 + "CONM2,70,100,,1.,1.,0.,0.\nCONM2,71,100,,2.,1.,0.,0.\nGRAV,2,,5.,0.,0.,-2.\n",
       {0, 0, -30},
       {-45, 180, 0}},
      {"masses on nodes", "CONM2,70,17,,3.\nCONM2,71,18,,3.\nGRAV,2,,5.,0.,0.,-2.\n", {0, 0, -60}, {0, 240, 0}},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    run(statics + bar() + foot + c.text);
    if (HasFatalFailure()) return;
    const auto r = last("motion/SPC_1", 6);
    EXPECT_LT((Vec3(r[0], r[1], r[2]) + c.force).norm(), 1e-5);
    EXPECT_LT((Vec3(r[3], r[4], r[5]) + c.moment).norm(), 1e-3) << r[3] << ' ' << r[4] << ' ' << r[5];
  }
}

// The foot on springs of 1 kN/m in all: it gives way by 0.4 m... of 400 N, whatever card they are.
TEST_F(ImportBdfScene, SpringsOfEveryCardGiveWayByForceOverStiffness) {
  const std::string pull = "PLOAD4,2,4,-400.,,,,17,19\n", aside = "SPC1,1,23,1,THRU,4\n";
  const std::string hub = "GRID,100,,-1.,.5,.5\nRBE2,60,100,123456,1,2,3,4\n";
  std::string four, bushes, by_property;
  for (int g = 1; g <= 4; ++g) {
    four += fmt::format("CELAS2,{},2.5+5,{},1\n", 200 + g, g);
    by_property += fmt::format("CELAS1,{},8,,,{},1\n", 200 + g, g);
    bushes += fmt::format("CBUSH,{},8,{},,,,,0\n", 200 + g, g);
  }
  std::string behind = "CHEXA,900,1,305,306,307,308,301,302\n,303,304\nSPC1,1,123,301,THRU,308\n", between, bushes_between;
  for (int g = 0; g < 8; ++g)
    behind += fmt::format("GRID,{},,{}.,{}.,{}.\n", 301 + g, -(g / 4), g % 4 == 1 || g % 4 == 2 ? 1 : 0, g % 4 > 1 ? 1 : 0);
  for (int g = 1; g <= 4; ++g) {
    between += fmt::format("CELAS2,{},2.5+5,{},1,{},1\n", 200 + g, 300 + g, g);
    bushes_between += fmt::format("CBUSH,{},8,{},{},,,,0\n", 200 + g, 300 + g, g);
  }
  const std::pair<const char*, std::string> cases[] = {
      {"CELAS2 to the ground", aside + four},
      {"CELAS1 to the ground", aside + by_property + "PELAS,8,2.5+5\n"},
      {"CBUSH to the ground", aside + bushes + "PBUSH,8,K,2.5+5\n"},
      {"CBUSH to the ground in a turned system",
       "CORD2R,7,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nCBUSH,200,8,100,,,,,7\nPBUSH,8,K,,,1.+6\n" + hub + "SPC1,1,23456,100\n"},
      {"CBUSH between two hubs",
       hub + "GRID,101,,-2.,.5,.5\nSPC1,1,123456,101\nCBUSH,200,8,101,100,0.,1.,0.\nPBUSH,8,K,1.+6,1.+6,1.+6,1.+9,1.+9,1.+9\n"},
      {"CELAS2 between two hubs, along their line",
       hub + "GRID,101,,-2.,.5,.5\nSPC1,1,123456,101\nSPC1,1,23456,100\nCELAS2,200,1.+6,101,1,100,1\n"},
      {"CBUSH1D", hub + "GRID,101,,-2.,.5,.5\nSPC1,1,123456,101\nSPC1,1,23456,100\nCBUSH1D,200,8,101,100\nPBUSH1D,8,1.+6\n"},
      {"CELAS2 between two hubs, across their line",
       hub + "GRID,101,,-2.,3.5,.7\nSPC1,1,123456,101\nSPC1,1,23456,100\nCELAS2,200,1.+6,101,1,100,1\n"},
      {"CELAS2 between nodes of solids at one place", aside + behind + between},
      {"CBUSH between nodes of solids at one place", aside + behind + bushes_between + "PBUSH,8,K,2.5+5\n"},
      {"CELAS2 in the grid's own axes",
       "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nGRID,100,,-1.,.5,.5,7\nRBE2,60,100,123456,1,2,3,4\nSPC1,1,13456,100\nCELAS2,200,1.+6,100,"
       "2\n"},
  };
  for (const auto& [name, text] : cases) {
    SCOPED_TRACE(name);
    run(statics + bar() + pull + text);
    if (HasFatalFailure()) return;
    EXPECT_NEAR(head().x(), 400 / 1e6 + 1.6e-6, 1e-9);
  }
}

// Dampers of 400 N s/m in all at the nodes of a cube of 1000 kg: m v' = F - c v, of F = 4 N, to 1e-4 of the way at 10 s.
TEST_F(ImportBdfScene, DampersAloneAtNodesOfSolidsBrakeThem) {
  std::string text =
      "SOL 109\nCEND\nSPC = 1\nLOAD = 2\nTSTEP = 3\nBEGIN BULK\nTSTEP,3,200,.05\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\n"
      "MAT1,1,1.+9,,0.,1000.\nSPC1,1,23,1,THRU,8\n";
  for (int g = 0; g < 8; ++g)
    text += fmt::format("GRID,{},,{}.,{}.,{}.\nCDAMP2,{},50.,{},1\nFORCE,2,{},,.5,1.,0.,0.\n", 1 + g, g % 4 == 1 || g % 4 == 2 ? 1 : 0,
                        g % 4 > 1 ? 1 : 0, g / 4, 20 + g, 1 + g, 1 + g);
  run(text);
  if (HasFatalFailure()) return;
  const Store s = Store::open(place / "run.h5");
  const auto u = s.read<double>("/field/" + s.list("/field").back() + "/displacement");
  const double m = 1000, c = 400, t = 10;
  EXPECT_NEAR(u[0], 4 / c * (t - m / c * (1 - std::exp(-c * t / m))), 1e-5);
}

// f = sqrt(k/m)/(2 pi), and of a rotor on a torsional spring sqrt(k/J)/(2 pi); the inertia of CONM2 is the tensor with -I21.
TEST_F(ImportBdfScene, MassesOnSpringsHaveTheFrequencyOfTheClosedForm) {
  const std::string modes = "SOL SEMODES\nCEND\nMETHOD = 3\nSPC = 1\nBEGIN BULK\nEIGRL,3,,,2\n" + bar("7850.") + "SPC1,1,123,1,THRU,20\n";
  const auto first = [&] { return Store::open(place / "run.h5").read<double>("/history/mode").at(10); };  // after the state of rest
  run(modes + "GRID,100,,9.,0.,0.\nCONM2,1,100,,2.\nCELAS2,2,800.,100,1\nSPC,1,100,23456\n");
  EXPECT_NEAR(first(), 20 / (2 * std::numbers::pi), 1e-8);
  run(modes + "GRID,100,,9.,0.,0.,,23456\nCONM2,1,100,,2.\nCELAS2,2,800.,,,100,1\n");  // held by the grid itself
  EXPECT_NEAR(first(), 20 / (2 * std::numbers::pi), 1e-8);
  run(modes + "GRID,100,,9.,0.,0.,,23456\nCONM2,1,100,,2.\nCELAS2,2,800.,100,1\nCDAMP2,3,8.,100,1\n");
  EXPECT_NEAR(Store::open(place / "run.h5").read<double>("/history/mode").at(11), 8 / (2 * std::sqrt(800. * 2)), 1e-6);
  // J about (1, 1, 0)/sqrt 2 is (I11 + I22 - 2 I21)/2 = (5 + 5 - 2)/2 = 4
  run(modes + "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,1.,1.,0.\nGRID,100,,9.,0.,0.,7,12356\nCONM2,1,100,,2.\n,5.,1.,5.,,,6.\nCELAS2,2,400.,100,4\n");
  EXPECT_NEAR(first(), 10 / (2 * std::numbers::pi), 1e-8);
  run(modes +
      "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,1.,1.,0.\nGRID,100,,9.,0.,0.,7,12356\nCONM2,1,100,,2.\n,5.,1.,5.,,,6.\nCBUSH,2,8,100,,,,,7\nPBUSH,"
      "8,K,,,,400.\n");
  EXPECT_NEAR(first(), 10 / (2 * std::numbers::pi), 1e-8);
}

TEST_F(ImportBdfScene, SupportsHoldTheComponentsOfTheirGridsOwnAxes) {
  std::string turned = bar();  // axes of the foot: 1 is y, 2 is -x
  for (int g = 1; g <= 4; ++g) turned.insert(turned.find('\n', turned.find(fmt::format("GRID,{},", g))), ",7");
  imported_deck("a.bdf", turned + "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nSPC1,1,1,1,2\nSPC,1,3,2,,4,2,-.5\n", "--scene-out s.toml");
  const Scene s = Scene::load(place / "s.toml");
  ASSERT_EQ(s.entries("motion").size(), 3u);
  EXPECT_EQ(s.entries("motion")[0].texts("components"), std::vector<std::string>{"x"});
  EXPECT_EQ(s.entries("motion")[1].texts("components"), std::vector<std::string>{"y"});
  EXPECT_EQ(s.entries("motion")[2].kind, "translation");
  EXPECT_LT((s.entries("motion")[2].vector3("displacement") - Vec3(.5, 0, 0)).norm(), 1e-15);
}

// Of several subcases the first, of what it does not take and of what no line can say the name and the number.
TEST_F(ImportBdfScene, WhatIsLeftOutIsToldByNameAndNumber) {
  place.write(
      "a.bdf",
      "SOL 101\nCEND\nTITLE = two cases\nSTRESS(PLOT) = ALL\nTEMPERATURE(LOAD) = 9\nSPC = 1\nSUBCASE 1\n LOAD = 2\nSUBCASE 2\n LOAD = 3\n"
      "BEGIN BULK\n" +
          bar() + foot +
          "FORCE,2,17,,100.,1.,0.,0.\nFORCE,3,17,,100.,1.,0.,0.\nFORCE,3,18,,100.,1.,0.,0.\nMOMENT,2,17,,1.,1.,0.,0.\n"
          "TEMP,9,17,20.,18,20.\nMPC,5,17,1,1.,18,1,-1.\nSPC1,7,3,17\nPLOAD4,2,4,1.,2.,3.,4.,17,19\n"
          "CELAS2,80,1.,17,4\nCELAS2,81,1.,17,1,18,2\nCELAS2,82,-1.,17,1\nGRID,100,,9.,9.,9.\nFORCE,2,100,,1.,1.,0.,0.\n"
          "RBE3,60,,17,123,1.,123,18,19\nRBE2,61,1,12,2,3,4\n");
  imported("a.bdf", "--scene-out s.toml");
  for (const char* what : {"SUBCASE after the first (1, a.bdf:9)", "case control TEMPERATURE (1, a.bdf:5)",
                           "FORCE of a set that the subcase does not use (2,", "MOMENT on a node of solids, which does not turn (1,",
                           "TEMP (1,", "MPC of a set that the subcase does not use (1,", "SPC of a set that the subcase does not use (1,",
                           "PLOAD4 that varies over the face (1,", "CELAS2 on the rotation of a node of solids, which does not turn (1,",
                           "CELAS2 between different components (1,", "CELAS2 below zero (1,", "FORCE on a grid of no element (1,",
                           "RBE3 whose grid is a node of a cell (1,", "RBE2 of some components of nodes of solids (1,"}) {
    expect_said(std::string("not read: ") + what);
    const std::string card = std::string(what).substr(0, std::string(what).rfind(" ("));
    const bool taken = card.find("does not use") == std::string::npos;  // else nothing is lost
    EXPECT_EQ(test::text_of(place / "s.toml").find("[[left_out]]\ncard = \"" + card + "\"") != std::string::npos, taken) << what;
  }
  EXPECT_EQ(err.find("STRESS"), std::string::npos) << err;
  const Scene s = Scene::load(place / "s.toml");
  ASSERT_EQ(s.entries("load").size(), 1u);
  EXPECT_EQ(s.table("scene").text("title"), "two cases");
}

TEST_F(ImportBdfScene, UnitsConvertWhatTheLinesSay) {
  run(statics + bar() + foot +
          "GRID,100,,5.,.5,.5\nRBE2,60,100,123456,17,18,19,20\nFORCE,2,100,,4.,1.,0.,0.\nCONM2,70,100,,3.\n,1.,,1.,,,1.\n",
      false, "--units mm-t-s");
  const Scene s = Scene::load(place / "s.toml");
  EXPECT_LT((s.entries("body")[0].vector3("com") - Vec3(5e-3, 5e-4, 5e-4)).norm(), 1e-15);
  EXPECT_NEAR(s.entries("body")[0].number("mass"), 3000, 1e-9);
  EXPECT_NEAR(s.entries("body")[0].numbers("inertia")[0], 1e-3, 1e-15);  // t mm^2
  EXPECT_NEAR(head().x(), 4 * 4 / 1e9 * 1e-3, 1e-16);                    // 4 N over 1 mm^2 of 1e9 MPa, 4 mm
}

// Truth: 10 N on the front of a cube that is glued to the head of the bar come out at the foot; a set that is not taken glues nothing.
TEST_F(ImportBdfScene, GlueOfTwoRegionsOfFacesIsATie) {
  std::string cube;
  for (int i = 0; i < 18; ++i) cube += fmt::format("GRID,{},,{}.,{:.1f},{:.1f}\n", 201 + i, 4 + i / 9, (i / 3 % 3) / 2., (i % 3) / 2.);
  std::string faces = "BSURFS,8,,,";
  for (int c = 0; c < 4; ++c) {
    const int a = 201 + 3 * (c / 2) + c % 2;
    cube += fmt::format("CHEXA,{},1,{},{},{},{},{},{}\n,{},{}\n", 11 + c, a, a + 3, a + 4, a + 1, a + 9, a + 12, a + 13, a + 10);
    faces += fmt::format("{}{},{},{},{}", c % 2 ? "\n," : ",", 11 + c, a, a + 3, a + 4);
  }
  const std::string glue = faces + "\nBSURFS,7,,,,4,17,18,19\nBGSET,5,8,7,0.1\nBGSET,6,8,7\n";
  run("SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBGSET = 5\nBEGIN BULK\n" + bar() + cube + glue + foot + "FORCE,2,214,,10.,1.,0.,0.\nENDDATA\n",
      true);
  const auto f = last("motion/SPC_1", 6);
  EXPECT_NEAR(f[0], -10, 1e-6);
  const Scene s = Scene::load(place / "s.toml");
  ASSERT_EQ(s.entries("tie").size(), 1u);
  EXPECT_EQ(s.entries("tie")[0].number("gap"), 0.1);
  EXPECT_TRUE(s.entries("left_out").empty());
}

// Truth: a cube that is pushed against the head of the bar passes the push on to the foot; pulled, it would be free.
TEST_F(ImportBdfScene, RegionsOfFacesThatMayMeetAreAContact) {
  std::string cube;
  for (int i = 0; i < 8; ++i) cube += fmt::format("GRID,{},,{}.,{}.,{}.\n", 201 + i, 4 + i / 4, (i / 2) % 2, i % 2);
  cube += "CHEXA,11,1,201,205,207,203,202,206\n,208,204\nBSURFS,8,,,,11,201,202,204\nBSURFS,7,,,,4,17,18,19\n";
  run("SOL 101\nCEND\nSPC = 9\nLOAD = 2\nBCSET = 3\nBEGIN BULK\nSPCADD,9,1,4\n" + bar() + cube +
          "BCTADD,3,5\nBCTSET,5,8,7,0.3\nBCTSET,5,7,8,0.3\nBCTSET,6,8,7\n" + foot +
          "SPC1,4,23,201,THRU,208\nFORCE,2,205,,2.5,-1.,0.,0.\nFORCE,2,206,,2.5,-1.,0.,0.\nFORCE,2,207,,2.5,-1.,0.,0.\nFORCE,2,208,,2.5,-1."
          ",0.,0.\n"
          "ENDDATA\n",
      true);
  const Scene s = Scene::load(place / "s.toml");
  ASSERT_EQ(s.entries("contact").size(), 1u);
  EXPECT_EQ(s.entries("contact")[0].number("friction"), 0.3);
  EXPECT_TRUE(s.entries("left_out").empty());
  EXPECT_NEAR(last("contact/contact_5", 8)[0], 10, 1e-5);  // on the cube
  EXPECT_NEAR(last("motion/SPC_1", 6)[0], 10, 1e-5);
}

// PLOAD and PLOAD2 push along the normal that their grids or shells turn about, however the solids are numbered.
TEST_F(ImportBdfScene, PressuresByGridsPushAlongTheirNormalOnSolidsOfEitherHand) {
  std::string grids;
  for (int i = 0; i < 8; ++i) grids += fmt::format("GRID,{},,{}.,{}.,{}.\n", i + 1, (i + 1) / 2 % 2, i / 2 % 2, i / 4);
  for (const char* cell : {"1,2,3,4,5,6\n,7,8\n", "5,6,7,8,1,2\n,3,4\n"})
    for (const char* load :
         {"PLOAD,2,1000.,5,6,7,8\n", "CQUAD4,50,9,5,6,7,8\nPLOAD2,2,1000.,50\n", "CQUAD4,50,9,8,7,6,5\nPLOAD4,2,50,-1000.\n"}) {
      SCOPED_TRACE(std::string(cell) + load);
      run(statics + grids + "CHEXA,1,1," + cell + "PSOLID,1,1\nMAT1,1,1.+9,,0.\n" + foot + load);
      EXPECT_NEAR(last("motion/SPC_1", 6)[2], -1000, 1e-3);
    }
}

// In a deck in millimetres that --scale makes metres, displacements are lengths too: of nodes, and of grids of beams.
TEST_F(ImportBdfScene, DisplacementsThatTheDeckPrescribesAreScaledAsItsLengths) {
  std::string moved;
  for (int a = 17; a <= 20; ++a) moved += fmt::format("SPC,1,{},1,.5\n", a);
  run("SOL 101\nCEND\nSPC = 1\nBEGIN BULK\n" + bar() + foot + moved, false, "--scale 1e-3");
  EXPECT_NEAR(head().x(), 5e-4, 1e-12);
  solve(
      "SOL 101\nCEND\nSPC = 1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1000.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,4.+3,8.+6,2.+6,3.+6\n"
      "MAT1,1,2.1+11,8.+10,,7850.\nSPC1,1,123456,1\nSPC,1,2,3,.5\n",
      "a.bdf", "--scale 1e-3");
  EXPECT_NEAR(last("body/grid_2", 12)[2], 5e-4, 1e-9);
}

}  // namespace
}  // namespace hilo::test::import_bdf_scene_test
