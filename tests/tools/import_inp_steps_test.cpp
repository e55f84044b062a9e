// SPDX-License-Identifier: GPL-3.0-or-later
// Several *STEPs of a deck are one run where one run can say them; else what is left of them is told.  Truth: forces by hand, and the
// motion of a bar of two cells that is let go, from the roots of its two equations.
#include <cmath>
#include <numbers>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_inp_steps_test {
namespace {

/// A bar of two cubes of 1 m along x, held at its foot: E = 1e9 Pa, 1000 kg/m^3.
const std::string bar =
    "*NODE\n1, 0, 0, 0\n2, 0, 1, 0\n3, 0, 1, 1\n4, 0, 0, 1\n5, 1, 0, 0\n6, 1, 1, 0\n7, 1, 1, 1\n8, 1, 0, 1\n9, 2, 0, 0\n10, 2, 1, 0\n"
    "11, 2, 1, 1\n12, 2, 0, 1\n*ELEMENT, TYPE=C3D8, ELSET=bar\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 5, 6, 7, 8, 9, 10, 11, 12\n"
    "*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=head, GENERATE\n9, 12\n*NSET, NSET=half\n9, 10\n*SURFACE, NAME=end\n2, S2\n*SURFACE, "
    "NAME=free\n2\n"
    "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n*SOLID SECTION, ELSET=bar, MATERIAL=m\n*BOUNDARY\nfoot, 1, 3\n";
const std::string statics = "*STEP\n*STATIC\n", end = "*END STEP\n";

class ImportInpSteps : public test::Import {
 protected:
  std::vector<double> read(const std::string& array) const { return Store::open(place / "run.h5").read<double>(array); }
  /// Force along x that holds the foot at each of these times.
  std::vector<double> foot(const std::vector<double>& times) const {
    const auto t = read("/history/t"), force = read("/history/motion/foot");
    std::vector<double> out;
    for (const double wanted : times)
      for (size_t i = 0; i < t.size(); ++i)
        if (std::abs(t[i] - wanted) < 1e-9) out.push_back(std::round(1e6 * force[6 * i]) / 1e6);
    return out;
  }
};

TEST_F(ImportInpSteps, StaticOnesFollowEachOtherAndLoadsStayUntilTheyAreGivenAnew) {
  solve(bar + statics + "*CLOAD\nhead, 1, 1.\n" + end +                                   // 4 N
        statics + "*DSLOAD\nend, P, -2.\n" + end +                                        // and 2 N, on 1 m^2
        statics + "*CLOAD\nhead, 1, 3.\n" + end +                                         // 12 N instead of 4
        "*STEP\n*STATIC\n.1, 2.\n*CLOAD, OP=NEW\nhalf, 1, 5.\n*DSLOAD, OP=NEW\n" + end);  // 10 N and nothing else
  EXPECT_EQ(foot({1, 2, 3, 5}), (std::vector<double>{-4, -6, -14, -10}));
  expect_said("steps 1 to 4 become one run");
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
}

TEST_F(ImportInpSteps, GravityOfAStepGrowsInItAndStays) {
  solve(bar + statics + "*DLOAD\nbar, GRAV, 9., 1., 0., 0.\n" + end + statics + "*CLOAD\nhead, 1, 1.\n" + end);
  EXPECT_EQ(foot({1, 2}), (std::vector<double>{-18000, -18004}));
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
}

// What yields remembers how it came there: as many load steps as the deck begins with.  What is elastic needs one.
TEST_F(ImportInpSteps, WhatYieldsTakesTheIncrementOfTheDeck) {
  for (const bool yields : {false, true}) {
    std::string text = bar + "*STEP\n*STATIC\n.05, 1.\n*CLOAD\nhead, 1, 1.\n" + end;
    if (yields) text.insert(text.find("*DENSITY"), "*PLASTIC\n1e6, 0.\n2e6, 0.1\n");
    solve(text);
    EXPECT_EQ(Scene::load(place / "s.toml").table("time").number("steps"), yields ? 20 : 1);
  }
}

// Half way through a step: a load without an amplitude has gone half the way from its last value; one with an amplitude is where that is.
TEST_F(ImportInpSteps, LoadsGoFromWhereTheyWereAndAmplitudesBeginWithTheirStep) {
  solve(bar + "*AMPLITUDE, NAME=a\n0., 0., .5, 1., 1., 0.\n" + statics + "*CLOAD\nhead, 1, 1.\n" + end + statics +
            "*CLOAD\nhead, 1, 2.\n*CLOAD, AMPLITUDE=a\nhead, 2, 7.\n" + end,
        "a.inp", "", "--set time.steps=4");
  EXPECT_EQ(foot({.5, 1, 1.5, 2}), (std::vector<double>{-2, -4, -6, -8}));
  const auto t = read("/history/t"), force = read("/history/motion/foot");
  for (size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(force[6 * i + 1], std::abs(t[i] - 1.5) < 1e-9 ? -28 : 0, 1e-6) << t[i];
}

// A node that a later step speaks of under another name has one load, not two.
TEST_F(ImportInpSteps, ANodeOfTwoSetsHasTheLastLoad) {
  solve(bar + statics + "*CLOAD\nhead, 1, 1.\n" + end + statics + "*CLOAD\nhalf, 1, 3.\n9, 2, 0.\n" + end);
  EXPECT_EQ(foot({1, 2}), (std::vector<double>{-4, -8}));
}

// A face that a later step speaks of by another set, by number or by a surface has one pressure, not two.  Each face has 1 m^2.
TEST_F(ImportInpSteps, AFaceOfTwoSetsHasTheLastPressure) {
  solve(bar + statics + "*DSLOAD\nend, P, -2.\n" + end + statics + "*DLOAD\n2, P2, -3.\n" + end);
  EXPECT_EQ(foot({1, 2}), (std::vector<double>{-2, -3}));
  solve(bar + "*ELSET, ELSET=outer\n2\n" + statics + "*DLOAD\nbar, P3, 1.\n" + end + statics + "*DLOAD\nouter, P3, 3.\n" + end);
  const auto force = read("/history/motion/foot");
  EXPECT_NEAR(force[8], -2, 1e-6);
  EXPECT_NEAR(force[14], -4, 1e-6);  // 1 on the first cell, 3 on the second
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
}

// Truth: CalculiX 2.20 keeps the first axis of a set and says nothing.  1 rad/s about z through 0: m w^2 R = 2000 kg 1 m.
TEST_F(ImportInpSteps, CentrifAboutAnotherAxisIsTold) {
  const std::string first = "*DLOAD\nbar, CENTRIF, 1., 0., 0., 0., 0., 0., 1.\n", other = "bar, CENTRIF, 4., 0., 0., 0., 0., 1., 0.\n";
  for (const auto& text : {statics + first + other + end, statics + first + end + statics + "*DLOAD\n" + other + end}) {
    solve(bar + text, "a.inp", "", "--accept-left-out");
    EXPECT_NEAR(foot({1}).at(0), -2000, 1e-6);
    expect_said("about another axis");
  }
}

// Truth: CalculiX takes the first line that turns an element.
TEST_F(ImportInpSteps, CentrifOfOverlappingSetsIsTold) {
  solve(bar + statics + "*DLOAD\nbar, CENTRIF, 1., 0., 0., 0., 0., 0., 1.\n2, CENTRIF, 3., 0., 0., 0., 0., 0., 1.\n" + end, "a.inp", "",
        "--accept-left-out");
  EXPECT_NEAR(foot({1}).at(0), -2000, 1e-6);
  expect_said("*DLOAD CENTRIF on elements that one before it turns");
}

// Truth: CalculiX takes (w/2 pi)^2 off the squares of frequencies in the plane of rotation; ours stay, and a line says so.
TEST_F(ImportInpSteps, SpinSofteningIsTold) {
  imported_deck("a.inp",
                bar + "*STEP, NLGEOM\n*STATIC\n*DLOAD\nbar, CENTRIF, 1., 0., 0., 0., 0., 0., 1.\n" + end +
                    "*STEP, PERTURBATION\n*FREQUENCY\n2\n" + end,
                "--scene-out s.toml");
  EXPECT_NE(err.find("not read: spin softening of *DLOAD CENTRIF in *FREQUENCY"), std::string::npos) << err;
}

// Motions go on from step to step too: 1 and 3 um at the head, E A/L = 5e8 N/m.
TEST_F(ImportInpSteps, AMovedSupportGoesOn) {
  solve(bar + statics + "*BOUNDARY\nhead, 1, 1, 1e-6\n" + end + statics + "*BOUNDARY\nhead, 1, 1, 3e-6\n" + end);
  const auto at = foot({1, 2});
  EXPECT_NEAR(at[0], -500, .01);
  EXPECT_NEAR(at[1], -1500, .01);
}

// Truth: FIXED keeps the support where a step before has moved it, and says no place of its own.
TEST_F(ImportInpSteps, AFixedSupportStaysWhereItIs) {
  solve(bar + statics + "*BOUNDARY\nhead, 1, 1, 1e-6\n" + end + statics + "*BOUNDARY, FIXED\nhead, 1, 1\n" + end);
  EXPECT_NE(err.find("*BOUNDARY, FIXED"), std::string::npos) << err;
  for (const double F : foot({1, 2})) EXPECT_NEAR(F, -500, .01);
}

// Pulled with 4 N and let go.  Two cells with the mass of linear shape functions: K = EA/h [2 -1; -1 1], M = rho A h/6 [4 1; 1 2], of which
// the modes are sin(i theta), theta = 45 and 135 degrees, w = c/h sqrt(6 (1 - cos theta)/(2 + cos theta)).
TEST_F(ImportInpSteps, WhatIsPulledAndLetGoSwingsFromWhereItWas) {
  solve(bar + statics + "*CLOAD\nhead, 1, 1.\n" + end + "*STEP\n*DYNAMIC, DIRECT\n5e-6, 2e-3\n*CLOAD, OP=NEW\n" + end);
  expect_said("begins from the equilibrium of the static ones");
  const double u = 4 / 1e9;  // of the first cell
  const auto at = [&](double t) {
    const double theta[] = {std::numbers::pi / 4, 3 * std::numbers::pi / 4};
    // sum a_j (sin theta_j, sin 2 theta_j) = (u, 2 u)
    const double s1 = std::sin(theta[0]), s2 = std::sin(theta[1]), d1 = std::sin(2 * theta[0]), d2 = std::sin(2 * theta[1]);
    const double det = s1 * d2 - s2 * d1, a[] = {(u * d2 - s2 * 2 * u) / det, (s1 * 2 * u - d1 * u) / det};
    double x1 = 0, x2 = 0;
    for (int j = 0; j < 2; ++j) {
      const double w = 1000 * std::sqrt(6 * (1 - std::cos(theta[j])) / (2 + std::cos(theta[j])));
      x1 += a[j] * std::sin(theta[j]) * std::cos(w * t), x2 += a[j] * std::sin(2 * theta[j]) * std::cos(w * t);
    }
    return 1e9 / 2 * (x1 * x1 + (x2 - x1) * (x2 - x1));  // elastic energy
  };
  const auto t = read("/history/t"), energy = read("/history/energy");
  ASSERT_GT(t.size(), 400u);
  EXPECT_NEAR(t.back(), 2e-3, 1e-12);
  double least = 1;
  for (size_t i = 0; i < t.size(); ++i) {
    EXPECT_NEAR(energy[6 * i + 1], at(t[i]), 2e-3 * at(0)) << t[i];
    least = std::min(least, energy[6 * i + 1] / at(0));
  }
  EXPECT_LT(least, .1);
}

// What is there at once stays as it is, through its own step and those behind it.  Truth: forces by hand: 4 N, 2 N on 1 m^2, rho A L g,
// E A u/L, and rho A omega^2 L^2/2; a moment of 3 N m about z.
TEST_F(ImportInpSteps, WhatAStaticStepHasAtOnceIsConstant) {
  const std::string at_once = "*STEP, AMPLITUDE=STEP\n*STATIC\n", body = "*NODE\n50, 2., .5, .5\n*RIGID BODY, NSET=head, REF NODE=50\n";
  const struct {
    std::string model, load;
    int component;
    double force, within;
  } cases[] = {
      {"", "*CLOAD\nhead, 1, 1.\n", 0, -4, 1e-5},
      {"", "*DSLOAD\nend, P, -2.\n", 0, -2, 1e-5},
      {"", "*DLOAD\nbar, GRAV, 9., 1., 0., 0.\n", 0, -18000, 1e-3},
      {"", "*DLOAD\nbar, CENTRIF, 1., 0., .5, 0., 0., 0., 1.\n", 0, -2000, 1e-3},
      {"", "*BOUNDARY\nhead, 1, 1, 1e-6\n", 0, -500, 1e-2},
      {body, "*CLOAD\n50, 6, 3.\n", 5, -3, 1e-5},
  };
  for (const auto& c : cases)
    for (const bool by_amplitude : {false, true}) {
      SCOPED_TRACE(c.load);
      std::string load = c.load;
      if (by_amplitude) load.insert(load.find('\n'), ", OP=MOD, AMPLITUDE=one");
      const std::string step = (by_amplitude ? statics : at_once) + load;
      solve(bar + c.model + "*AMPLITUDE, NAME=one\n0., 1., 1., 1.\n" + step + end + (by_amplitude ? step : statics) + "*CLOAD\n5, 3, 1.\n" +
                end,
            "a.inp", "", "--set time.steps=4");
      const auto t = read("/history/t"), force = read("/history/motion/foot");
      ASSERT_GE(t.size(), 5u);
      for (size_t i = 1; i < t.size(); ++i) EXPECT_NEAR(force[6 * i + static_cast<size_t>(c.component)], c.force, c.within) << t[i];
      EXPECT_EQ(err.find("not read"), std::string::npos) << err;
    }
}

// Truth: forces by hand: 4 N all the time, and 8 N that come and go.
TEST_F(ImportInpSteps, WhatAStepHasAtOnceBesideAnAmplitudeIsConstant) {
  solve(bar + "*AMPLITUDE, NAME=a\n0., 0., .5, 1., 1., 0.\n*STEP, AMPLITUDE=STEP\n*STATIC\n" +
            "*CLOAD\nhead, 1, 1.\n*CLOAD, AMPLITUDE=a\nhead, 2, 2.\n" + end,
        "a.inp", "", "--set time.steps=4");
  EXPECT_EQ(foot({.25, .5, .75, 1}), (std::vector<double>{-4, -4, -4, -4}));
}

// Truth: 2 kg under F t: F t^3/(6 m).
TEST_F(ImportInpSteps, AmplitudeRampOfADynamicStepGrows) {
  solve(bar + "*NODE\n60, 5., 0., 0.\n*ELEMENT, TYPE=MASS, ELSET=p\n90, 60\n*MASS, ELSET=p\n2.\n*BOUNDARY\n60, 2, 3\n" +
        "*STEP, AMPLITUDE=RAMP\n*DYNAMIC, DIRECT\n.01, 1.\n*CLOAD\n60, 1, 12.\n" + end);
  const auto x = read("/history/body/node_60");
  EXPECT_NEAR(x[x.size() - 12] - x[0], 1, 1e-4);
}

// Truth: CalculiX, whose first step ends before the load of the second is there.
TEST_F(ImportInpSteps, WhatALaterStepHasAtOnceIsNotThereAtTheEndOfTheOneBefore) {
  solve(bar + statics + "*CLOAD\nhead, 1, 1.\n" + end + "*STEP, AMPLITUDE=STEP\n*STATIC\n*CLOAD\nhead, 1, 3.\n" + end, "a.inp", "",
        "--set time.steps=4");
  EXPECT_EQ(foot({.5, 1, 1.5, 2}), (std::vector<double>{-2, -4, -12, -12}));
}

TEST_F(ImportInpSteps, WhatOneRunCannotSayIsToldAndTheStepsBeforeItStay) {
  const std::string pull = "*CLOAD\nhead, 1, 1.\n", side = "*CLOAD\nhead, 2, 1.\n";
  struct {
    std::string text, why, card;
    double end;
  } cases[] = {
      {statics + pull + end + statics + "*BOUNDARY, OP=NEW\n1, 1, 3\n3, 1, 3\n" + side + end, "a support that is taken away",
       "*BOUNDARY in step 2 and later", 1},
      {statics + pull + end + statics + "*BOUNDARY\nhead, 1, 1\n" + end, "a support that is not there from the first step on",
       "*BOUNDARY in step 2 and later", 1},
      {statics + pull + end + statics + side + end + statics + "*BOUNDARY\nhead, 3, 3\n" + end,
       "a support that is not there from the first step on", "*BOUNDARY in step 3 and later", 2},
      {statics + "*DSLOAD\nfree, P, 1.\n" + end + statics + "*DLOAD\n2, P2, 3.\n" + end, "a pressure on a part of surface free",
       "*DLOAD in step 2 and later", 1},
      {statics + pull + end + "*STEP\n*BUCKLE\n2\n" + side + end, "*BUCKLE is another run", "*CLOAD in step 2 and later", 1},
      {statics + pull + end + "*STEP\n*FREQUENCY\n2\n" + end, "that of the unloaded model", "*FREQUENCY in step 2 and later", 1},
      {"*EQUATION\n2\n9, 1, 1., 10, 1, -1.\n" + statics + pull + end + statics + side + "*EQUATION, REMOVE\n9, 1\n" + end,
       "*EQUATION, REMOVE is not read", "*CLOAD in step 2 and later", 1},
      {statics + pull + end + statics + side + "*CHANGE SOLID SECTION, ELSET=bar, MATERIAL=m\n" + end, "*CHANGE SOLID SECTION is not read",
       "*CLOAD in step 2 and later", 1},
  };
  for (const auto& c : cases) {
    imported_deck("a.inp", bar + c.text, "--scene-out s.toml");
    EXPECT_NE(err.find(c.why), std::string::npos) << c.text << err;
    EXPECT_NE(err.find("not read: " + c.card), std::string::npos) << c.text << err;
    const Scene scene = Scene::load(place / "s.toml");
    const Entry& time = scene.table("time");
    EXPECT_EQ(time.text("analysis"), "static");
    EXPECT_EQ(time.has("end") ? time.number("end") : 1, c.end);
  }
}

// A pressure of 2 Pa on the end, along x: as a traction it points inwards too where the cells are numbered as in a mirror.
TEST_F(ImportInpSteps, APressureThatShakesPushesInwardsOnSolidsOfEitherHand) {
  std::string mirrored = bar;
  for (const auto& [of, as] : {std::pair("1, 1, 2, 3, 4, 5, 6, 7, 8\n", "1, 5, 6, 7, 8, 1, 2, 3, 4\n"),
                               std::pair("2, 5, 6, 7, 8, 9, 10, 11, 12\n", "2, 9, 10, 11, 12, 5, 6, 7, 8\n"), std::pair("2, S2", "2, S1")})
    mirrored.replace(mirrored.find(of), std::string_view(of).size(), as);
  for (const auto& [text, face] : {std::pair(bar, "P2"), std::pair(mirrored, "P1")}) {
    imported_deck("a.inp",
                  text + "*STEP\n*FREQUENCY\n2\n" + end + "*STEP\n*STEADY STATE DYNAMICS\n1., 9., 5\n*DLOAD\n2, " + face + ", 2.\n" + end,
                  "--scene-out s.toml");
    const Scene scene = Scene::load(place / "s.toml");
    ASSERT_EQ(scene.entries("load").size(), 1u) << err;
    EXPECT_LT((scene.entries("load")[0].vector3("traction") - Vec3(-2, 0, 0)).norm(), 1e-12) << face;
  }
}

}  // namespace
}  // namespace hilo::test::import_inp_steps_test
