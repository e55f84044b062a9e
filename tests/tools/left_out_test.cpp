// SPDX-License-Identifier: GPL-3.0-or-later
// What import leaves out reaches the run: [[left_out]], warnings that --quiet keeps, refusals; and solids that nothing holds or touches.
#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::left_out_test {
namespace {

const std::string bar =
    "*NODE\n1, 0, 0, 0\n2, 0, 1, 0\n3, 0, 1, 1\n4, 0, 0, 1\n5, 1, 0, 0\n6, 1, 1, 0\n7, 1, 1, 1\n8, 1, 0, 1\n9, 2, 0, 0\n10, 2, 1, 0\n"
    "11, 2, 1, 1\n12, 2, 0, 1\n100, 3, 0, 0\n*ELEMENT, TYPE=C3D8, ELSET=bar\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 5, 6, 7, 8, 9, 10, 11, 12\n"
    "*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=head, GENERATE\n9, 12\n*SURFACE, NAME=end\n2, S2\n"
    "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n*SOLID SECTION, ELSET=bar, MATERIAL=m\n";
const std::string held = "*BOUNDARY\nfoot, 1, 3\n", statics = "*STEP\n*STATIC\n", pull = "*CLOAD\nhead, 1, 1.\n", end = "*END STEP\n";

class LeftOut : public test::Import {
 protected:
  void import(const std::string& text) { imported_deck("a.inp", text, "--quiet --scene-out s.toml"); }
  std::string solved(int code, const std::string& options = "") {
    const auto ran = place.run("hilo-solve --quiet s.toml -o run.h5 " + options);
    EXPECT_EQ(ran.exit, code) << ran.err;
    return ran.err;
  }
};

TEST_F(LeftOut, IsToldByImportAndBeforeTheRunAlsoWhenQuietAndIsInRunJson) {
  import(bar + held + statics + pull + "*TEMPERATURE\nhead, 20.\n*TEMPERATURE\nfoot, 20.\n" + end);
  EXPECT_EQ(err, "hilo-import: not read: *TEMPERATURE (2, a.inp:36)\n");
  const Scene s = Scene::load(place / "s.toml");
  ASSERT_EQ(s.entries("left_out").size(), 1u);
  const Entry& e = s.entries("left_out")[0];
  EXPECT_EQ(e.text("card"), "*TEMPERATURE");
  EXPECT_EQ(e.text("loss"), "load");
  EXPECT_EQ(e.number("count"), 2);
  EXPECT_EQ(e.text("place"), "a.inp:36");
  const std::string said = solved(0);
  EXPECT_NE(said.find("hilo-solve: warning: s.toml:"), std::string::npos) << said;
  EXPECT_NE(said.find("import left out *TEMPERATURE (2, a.inp:36)\n"), std::string::npos) << said;
  const std::string json = test::text_of(place / "run.json");
  expect_words(json, R"("left_out": [{"loss": "load", "card": "*TEMPERATURE", "count": 2, "place": "a.inp:36"}])");
}

TEST_F(LeftOut, ATieThatWasLostIsRefusedUnlessAccepted) {
  for (const char* tie : {"*EQUATION\n2\n9, 4, 1., 10, 4, -2.\n", "*CONTACT PAIR, GEOMETRIC CORRECTION=g\nend, end\n",
                          "*TIE, CYCLIC SYMMETRY, NAME=t\nend, end\n", "*MPC\nMEANROT, 9, 10, 11, 12\n"}) {
    import(bar + tie + held + statics + pull + end);
    const std::string card = std::string(tie).substr(0, std::string(tie).find_first_of(",\n"));
    const std::string said = solved(2);
    EXPECT_NE(said.find("import left out " + card), std::string::npos) << said;
    EXPECT_NE(said.find("--accept-left-out"), std::string::npos) << said;
    EXPECT_EQ(solved(0, "--accept-left-out").find("--accept-left-out"), std::string::npos);
  }
}

// Truth: case control takes a set of MPC by its number or by MPCADD; one that it does not take is no part of the model.
TEST_F(LeftOut, AnMpcIsLostOnlyWhereCaseControlTakesIt) {
  const auto import_bdf = [&](const std::string& control) {
    imported_deck("a.bdf",
                  control +
                      "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\n"
                      "GRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\n"
                      "MAT1,1,1.+9,,0.,1000.\nSPC1,1,123,1,2,3,4\nFORCE,2,7,,1.,1.,0.,0.\nMPC,5,6,4,1.,7,4,-2.\n"
                      "MPC,6,6,5,1.,7,5,-2.\nMPCADD,9,5,6\nENDDATA\n",
                  "--quiet --scene-out s.toml");
    std::vector<std::string> cards;
    const Scene s = Scene::load(place / "s.toml");
    for (const Entry& e : s.entries("left_out")) cards.push_back(e.text("card"));
    return cards;
  };
  const std::string control = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\n";
  EXPECT_TRUE(import_bdf(control).empty());
  solved(0);
  for (const char* mpc : {"MPC = 5\n", "MPC = 9\n"}) {
    EXPECT_EQ(import_bdf(control + mpc), std::vector<std::string>{"MPC of turns"});
    EXPECT_NE(solved(2).find("import left out MPC"), std::string::npos);
  }
}

TEST_F(LeftOut, AStaticRunThatLostAllLoadsIsRefused) {
  import(bar + held + statics + "*TEMPERATURE\nhead, 20.\n" + end);
  EXPECT_NE(solved(2).find("nothing else loads this static analysis"), std::string::npos);
  solved(0, "--accept-left-out");
  import(bar + held + statics + end);  // that it has none from the start is its own affair
  EXPECT_EQ(solved(0), "");
}

TEST_F(LeftOut, RequestsForOutputAreNot) {
  import(bar + held + statics + pull + "*NODE FILE\nU\n*EL PRINT, ELSET=bar\nS\n" + end);
  EXPECT_EQ(err, "");
  EXPECT_TRUE(Scene::load(place / "s.toml").entries("left_out").empty());
}

TEST_F(LeftOut, PressureOnNothingIsToldToo) {
  import(bar + "*ELEMENT, TYPE=MASS, ELSET=p\n900, 12\n*MASS, ELSET=p\n5.\n" + held + statics + pull + "*DLOAD\np, P1, 5.\n" + end);
  expect_said("*DLOAD on elements that are no cells (1, a.inp:");
}

TEST_F(LeftOut, AMaterialWithoutALawIsNamedAsTheCause) {
  std::string text = bar + held + statics + pull + end;
  text.replace(text.find("*ELASTIC\n1e9, 0.\n"), 17, "*HYPERFOAM\n1., 2., 3.\n");
  import(text);
  expect_said("*MATERIAL of region \"bar\": no law of hilo (*HYPERFOAM, a.inp:");
  EXPECT_NE(solved(2).find("import left out *HYPERFOAM"), std::string::npos);
}

// E = 1e9, rho = 1000: waves run at 1000 m/s along sqrt(6) m, a fifth of that is 4.9e-4 s.
TEST_F(LeftOut, ADynamicDeckHasStepsThatResolveItsMotion) {
  const auto step = [&](const std::string& dynamic) {
    import(bar + held + "*STEP\n" + dynamic + pull + end);
    return Scene::load(place / "s.toml").table("time").number("step");
  };
  EXPECT_NEAR(step("*DYNAMIC\n0.1, 0.1\n"), std::sqrt(6) / 1000 / 5, 1e-9);
  EXPECT_NEAR(step("*DYNAMIC\n1e-5, 0.1\n"), 1e-5, 1e-12) << "a shorter one of the deck";
  EXPECT_NEAR(step("*DYNAMIC, DIRECT\n0.1, 0.1\n"), 0.1, 1e-12) << "just that, the deck says";
  EXPECT_NEAR(step("*DYNAMIC\n1e-3, 1e-3\n"), 5e-5, 1e-12) << "at least twenty";
  EXPECT_NEAR(step("*DYNAMIC\n100., 100.\n"), 0.1, 1e-9) << "at most a thousand";
}

const std::string lid =
    "*NODE\n21, 0, 0, 5\n22, 0, 1, 5\n23, 0, 1, 6\n24, 0, 0, 6\n25, 1, 0, 5\n26, 1, 1, 5\n27, 1, 1, 6\n28, 1, 0, 6\n"
    "*ELEMENT, TYPE=C3D8, ELSET=lid\n11, 21, 22, 23, 24, 25, 26, 27, 28\n*SOLID SECTION, ELSET=lid, MATERIAL=m\n";

TEST_F(LeftOut, ASolidThatNothingHoldsOrTouchesIsNamedAtImportAndBeforeARun) {
  const std::string dynamic = "*STEP\n*DYNAMIC, DIRECT\n1e-4, 1e-3\n";
  imported_deck("a.inp", bar + lid + held + dynamic + pull + end, "--scene-out s.toml");
  expect_said(
      "1 of 2 solids share no node with another, and nothing of the deck holds, moves, loads or ties them: \"lid\" (from "
      "cell 11 on)");
  const auto ran = succeeded(place.run("hilo-solve s.toml -o run.h5"));
  expect_words(ran.err, "warning: \"lid\", about (0.5, 0.5, 5.5) m: nothing holds, moves, loads or touches it");
  EXPECT_EQ(ran.err.find("\"bar\", about"), std::string::npos) << ran.err;
  for (const char* how : {"--rigid lid --nonlinear bar", "--rigid bar --nonlinear lid", "--rigid bar --rigid lid"}) {
    ASSERT_EQ(place.run("hilo-tag out.h5 -o tags.h5 " + std::string(how)).exit, 0) << how;
    const std::string said = place.run("hilo-solve s.toml tags.h5 -o run.h5").err;
    EXPECT_NE(said.find("\"lid\", about (0.5, 0.5, 5.5) m: nothing holds"), std::string::npos) << how << said;
    EXPECT_EQ(said.find("\"bar\", about"), std::string::npos) << how << said;
  }
  for (const char* more : {"[[load]]\nkind = \"force\"\nname = \"f\"\non = \"lid\"\nforce = [1, 0, 0]\n",
                           "[[initial]]\non = [\"lid\"]\nvelocity = [1, 0, 0]\n",
                           "[[spring]]\nkind = \"axial\"\nname = \"k\"\na = \"ground\"\nb = \"lid\"\nat_a = [0, 0, 9]\nat_b = [0, 0, 6]\n"
                           "stiffness = 10\n"}) {
    place.write("more.toml", test::text_of(place / "s.toml") + more);
    const std::string said = place.run("hilo-solve more.toml -o run.h5").err;
    EXPECT_EQ(said.find("nothing holds"), std::string::npos) << more << said;
  }
}

TEST_F(LeftOut, SpringsToTheGroundHoldASolidInAStaticRun) {
  std::string text = bar;
  for (int dof = 1; dof <= 3; ++dof)
    for (int n = 1; n <= 4; ++n) {
      const int id = 100 * dof + n;
      text += fmt::format("*ELEMENT, TYPE=SPRING1, ELSET=s{0}\n{0}, {1}\n*SPRING, ELSET=s{0}\n{2}\n1000.\n", id, n, dof);
    }
  import(text + statics + pull + end);
  EXPECT_EQ(solved(0), "");  // 4 N over 4 springs of 1000 N/m
}

}  // namespace
}  // namespace hilo::test::left_out_test
