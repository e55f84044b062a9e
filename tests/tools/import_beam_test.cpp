// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of decks as beams of the scene: loads, supports, masses, modes, and what they hold.
#include "beam_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_beam_test {
namespace {

using namespace beam_decks;

TEST_F(ImportBeam, ACantileverOfTwoBarsHasTheTipOfTimoshenko) {
  // .04 high in plane 1, along y; .02 wide along z; offsets put the bars beside their grids by 3 along z
  solve(stat + "GRID,1,,0.,0.,3.\nGRID,2,,.5,0.,3.\nGRID,3,,1.,0.,3.\nGRID,9,,0.,7.,3.\nPBARL,5,1,,BAR,,,,,+\n+,.02,.04\n" + steel +
        "CBAR,1,5,1,2,9,,,,+\n+,,,0.,0.,-3.,0.,0.,-3.\nCBAR,2,5,2,3,9,,,,+\n+,,,0.,0.,-3.,0.,0.,-3.\n"
        "SPC1,1,123456,1\nFORCE,2,3,,1.,0.,-.1,0.\nMOMENT,2,3,,1.,-.3,0.,0.\n");
  const double A = .0008, I = .02 * .04 * .04 * .04 / 12, k = 10 * 1.3 / (12 + 11 * .3);
  // the force acts 3 beside the line: its moment there, -.1 * -(3), and the deck's own take each other away
  EXPECT_NEAR(moved("grid_3").y(), -.1 * (1 / (3 * E * I) + 1 / (k * G * A)), 1e-5 * .1 / (3 * E * I));
  const auto forces = change("beam.CBAR_1*");
  EXPECT_NEAR(std::abs(forces[3]) + std::abs(forces[4]), .1, 1e-6) << "bending at the root";
}

// Two bars of .5 under 3 N/m along y, by four ways to say so; what is no uniform load over a whole beam is told.
TEST_F(ImportBeam, ForcesPerLengthBendBars) {
  const double A = .0008, I = .02 * .04 * .04 * .04 / 12, k = 10 * 1.3 / (12 + 11 * .3),
               want = .3 * (1 / (8 * E * I) + 1 / (2 * k * G * A));
  const auto deck = [&](const std::string& loads) {
    return stat + "GRID,1,,0.,0.,0.\nGRID,2,,.5,0.,0.\nGRID,3,,1.,0.,0.\nPBARL,5,1,,BAR,,,,,+\n+,.02,.04\n" + steel +
           "CBAR,1,5,1,2,0.,1.,0.\nCBAR,2,5,2,3,0.,1.,0.\nSPC1,1,123456,1\n" + loads;
  };
  for (const char* load : {"FY,FR,0.,.3,1.,.3", "FYE,LE,0.,.3,.5,.3", "FY,FRPR,0.,.3,1.,.3"}) {
    solve(deck(fmt::format("PLOAD1,2,1,{0}\nPLOAD1,2,2,{0}\n", load)));
    EXPECT_NEAR(moved("grid_3").y() / want, 1, 1e-4) << load;
  }
  // one that falls evenly to nothing at the tip: w L^4/(30 E I) + w L^2/(6 k G A)
  solve(deck("PLOAD1,2,1,FY,FR,0.,.3,1.,.15\nPLOAD1,2,2,FY,LE,0.,.15,.5,0.\n"));
  EXPECT_NEAR(moved("grid_3").y() / (.3 * (1 / (30 * E * I) + 1 / (6 * k * G * A))), 1, 1e-4);
  imported_deck("t.bdf", deck("PLOAD1,2,2,MZ,FR,0.,.3,1.,.3\n"), "--scene-out t.toml");
  expect_said("PLOAD1 of moments per length");
  const auto wrong = [&](const std::string& line, const std::string& why) {
    refused_deck("w.bdf", deck(line), "-o b.h5 --scene-out w.toml", 2, "w.bdf:15:" + why);
  };
  wrong("PLOAD1,2,1,FQ,FR,0.,.3,1.,.3\n", "12: PLOAD1: no type \"FQ\" (FX, FY, FZ, FXE, FYE, FZE or moments)");
  wrong("PLOAD1,2,1,FY,FR,.5,.3,.2,.3\n", "24: PLOAD1: it ends at 0.2, before it begins at 0.5 (X2 from X1 on)");
  wrong("PLOAD1,2,1,FY,LE,.1,.3,.7,.3\n", " PLOAD1: 0.7 is not on the beam, which is 0.5 long");
  solve(
      "*NODE,NSET=ALL\n1,0,0,0\n2,.5,0,0\n3,1,0,0\n*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n2,2,3\n*MATERIAL,NAME=M\n*ELASTIC\n2.1e11,.3\n"
      "*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=RECT\n.04,.02\n0,1,0\n*BOUNDARY\n1,1,6\n*STEP\n*STATIC\n*DLOAD\nE,PY,.3\n*END STEP\n",
      "a.inp");
  EXPECT_NEAR(moved("node_3").y() / want, 1, 1e-4);
}

// A part of a beam loaded, by a force that varies too, and forces and moments at points: sums of Timoshenko's cantilever under a force at
// a, P (a^2 (3 L - a)/(6 E I) + a/(k G A)).
TEST_F(ImportBeam, PartsAndPointsOfBarsAreLoaded) {
  const double A = .0008, I = .02 * .04 * .04 * .04 / 12, k = 10 * 1.3 / (12 + 11 * .3);
  const auto force = [&](double P, double a) { return P * (a * a * (3 - a) / (6 * E * I) + a / (k * G * A)); };
  const auto moment = [&](double M, double a) { return M * a * (1 - a / 2) / (E * I); };
  const auto line = [&](double from, double to, double p, double q) {
    double sum = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
      const double t = (i + .5) / n;
      sum += force((p + t * (q - p)) * (to - from) / n, from + t * (to - from));
    }
    return sum;
  };
  const auto tip = [&](const std::string& loads, const std::string& pins = "") {
    solve(stat + "GRID,1,,0.,0.,0.\nGRID,2,,.5,0.,0.\nGRID,3,,1.,0.,0.\nPBARL,5,1,,BAR,,,,,+\n+,.02,.04\n" + steel +
          "CBAR,1,5,1,2,0.,1.,0.\nCBAR,2,5,2,3,0.,1.,0." + pins + "\nSPC1,1,123456,1\n" + loads);
    return moved("grid_3").y();
  };
  const std::pair<std::string, double> cases[] = {
      {"PLOAD1,2,1,FY,FR,0.,.3,.5,.3\n", line(0, .25, .3, .3)},   {"PLOAD1,2,1,FYE,LE,.1,.3,.35,-.2\n", line(.1, .35, .3, -.2)},
      {"PLOAD1,2,2,FY,FR,.25,.1,1.,.4\n", line(.625, 1, .1, .4)}, {"PLOAD1,2,2,FY,FR,.5,.3\n", force(.3, .75)},
      {"PLOAD1,2,2,FY,LE,.5,.3,.5,.3\n", force(.3, 1)},           {"PLOAD1,2,1,FY,LE,0.,.3\nPLOAD1,2,1,MZE,FR,.4,.2\n", moment(.2, .2)}};
  double all = 0;
  std::string together;
  for (const auto& [loads, want] : cases) {
    EXPECT_NEAR(tip(loads) / want, 1, 1e-4) << loads;
    together += loads, all += want;
  }
  EXPECT_NEAR(tip(together) / all, 1, 1e-4);
  // a factor of LOAD; at a hinge in the root of bar 2 the force is on the bar's side, which hangs on a support at its end
  EXPECT_NEAR(tip("LOAD,2,2.,1.5,7\nPLOAD1,7,2,FY,FR,.5,.3\n") / force(.9, .75), 1, 1e-4);
  tip("SPC1,1,123456,3\nPLOAD1,2,2,FY,FR,.5,.3\n", ",,+\n+,56");
  EXPECT_NEAR(moved("grid_2").y() / (.3 * 5 / 32 * .5 * .5 * .5 / (3 * E * I)), 1, 1e-2)
      << "two cantilevers that meet in a hinge, one loaded at its middle";
}

