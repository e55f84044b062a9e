// SPDX-License-Identifier: GPL-3.0-or-later
// Materials of decks: what is plastic, rubber or orthotropic reaches the scene lines, and what has no law here is never taken for elastic.
#include <fmt/format.h>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_material_test {
namespace {

using ImportMaterial = test::Import;

const std::string cubes =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,0,0,2\n10,1,0,2\n11,1,1,2\n12,0,1,2\n"
    "*ELEMENT, TYPE=C3D8, ELSET=low\n1, 1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=C3D8, ELSET=high\n2, 5,6,7,8,9,10,11,12\n";
std::string with(const std::string& cards) {
  return cubes + "*MATERIAL, NAME=m\n" + cards + "*ELSET, ELSET=all\nlow, high\n*SOLID SECTION, ELSET=all, MATERIAL=m\n";
}

TEST_F(ImportMaterial, AYieldTableAndItsRatesReachTheScene) {
  const Mesh m =
      imported_deck("a.inp",
                    with("*ELASTIC\n2.1e5, .3\n*DENSITY\n7.85e-9\n*PLASTIC\n300., 0., 20.\n350., .01, 20.\n400, .1, 20.\n250, 0, 300.\n"
                         "*RATE DEPENDENT, TYPE=POWER LAW\n40., 5.\n"),
                    "--units mm-t-s --scene-out s.toml");
  const Scene s = Scene::load(place / "s.toml");
  ASSERT_EQ(s.entries("material").size(), 1u);
  const Entry& e = s.entries("material")[0];
  EXPECT_EQ(e.kind, "j2");
  EXPECT_NEAR(e.number("E"), 2.1e11, 1);
  EXPECT_NEAR(e.number("yield"), 300e6, 1e-3);
  EXPECT_EQ(e.numbers("hardening_strain"), (std::vector<double>{0, 0.01, 0.1}));
  EXPECT_NEAR(e.numbers("hardening_stress")[2], 400e6, 1e-3);
  EXPECT_EQ(e.number("reference_rate"), 40);
  EXPECT_EQ(e.number("rate_exponent"), 5);
  expect_said("*PLASTIC at further temperatures (1, a.inp:");
  // without the scene lines the solver finds no moduli, rather than elastic ones
  EXPECT_TRUE(std::isnan(m.region_data[0].E));
  EXPECT_NEAR(m.region_data[0].density, 7850, 1e-9);
  expect_said("(j2) stands in the scene lines alone");
  place.write("own.toml", "[time]\nend = 1\nstep = 0.1\n");
  expect_end(place.run("hilo-solve own.toml out.h5"), 2, "region \"all\" has no ");
}

TEST_F(ImportMaterial, TheSceneNamesItsMeshTheFirstTimeToo) {
  imported_deck("a.inp", with("*ELASTIC\n2.1e11, .3\n"), "--scene-out s.toml");
  EXPECT_EQ(Scene::load(place / "s.toml").table("scene").text("mesh"), "out.h5");
  std::filesystem::create_directory(place.path() / "scenes");
  imported("a.inp", "--scene-out scenes/s.toml");
  EXPECT_EQ(Scene::load(place / "scenes/s.toml").table("scene").text("mesh"), "../out.h5");
}

TEST_F(ImportMaterial, KinematicHardeningOfOneSlopeIsAModulus) {
  imported_deck("a.inp", with("*ELASTIC\n2.1e11, .3\n*PLASTIC, HARDENING=KINEMATIC\n300e6, 0.\n350e6, .01\n"), "--scene-out s.toml");
  const Entry e = Scene::load(place / "s.toml").entries("material")[0];
  EXPECT_NEAR(e.number("kinematic"), 5e9, 1);
  EXPECT_FALSE(e.given("hardening_strain"));
}

TEST_F(ImportMaterial, WhatHasNoLawHereIsNeverTakenForElastic) {
  for (const auto& [cards, what] :
       {std::pair<std::string, std::string>{"*PLASTIC, HARDENING=COMBINED\n3e8, 0.\n", "*PLASTIC, HARDENING=COMBINED"},
        {"*PLASTIC, HARDENING=KINEMATIC\n3e8, 0.\n4e8, .1\n4.1e8, .2\n", "of more than one slope"},
        {"*PLASTIC\n3e8, 0.\n2e8, .1\n", "*PLASTIC that softens"},
        {"*PLASTIC, RATE=10.\n3e8, 0.\n", "*PLASTIC, RATE=10."},
        {"*PLASTIC\n3e8, 0.\n*CYCLIC HARDENING\n3e8, 0.\n", "*CYCLIC HARDENING"},
        {"*PLASTIC\n3e8, 0.\n*RATE DEPENDENT, TYPE=YIELD RATIO\n1., 0.\n", "TYPE=YIELDRATIO"},
        {"*CREEP\n1e-10, 5., 0.\n", "*CREEP"},
        {"*HYPERELASTIC, YEOH\n1e6,,,1e-9\n", "*HYPERELASTIC, YEOH"},
        {"*HYPERELASTIC, OGDEN, N=2\n1e6, 2., 1e5, 4., 1e-9, 1e-9\n", "with D2"},
        {"*PLASTIC\n3e8, 0.\n*HYPERELASTIC, NEO HOOKE\n1e6, 1e-9\n", "j2 and mooney-rivlin at once"}}) {
    const Mesh m = imported_deck("a.inp", with("*ELASTIC\n2.1e11, .3\n" + cards), "--scene-out s.toml");
    const std::string scene = test::text_of(place / "s.toml");
    EXPECT_TRUE(std::isnan(m.region_data[0].E)) << what;
    EXPECT_NE(scene.find("has no law here ("), std::string::npos) << scene;
    EXPECT_NE(scene.find(what), std::string::npos) << what << "\n" << scene;
    EXPECT_EQ(Scene::load(place / "s.toml").entries("material").size(), 0u) << what;
  }
  refused_deck("a.inp", with("*ELASTIC\n2.1e11, .3\n*PLASTIC\n3e8, .1\n"), "-o b.h5", 2,
               "a.inp:22:6: material m: the first yield stress is at a plastic strain of 0.1 (the table begins at plastic strain 0)");
  refused_deck("a.inp", with("*ELASTIC\n2.1e11, .3\n*PLASTIC\n3e8, 0.\n4e8, 0.\n"), "-o b.h5", 2,
               "a.inp:23:6: material m: plastic strain does not rise");
}

TEST_F(ImportMaterial, OrthotropicModuliAreTurnedBySections) {
  // stiffness of E1 = 10, E2 = 5, E3 = 4, nu12 = .3, nu13 = .2, nu23 = .25, G 3 2 1 [GPa]
  Mat3 S;
  S << 1 / 10e9, -0.3 / 10e9, -0.2 / 10e9, -0.3 / 10e9, 1 / 5e9, -0.25 / 5e9, -0.2 / 10e9, -0.25 / 5e9, 1 / 4e9;
  const Mat3 C = S.inverse();
  char ortho[400];
  std::snprintf(ortho, sizeof ortho, "*ELASTIC, TYPE=ORTHO\n%.15g, %.15g, %.15g, %.15g, %.15g, %.15g, 3e9, 2e9\n1e9, 20.\n", C(0, 0),
                C(0, 1), C(1, 1), C(0, 2), C(1, 2), C(2, 2));
  for (const std::string& card :
       {std::string(ortho), std::string("*ELASTIC, TYPE=ENGINEERING CONSTANTS\n10e9, 5e9, 4e9, .3, .2, .25, 3e9, 2e9\n1e9\n")}) {
    imported_deck("a.inp",
                  cubes + "*ORIENTATION, NAME=turned, SYSTEM=RECTANGULAR\n0., 1., 0., -1., 0., 0.\n*MATERIAL, NAME=ply\n" + card +
                      "*SOLID SECTION, ELSET=low, MATERIAL=ply\n*SOLID SECTION, ELSET=high, MATERIAL=ply, ORIENTATION=turned\n",
                  "--scene-out s.toml");
    const Scene s = Scene::load(place / "s.toml");
    ASSERT_EQ(s.entries("material").size(), 2u);
    const Entry &plain = s.entries("material")[0], &turned = s.entries("material")[1];
    EXPECT_EQ(turned.name, "ply_turned");
    const std::pair<const char*, double> expected[] = {{"E1", 10e9},  {"E2", 5e9},  {"E3", 4e9},  {"nu12", .3}, {"nu13", .2},
                                                       {"nu23", .25}, {"G12", 3e9}, {"G13", 2e9}, {"G23", 1e9}};
    for (const auto& [key, value] : expected) EXPECT_NEAR(plain.number(key), value, 1e-9 * value) << key;
    EXPECT_EQ(turned.numbers("axis_1"), (std::vector<double>{0, 1, 0}));
    EXPECT_EQ(turned.numbers("axis_2"), (std::vector<double>{-1, 0, 0}));
    EXPECT_EQ(s.entries("region")[1].text("material"), "ply_turned");
  }
  imported_deck("a.inp",
                cubes + "*ORIENTATION, NAME=round, SYSTEM=CYLINDRICAL\n0., 0., 0., 0., 0., 1.\n*MATERIAL, NAME=ply\n" + ortho +
                    "*ELSET, ELSET=all\nlow, high\n*SOLID SECTION, ELSET=all, MATERIAL=ply, ORIENTATION=round\n",
                "--scene-out s.toml");
  EXPECT_NE(test::text_of(place / "s.toml").find("has no law here (*ORIENTATION, SYSTEM=CYLINDRICAL)"), std::string::npos);
}

TEST_F(ImportMaterial, RubbersReachTheScene) {
  imported_deck("a.inp", with("*HYPERELASTIC, MOONEY-RIVLIN\n.3, .1, .02\n"), "--units mm-t-s --scene-out s.toml");
  Entry e = Scene::load(place / "s.toml").entries("material")[0];
  EXPECT_EQ(e.kind, "mooney-rivlin");
  EXPECT_NEAR(e.number("c10"), 0.3e6, 1e-6);
  EXPECT_NEAR(e.number("c01"), 0.1e6, 1e-6);
  EXPECT_NEAR(e.number("bulk"), 100e6, 1e-6);
  imported_deck("a.inp", with("*HYPERELASTIC, OGDEN, N=3\n.63, 1.3, .0012, 5., -.01, -2., .05, 0.\n0., 20.\n"),
                "--units mm-t-s --scene-out s.toml");
  e = Scene::load(place / "s.toml").entries("material")[0];
  EXPECT_EQ(e.kind, "ogden");
  EXPECT_EQ(e.numbers("alpha"), (std::vector<double>{1.3, 5, -2}));
  EXPECT_NEAR(e.numbers("mu")[0], 0.63e6, 1e-6);
  EXPECT_NEAR(e.number("bulk"), 40e6, 1e-6);
  imported_deck("a.inp", with("*HYPERELASTIC, NEO HOOKE\n.5, 0.\n"), "--units mm-t-s --scene-out s.toml");
  e = Scene::load(place / "s.toml").entries("material")[0];
  EXPECT_NEAR(e.number("bulk"), 20e6, 1e-6) << "mu = 1 MPa, D1 = 0.1/mu";
  expect_said("has D1 = 0 (incompressible): taken as 0.1/mu");
}

/// A strip of S4, 0.5 m along x and 0.05 along y, clamped and pushed up at its end, all of it turned about y.  E1 is 100 GPa,
/// E2 10 GPa, and there is no contraction.
std::string strip(const std::string& orientation, const std::string& section, double tilt = 0, double bend = 0) {
  const Mat3 turn = Eigen::AngleAxisd(-tilt, Vec3::UnitY()).toRotationMatrix();
  const Vec3 n = turn.col(2);
  std::string deck = "*NODE\n";
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j < 2; ++j) {
      const Vec3 x = turn * Vec3(0.05 * i, 0.05 * j, bend * i * i);
      deck += fmt::format("{}, {:.15g}, {:.15g}, {:.15g}\n", 1 + i + 100 * j, x.x(), x.y(), x.z());
    }
  deck += "*ELEMENT, TYPE=S4, ELSET=E\n";
  for (int i = 1; i <= 10; ++i) deck += fmt::format("{}, {}, {}, {}, {}\n", i, i, i + 1, i + 101, i + 100);
  deck +=
      "*MATERIAL, NAME=ply\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1e11, 1e10, 1e9, 0, 0, 0, 5e9, 5e9\n5e9\n*DENSITY\n1600\n" + orientation;
  deck += "*SHELL SECTION, ELSET=E, " + section + "*BOUNDARY\n1, 1, 6\n101, 1, 6\n*STEP\n*STATIC\n*CLOAD\n";
  for (const int node : {11, 111})
    for (int k = 0; k < 3; ++k) deck += fmt::format("{}, {}, {:.15g}\n", node, k + 1, 0.005 * n[k]);
  return deck + "*END STEP\n";
}
const std::string across = "*ORIENTATION, NAME=o\n0, 1, 0, -1, 0, 0\n", along = "*ORIENTATION, NAME=o\n1, 0, 0, 0, 1, 0\n",
                  plate = "MATERIAL=ply, ORIENTATION=o\n.005\n", bare = "MATERIAL=ply\n.005\n";

