// SPDX-License-Identifier: GPL-3.0-or-later
// Couplings, rigid bodies, masses, springs and dampers of .inp decks: the scene lines that they become are run, and the answer is that of
// statics.
#include <fmt/format.h>

#include <numbers>

#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_inp_ties_test {
namespace {

/// A bar of four cubes of 1 m along x, E = 1 GPa, nu = 0: nodes 1 to 4 at its foot, 17 to 20 at its head; 100 beside the head.
const std::string bar = [] {
  std::string s = "*NODE\n";
  const int y[] = {0, 1, 1, 0}, z[] = {0, 0, 1, 1};
  for (int i = 0; i < 20; ++i) s += fmt::format("{}, {}, {}, {}\n", i + 1, i / 4, y[i % 4], z[i % 4]);
  s += "100, 5., 2., .5\n101, 5., .5, .5\n102, 6., .5, .5\n*ELEMENT, TYPE=C3D8, ELSET=bar\n";
  for (int c = 0; c < 4; ++c) {
    s += fmt::format("{}", c + 1);
    for (int a = 1; a <= 8; ++a) s += fmt::format(", {}", 4 * c + a);
    s += "\n";
  }
  return s +
         "*NSET, NSET=foot, GENERATE\n1, 4\n*NSET, NSET=head, GENERATE\n17, 20\n*NSET, NSET=ref\n100\n*SURFACE, NAME=end\n4, S2\n"
         "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.\n*DENSITY\n1000.\n*SOLID SECTION, ELSET=bar, MATERIAL=m\n";
}();
const std::string held = "*BOUNDARY\nfoot, 1, 3\n", statics = "*STEP\n*STATIC\n";

class ImportInpTies : public test::Import {
 protected:
  void run(const std::string& text) {
    solve(text);
    EXPECT_EQ(err.find("not read"), std::string::npos) << err;
  }
  std::vector<double> foot() const { return last("motion/foot", 6); }
};

// 10 N along z, and 1 2 3 N m, at (5, 2, .5): the foot answers with the opposite about its centre (0, .5, .5), whatever carries them.
TEST_F(ImportInpTies, WhatHangsOnAReferenceNodeIsInBalanceAtTheFoot) {
  const std::string load = statics + "*CLOAD\nref, 3, 10.\nref, 4, 1.\nref, 5, 2.\nref, 6, 3.\n*END STEP\n";
  const std::pair<const char*, std::string> cases[] = {
      {"*COUPLING, kinematic", "*COUPLING, REF NODE=100, SURFACE=end, CONSTRAINT NAME=c\n*KINEMATIC\n1, 6\n"},
      {"*COUPLING, kinematic, of displacements", "*COUPLING, REF NODE=ref, SURFACE=end, CONSTRAINT NAME=c\n*KINEMATIC\n1, 3\n"},
      {"*COUPLING, distributing", "*COUPLING, REF NODE=ref, SURFACE=end, CONSTRAINT NAME=c\n*DISTRIBUTING\n1, 6\n"},
      {"*RIGID BODY of nodes", "*RIGID BODY, NSET=head, REF NODE=100\n"},
  };
  for (const auto& [name, text] : cases) {
    SCOPED_TRACE(name);
    run(bar + text + held + load);
    if (HasFatalFailure()) return;
    const auto r = foot();
    EXPECT_LT((Vec3(r[0], r[1], r[2]) + Vec3(0, 0, 10)).norm(), 1e-5);
    EXPECT_LT((Vec3(r[3], r[4], r[5]) + Vec3(15 + 1, -50 + 2, 3)).norm(), 1e-3) << r[3] << ' ' << r[4] << ' ' << r[5];
  }
  // CalculiX: moments are forces on the node of rotations
  run(bar + "*RIGID BODY, NSET=head, REF NODE=100, ROT NODE=102\n" + held + statics +
      "*CLOAD\n100, 3, 10.\n102, 1, 1.\n102, 2, 2.\n102, 3, 3.\n*END STEP\n");
  const auto r = foot();
  EXPECT_LT((Vec3(r[3], r[4], r[5]) + Vec3(15 + 1, -50 + 2, 3)).norm(), 1e-3) << r[3] << ' ' << r[4] << ' ' << r[5];
}

// 400 N on a spring of 1 kN/mm in a row with the bar: F/k + F l/(E A).
TEST_F(ImportInpTies, SpringsGiveWayByForceOverStiffness) {
  const std::string coupling = "*COUPLING, REF NODE=101, SURFACE=end, CONSTRAINT NAME=c\n*KINEMATIC\n1, 6\n";
  run(bar + coupling + "*ELEMENT, TYPE=SPRINGA, ELSET=s\n50, 101, 102\n*SPRING, ELSET=s\n\n1e6\n" + held + "*BOUNDARY\n102, 2, 6\n" +
      statics + "*CLOAD\n102, 1, 400.\n*END STEP\n");
  const auto u = Store::open(place / "run.h5").read<double>("/history/body/node_102");
  EXPECT_NEAR(u[u.size() - 12] - u[0], 400 / 1e6 + 1.6e-6, 1e-9);
  run(bar + coupling +
      "*ELEMENT, TYPE=SPRING1, ELSET=s\n50, 101\n*SPRING, ELSET=s\n1\n1e6\n*NSET, NSET=mid, GENERATE\n1, 12\n*BOUNDARY\nmid, 2, 3\n" +
      statics + "*CLOAD\n101, 1, 400.\n*END STEP\n");
  const auto x = Store::open(place / "run.h5").read<double>("/history/body/node_101");
  EXPECT_NEAR(x[x.size() - 12] - x[0], 400 / 1e6, 1e-9);
}

// SPRING2 along x between nodes on a line along it, and between nodes at one place: the same answer.
TEST_F(ImportInpTies, SpringsBetweenOneComponentOfTwoNodesToo) {
  const std::string coupling = "*COUPLING, REF NODE=101, SURFACE=end, CONSTRAINT NAME=c\n*KINEMATIC\n1, 6\n*NODE\n103, 5., .5, .5\n";
  for (const std::string node : {"102", "103"}) {
    run(bar + coupling + "*ELEMENT, TYPE=SPRING2, ELSET=s\n50, 101, " + node + "\n*SPRING, ELSET=s\n1, 1\n1e6\n" + held + "*BOUNDARY\n" +
        node + ", 2, 6\n" + statics + "*CLOAD\n" + node + ", 1, 400.\n*END STEP\n");
    const auto u = Store::open(place / "run.h5").read<double>("/history/body/node_" + node);
    EXPECT_NEAR(u[u.size() - 12] - u[0], 400 / 1e6 + 1.6e-6, 1e-9) << node;
  }
  imported_deck("a.inp", bar + coupling + "*ELEMENT, TYPE=SPRING2, ELSET=s\n50, 101, 102\n*SPRING, ELSET=s\n2, 3\n1e6\n",
                "--scene-out s.toml");
  expect_said("not read: *SPRING of SPRING2, but along one component of both nodes");
}

/// The bar as a rigid body whose turns are the displacements of node 102.
const std::string turning = bar + "*NSET, NSET=all, GENERATE\n1, 20\n*RIGID BODY, NSET=all, REF NODE=100, ROT NODE=102\n";

// Truth: F/k along and M/k about each axis, as in CalculiX.
TEST_F(ImportInpTies, SpringsOnARotNodeTurnItsBody) {
  std::string springs;
  for (int k = 0; k < 6; ++k)
    springs += fmt::format("*ELEMENT, TYPE=SPRING1, ELSET=s{0}\n{1}, {2}\n*SPRING, ELSET=s{0}\n{3}\n{4}e5\n", k, 50 + k, k < 3 ? 100 : 102,
                           k % 3 + 1, k + 1);
  run(turning + springs + statics + "*CLOAD\n100, 1, 10.\n100, 2, -20.\n100, 3, 30.\n102, 1, 4.\n102, 2, -5.\n102, 3, 6.\n*END STEP\n");
  const auto u = Store::open(place / "run.h5").read<double>("/history/body/node_100");
  const double *first = u.data(), *end = u.data() + u.size() - 12;  // centre, and the ends of three directors
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(end[k] - first[k], (k == 1 ? -1 : 1) * 1e-4, 1e-12);
  EXPECT_NEAR(end[8] - end[2] - (first[8] - first[2]), 1e-5, 1e-9);
  EXPECT_NEAR(end[5] - end[2] - (first[5] - first[2]), 1e-5, 1e-9);  // about -y
  EXPECT_NEAR(end[4] - end[1] - (first[4] - first[1]), 1e-5, 1e-9);
}

/// A mass of 1 kg in a rigid body whose turns are the displacements of node 202, beside the bar.
const std::string lone =
    "*NODE\n200, 9., 0., 0.\n201, 9., 0., 0.\n202, 9., 0., 0.\n*ELEMENT, TYPE=MASS, ELSET=q\n60, 200\n*MASS, ELSET=q\n1.\n"
    "*NSET, NSET=free\n200\n*RIGID BODY, NSET=free, REF NODE=201, ROT NODE=202\n*BOUNDARY\n201, 1, 3\n";

// Truth: sqrt(k/J)/(2 pi), with J of the bar, 4000 kg ((4^2 + 1)/12 + 3^2 + 1.5^2) m^2, and 1e5 kg m^2 of a *MASS; and under a constant
// moment M the turn M/c (t - J/c (1 - exp(-c t/J))).
TEST_F(ImportInpTies, MassesAndDampersOnARotNodeTurnItsBody) {
  const double J = 1e5, with_bar = 4000 * (17 / 12. + 11.25) + J, c = 3e5;
  const auto mass = [](int node) {
    return fmt::format("*ELEMENT, TYPE=MASS, ELSET=p\n50, {0}\n*MASS, ELSET=p\n1e5\n*BOUNDARY\n{0}, 1, 2\n", node);
  };
  run(turning + mass(102) +
      "100, 1, 3\n*ELEMENT, TYPE=SPRING1, ELSET=s\n51, 102\n*SPRING, ELSET=s\n3\n8e6\n*STEP\n*FREQUENCY\n1\n*END STEP\n");
  EXPECT_NEAR(Store::open(place / "run.h5").read<double>("/history/mode").at(10), std::sqrt(8e6 / with_bar) / (2 * std::numbers::pi), 1e-6);
  run(bar + lone + mass(202) + "foot, 1, 3\n*ELEMENT, TYPE=DASHPOT1, ELSET=s\n51, 202\n*DASHPOT, ELSET=s\n3\n3e5\n" +
      "*STEP\n*DYNAMIC, DIRECT\n.01, 1.\n*CLOAD\n202, 3, 100.\n*END STEP\n");
  const auto u = Store::open(place / "run.h5").read<double>("/history/body/node_201");
  const size_t n = u.size() - 12;
  EXPECT_NEAR(u[n + 4] - u[n + 1] - (u[4] - u[1]), 100 / c * (1 - J / c * (1 - std::exp(-c / J))), 1e-7);
}

// Truth: M/k of a spring between the turns of two bodies, of which one is held.
TEST_F(ImportInpTies, ASpringBetweenTwoRotNodesTurnsOneAgainstTheOther) {
  run(turning + lone +
      "202, 1\n202, 3\n100, 1, 3\n102, 1, 3\n*ELEMENT, TYPE=SPRING2, ELSET=s\n51, 202, 102\n*SPRING, ELSET=s\n2, 2\n4e5\n" + statics +
      "*CLOAD\n202, 2, 4.\n*END STEP\n");
  const auto u = Store::open(place / "run.h5").read<double>("/history/body/node_201");
  const size_t n = u.size() - 12;
  EXPECT_NEAR(u[n + 5] - u[n + 2] - (u[5] - u[2]), -1e-5, 1e-10);
}

TEST_F(ImportInpTies, WhatARotNodeCannotHaveIsTold) {
  const std::pair<std::string, std::string> cases[] = {
      {"*ELEMENT, TYPE=SPRING2, ELSET=s\n50, 102, 101\n*SPRING, ELSET=s\n2, 2\n1e5\n",
       "*SPRING of SPRING2 on a ROT NODE, but linear and along one of its components 1 to 3, the same of two such nodes"},
      {"*ELEMENT, TYPE=SPRING1, ELSET=s\n50, 102\n*SPRING, ELSET=s, NONLINEAR\n2\n0., 0.\n1., 1.\n", "*SPRING of SPRING1 on a ROT NODE"},
      {"*ELEMENT, TYPE=DASHPOTA, ELSET=s\n50, 102, 1\n*DASHPOT, ELSET=s\n\n1e5\n", "*DASHPOT of DASHPOTA on a ROT NODE"},
      {"*ELEMENT, TYPE=MASS, ELSET=s\n50, 102\n*MASS, ELSET=s\n3.\n*STEP\n*STATIC\n*DLOAD\n50, GRAV, 9., 0., 0., 1.\n",
       "*DLOAD GRAV or CENTRIF on a MASS of a ROT NODE"},
  };
  for (const auto& [text, told] : cases) {
    imported_deck("a.inp", turning + text, "--scene-out s.toml");
    expect_said("not read: " + told);
  }
}

TEST_F(ImportInpTies, AMassOnASpringHasTheFrequencyOfTheClosedForm) {
  run(bar +
      "*NSET, NSET=all, GENERATE\n1, 20\n*ELEMENT, TYPE=MASS, ELSET=p\n50, 101\n*MASS, ELSET=p\n2.\n*ELEMENT, TYPE=SPRING1, ELSET=s\n51, "
      "101\n"
      "*SPRING, ELSET=s\n3\n800.\n*BOUNDARY\nall, 1, 3\n101, 1, 2\n101, 4, 6\n*STEP\n*FREQUENCY\n1\n*END STEP\n");
  EXPECT_NEAR(Store::open(place / "run.h5").read<double>("/history/mode").at(10), 20 / (2 * std::numbers::pi), 1e-8);
}

// Masses on nodes of cells and dampers are lines of the scene; what no line says is told.
TEST_F(ImportInpTies, WhatIsLeftOutIsToldByName) {
  place.write(
      "a.inp",
      bar +
          "*ELEMENT, TYPE=MASS, ELSET=p\n50, 17\n51, 18\n*MASS, ELSET=p\n2.\n*ELEMENT, TYPE=DASHPOTA, ELSET=d\n52, 17, 101\n"
          "*DASHPOT, ELSET=d\n\n7.\n*ELEMENT, TYPE=SPRING1, ELSET=q\n53, 17\n*SPRING, ELSET=q, NONLINEAR\n3\n0., 0.\n1., 1.\n"
          "*ORIENTATION, NAME=o\n0., 1., 0., -1., 0., 0.\n"
          "*COUPLING, REF NODE=100, SURFACE=end, CONSTRAINT NAME=c, ORIENTATION=o\n*KINEMATIC\n1, 2\n"
          "*COUPLING, REF NODE=17, SURFACE=end, CONSTRAINT NAME=e\n*KINEMATIC\n1, 6\n*BOUNDARY\n101, 1, 1, .5\n101, 4, 4\n100, 1\n");
  imported("a.inp", "--scene-out s.toml");
  for (const char* what : {"*COUPLING of some components in axes of its own (1,", "*COUPLING whose reference node is a node of a cell (1,",
                           "*BOUNDARY on a node of no cell (1,"})
    expect_said(std::string("not read: ") + what);
  const Scene s = Scene::load(place / "s.toml");
  double mass = 0;
  for (const auto& e : s.entries("point_mass")) mass += e.number("mass");
  EXPECT_EQ(mass, 4);
  ASSERT_EQ(s.entries("spring").size(), 2u);
  EXPECT_EQ(s.entries("spring")[0].number("damping"), 7);
  EXPECT_EQ(s.entries("spring")[1].text("kind"), "curve");
  ASSERT_EQ(s.entries("motion").size(), 1u);
  EXPECT_EQ(s.entries("motion")[0].vector3("displacement"), Vec3(.5, 0, 0));
}

/// A cube in front of the bar's head, of 2 x 2 x 1 cells whose nodes are 201 and on, and *TIE of its back with the head.
std::string tied_cube(const std::string& back, const std::string& tie) {
  std::string s = "*NODE\n";
  for (int i = 0; i < 18; ++i) s += fmt::format("{}, {}, {}, {}\n", 201 + i, 4 + i / 9, (i / 3 % 3) / 2., (i % 3) / 2.);
  s += "*ELEMENT, TYPE=C3D8, ELSET=cube\n";
  for (int c = 0; c < 4; ++c) {
    const int a = 201 + 3 * (c / 2) + c % 2;
    s += fmt::format("{}, {}, {}, {}, {}, {}, {}, {}, {}\n", 11 + c, a, a + 3, a + 4, a + 1, a + 9, a + 12, a + 13, a + 10);
  }
  return s + "*SOLID SECTION, ELSET=cube, MATERIAL=m\n*NSET, NSET=middle\n214\n" + back + "*TIE, NAME=weld" + tie + "\nback, end\n";
}

// Truth: a pull of 10 N at the middle of the cube's front comes out at the foot.
TEST_F(ImportInpTies, TiedSurfacesCarryWhatIsPulled) {
  for (const auto& [back, tie] : {std::pair{"*SURFACE, NAME=back\ncube, S1\n", ", POSITION TOLERANCE=0.1"},
                                  {"*NSET, NSET=behind, GENERATE\n201, 209\n*SURFACE, NAME=back, TYPE=NODE\nbehind\n", ", ADJUST=NO"}}) {
    run(bar + tied_cube(back, tie) + held + statics + "*CLOAD\nmiddle, 1, 10.\nmiddle, 2, 1.\n*END STEP\n");
    const auto f = foot();
    EXPECT_NEAR(f[0], -10, 1e-6);
    EXPECT_NEAR(f[1], -1, 1e-6);
    EXPECT_NEAR(f[5], -5, 1e-4) << "1 N at 5 m, less what 10 N do as it bends";
    const Scene s = Scene::load(place / "s.toml");
    ASSERT_EQ(s.entries("tie").size(), 1u);
    EXPECT_EQ(s.entries("tie")[0].text("a"), "end");
    EXPECT_EQ(s.entries("tie")[0].has("gap"), std::string(tie).find("TOL") != std::string::npos);
    EXPECT_EQ(err.find("ADJUST=NO") != std::string::npos, std::string(tie).find("ADJUST") != std::string::npos) << err;
  }
}

}  // namespace
}  // namespace hilo::test::import_inp_ties_test
