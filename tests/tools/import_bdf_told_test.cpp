// SPDX-License-Identifier: GPL-3.0-or-later
// What a Nastran file chooses in its case control, and what of its cards has no place in a scene: it is told, or the file is refused.
#include <fmt/format.h>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_bdf_told_test {
namespace {

const std::string cube =
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\n"
    "GRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nMAT1,1,1.+9,,0.\n";
const std::string foot = "SPC1,1,123,1,THRU,4\n", force = "FORCE,2,7,,100.,1.,0.,0.\n";
const std::string head = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n";

class ImportBdfTold : public test::Import {
 protected:
  Scene scene(const std::string& text, const std::string& options = "") {
    imported_deck("a.bdf", text, "--scene-out s.toml " + options);
    return Scene::load(place / "s.toml");
  }
  void told(const std::string& text, const std::string& what) {
    scene(text);
    expect_said("not read: " + what);
    EXPECT_NE(test::text_of(place / "s.toml").find("[[left_out]]\ncard = \"" + what.substr(0, what.rfind(" (")) + "\""), std::string::npos)
        << what;
  }
};

TEST_F(ImportBdfTold, TextInCaseControlEndsWithItsLine) {
  for (const char* word : {"TITLE", "SUBTITLE", "LABEL", "ECHO"}) {
    const Scene s =
        scene(fmt::format("{} = a,\nSOL 101\nCEND\n{} = a,\nSPC = 1\nSET 1 = 1,2,\n3,4\nDISP = 1\nSUBCASE 1\nLOAD = 2\n{} = a,\n"
                          "SUBCASE 2\nLOAD = 3\nBEGIN BULK\n",
                          word, word, word) +
              cube + foot + force + "FORCE,3,8,,1.,1.,0.,0.\n");
    EXPECT_EQ(s.table("time").text("analysis"), "static") << word;
    EXPECT_EQ(s.entries("motion").size(), 1u) << word;
    ASSERT_EQ(s.entries("load").size(), 1u) << word;
    EXPECT_EQ(s.entries("load")[0].vector3("force"), Vec3(100, 0, 0)) << word;
    EXPECT_EQ(err.find("case control"), std::string::npos) << err;
  }
}

TEST_F(ImportBdfTold, CaseControlThatNamesNoSetTakesNone) {
  const Scene taken = scene("SOL 101\nTITLE = a\nBEGIN BULK\n" + cube + foot + force);  // without CEND: the only set there is
  EXPECT_EQ(taken.entries("motion").size() + taken.entries("load").size(), 2u);
  for (const char* control : {"METHOD = 4\n", "DISP = ALL\n", "SUBCASE 1\nLABEL = x\nSUBCASE 2\nLOAD = 2\nSPC = 1\n"}) {
    const Scene s = scene(fmt::format("SOL 103\nCEND\n{}BEGIN BULK\n", control) + cube + foot + force + "EIGRL,4,,,10\n");
    EXPECT_TRUE(s.entries("motion").empty() && s.entries("load").empty()) << control;
    for (const char* card : {"SPC", "FORCE"}) expect_said(fmt::format("not read: {} of a set that the subcase does not use (1,", card));
  }
}

TEST_F(ImportBdfTold, ComponentsMayHaveBlanksAndContinuationsAnyCase) {
  const Scene s = scene(head + cube + "SPC1    1       1 2 3   1       2       3                               +SP1d\n+SP1D   4\n" + force);
  ASSERT_EQ(s.entries("motion").size(), 1u);
  EXPECT_EQ(s.entries("motion")[0].texts("components").size(), 3u);
}

// Not every grid of a range needs to be there, and a wide range takes no memory.
TEST_F(ImportBdfTold, ARangeOfSupportsHoldsTheGridsThatAreThere) {
  for (const char* range : {"1,THRU,4", "4,1,THRU,3", "-", "3,4,1,2"}) {
    const std::string line = range[0] == '-' ? "SPC1,1,123,1,THRU,999999999,BY,5\n" : fmt::format("SPC1,1,123,{}\n", range);
    scene(head + cube + line + force);
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    EXPECT_EQ(m.node_sets.at("SPC_1").size(), range[0] == '-' ? 2u : 4u) << line;
    EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  }
  told(head + cube + "SPC1,1,123,1,44\n" + force, "SPC on a grid that is not there (1, a.bdf:");
}

TEST_F(ImportBdfTold, EntriesBehindAnIncludedEndAreNotLost) {
  place.write("end.bdf", cube + "ENDDATA\n");
  imported_deck("b.bdf", head + "INCLUDE 'end.bdf'\n$ nothing\n" + "\nENDDATA\n");
  refused_deck("c.bdf", head + "INCLUDE 'end.bdf'\n$ nothing\n" + foot, "-o no.h5", 2,
               "end.bdf:13: ENDDATA ends an included file, but entries follow at c.bdf:8 (remove it from the included file)");
}

TEST_F(ImportBdfTold, WhatHasNoPlaceInASceneIsNamed) {
  const std::string hub = "GRID,100,,1.,.5,.5\nRBE2,60,100,123456,2,3,6,7\n", all = head + cube + foot + force + hub;
  told("SOL 101\nCEND\nSPC = 9\nBEGIN BULK\n" + cube + foot + "SPCADD,9,1,8\n", "SPCADD of set 8, of which there is none (1, a.bdf:");
  told(all + "CONROD,50,1,7,1,.1,,,5.\nCONROD,51,1,8,1,.1,2.\n", "CONROD: mass per length NSM (1,");
  expect_said("CONROD: torsional constant J (1,");
  told(all + "CROD,50,2,1,7\nPROD,2,1,.1,3.,,4.\n", "PROD: mass per length NSM (1,");
  expect_said("PROD: torsional constant J (1,");
  told(all + "CELAS1,70,8,,,7,1\nPELAS,8,5.,.01\n", "PELAS: structural damping GE (1,");
  told(all + "CELAS2,70,5.,,,7,1,.01\n", "CELAS2: structural damping GE (1,");
  told(all + "PLOAD2,2,1.,90,91\nCQUAD4,50,9,2,3,7,6\nPLOAD2,2,1.,50,92\n", "PLOAD on elements that are not there (3,");
}

TEST_F(ImportBdfTold, AZeroOfAGridOverridesItsDefault) {
  std::string own = cube;
  own.insert(own.find('\n', own.find("GRID,7,")), ",,0");
  const Scene s = scene(head + own + force + "GRDSET,,,,,,,3\n");
  EXPECT_EQ(read_mesh_file(place / "out.h5").mesh.node_sets.at(s.entries("motion")[0].text("on")).size(), 7u);
  scene(head + cube + force + "GRDSET,,,,,,,0\nGRID,50,,5.,0.,0.\n");
  EXPECT_EQ(err.find("SPC on a grid"), std::string::npos) << err;
}

TEST_F(ImportBdfTold, AMassOnAMeanIsSharedWhereItStandsInTheMean) {
  const std::string mean = "RBE3,60,,100,123456,1.,123,2,3\n,6,7\nCONM2,70,100,,4.\n";
  EXPECT_EQ(scene(head + cube + foot + "GRID,100,,1.,.5,.5\n" + mean).entries("point_mass").size(), 1u);
  told(head + cube + foot + "GRID,100,,2.,.5,.5\n" + mean, "CONM2 on an RBE3 away from the mean of its grids (1,");
  EXPECT_TRUE(Scene::load(place / "s.toml").entries("point_mass").empty());
}

TEST_F(ImportBdfTold, PropertiesOfSpringsHaveNumbersByCard) {
  const std::string two = head + cube + foot + "CELAS1,70,8,,,7,1\nPELAS,8,5.\n";
  EXPECT_DOUBLE_EQ(scene(two + "PBUSH,8,K,1.,2.,3.\nPDAMP,8,9.\n").entries("joint")[0].number("stiffness"), 5);
  refused_deck("b.bdf", two + "PELAS,8,6.\n", "-o no.h5", 2, "b.bdf:21:7: PELAS 8 is given twice (number each property once)");
  refused_deck("b.bdf", head + cube + "CBUSH,70,8,7,,,,,0\nPELAS,8,6.\n", "-o no.h5", 2, "b.bdf:18: CBUSH 70: no PBUSH 8");
}

TEST_F(ImportBdfTold, APressureAlongACurvedSystemPointsAsAtTheCentreOfItsFacet) {
  const Scene s = scene(head + cube + foot + "CORD2C,9,,0.,.5,0.,0.,.5,1.\n,1.,.5,0.\nPLOAD4,2,1,400.,,,,2,7\n,9,1.,0.,0.\n");
  EXPECT_LT((s.entries("load")[0].vector3("traction") - Vec3(400, 0, 0)).norm(), 1e-9);
  expect_said("a.bdf:21: PLOAD4 in a curved system");
}

// The moment is that of the deck, on a geometry of another size: the forces that make it are larger.
TEST_F(ImportBdfTold, AMomentOnAMeanKeepsItsSizeUnderScale) {
  const std::string text = head + cube + foot + "GRID,100,,1.,.5,.5\nRBE3,60,,100,123456,1.,123,2,3\n,6,7\nMOMENT,2,100,,8.,1.,0.,0.\n";
  for (const double scale : {1., 1e-3}) {
    const Scene s = scene(text, fmt::format("--scale {}", scale));
    const Mesh m = read_mesh_file(place / "out.h5").mesh;
    Vec3 sum = Vec3::Zero();
    for (const auto& l : s.entries("load"))
      for (const auto a : m.node_sets.at(l.text("on"))) sum += m.X[static_cast<size_t>(a)].cross(l.vector3("force"));
    EXPECT_LT((sum - Vec3(8, 0, 0)).norm(), 1e-9) << scale;
  }
}

// Skin that is there to be pressed on has no PSHELL; one of a structure adds stiffness and mass to the solids.
TEST_F(ImportBdfTold, ShellsOfAStructureOnSolidsAreToldAsLeftOut) {
  const std::string skin = head + cube + foot + force + "CQUAD4,50,9,5,6,7,8\n";
  told(skin + "PSHELL,9,1,.05,1\n", "CQUAD4 of a PSHELL or PCOMP on faces of solids: stiffness and mass (1,");
  scene(skin);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
}

TEST_F(ImportBdfTold, ModesFromAFrequencyOnAreTold) {
  const std::string modes = "SOL 103\nCEND\nSPC = 1\nMETHOD = 4\nBEGIN BULK\n" + cube + foot;
  told(modes + "EIGRL,4,60.,,2\n", "EIGRL from a frequency (the lowest modes are looked for) (1,");
  told(modes + "EIGR,4,LAN,60.,,,2\n", "EIGR from a frequency (the lowest modes are looked for) (1,");
  scene(modes + "EIGRL,4,-1.,,2\n");
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
}

// m a^2 of two masses that stand apart; their own inertia is that of the deck.
TEST_F(ImportBdfTold, MassesApartOnAGridHaveTheInertiaOfTheScaledGeometry) {
  const std::string text = head + cube + foot + "GRID,100,,1.,.5,.5\nRBE2,60,100,123456,2,3,6,7\nCONM2,70,100,,3.,0.,2.,0.\n" +
                           "CONM2,71,100,,3.,0.,-2.,0.\n,.5,,.5,,,.5\n";
  for (const double scale : {1., 0.1}) {
    const auto inertia = scene(text, fmt::format("--scale {}", scale)).entries("body")[0].numbers("inertia");
    EXPECT_NEAR(inertia[0], .5 + 24 * scale * scale, 1e-12) << scale;
    EXPECT_NEAR(inertia[1], .5, 1e-12) << scale;
  }
}

}  // namespace
}  // namespace hilo::test::import_bdf_told_test