// P L^3 / 3EI is 80e-6 m where E2 lies along the strip, 8e-6 m where E1 does; CalculiX 2.20 has 79.80 and 7.984 of each tilt
TEST_F(ImportMaterial, ShellsTakeTheirOrientationIntoTheirSurface) {
  const auto deflection = [&](const std::string& text, double tilt = 0) {
    solve(text, "a.inp", "--thicken");
    const Vec3 tip = Vec3(0.5 * std::cos(tilt), 0.025, 0.5 * std::sin(tilt));
    const auto ran = succeeded(
        place.run(fmt::format("hilo-post at run.h5 displacement --point {:.15g},{:.15g},{:.15g} --steps last", tip.x(), tip.y(), tip.z())));
    std::istringstream words(ran.out.substr(ran.out.find_last_of('\n', ran.out.size() - 2) + 1));
    double length = 0;
    for (double x = 0; words >> x;) length = x;  // [um]
    return length;
  };
  EXPECT_NEAR(deflection(strip(across, plate)), 80, 0.4);
  EXPECT_NEAR(deflection(strip(along, plate)), 8, 0.04);
  EXPECT_NEAR(deflection(strip(along + "3, 90.\n", plate)), 80, 0.4);
  EXPECT_NEAR(deflection(strip(across, plate, 0.5), 0.5), 80, 0.4) << "axis 2 is laid into the surface";
  EXPECT_NEAR(deflection(strip("", bare, 0.5), 0.5), 8, 0.04) << "x, laid into the surface";
  EXPECT_NEAR(deflection(strip("", bare, M_PI / 2), M_PI / 2), 8, 0.04) << "z, where x is the normal";
  EXPECT_NEAR(deflection(strip(across, "COMPOSITE\n.002,,ply,o\n.003,,ply,o\n")), 80, 0.4);
  EXPECT_NEAR(deflection(strip(across, "COMPOSITE, ORIENTATION=o\n.002,,ply\n.003,,ply\n")), 80, 0.4);
  EXPECT_NEAR(deflection(strip(along, "COMPOSITE, ORIENTATION=o\n.002,,ply,90.\n.003,,ply,90.\n")), 80, 0.4);
}

