// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and dampers of .inp decks by tables and along components, and supports that move by velocity and acceleration: closed forms of a
// mass beside a cube that is held.
#include <fmt/format.h>

#include <cmath>

#include "import_case.hpp"

namespace hilo::test::import_inp_springs_test {
namespace {

/// A cube that is held, and masses of 2 kg at nodes 11 and 12, which may move along `free` alone.
std::string cube(int free) {
  std::string s =
      "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1\n11, 3., 1., 2.\n"
      "12, 5., 4., 1.\n*ELEMENT, TYPE=C3D8, ELSET=cube\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n"
      "*SOLID SECTION, ELSET=cube, MATERIAL=m\n*NSET, NSET=corners, GENERATE\n1, 8\n*ELEMENT, TYPE=MASS, ELSET=p\n90, 11\n91, 12\n"
      "*MASS, ELSET=p\n2.\n*BOUNDARY\ncorners, 1, 3\n12, 1, 6\n11, 4, 6\n";
  for (int k = 1; k <= 3; ++k)
    if (k != free) s += fmt::format("11, {}\n", k);
  return s;
}

class ImportInpSprings : public test::Import {
 protected:
  /// How far node 11 goes along the component, at each time.
  std::vector<double> way(int component, const std::string& text, const std::string& step) {
    solve(cube(component) + text + "*STEP\n" + step + "*END STEP\n");
    EXPECT_EQ(err.find("not read"), std::string::npos) << err;
    const auto x = Store::open(place / "run.h5").read<double>("/history/body/node_11");
    std::vector<double> out;
    for (size_t i = 0; i < x.size(); i += 12)
      out.push_back(x[i + static_cast<size_t>(component) - 1] - x[static_cast<size_t>(component) - 1]);
    return out;
  }
  double end(int component, const std::string& text, const std::string& step) { return way(component, text, step).back(); }
};

const std::string table = "-50., -1e-3\n0., 0.\n100., 1e-3\n300., 2e-3\n";  // stiffer at each point, softer in return

TEST_F(ImportInpSprings, ATableActsAlongAComponent) {
  for (const int k : {1, 3}) {
    SCOPED_TRACE(k);
    const std::string spring = fmt::format("*ELEMENT, TYPE=SPRING1, ELSET=s\n50, 11\n*SPRING, ELSET=s, NONLINEAR\n{}\n{}", k, table);
    const auto load = [&](double f) { return fmt::format("*STATIC\n*CLOAD\n11, {}, {}\n", k, f); };
    EXPECT_NEAR(end(k, spring, load(200)), 1.5e-3, 1e-10);
    EXPECT_NEAR(end(k, spring, load(-20)), -4e-4, 1e-10);
  }
}

// The extension is the component of the first node less that of the second.
TEST_F(ImportInpSprings, ATableActsBetweenComponentsOfTwoNodes) {
  for (const bool turned : {false, true}) {
    SCOPED_TRACE(turned);
    const std::string spring =
        fmt::format("*ELEMENT, TYPE=SPRING2, ELSET=s\n50, {}\n*SPRING, ELSET=s, NONLINEAR\n3, 3\n{}", turned ? "12, 11" : "11, 12", table);
    EXPECT_NEAR(end(3, spring, "*STATIC\n*CLOAD\n11, 3, -40.\n"), turned ? -4e-4 : -8e-4, 1e-10);
  }
}

// A linear one off the line of its nodes, too: F/k.
TEST_F(ImportInpSprings, ComponentsOffTheLineOfTheirNodes) {
  EXPECT_NEAR(end(2, "*ELEMENT, TYPE=SPRING2, ELSET=s\n50, 11, 12\n*SPRING, ELSET=s\n2, 2\n2e4\n", "*STATIC\n*CLOAD\n11, 2, 40.\n"), 2e-3,
              1e-9);
}

// m v' = F - c v: x = F/c (t - m/c (1 - exp(-c t/m))), with F = 4, c = 4, m = 2, t = 1; forces of the dampers are beyond 2 m/s constant, so
// that m v' = F - 8 from where v is 2: with F = 28 after some time t0 = -m/c log(1 - 2 c/F).
TEST_F(ImportInpSprings, DampersOfTablesAndComponents) {
  const double slow = 1 - (1 - std::exp(-2.)) / 2, t0 = -.5 * std::log(1 - 8. / 28), x0 = 7 * (t0 - .5 * (1 - std::exp(-2 * t0))),
               fast = x0 + 2 * (1 - t0) + 5 * (1 - t0) * (1 - t0);
  const std::string by_table = ", NONLINEAR\n", points = "-8., -2.\n0., 0.\n8., 2.\n";
  const auto steps = [](double f) { return fmt::format("*DYNAMIC, DIRECT\n.005, 1.\n*CLOAD\n11, 2, {}\n", f); };
  for (const std::string type : {"DASHPOT1", "DASHPOT2"}) {
    SCOPED_TRACE(type);
    const std::string damper = "*ELEMENT, TYPE=" + type + ", ELSET=s\n50, 11" + (type == "DASHPOT2" ? ", 12" : "") + "\n*DASHPOT, ELSET=s";
    const std::string components = type == "DASHPOT2" ? "2, 2\n" : "2\n";
    EXPECT_NEAR(end(2, damper + "\n" + components + "4.\n", steps(4)), slow, 1e-4);
    EXPECT_NEAR(end(2, damper + by_table + components + points, steps(4)), slow, 1e-4);
    EXPECT_NEAR(end(2, damper + by_table + components + points, steps(28)), fast, 1e-3);
  }
  // along the line of two nodes: node 12 right above, so that the line stays
  const std::string above = "*NODE\n13, 3., 9., 2.\n*ELEMENT, TYPE=MASS, ELSET=q\n92, 13\n*MASS, ELSET=q\n1.\n*BOUNDARY\n13, 1, 6\n";
  for (const std::string nodes : {"11, 13", "13, 11"})
    EXPECT_NEAR(
        end(2, above + "*ELEMENT, TYPE=DASHPOTA, ELSET=s\n50, " + nodes + "\n*DASHPOT, ELSET=s" + by_table + "\n" + points, steps(4)), slow,
        1e-4)
        << nodes;
}

// No cell at all: 11 N on the table of a spring, and a mass of 2 kg on 800 N/m.
TEST_F(ImportInpSprings, DecksOfSpringsAndMassesAloneAreScenesOfBodies) {
  place.write("a.inp",
              "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n*ELEMENT, TYPE=SPRINGA, ELSET=s\n1, 1, 2\n*BOUNDARY\n1, 1, 3\n2, 2, 3\n"
              "*SPRING, ELSET=s, NONLINEAR\n\n0., 0.\n10., 1.\n100., 20.\n*STEP\n*STATIC\n*CLOAD\n2, 1, 11.\n*END STEP\n");
  place.write("b.bdf",
              "SOL 103\nCEND\nSPC = 1\nMETHOD = 4\nBEGIN BULK\nGRID,1,,0.,0.,0.,,23456\nGRID,2,,1.,0.,0.\nSPC1,1,123456,2\n"
              "CONM2,5,1,,2.\nCELAS2,6,800.,1,1,2,1\nEIGRL,4,,,1\nENDDATA\n");
  imported("a.inp", "--scene-out s.toml");
  auto ran = succeeded(place.run("hilo-solve --quiet s.toml -o run.h5"), test::text_of(place / "s.toml"));
  const auto x = Store::open(place / "run.h5").read<double>("/history/body/node_2");
  EXPECT_NEAR(x[x.size() - 12] - x[0], 1 + 19 / 90., 1e-9);
  imported("b.bdf", "--scene-out s.toml");
  ran = place.run("hilo-solve --quiet s.toml -o run.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err << test::text_of(place / "s.toml");
  EXPECT_NEAR(Store::open(place / "run.h5").read<double>("/history/mode").at(10), 20 / (2 * 3.14159265358979), 1e-8);
}

TEST_F(ImportInpSprings, WhatNoSceneSaysIsNamed) {
  imported_deck("a.inp",
                cube(1) +
                    "*ELEMENT, TYPE=SPRING2, ELSET=a\n50, 11, 12\n*SPRING, ELSET=a\n1, 2\n1e3\n*ELEMENT, TYPE=SPRING1, ELSET=b\n51, 11\n"
                    "*SPRING, ELSET=b, NONLINEAR\n4\n0., 0.\n1., 1.\n*ELEMENT, TYPE=DASHPOTA, ELSET=c\n52, 1, 2\n"
                    "*DASHPOT, ELSET=c, NONLINEAR\n\n0., 0.\n1., 1.\n*ELEMENT, TYPE=DASHPOT1, ELSET=d\n53, 11\n*DASHPOT, ELSET=d\n",
                "--scene-out s.toml");
  for (const char* what :
       {"*SPRING of SPRING2, but along one component of both nodes", "*SPRING, NONLINEAR, of SPRING1, but along a component",
        "*DASHPOT, NONLINEAR, of DASHPOTA between two nodes that do not turn", "*ELEMENT, TYPE=DASHPOT1 without a value"})
    expect_said(std::string("not read: ") + what + " (1,");
  const std::pair<const char*, const char*> cases[] = {
      {"*SPRING, ELSET=b, NONLINEAR\n1\n5., 1.\n",
       "a.inp:35: *SPRING, NONLINEAR: two forces at least, at extensions that differ (force, extension)"},
      {"*SPRING, ELSET=b, NONLINEAR\n1\n5., 1.\n6., 1.\n",
       "a.inp:35: *SPRING, NONLINEAR: two forces at least, at extensions that differ (force, extension)"},
      {"*SPRING, ELSET=b, NONLINEAR\n1\n5., x\n", "a.inp:37:5: expected a number, found \"x\""},
  };
  for (const auto& [text, message] : cases) {
    refused_deck("a.inp", cube(1) + "*ELEMENT, TYPE=SPRING1, ELSET=b\n51, 11\n" + text, "-o a.h5", 2, message);
  }
}

// The base of a spring: x'' = a(t) = 3 + 6 t to 1 s and 9 from then on: x = 3/2 t^2 + t^3, and 5/2 + 6 (t - 1) + 9/2 (t - 1)^2.  Mass 11 is
// the support itself.
TEST_F(ImportInpSprings, SupportsMoveByVelocityAndAcceleration) {
  const auto exact = [](double t) { return t < 1 ? 1.5 * t * t + t * t * t : 2.5 + 6 * (t - 1) + 4.5 * (t - 1) * (t - 1); };
  const std::string amplitude = "*AMPLITUDE, NAME=quake\n0., 1., 1., 3.\n", dynamic = "*DYNAMIC, DIRECT\n.01, 2.\n";
  const std::string held = "*BOUNDARY\n11, 1\n";
  for (const std::string& move : {dynamic + "*BOUNDARY, TYPE=ACCELERATION, AMPLITUDE=quake\n11, 1, 1, 3.\n",
                                  dynamic + held + "*BASE MOTION, DOF=1, AMPLITUDE=quake, SCALE=3.\n"}) {
    SCOPED_TRACE(move);
    const auto x = way(1, amplitude, move);
    ASSERT_EQ(x.size(), 201u);
    for (size_t i = 0; i < x.size(); i += 20) EXPECT_NEAR(x[i], exact(static_cast<double>(i) / 100), 1e-9) << i;
  }
  // a velocity: 1 + 2 t to 1 s, then 3: t + t^2, 2 + 3 (t - 1)
  const auto x = way(1, amplitude, dynamic + "*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=quake\n11, 1, 1, 1.\n");
  ASSERT_EQ(x.size(), 201u);
  for (size_t i = 0; i < x.size(); i += 20) {
    const double t = static_cast<double>(i) / 100;
    EXPECT_NEAR(x[i], t < 1 ? t + t * t : 2 + 3 * (t - 1), 2e-3) << i;
  }
  // without an amplitude: at once
  EXPECT_NEAR(end(1, "", dynamic + "*BOUNDARY, TYPE=ACCELERATION\n11, 1, 1, 3.\n"), 6, 1e-9);
}

TEST_F(ImportInpSprings, BaseMotionsThatNoSceneSaysAreNamed) {
  const std::string amplitude = "*AMPLITUDE, NAME=q\n0., 1., 1., 3.\n";
  const std::pair<const char*, const char*> cases[] = {
      {"*STEADY STATE DYNAMICS\n1., 9.\n*BASE MOTION, DOF=1, AMPLITUDE=q\n", "*BASE MOTION of *STEADY STATE DYNAMICS"},
      {"*MODAL DYNAMIC\n.1, 9.\n*BASE MOTION, DOF=1, AMPLITUDE=q\n", "*BASE MOTION of *MODAL DYNAMIC"},
      {"*DYNAMIC\n.1, 9.\n*BASE MOTION, DOF=5, AMPLITUDE=q\n", "*BASE MOTION on degree of freedom 5"},
      {"*DYNAMIC\n.1, 9.\n*BASE MOTION, DOF=1, AMPLITUDE=q, BASE NAME=b\n", "*BASE MOTION, BASENAME=b"},
      {"*STATIC\n*BOUNDARY, TYPE=VELOCITY\n11, 1, 1, 3.\n", "*BOUNDARY, TYPE=VELOCITY, of *STATIC"},
      {"*DYNAMIC\n.1, 9.\n*BOUNDARY, TYPE=ACCELERATION, AMPLITUDE=none\n11, 1, 1, 3.\n",
       "*BOUNDARY, TYPE=ACCELERATION, with *AMPLITUDE NONE"},
      {"*FREQUENCY\n3\n*END STEP\n*STEP\n*MODAL DYNAMIC\n.1, 9.\n*BASE MOTION, DOF=1, AMPLITUDE=q\n", "*BASE MOTION in step 2 and later"},
  };
  for (const auto& [step, what] : cases) {
    imported_deck("a.inp", cube(1) + amplitude + "*STEP\n" + step + "*END STEP\n", "--scene-out s.toml");
    expect_said(std::string("not read: ") + what + " (1,");
    EXPECT_NE(test::text_of(place / "s.toml").find(fmt::format("card = \"{}\"", what)), std::string::npos) << what;
  }
  for (const auto& [card, message] : {std::pair{"*BASE MOTION, DOF=7, AMPLITUDE=q\n", "a.inp:38:19: *BASE MOTION, DOF=7 (1 to 6)"},
                                      {"*BASE MOTION, AMPLITUDE=q\n", "a.inp:38:1: *BASE MOTION lacks DOF="},
                                      {"*BASE MOTION, DOF=1, AMPLITUDE=q, SCALE=x\n", "a.inp:38:41: expected a number, found \"x\""},
                                      {"*BASE MOTION, DOF=1, AMPLITUDE=q, TYPE=JERK\n",
                                       "a.inp:38:40: *BASE MOTION, TYPE=JERK (DISPLACEMENT, VELOCITY or ACCELERATION)"}}) {
    refused_deck("a.inp", cube(1) + amplitude + "*STEP\n*DYNAMIC\n.1, 9.\n" + card + "*END STEP\n", "-o a.h5", 2, message);
  }
}

}  // namespace
}  // namespace hilo::test::import_inp_springs_test