// SOL 105 and *BUCKLE: Euler's load of a cantilever, pi^2 E I/(4 L^2), as a factor of that of the deck; the other plane has four times it.
TEST_F(ImportBeam, ABucklingSolutionHasTheFactorsOfEuler) {
  const double euler = pi * pi * E * 1e-9 / 4;
  std::string bars =
      "SOL 105\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 2\nSUBCASE 2\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,2\nPBAR,5,1,1.-3,1.-9,4.-9,2.-9\n" + steel;
  for (int i = 0; i <= 8; ++i) bars += fmt::format("GRID,{},,{},0.,0.\n", i + 1, i / 8.);
  for (int i = 1; i <= 8; ++i) bars += fmt::format("CBAR,{},5,{},{},0.,1.,0.\n", i, i, i + 1);
  solve(bars + fmt::format("SPC1,1,123456,1\nFORCE,2,9,,{:.6g},-1.,0.,0.\n", 1.5 * euler));
  EXPECT_NEAR(frequency(1) * 1.5, 1, 1e-3);
  EXPECT_NEAR(frequency(2) * 1.5, 4, 4e-3);
  EXPECT_EQ(told.find("SUBCASE"), std::string::npos) << told;
  EXPECT_EQ(Scene::load(place / "a.toml").table("time").number("modes"), 2);
  std::string deck = "*NODE\n", b31 = "*ELEMENT, TYPE=B31, ELSET=all\n";
  for (int i = 0; i <= 8; ++i) deck += fmt::format("{}, {}, 0., 0.\n", i + 1, i / 8.);
  for (int i = 1; i <= 8; ++i) b31 += fmt::format("{0}, {0}, {1}\n", i, i + 1);
  solve(deck + b31 +
            "*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, .3\n*DENSITY\n7850.\n*BEAM SECTION, ELSET=all, MATERIAL=m, SECTION=RECT\n"
            ".02, .04\n0., 0., 1.\n*BOUNDARY\n1, 1, 6\n*STEP\n*BUCKLE\n1\n*CLOAD\n9, 1, -100.\n*END STEP\n",
        "a.inp");
  EXPECT_NEAR(frequency(1) * 100 / (pi * pi * E * .04 * .02 * .02 * .02 / 48), 1, 2e-3);
}

