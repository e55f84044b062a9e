// SPDX-License-Identifier: GPL-3.0-or-later
// What .inp decks say twice, beside or behind what one expects: it counts, or it is told.
#include <cmath>
#include <map>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_inp_silent_test {
namespace {

/// A bar of two cubes of 1 m along x, held at its foot; node 100 beside its head.
const std::string bar =
    "*NODE\n1, 0, 0, 0\n2, 0, 1, 0\n3, 0, 1, 1\n4, 0, 0, 1\n5, 1, 0, 0\n6, 1, 1, 0\n7, 1, 1, 1\n8, 1, 0, 1\n9, 2, 0, 0\n10, 2, 1, 0\n"
    "11, 2, 1, 1\n12, 2, 0, 1\n100, 3, 0, 0\n*ELEMENT, TYPE=C3D8, ELSET=bar\n1, 1, 2, 3, 4, 5, 6, 7, 8\n2, 5, 6, 7, 8, 9, 10, 11, 12\n"
    "*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=head, GENERATE\n9, 12\n*ELSET, ELSET=last\n2\n*SURFACE, NAME=end\n2, S2\n"
    "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n*MATERIAL, NAME=soft\n*ELASTIC\n1e6, 0.\n*DENSITY\n1000.\n"
    "*SOLID SECTION, ELSET=bar, MATERIAL=m\n";
const std::string held = "*BOUNDARY\nfoot, 1, 3\n", statics = "*STEP\n*STATIC\n", end = "*END STEP\n";

class ImportInpSilent : public test::Import {
 protected:
  std::string scene(const std::string& text) {
    imported_deck("a.inp", text, "--scene-out s.toml");
    return test::text_of(place / "s.toml");
  }
  std::vector<double> foot(const std::string& text) {
    solve(text);
    return last("motion/foot", 6);
  }
  void expect_told(const std::string& what, const std::string& text) {
    scene(text);
    expect_said(what);
  }
};

TEST_F(ImportInpSilent, APressureSaidTwiceCountsTwice) {
  const std::string two[] = {"*DLOAD\nlast, P2, 5.\n*DLOAD\nlast, P2, 5.\n", "*DSLOAD\nend, P, 5.\n*DSLOAD\nend, P, 5.\n"};
  for (const auto& loads : two) EXPECT_NEAR(foot(bar + held + statics + loads + end)[0], 10, 1e-6) << loads;
}

TEST_F(ImportInpSilent, DataThatNoReaderAsksForIsTold) {
  const std::string deck = bar + held + "*AMPLITUDE, NAME=a\n0, 0, 1, 1\n" + statics + "*CLOAD\n9, 1, 4.\n" + end;
  scene(deck);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  const std::pair<std::string, std::string> more[] = {
      {"9, 1, 4.", "9, 1, 4., 5."},
      {"foot, 1, 3", "foot, 1, 3, 0., 7."},
      {"*END STEP\n", "*END STEP\n1, 2, 3\n"},
      {"1, 0, 0, 0\n", "1, 0, 0, 0, 0, 0, 0, 9\n"},
      {"*SOLID SECTION, ELSET=bar, MATERIAL=m\n", "*SOLID SECTION, ELSET=bar, MATERIAL=m\n1., 2., 3.\n"}};
  for (const auto& [part, longer] : more) {
    std::string text = deck;
    text.replace(text.find(part), part.size(), longer);
    expect_told("not read: some data of *", text);
    EXPECT_NE(test::text_of(place / "s.toml").find("card = \"some data of *"), std::string::npos);
  }
  expect_told("text before the first keyword", "1, 2\n" + deck);
  imported_deck("modes.inp", bar + held + "*STEP\n*FREQUENCY\n2, , , 1e-3\n" + end);
  expect_said("*FREQUENCY: its fourth number");
  for (const char* limits : {"300.", ", 2000.", "300., 2000."}) {
    imported_deck("modes.inp", bar + held + "*STEP\n*FREQUENCY\n2, " + limits + "\n" + end);
    expect_said("*FREQUENCY: its limits (the lowest modes are looked for)");
  }
}

TEST_F(ImportInpSilent, NamesInLatin1BecomeUtf8) {
  std::string text = bar + held + statics + end;
  for (size_t at; (at = text.find("ELSET=bar")) != text.npos;) text.replace(at, 9, "ELSET=K\xF6rper");
  EXPECT_NE(scene(text).find("[region.\"K\xC3\xB6rper\"]"), std::string::npos);
  EXPECT_EQ(cells_of(read_mesh_file(place / "out.h5").mesh, "K\xC3\xB6rper"), 2);
  EXPECT_EQ(place.run("hilo-solve --quiet s.toml -o run.h5").exit, 0);
}

TEST_F(ImportInpSilent, OpNewForgetsTheSupportsBeforeTheStepAlone) {
  const std::string text =
      scene(bar + "*BOUNDARY\nhead, 2, 2\n" + statics + "*BOUNDARY, OP=NEW\nfoot, 1, 3\n*BOUNDARY, OP=NEW\n12, 3, 3\n" + end);
  EXPECT_NE(text.find("on = \"foot\""), std::string::npos) << text;
  EXPECT_NE(text.find("components = [\"z\"]"), std::string::npos) << text;
  EXPECT_EQ(text.find("on = \"head\""), std::string::npos) << text;
}

TEST_F(ImportInpSilent, ALastValueOfAnAmplitudeThatIsNotThereIsZero) {
  expect_words(scene(bar + held + "*AMPLITUDE, NAME=a\n0., 1., .5, 1., 1.,\n" + statics + "*CLOAD, AMPLITUDE=a\nhead, 1, 1.\n" + end),
               "value = [1.0, 1.0, 0.0]");
}

TEST_F(ImportInpSilent, ASpringAMassOrADamperIsTheFirstNumberOfItsLine) {
  const std::string spring =
      bar + "*ELEMENT, TYPE=SPRINGA, ELSET=s\n900, 9, 100\n*SPRING, ELSET=s\n\n1.E4, , 293.\n" + held + statics + end;
  EXPECT_NE(scene(spring).find("stiffness = 10000.0"), std::string::npos);
  expect_said("*SPRING: numbers after the first");
  expect_words(scene(bar + "*ELEMENT, TYPE=MASS, ELSET=s\n900, 100\n*MASS, ELSET=s\n5., , 20.\n" + held + statics + end), "mass = 5.0");
  expect_told(
      "*SPRING of several values",
      bar + "*ELEMENT, TYPE=SPRINGA, ELSET=s\n900, 9, 100\n*SPRING, ELSET=s\n\n1.E4, , 293.\n2.E4, , 400.\n" + held + statics + end);
}

TEST_F(ImportInpSilent, GravityAndCentrifugalForcesOfMassesAreThoseOfTheirSets) {
  const std::string mass = bar + "*ELEMENT, TYPE=MASS, ELSET=s\n900, 12\n*MASS, ELSET=s\n500.\n" + held + statics;
  EXPECT_NEAR(foot(mass + "*DLOAD\nbar, GRAV, 10., 0., 0., -1.\n" + end)[2], 10 * 2000, 1e-3);
  EXPECT_NEAR(foot(mass + "*DLOAD\ns, GRAV, 10., 0., 0., -1.\n" + end)[2], 10 * 500, 1e-3);
  EXPECT_NEAR(foot(mass + "*DLOAD\nbar, GRAV, 10., 0., 0., -1.\ns, GRAV, 10., 0., 0., -1.\n" + end)[2], 10 * 2500, 1e-3);
  // 9/s^2 about z: the bar's rho A L^2/2 and, at (2, 0) and as a body at (3, 0), 500 kg
  for (const auto& [node, x] : {std::pair{"12", 2.}, {"100", 3.}}) {
    SCOPED_TRACE(node);
    std::string text = mass;
    text.replace(text.find("900, 12"), 7, std::string("900, ") + node);
    if (x == 3) text.insert(text.find("*BOUNDARY"), "*RIGID BODY, NSET=head, REF NODE=100\n");
    const auto spun = [&](const std::string& set) {
      return foot(text + "*DLOAD\n" + set + ", CENTRIF, 9., 0., 0., 0., 0., 0., 2.\n" + end);
    };
    for (const char* set : {"s", "900"}) EXPECT_NEAR(spun(set)[0], -9 * 500 * x, 1e-3) << set;
    text.insert(text.find("*BOUNDARY"), "*ELSET, ELSET=all\nbar, s\n");
    EXPECT_NEAR(spun("all")[0], -9 * (500 * x + 2000), 1e-2);
  }
}

// Truth: CalculiX: each component of a node is what the last line says that speaks of it.
TEST_F(ImportInpSilent, InitialVelocitiesOfOverlappingSetsAreMergedByNode) {
  solve(bar + "*NSET, NSET=all, GENERATE\n1, 12\n*INITIAL CONDITIONS, TYPE=VELOCITY\nhead, 3, .2\nall, 2, .1\n9, 3, .3\n12, 1, .5\n" +
        "*STEP\n*DYNAMIC, DIRECT\n1e-6, 1e-6\n" + end);
  const auto v = Store::open(place / "run.h5").read<double>("/field/000000/velocity");
  ASSERT_EQ(v.size(), 36u);
  for (size_t a = 0; a < 12; ++a) {
    EXPECT_EQ(v[3 * a], a == 11 ? .5 : 0) << a;
    EXPECT_EQ(v[3 * a + 1], .1) << a;
    EXPECT_EQ(v[3 * a + 2], a < 8 ? 0 : a == 8 ? .3 : .2) << a;
  }
}

// Truth: 4 N along the axes of the part, (.6, .8, 0) or away from an axis along x that meets (0, .5, -9), turned with its instance by 90
// degrees about z: x becomes y, y becomes -x.
TEST_F(ImportInpSilent, TransformsOfAPartTurnWithItsInstance) {
  const auto at = bar.find("*MATERIAL"), section = bar.find("*SOLID");
  const auto foot_of = [&](const std::string& transform) {
    return foot("*PART, NAME=p\n" + bar.substr(0, at) + bar.substr(section) + transform +
                "*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=i, PART=p\n1., 2., 3.\n0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n"
                "*END ASSEMBLY\n" +
                bar.substr(at, section - at) + held + statics + "*CLOAD\ni.head, 1, 1.\n" + end);
  };
  const auto along = foot_of("*TRANSFORM, NSET=head, TYPE=R\n.6, .8, 0., -.8, .6, 0.\n");
  EXPECT_NEAR(along[0], 4 * .8, 1e-5);
  EXPECT_NEAR(along[1], -4 * .6, 1e-5);
  const auto away = foot_of("*TRANSFORM, NSET=head, TYPE=C\n0., .5, -9., 1., .5, -9.\n");
  EXPECT_NEAR(away[2], -2 * (9 / std::sqrt(81.25) + 10 / std::sqrt(100.25)), 1e-5);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(away[k], 0, 1e-5);
}

TEST_F(ImportInpSilent, AHeadingOfSeveralLinesIsATitleAndWhatHasNoLawHasNoMaterial) {
  const std::string text = scene("*HEADING\nA bar\nof two cubes, 3\n" + bar + held + statics + "*CLOAD\n9, 1, 4.\n" + end);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  EXPECT_NE(text.find("A bar"), std::string::npos) << text;
  std::string lawless = bar;
  lawless.erase(lawless.find("*ELASTIC"), 16);
  scene(lawless + held + statics + "*CLOAD\n9, 1, 4.\n" + end);
  const auto ran = place.run("hilo-solve --quiet s.toml -o run.h5");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_NE(ran.err.find("region \"bar\" has no material (give it with"), std::string::npos) << ran.err;
}

TEST_F(ImportInpSilent, TheLastSectionOfACellIsItsOwn) {
  const std::string text = scene(bar + "*SOLID SECTION, ELSET=last, MATERIAL=soft\n" + held + statics + end);
  EXPECT_NE(text.find("material = \"soft\""), std::string::npos) << text;
  EXPECT_NE(text.find("material = \"m\""), std::string::npos) << text;
}

TEST_F(ImportInpSilent, ABodyHasNoNameOfASet) {
  const std::string text = scene(bar + "*NSET, NSET=node_100, GENERATE\n5, 8\n*RIGID BODY, NSET=head, REF NODE=100\n" + held + statics +
                                 "*CLOAD\nnode_100, 1, 1.\n100, 1, 7.\n" + end);
  EXPECT_NE(text.find("on = \"node_100\""), std::string::npos) << text;
  EXPECT_NE(text.find("on = \"node_100_body\""), std::string::npos) << text;
}

TEST_F(ImportInpSilent, WhatHasNoPlaceIsTold) {
  expect_told("*AMPLITUDE, VALUE=ABSOLUTE", bar + held + "*AMPLITUDE, NAME=a, VALUE=ABSOLUTE\n0., 0., 1., 1.\n" + statics + end);
  expect_told(
      "*DISTRIBUTING of a node that is *KINEMATIC too",
      bar +
          "*COUPLING, REF NODE=100, SURFACE=end, CONSTRAINT NAME=c\n*DISTRIBUTING\n1, 6\n*COUPLING, REF NODE=100, SURFACE=end, CONSTRAINT "
          "NAME=d\n*KINEMATIC\n1, 6\n" +
          held + statics + end);
}

TEST_F(ImportInpSilent, AnInstanceIsMovedThenTurnedAboutItsAxis) {
  const Mesh m =
      imported_deck("a.inp", "*PART, NAME=p\n" + bar +
                                 "*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=p-1, PART=p\n1., 0., 0.\n0., 0., 0., 0., 0., 2., 90.\n"
                                 "*END INSTANCE\n*END ASSEMBLY\n");
  const std::map<std::int64_t, Vec3> before{{9, Vec3(2, 0, 0)}, {11, Vec3(2, 1, 1)}};
  int seen = 0;
  for (std::int64_t a = 0; a < m.n_nodes(); ++a) {
    if (!before.contains(m.node_id[a])) continue;
    const Vec3 x = before.at(m.node_id[a]);
    EXPECT_LT((m.X[a] - Vec3(-x.y(), x.x() + 1, x.z())).norm(), 1e-12);  // by 1 along x, about z by a right angle
    ++seen;
  }
  EXPECT_EQ(seen, 2);
}

TEST_F(ImportInpSilent, ANastranDeckOfThatNameIsReadAsOne) {
  EXPECT_NEAR(test::volume(imported_deck(
                  "a.inp",
                  "SOL 101\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\nCTETRA,1,1,1,2,3,4\n"
                  "PSOLID,1,1\nMAT1,1,1.+9,,0.3,1000.\nENDDATA\n")),
              1. / 6, 1e-12);
  expect_said("is a Nastran deck");
}

TEST_F(ImportInpSilent, TheFirstCauseIsNamed) {
  const std::string coupling = "*ORIENTATION, NAME=o\n0., 1., 0., -1., 0., 0.\n*COUPLING, REF NODE=100, SURFACE=end, CONSTRAINT NAME=c, ";
  EXPECT_NE(scene(bar + coupling + "ORIENTATION=o\n*KINEMATIC\n1, 6\n" + held + statics + "*CLOAD\n100, 1, 7.\n" + end)
                .find("kind = \"fixed\"\nname = \"node_100\""),
            std::string::npos)
      << "axes say nothing where all components are tied";
  expect_told("*COUPLING, INFLUENCERADIUS=2.", bar + coupling + "INFLUENCE RADIUS=2.\n*DISTRIBUTING\n1, 6\n" + held + statics + end);
  std::string metal = bar + held + statics + end;
  metal.insert(metal.find("*DENSITY"), "*PLASTIC, HARDENING=JOHNSON COOK\n175., 380., .32, .55, 1220., 298.\n");
  expect_told("*PLASTIC, HARDENING=JOHNSONCOOK", metal);
}

}  // namespace
}  // namespace hilo::test::import_inp_silent_test