TEST_F(ImportMaterial, AnOrientationOfShellsThatIsNoOneDirectionIsTold) {
  const auto told = [&](const std::string& text, const std::string& what) {
    imported_deck("a.inp", text, "--thicken --scene-out s.toml");
    expect_said(what);
    EXPECT_EQ(Scene::load(place / "s.toml").entries("material").size(), 0u) << what;
    EXPECT_NE(test::text_of(place / "s.toml").find("[[left_out]]\ncard = \"" + what), std::string::npos) << what;
  };
  told(strip(across, plate, 0, 0.002), "*ORIENTATION of shells that do not lie in one plane");
  told(strip("", bare, 0, 0.002), "*ELASTIC that differs with direction, of shells that do not lie in one plane");
  // Abaqus takes axis 2 there, CalculiX axis 3
  told(strip("*ORIENTATION, NAME=o\n0, 0, 1, 0, 1, 0\n", plate), "*ORIENTATION of shells whose normal is not near its axis 3");
  told(strip(along + "1, 0.\n", plate, 1), "*ORIENTATION of shells whose normal is not near its axis 3");
  told(strip(across, "COMPOSITE\n.002,,ply,o\n.003,,ply\n"), "*SHELL SECTION, COMPOSITE of several orientations");
  told(strip(along, "COMPOSITE, ORIENTATION=o\n.002,,ply,0.\n.003,,ply,90.\n"), "*SHELL SECTION, COMPOSITE of several orientations");
  told(strip("*ORIENTATION, NAME=o, SYSTEM=CYLINDRICAL\n0, 0, 0, 0, 0, 1\n", plate), "*ORIENTATION, SYSTEM=CYLINDRICAL");
  refused_deck("a.inp", strip(along + "4, 90.\n", plate), "-o b.h5 --thicken", 2, "a.inp:43:1: *ORIENTATION o: axis 4 (1, 2 or 3)");
  refused_deck("a.inp", strip("", plate), "-o b.h5 --thicken", 2, "a.inp:41:52: *SHELL SECTION: no orientation \"o\"");
  // shells that are not thickened are rigid, and keep the axes as they are
  imported_deck("a.inp", strip(across, plate, 0, 0.002), "--scene-out s.toml");
  EXPECT_EQ(Scene::load(place / "s.toml").entries("material")[0].numbers("axis_1"), (std::vector<double>{0, 1, 0}));
}