// Two cantilevers whose tips are nodes at the same place, joined by equations: a hinge.
TEST_F(ImportBeam, EquationsBetweenNodesAtTheSamePlaceAreAHinge) {
  solve(
      "*NODE\n1,0,0,0\n2,.5,0,0\n3,.5,0,0\n4,1,0,0\n*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n2,3,4\n*MATERIAL,NAME=M\n*ELASTIC\n2.1e11,.3\n"
      "*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=RECT\n.04,.02\n0,1,0\n*EQUATION\n2\n2,1,1.,3,1,-1.\n*EQUATION\n2\n2,2,1.,3,2,-1.\n"
      "*EQUATION\n2\n2,3,1.,3,3,-1.\n*BOUNDARY\n1,1,6\n4,1,6\n*STEP\n*STATIC\n*CLOAD\n2,2,.3\n*END STEP\n",
      "a.inp");
  const double I = .02 * .04 * .04 * .04 / 12, k = 10 * 1.3 / (12 + 11 * .3), want = .15 * (.125 / (3 * E * I) + .5 / (k * G * .0008));
  EXPECT_NEAR(moved("node_2").y() / want, 1, 1e-4);
  EXPECT_NEAR(moved("node_3").y() / want, 1, 1e-4);
}

// Offsets in axes of the element, x from grid to grid, y in its plane 1: a beam along Y, its y along Z and its z along X, carries a pull at
// arms of .1 and .2.
TEST_F(ImportBeam, OffsetsInAxesOfTheElementAreTurned) {
  const auto tip = [&](const std::string& offsets) {
    solve(stat + "GRID,1,,0.,0.,0.\nGRID,2,,0.,3.,0.\nCBAR,1,5,1,2,0.,0.,1.," + offsets + "\nPBAR,5,1,1.-3,4.-7,4.-7,2.-7\n" + steel +
          "SPC1,1,123456,1\nFORCE,2,2,,1.,0.,1.,0.\n");
    return moved("grid_2");
  };
  const double stretch = 3 / (E * 1e-3), bend = 3 / (E * 4e-7);
  for (const char* offsets : {"GOO,+\n+,,,0.,.1,.2,0.,.1,.2", "GOG,+\n+,,,0.,.1,.2,.2,0.,.1", "BGO,+\n+,,,.2,0.,.1,0.,.1,.2"}) {
    const Vec3 u = tip(offsets);
    EXPECT_NEAR(u.y() / (stretch + (.01 + .04) * bend), 1, 1e-4) << offsets;
    EXPECT_NEAR(u.x() / (.2 * bend * 1.5), 1, 1e-4) << offsets;
    EXPECT_NEAR(u.z() / (.1 * bend * 1.5), 1, 1e-4) << offsets;
  }
}

