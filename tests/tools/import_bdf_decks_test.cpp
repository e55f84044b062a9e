// SPDX-License-Identifier: GPL-3.0-or-later
// What decks of Nastran's own users say beside beams, shells and rods: defaults, masses, pipes, rotation, equations, pressures that vary,
// sections off their grids, composites.  Run, and compared with closed forms.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_bdf_decks_test {
namespace {

using std::numbers::pi;

class ImportBdfDecks : public test::ImportAndRun {
 protected:
  void solve(const std::string& text, const std::string& options = "") {
    place.write("a.bdf", text);
    const auto ran =
        succeeded(place.run("hilo-import a.bdf -o out.h5 --scene-out a.toml " + options + " && hilo-solve a.toml out.h5 -o run.h5"));
    table = ran.out, err = ran.err;
  }
  /// Where the body of a grid went.
  Vec3 moved(int grid) {
    const std::vector<double> v = change(fmt::format("body.grid_{}*", grid));
    return {v[0], v[1], v[2]};
  }
  /// The displacement of the nodes at x = `at` along z, their mean.
  double lift(double at) {
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    const Store s = Store::open(place / "run.h5");
    const auto u = s.read<double>("/field/" + s.list("/field").back() + "/displacement");
    double sum = 0, n = 0;
    for (size_t a = 0; a < m.X.size(); ++a)
      if (std::abs(m.X[a].x() - at) < 1e-9) sum += u[3 * a + 2], ++n;
    return sum / n;
  }
  Scene scene(const std::string& text, const std::string& options = "") {
    imported_deck("a.bdf", text, "--scene-out s.toml " + options);
    return Scene::load(place / "s.toml");
  }
};

constexpr double E = 2.1e11, G = E / 2.6;
const std::string stat = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n",
                  modes = "SOL 103\nCEND\nSPC = 1\nMETH = 3\nBEGIN BULK\nEIGRL,3,,,3\n";
const std::string steel = "MAT1,1,2.1+11,,.3,7850.\n", two = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nSPC1,1,123456,1\n";

TEST_F(ImportBdfDecks, ABeamThatLeavesItBlankHasTheDefaultsOfBaror) {
  // plane 1 is along y by the default, along z by the word of the last element
  const std::string bars = "PBAR,5,1,1.-3,4.-7,1.-7,2.-7\nPBAR,6,1,1.-3,4.-7,1.-7,2.-7\n" + steel;
  const double bend = 1 / (3 * E);
  for (const auto& [bar, I] : {std::pair{"CBAR,1,,1,2\nBAROR,,5,,,0.,1.,0.\n", 4e-7},
                               {"BAROR,,5,,,0.,1.,0.\nCBAR,1,6,1,2,0.,0.,1.\n", 1e-7},
                               {"CBAR,1,5,1,2\nGRID,9,,0.,7.,0.\nBAROR,,,,,9\n", 4e-7}}) {
    solve(stat + two + bars + bar + "FORCE,2,2,,1.,0.,1.,0.\n");
    EXPECT_NEAR(moved(2).y(), bend / I, 1e-4 * bend / I) << bar;
  }
  solve(stat + two + "PBEAM,5,1,1.-3,4.-7,1.-7,,2.-7\n" + steel + "CBEAM,1,,1,2\nBEAMOR,,5,,,0.,1.,0.\nFORCE,2,2,,1.,0.,1.,0.\n");
  EXPECT_NEAR(moved(2).y(), bend / 4e-7 + 1 / (G * 1e-3), 1e-4 * bend / 4e-7);
  refused_deck("a.bdf", "BAROR,,5\nBAROR,,6\n", "-o b.h5", 2, "a.bdf:2: BAROR is given twice (give it once)");
}

// The grids are in the shear centre, the line of stretch is n away along y: a pull there bends, a push across does not twist.
TEST_F(ImportBdfDecks, APullInTheShearCentreBendsABeamWhoseNeutralAxisIsElsewhere) {
  const double A = 1e-3, I1 = 4e-7, L = 1, F = 100;
  const std::string arm = "GRID,3,,1.,.5,0.\nRBE2,9,2,123456,3\nCONM2,8,3,,0.\n";
  for (const double n : {.05, -.02}) {
    const std::string beam = two + steel + arm + "CBEAM,1,5,1,2,0.,1.,0.\n" +
                             fmt::format("PBEAM,5,1,1.-3,4.-7,1.-7,,2.-7,,+\n+,,,,,,,,,+\n+,0.,0.,,,,,,,+\n+,,,,,{}\n", n);
    solve(stat + beam + "FORCE,2,2,,100.,1.,0.,0.\n");
    EXPECT_EQ(err.find("N1, N2"), std::string::npos) << err;
    EXPECT_NEAR(moved(2).y(), F * n * L * L / (2 * E * I1), 2e-3 * std::abs(F * n / (2 * E * I1))) << n;
    EXPECT_NEAR(moved(2).x(), F * L / (E * A) + F * n * n * L / (E * I1), 2e-3 * F * n * n / (E * I1) + 1e-3 * F / (E * A)) << n;
    solve(stat + beam + "FORCE,2,2,,1.,0.,0.,1.\n");
    EXPECT_NEAR(moved(2).z(), 1 / (3 * E * 1e-7), 2e-3 / (3 * E * 1e-7)) << n;
    EXPECT_NEAR(moved(3).z(), moved(2).z(), 1e-4 * moved(2).z()) << "no twist";
    solve(stat + beam + "MOMENT,2,2,,1.,1.,0.,0.\n");
    EXPECT_NEAR(moved(3).z(), .5 / (G * 2e-7), 1e-3 * .5 / (G * 2e-7)) << "a twist about the shear centre";
    EXPECT_LT(moved(2).norm(), 1e-4 * moved(3).z());
  }
}

// A T of .2 x .1, walls of .02: its shear centre is in the middle of the flange, its centre of area e below.
TEST_F(ImportBdfDecks, ATOfACbeamStandsOnItsShearCentreAndOneOfACbarInItsCentreOfArea) {
  const double Af = .2 * .02, Aw = .08 * .02, e = Aw * .05 / (Af + Aw), d = .05 - e;
  const double I = .2 * std::pow(.02, 3) / 12 + Af * e * e + .02 * std::pow(.08, 3) / 12 + Aw * d * d;
  const auto tip = [&](const char* bar, const char* property) {
    solve(stat + two + steel +
          fmt::format("{},1,5,1,2,0.,1.,0.\n{},5,1,,T,,,,,+\n+,.2,.1,.02,.02\nFORCE,2,2,,1000.,1.,0.,0.\n", bar, property));
    return moved(2).y();
  };
  EXPECT_NEAR(tip("CBEAM", "PBEAML"), -1000 * e / (2 * E * I), .03 * 1000 * e / (2 * E * I));  // e by thin walls: 2.3 % less
  EXPECT_NEAR(tip("CBAR", "PBARL"), 0, 1e-4 * 1000 * e / (2 * E * I));
}

// N(x) = rho A w^2 (L^2 - x^2)/2 + m w^2 L; a factor of LOAD scales it.
TEST_F(ImportBdfDecks, ARotationPullsAtBeamsAndMasses) {
  const double w = 2 * pi * 3, A = 1e-3, m = 5;
  const std::string arm =
      stat + two + "CBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\nCONM2,8,2,,5.\nLOAD,2,1.,4.,9\nRFORCE,9,,,3.,0.,0.,1.\n";
  const double of_mass = 4 * m * w * w / (E * A), of_beam = 4 * 7850 * w * w / (3 * E);
  solve(arm + "MAT1,1,2.1+11,,.3\n");
  EXPECT_NEAR(moved(2).x(), of_mass, 1e-5 * of_mass);
  solve(arm + steel);
  EXPECT_NEAR(moved(2).x(), of_mass + of_beam, .06 * of_beam);  // one cell takes 7/20 of such a load at its end, not 1/3
  // beside the grid, at y = .2, of a hub at y = .1: w^2 m (x, .1), about the grid w^2 m (.2 * -1 x ...) along z
  const Scene s = scene(stat + two +
                        "GRID,7,,0.,.1,0.\nMAT1,1,2.1+11,,.3\nCBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\n"
                        "CONM2,8,2,,5.,0.,.2,0.\nRFORCE,2,7,,3.,0.,0.,1.\n");
  Vec3 F = Vec3::Zero(), M = Vec3::Zero();
  for (const auto& l : s.entries("load")) (l.kind == "force" ? F : M) += l.kind == "force" ? l.vector3("force") : l.vector3("torque");
  EXPECT_LT((F - m * w * w * Vec3(1, .1, 0)).norm(), 1e-9 * F.norm());
  EXPECT_LT((M - m * w * w * Vec3(0, 0, -.2)).norm(), 1e-9 * M.norm());
}

// Two cantilevers that meet: clamped at both ends as one beam, or with a hinge in the middle.
TEST_F(ImportBdfDecks, EquationsOfAllComponentsOfTwoGridsAtOnePlaceAreAJoint) {
  std::string deck =
      "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nMPC = 7\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,0.,0.\n"
      "GRID,4,,2.,0.,0.\nSPC1,1,123456,1,4\nCBAR,1,5,1,2,0.,0.,1.\nCBAR,2,5,3,4,0.,0.,1.\nPBAR,5,1,1.-3,1.-7,4.-7,4.-7\n" +
      steel + "FORCE,2,2,,1.,0.,1.,0.\n";
  for (const int k : {1, 2, 3, 4, 5}) deck += fmt::format("MPC,7,3,{},1.,2,{},-1.\n", k, k);
  solve(deck);
  EXPECT_EQ(err.find("MPC"), std::string::npos) << err;
  EXPECT_NEAR(moved(2).y(), .5 / (3 * E * 4e-7), 1e-4 * .5 / (3 * E * 4e-7)) << "a hinge";
  solve(deck + "MPC,7,2,6,3.,3,6,-3.\n");
  EXPECT_NEAR(moved(2).y(), 8 / (192 * E * 4e-7), 1e-4 * 8 / (192 * E * 4e-7)) << "one beam";
}

TEST_F(ImportBdfDecks, MassesAlongComponentsAreAMassWhereTheyAreEqual) {
  const std::string bar = modes + two + "CBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,1.-7,4.-7,4.-7\nMAT1,1,2.1+11,,.3\n";
  const double f = std::sqrt(3 * E * 1e-7 / 5) / (2 * pi);
  solve(bar + "PMASS,4,5.\nCMASS1,11,4,2,1\nCMASS1,12,4,2,2\nCMASS1,13,4,2,3\n");
  EXPECT_NEAR(frequency(1), f, 1e-4 * f);
  solve(bar + "SPC1,1,1,2\nCMASS2,12,5.,2,2\nCMASS2,13,5.,,,2,3\n");  // the component without mass is held
  EXPECT_NEAR(frequency(1), f, 1e-4 * f);
  scene(bar + "CMASS2,12,5.,2,2\nCMASS2,13,4.,2,3\n");
  expect_said("not read: CMASS2: a mass that differs by direction (1, a.bdf:");
  refused_deck("a.bdf", bar + "CMASS1,12,9,2,2\n", "-o b.h5", 2, "a.bdf:13: CMASS1 12: no PMASS 9");
}

TEST_F(ImportBdfDecks, APipeStretchesByTheAreaOfItsWall) {
  const auto tip = [&](const std::string& pipe) {
    solve(stat + two + "SPC1,1,23,2\n" + steel + "CTUBE,1,5,1,2\nFORCE,2,2,,1000.,1.,0.,0.\n" + pipe);
    const Store s = Store::open(place / "run.h5");
    return s.read<double>("/field/" + s.list("/field").back() + "/displacement")[3];
  };
  EXPECT_NEAR(tip("PTUBE,5,1,.1,.01\n"), 1000 / (E * pi * .01 * .09), 1e-5 * 1000 / (E * pi * .01 * .09));
  EXPECT_NEAR(tip("PTUBE,5,1,.1\n"), 1000 / (E * pi * .0025), 1e-5 * 1000 / (E * pi * .0025));
  refused_deck("a.bdf", two + "CTUBE,1,5,1,2\nPTUBE,5,1,.1,.06\n", "-o b.h5", 2,
               "a.bdf:5:11: PTUBE 5: no pipe has the diameters 0.1 and 0.1 and the wall 0.06");
}

TEST_F(ImportBdfDecks, AnInertiaOfNoBodyStopsNoStaticRun) {
  const std::string bar = two + steel + "CBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,1.-7,4.-7,4.-7\nCONM2,8,2,,5.,,,,,+\n+,1.,,1.,,,9.\n";
  solve(stat + bar + "FORCE,2,2,,1.,0.,0.,1.\n");
  EXPECT_NEAR(moved(2).z(), 1 / (3 * E * 1e-7), 1e-4 / (3 * E * 1e-7));
  imported_deck("a.bdf", modes + bar, "--scene-out a.toml");
  EXPECT_NE(place.run("hilo-solve a.toml -o run.h5").err.find("no body has this inertia"), std::string::npos);
}

// Without J: a line of bars does not twist, as AUTOSPC holds that; a frame has the twist of its other members.
TEST_F(ImportBdfDecks, ALineOfBarsWithoutJDoesNotTwist) {
  const std::string bars = two + "GRID,3,,2.,0.,0.\nCBAR,1,5,1,2,0.,0.,1.\nCBAR,2,5,2,3,0.,0.,1.\nPBAR,5,1,1.-3,4.-7,1.-7\n" + steel;
  solve(stat + bars + "GRID,4,,2.,1.,0.\nRBE2,9,3,123456,4\nFORCE,2,4,,1.,0.,0.,1.\n");
  EXPECT_NEAR(moved(3).z(), 8 / (3 * E * 4e-7), 1e-3 * 8 / (3 * E * 4e-7));
  EXPECT_NEAR(moved(4).z() - moved(3).z(), 2 / (G * 5e-7), 1e-3 * 2 / (G * 5e-7));
  EXPECT_NE(err.find("they do not twist"), std::string::npos) << err;
  scene(stat + bars + "GRID,4,,1.,1.,0.\nCBAR,3,5,2,4,0.,0.,1.\n");
  expect_said("property 5 has no J: a millionth of I1 + I2 is taken");
}

const std::string strip = [] {  // 10 x 1 x .1 along x, clamped at x = 0, with 2 N along z at its end
  std::string s = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n";
  for (int i = 0; i <= 20; ++i) s += fmt::format("GRID,{},,{},0.,0.\nGRID,{},,{},1.,0.\n", 2 * i + 1, i / 2., 2 * i + 2, i / 2.);
  return s + "SPC1,1,123456,1,2\nFORCE,2,41,,1.,0.,0.,1.\nFORCE,2,42,,1.,0.,0.,1.\n";
}();
std::string quads(const std::string& theta) {
  std::string s;
  for (int i = 0; i < 20; ++i) s += fmt::format("CQUAD4,{},7,{},{},{},{},{}\n", i + 1, 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2, theta);
  return s;
}
double strip_tip(double stiff, double shear) { return 2. * 1000 / (3 * stiff * 1e-3 / 12) + 2. * 10 / (5. / 6 * shear * .1); }

TEST_F(ImportBdfDecks, AFlatShellThatOnlyBendsBends) {
  solve(strip + quads("") + "PSHELL,7,,.1,1,,1\nMAT1,1,1.+9,,0.\n", "--thicken");
  EXPECT_NEAR(lift(10), strip_tip(1e9, .5e9), .01 * strip_tip(1e9, .5e9));
  place.write("a.bdf", strip + quads("") + "PSHELL,7,,.1,1,,1\nMAT1,1,1.+9,,0.\nGRID,43,,10.,1.,1.\nCTRIA3,90,7,41,42,43\n");
  EXPECT_NE(place.run("hilo-import a.bdf -o b.h5 --thicken").err.find("PSHELL without MID1, and not in one plane"), std::string::npos);
}

TEST_F(ImportBdfDecks, AnOrthotropicShellBendsByTheModulusAlongIt) {
  const std::string material = "PSHELL,7,8,.1,8,,8\nMAT8,8,4.+9,1.+9,.2,.5+9,.5+9,.5+9\n";
  for (const auto& [theta, stiff] : {std::pair{"", 4e9}, {"90.", 1e9}, {"0", 4e9}}) {
    solve(strip + quads(theta) + material, "--thicken");
    EXPECT_NEAR(lift(10), strip_tip(stiff, .5e9), .02 * strip_tip(stiff, .5e9)) << theta;
  }
  const std::string layers = strip + quads("") + "MAT8,8,4.+9,1.+9,.2,.5+9,.5+9,.5+9\nPCOMP,7,,,,,,,SYM\n,8,.025,90.,,8,.025,";
  solve(layers + "-90.\n", "--thicken");
  EXPECT_NEAR(lift(10), strip_tip(1e9, .5e9), .02 * strip_tip(1e9, .5e9));
  imported_deck("a.bdf", layers + "0.\n", "--thicken --scene-out a.toml");
  expect_said("not read: MAT8: layers of several directions (1, a.bdf:");
  EXPECT_NE(place.run("hilo-solve a.toml out.h5 -o run.h5").err.find("import left out MAT8"), std::string::npos);
}

TEST_F(ImportBdfDecks, AMetalOfShellsYields) {
  const Scene s = scene(strip + quads("") + "PSHELL,7,1,.1,1,,1\nMAT1,1,1.+9,,0.\nMATS1,1,,PLASTIC,0.,1,1,1.+6\n", "--thicken");
  ASSERT_EQ(s.entries("material").size(), 1u);
  EXPECT_EQ(s.entries("material")[0].kind, "j2");
}

// p = 1 to 4 at the corners of a unit square: 2.5 in all, about x = 5/4 and y = 17/12 of it.
TEST_F(ImportBdfDecks, APressureThatVariesIsThatOfItsShell) {
  const Scene s = scene(
      "SOL 101\nCEND\nLOAD = 2\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n"
      "CQUAD4,1,7,1,2,3,4\nPSHELL,7,1,.1,1,,1\nMAT1,1,1.+9,,0.\nPLOAD4,2,1,1.,2.,3.,4.\n");
  const Mesh m = read_mesh_file(place / "out.h5").mesh;
  Vec3 F = Vec3::Zero(), M = F;
  for (const auto& l : s.entries("load"))
    for (const auto a : m.node_sets.at(l.text("on"))) F += l.vector3("force"), M += m.X[static_cast<size_t>(a)].cross(l.vector3("force"));
  EXPECT_LT((F - Vec3(0, 0, 2.5)).norm(), 1e-12);
  EXPECT_LT((M - Vec3(17 / 12., -1.25, 0)).norm(), 1e-12);
}

TEST_F(ImportBdfDecks, ARangeOfElementsUnderAPressureMayHaveGaps) {
  const std::string plate =
      "SOL 101\nCEND\nLOAD = 2\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n"
      "GRID,5,,2.,0.,0.\nGRID,6,,2.,1.,0.\nCQUAD4,1001,7,1,2,3,4\nCQUAD4,2001,7,2,5,6,3\nPSHELL,7,1,.1,1,,1\n"
      "MAT1,1,1.+9,,0.\n";
  for (const char* load : {"PLOAD2,2,5.,1001,THRU,4004\n", "PLOAD4,2,1001,5.,,,,THRU,4004\n"}) {
    const Scene s = scene(plate + load, "--thicken");
    ASSERT_EQ(s.entries("load").size(), 1u) << load;
    const auto facets = read_mesh_file(place / "out.h5").mesh.facet_sets.at(s.entries("load")[0].text("on"));
    EXPECT_EQ(facets.size(), 2u) << load;
    EXPECT_TRUE(s.entries("left_out").empty()) << load;
  }
  scene(plate + "GRID,7,,3.,0.,0.\nCTRIA3,3001,7,5,7,6\nFORCE,2,1,,1.,1.,0.,0.\n", "--thicken");
  expect_said("a.bdf:17: forces at grids of shells act as point forces on the divided mesh");
  scene(plate + "PLOAD2,2,5.,5001,THRU,5004\n", "--thicken");
  expect_said("not read: PLOAD on elements that are not there (1, a.bdf:");
}

TEST_F(ImportBdfDecks, AMeanThatLeavesComponentsFreeCarriesThoseThatItHas) {
  const std::string cube =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\n"
      "GRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nMAT1,1,1.+9,,0.\nSPC1,1,123,1,2,3,4\nGRID,9,,.6,.5,1.\n"
      "RBE3,60,,9,3,1.,123,5,6\n,7,8\n";
  const Scene s = scene(stat + cube + "FORCE,2,9,,100.,0.,0.,1.\n");
  const Mesh m = read_mesh_file(place / "out.h5").mesh;
  Vec3 F = Vec3::Zero(), M = F;
  for (const auto& l : s.entries("load"))
    for (const auto a : m.node_sets.at(l.text("on"))) F += l.vector3("force"), M += m.X[static_cast<size_t>(a)].cross(l.vector3("force"));
  EXPECT_LT((F - Vec3(0, 0, 100)).norm(), 1e-9);
  EXPECT_LT((M - Vec3(50, -60, 0)).norm(), 1e-9);
  EXPECT_TRUE(s.entries("left_out").empty());
  scene(stat + cube + "FORCE,2,9,,100.,1.,0.,0.\n");
  expect_said("not read: load on an RBE3 along a component that it leaves free (1, a.bdf:");
}

TEST_F(ImportBdfDecks, FourLettersOfCaseControlAreEnough) {
  const std::string bulk = "BEGIN BULK\nPARAM,POST,-1\nPLOTEL,90,1,2\n" + two + steel +
                           "CBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,1.-7,4.-7,4.-7\nFORCE,2,2,,1.,0.,0.,1.\nEIGRL,3,,,3\nTEMPD,9,5.\n";
  const std::string head =
      "SOL 101\nCEND\nTITL = a\nSUBTI = b\nSPC = 1\nDISP = ALL\nSPCF = ALL\nELFO(BOTH) = ALL\nMPFACTOR = ALL\n"
      "SUBCASE 1\nLOAD = 2\nLABE = c\nSUBCASE 2\nANALYSIS = MODES\nMETH = 3\nOUTPUT(XYPLOT)\nXTITLE = d\n";
  EXPECT_EQ(scene(head + bulk).table("time").text("analysis"), "static");
  EXPECT_EQ(err.find("case control"), std::string::npos) << err;
  EXPECT_EQ(Scene::load(place / "s.toml").entries("left_out").size(), 1u) << "the second subcase";
  const Scene s = scene(head + bulk, "--subcase 2");
  EXPECT_EQ(s.table("time").text("analysis"), "modes");
  EXPECT_EQ(s.table("time").number("modes"), 3);
}

// Parts of a model that are not read must not be missing without a word.
TEST_F(ImportBdfDecks, AnElementThatIsNotReadStopsTheRun) {
  scene(stat + two + steel + "CBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,1.-7,4.-7,4.-7\nFORCE,2,2,,1.,0.,0.,1.\nCSHEAR,6,1,1,2,3,4\n");
  EXPECT_NE(place.run("hilo-solve s.toml -o run.h5").err.find("import left out CSHEAR"), std::string::npos);
}

}  // namespace
}  // namespace hilo::test::import_bdf_decks_test