TEST_F(ImportMaterial, AnOrientationTurnsAboutAnAxis) {
  imported_deck("a.inp",
                cubes +
                    "*ORIENTATION, NAME=o\n0., 2., 0., -1., 0., 0.\n1, 90.\n*MATERIAL, NAME=ply\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n"
                    "10e9, 5e9, 4e9, .3, .2, .25, 3e9, 2e9\n1e9\n*ELSET, ELSET=all\nlow, high\n"
                    "*SOLID SECTION, ELSET=all, MATERIAL=ply, ORIENTATION=o\n",
                "--scene-out s.toml");
  const auto b = Scene::load(place / "s.toml").entries("material")[0].numbers("axis_2");
  EXPECT_NEAR(b[0], 0, 1e-15);
  EXPECT_NEAR(b[2], 1, 1e-15) << "axis 3";
}

TEST_F(ImportMaterial, AMaterialGivenTwiceIsRefused) {
  refused_deck("a.inp", with("*ELASTIC\n2.1e11, .3\n*MATERIAL, NAME=M\n*ELASTIC\n1e11, .3\n"), "-o b.h5", 2,
               "a.inp:21:17: *MATERIAL M is given twice, first at a.inp:18 (name each once)");
  place.write("m.inc", "*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, .3\n");  // one file that is read twice says one thing
  imported_deck("a.inp", cubes +
                             "*INCLUDE, INPUT=m.inc\n*INCLUDE, INPUT=m.inc\n*ELSET, ELSET=all\nlow, high\n"
                             "*SOLID SECTION, ELSET=all, MATERIAL=m\n");
}