TEST_F(ImportBeam, PinsFreeTurnsAndSupportsOfAnyComponentsHold) {
  // clamped grids, pinned ends: P L^3/(48 E I) and no moment there
  const std::string mesh = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nPBAR,5,1,1.-3,2.-7,2.-7,4.-7\n" + steel;
  solve(stat + mesh + "CBAR,1,5,1,2,0.,0.,1.,,+\n+,56,\nCBAR,2,5,2,3,0.,0.,1.,,+\n+,,56\nSPC1,1,123456,1,3\nFORCE,2,2,,1.,0.,0.,-1.\n");
  EXPECT_NEAR(moved("grid_2").z(), -8 / (48 * E * 2e-7), 1e-5 * 8 / (48 * E * 2e-7));
  // the same by supports: a pin that holds the turn about its line too, and a roller
  solve(stat + mesh + "CBAR,1,5,1,2,0.,0.,1.\nCBAR,2,5,2,3,0.,0.,1.\nSPC1,1,1234,1\nSPC1,1,23,3\nFORCE,2,2,,1.,0.,0.,-1.\n");
  EXPECT_NEAR(moved("grid_2").z(), -8 / (48 * E * 2e-7), 1e-5 * 8 / (48 * E * 2e-7));
  // turns alone are held at the far end: a guide, which moves by P L^3/(12 E I), and along the beam and across it freely
  solve(stat + mesh + "CBAR,1,5,1,2,0.,0.,1.\nCBAR,2,5,2,3,0.,0.,1.\nSPC1,1,123456,1\nSPC1,1,456,3\nFORCE,2,3,,1.,0.,0.,-1.\n");
  EXPECT_NEAR(moved("grid_3").z(), -8 / (12 * E * 2e-7), 1e-5 * 8 / (12 * E * 2e-7));
  EXPECT_EQ(moved("grid_1"), Vec3::Zero());
}

TEST_F(ImportBeam, AMassOnMasslessBarsSwingsAsOnASpring) {
  // no RHO: f = sqrt(3 E I / (M L^3)) / 2 pi along y and z; a rigid element carries the mass beyond the tip
  solve(modes +
        "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,0.,0.\nCBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,1.-7,4.-7,4.-7\n"
        "MAT1,1,2.1+11,,.3\nSPC1,1,123456,1\nRBE2,7,2,123456,3\nCONM2,8,3,,5.\n");
  EXPECT_NEAR(frequency(1), std::sqrt(3 * E * 1e-7 / 5) / (2 * pi), 1e-4 * 18);
  EXPECT_NEAR(frequency(2), std::sqrt(3 * E * 4e-7 / 5) / (2 * pi), 1e-4 * 36);
}

TEST_F(ImportBeam, WeightsOfBeamsPerLengthAreMassesToo) {
  // NSM is a weight under PARAM WTMASS: the frequencies are those of a tenth of all mass
  const std::string deck =
      modes + "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,1.-7,4.-7,4.-7,50.\n" + steel + "SPC1,1,123456,1\n";
  solve(deck);
  const double f = frequency(1);
  solve(deck + "PARAM,WTMASS,.1\n");
  EXPECT_NEAR(frequency(1), f * std::sqrt(10), 1e-5 * f);
}

TEST_F(ImportBeam, ACouplingOfASurfaceOfNodesHoldsThoseOfBeams) {
  // a stiff body between a cantilever and a held block: as a rigid body of the same nodes, and far stiffer than the cantilever alone
  const std::string deck =
      "*NODE\n1,0,0,0\n2,1,0,0\n99,1.5,.5,.5\n" + block + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n" + section + "*NSET,NSET=T\n2,11,14,15,18\n";
  const std::string rest = "*BOUNDARY\n12,1,3\n13,1,3\n16,1,3\n17,1,3\n1,1,6\n*STEP\n*STATIC\n*CLOAD\n2,3,1000.\n*END STEP\n";
  solve(deck + "*RIGID BODY,REF NODE=99,NSET=T\n" + rest, "a.inp");
  const double as_body = moved("node_2").z();
  solve(deck + "*SURFACE,NAME=SU,TYPE=NODE\nT\n*COUPLING,CONSTRAINT NAME=C,REF NODE=99,SURFACE=SU\n*KINEMATIC\n1,6\n" + rest, "a.inp");
  EXPECT_NEAR(moved("node_2").z(), as_body, 1e-6 * std::abs(as_body));
  EXPECT_LT(std::abs(as_body), 1e-2 * 1000 / (3 * E * std::pow(.04, 4) / 12));
}

TEST_F(ImportBeam, ACantileverVibratesAtEulersFrequencies) {
  std::string mesh = modes + steel + "PBARL,5,1,,ROD,,,,,+\n+,.005\nSPC1,1,123456,1\n";  // L/r 400: no shear to speak of
  for (int i = 0; i <= 8; ++i) mesh += "GRID," + std::to_string(i + 1) + ",," + std::to_string(.125 * i) + ",0.,0.\n";
  for (int i = 1; i <= 8; ++i)
    mesh += "CBAR," + std::to_string(i) + ",5," + std::to_string(i) + ',' + std::to_string(i + 1) + ",0.,0.,1.\n";
  solve(mesh);
  const double r = .005, f = 3.5160152685 / (2 * pi) * std::sqrt(E * r * r / 4 / 7850);
  EXPECT_NEAR(frequency(1), f, 2e-4 * f);
  EXPECT_NEAR(frequency(3), f * 22.0344916 / 3.5160152685, 2e-3 * f * 6.27);
}

TEST_F(ImportBeam, AQuarterRingOfB32FollowsCastigliano) {
  // radius 1, clamped at (1,0), a force along -x... of the free end (0,1) in its plane: u = F R^3/(E I) pi/4 along the force
  std::string deck = "*NODE\n";
  const int n = 8;
  for (int i = 0; i <= 2 * n; ++i)
    deck +=
        std::to_string(i + 1) + ',' + std::to_string(std::cos(pi / 4 / n * i)) + ',' + std::to_string(std::sin(pi / 4 / n * i)) + ",0\n";
  deck += "*ELEMENT,TYPE=B32,ELSET=RING\n";
  for (int i = 0; i < n; ++i)
    deck +=
        std::to_string(i + 1) + ',' + std::to_string(2 * i + 1) + ',' + std::to_string(2 * i + 2) + ',' + std::to_string(2 * i + 3) + '\n';
  deck +=
      "*MATERIAL,NAME=M\n*ELASTIC\n2.1e11,.3\n*BEAM SECTION,ELSET=RING,MATERIAL=M,SECTION=RECT\n.02,.01\n0,0,1\n"
      "*BOUNDARY\n1,1,6\n*STEP\n*STATIC\n*CLOAD\n17,2,.01\n*END STEP\n";
  solve(deck, "a.inp");
  const double I = .02 * std::pow(.01, 3) / 12;
  // moment F cos at the angle from the clamp: int cos^2 = pi/4
  EXPECT_NEAR(moved("node_17").y(), .01 * pi / 4 / (E * I), 1e-3 * .01 * pi / 4 / (E * I));
}

TEST_F(ImportBeam, BarsHoldABlockOfSolidsByItsNodes) {
  // four bars along x pull at the corners of a stiff block: 4 E A/L, and the block does not turn with them
  std::string deck = stat + "MAT1,2,1.+15,,.3,1.\nPSOLID,2,2\nPBAR,5,1,1.-5,2.-8,2.-8,4.-8\n" + steel;
  const double y[] = {0, 1, 1, 0}, z[] = {0, 0, 1, 1};
  for (int i = 0; i < 4; ++i)
    for (int x = 0; x < 3; ++x)
      deck += "GRID," + std::to_string(10 * x + i + 1) + ",," + std::to_string(x) + ".," + std::to_string(y[i]) + ',' +
              std::to_string(z[i]) + '\n';
  deck += "CHEXA,1,2,11,12,13,14,21,22,+\n+,23,24\n";
  for (int i = 1; i <= 4; ++i)
    deck += "CBAR," + std::to_string(i + 1) + ",5," + std::to_string(i) + ',' + std::to_string(10 + i) + ",0.,0.,1.\nFORCE,2," +
            std::to_string(20 + i) + ",,100.,1.,0.,0.\n";
  solve(deck + "SPC1,1,123456,1,THRU,4\n");
  EXPECT_NEAR(moved("grid_11").x(), 100 / (E * 1e-5), 1e-4 * 100 / (E * 1e-5));
  const Mesh m = read_mesh_file(place / "out.h5").mesh;
  EXPECT_EQ(m.n_cells(), 1);
  EXPECT_EQ(m.n_nodes(), 8);
}

TEST_F(ImportBeam, ARunWithTheMeshOfNoCellsGoesWithoutIt) {
  solve(stat + "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCBAR,1,5,1,2,0.,0.,1.\nPBARL,5,1,,I,,,,,+\n+,.2,.1,.1,.01,.02,.02\n" + steel +
        "SPC1,1,123456,1\nFORCE,2,2,,1.,0.,0.,1.\n");
  const auto ran = succeeded(place.run("hilo-solve a.toml out.h5 -o b.h5"));
  EXPECT_NE(ran.err.find("out.h5 has no cells: the run goes without it"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::import_beam_test