std::string bulk(const std::string& entries) {
  return "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1."
         "\nGRID,8,,0.,1.,1.\n"
         "CHEXA,1,5,1,2,3,4,5,6\n,7,8\nPSOLID,5,17\n" +
         entries + "ENDDATA\n";
}

TEST_F(ImportMaterial, Mats1IsAMetal) {
  const auto metal = [&](const std::string& entries) {
    const Mesh m = imported_deck("a.bdf", bulk("MAT1,17,2.+5,,.3,7.85-9\n" + entries), "--units mm-t-s --scene-out s.toml");
    EXPECT_TRUE(std::isnan(m.region_data[0].E));
    return Scene::load(place / "s.toml").entries("material")[0];
  };
  Entry e = metal("MATS1,17,,PLASTIC,1000.,1,1,250.\n");
  EXPECT_EQ(e.kind, "j2");
  EXPECT_NEAR(e.number("yield"), 250e6, 1e-3);
  EXPECT_NEAR(e.number("hardening"), 1e9, 1e-3);
  EXPECT_NEAR(e.number("density"), 7850, 1e-9);
  e = metal("MATS1,17,,,1000.,,2,250.\n");
  EXPECT_NEAR(e.number("kinematic"), 1e9, 1e-3);
  EXPECT_EQ(e.number("hardening"), 0);
  e = metal("MATS1,17,,PLASTIC,1000.,1,3,250.\n");
  EXPECT_NEAR(e.number("kinematic"), 0.3e9, 1e-3);
  EXPECT_NEAR(e.number("hardening"), 0.7e9, 1e-3);
  expect_said("HR 3 is taken as 30 % kinematic");
  // by total strain from the origin: yield at 250/2e5, then 300 at a plastic strain of 0.02 - 300/2e5
  e = metal("MATS1,17,28,PLASTIC,,1,1,250.\nTABLES1,28\n,0.,0.,1.25-3,250.,.02,300.,.1,350.\n,ENDT\n");
  ASSERT_EQ(e.numbers("hardening_strain").size(), 3u);
  EXPECT_EQ(e.numbers("hardening_strain")[0], 0);
  EXPECT_NEAR(e.numbers("hardening_strain")[1], 0.02 - 300 / 2e5, 1e-15);
  EXPECT_NEAR(e.numbers("hardening_stress")[2], 350e6, 1e-3);
  // by plastic strain
  e = metal("MATS1,17,28,PLSTRN,,1,1\nTABLES1,28\n,0.,250.,.05,300.,ENDT\n");
  EXPECT_EQ(e.numbers("hardening_strain"), (std::vector<double>{0, 0.05}));
}

TEST_F(ImportMaterial, Mats1WithoutALawHereIsNeverTakenForElastic) {
  for (const auto& [entries, what] :
       {std::pair<std::string, std::string>{"MATS1,17,28,NLELAST\nTABLES1,28\n,0.,0.,1.,1.,ENDT\n", "MATS1, TYPE NLELAST"},
        {"MATS1,17,,PLASTIC,0.,4,1,250.\n", "MATS1, YF 4"},
        {"MATS1,17,,PLASTIC,0.,1,6,250.\n", "MATS1, HR 6"},
        {"MATS1,17,28,PLASTIC,,1,1\n", "no TABLES1"},
        {"MATS1,17,28,PLSTRN,,1,1\nTABLES1,28\n,0.,250.,.05,200.,ENDT\n", "MATS1 that softens"}}) {
    const Mesh m = imported_deck("a.bdf", bulk("MAT1,17,2.+5,,.3,7.85-9\n" + entries), "--scene-out s.toml");
    EXPECT_TRUE(std::isnan(m.region_data[0].E)) << what;
    EXPECT_NE(test::text_of(place / "s.toml").find(what), std::string::npos) << what << test::text_of(place / "s.toml");
  }
  refused_deck("a.bdf", bulk("MAT1,17,2.+5,,.3\nMATS1,17,28,PLASTIC,,1,1\nTABLES1,28\n,0.,0.,.01,250.,.02,300.,ENDT\n"), "-o b.h5", 2,
               "a.bdf:13:10: MATS1 17: the yield point of table 28 is not at its stress divided by Young's modulus");
  const Mesh m = imported_deck("a.bdf", bulk("MAT9,17,1.+5\n"), "--scene-out s.toml");
  EXPECT_TRUE(std::isnan(m.region_data[0].E));
  EXPECT_NE(test::text_of(place / "s.toml").find("MAT9"), std::string::npos);
  imported_deck("a.bdf", bulk("MATHP,17,.3,.1,50.,1.1-9\n"), "--units mm-t-s --scene-out s.toml");
  const Entry e = Scene::load(place / "s.toml").entries("material")[0];
  EXPECT_EQ(e.kind, "mooney-rivlin");
  EXPECT_NEAR(e.number("bulk"), 100e6, 1e-6);
}

}  // namespace
}  // namespace hilo::test::import_material_test
