// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of decks as beams of the scene, run and compared with closed forms.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"
#include "model/scene.hpp"
#include "model/thin_regions.hpp"
#include "succeeded.hpp"

namespace hilo {
namespace {

using std::numbers::pi;

class ImportBeam : public test::ImportAndRun {
 protected:
  /// Imports and runs a deck.
  void solve(const std::string& text, const std::string& file = "a.bdf", const std::string& options = "") {
    place.write(file, text);
    const auto ran = test::succeeded(
        place.run("hilo-import --quiet " + file + " -o out.h5 --scene-out a.toml " + options + " && hilo-solve a.toml -o run.h5"));
    table = ran.out;
    told = ran.err;
  }
  Vec3 moved(const std::string& body) {
    const auto v = change("body." + body + "*");
    return {v[0], v[1], v[2]};
  }
  std::string told;
};

const std::string stat = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n";
const std::string modes = "SOL 103\nCEND\nSPC = 1\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,3\n";
const std::string steel = "MAT1,1,2.1+11,,.3,7850.\n";
constexpr double E = 2.1e11, G = E / 2.6;

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
  place.write("t.bdf", deck("PLOAD1,2,2,MZ,FR,0.,.3,1.,.3\n"));
  imported("t.bdf", "--scene-out t.toml");
  expect_said("PLOAD1 of moments per length");
  const auto wrong = [&](const std::string& line, const std::string& why) {
    place.write("w.bdf", deck(line));
    refused("w.bdf -o b.h5 --scene-out w.toml", 2, "w.bdf:15:" + why);
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

// Shapes of rectangles: how far a cantilever of 1 m bends in both planes and twists, by A, I and J of the parts; thin open parts have
// J = sum b t^3/3 to a tenth (where walls meet they are stiffer), closed ones Bredt's.
TEST_F(ImportBeam, ShapesOfRectanglesHaveTheirMoments) {
  struct Shape {
    const char *type, *dims;
    double I1, I2, J;
  };
  const auto flat = [](double w, double h) { return w * h * h * h / 12; };  // of a rectangle about its middle, h across the axis
  const auto two = [](double A, double B, double apart) { return A * B / (A + B) * apart * apart; };
  const double t = .002;
  const Shape shapes[] = {
      {"H", ".04,.004,.06,.002", 2 * flat(t, .06) + flat(.04, t), flat(t, .04) + 2 * flat(.06, t) + 2 * .06 * t * .021 * .021,
       (.12 + .04) * t * t * t / 3},
      {"CROSS", ".058,.002,.05,.002", flat(t, .05) + flat(.058, t), flat(.05, t) + flat(t, .06) - flat(t, t), (.05 + .058) * t * t * t / 3},
      {"T1", ".06,.04,.002,.002", flat(t, .06) + flat(.04, t), flat(.06, t) + flat(t, .04) + two(.06 * t, .04 * t, .021),
       .1 * t * t * t / 3},
      {"T2", ".06,.042,.002,.002", flat(.06, t) + flat(t, .04) + two(.06 * t, .04 * t, .021), flat(t, .06) + flat(.04, t),
       .1 * t * t * t / 3},
      {"CHAN1", ".03,.002,.056,.06", flat(t, .06) + 2 * flat(.03, t) + 2 * .03 * t * .029 * .029,
       flat(.06, t) + 2 * flat(t, .03) + two(.06 * t, 2 * .03 * t, .016), (.06 + .06) * t * t * t / 3},
      {"CHAN2", ".002,.002,.03,.06", 2 * flat(t, .03) + flat(.056, t) + two(2 * .03 * t, .056 * t, .014),
       2 * flat(.03, t) + 2 * .03 * t * .029 * .029 + flat(t, .056), (.06 + .056) * t * t * t / 3},
      {"BOX1", ".06,.04,.002,.004,.002,.002", 0, 2 * flat(.04, t) + 2 * .04 * t * .029 * .029 + flat(.006, .056),
       4 * std::pow(.058 * .037, 2) / (.058 / .002 + .058 / .004 + 2 * .037 / .002)},
      {"I", ".06,.05,.03,.002,.002,.004", 0, flat(t, .05) + flat(.004, .03) + flat(.054, t),
       (.05 * t * t * t + .03 * 8 * t * t * t + .054 * t * t * t) / 3},
  };
  for (const Shape& s : shapes) {
    solve(stat + "GRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,3.,1.,0.\nGRID,5,,0.,2.,0.\nGRID,6,,3.,2.,0.\n" +
          "CBAR,1,5,1,2,0.,1.,0.\nCBAR,2,5,3,4,0.,1.,0.\nCBAR,3,5,5,6,0.,1.,0.\nPBARL,5,1,," + s.type + ",,,,,+\n+," + s.dims + "\n" +
          steel + "SPC1,1,123456,1,3,5\nFORCE,2,2,,.01,0.,1.,0.\nFORCE,2,4,,.01,0.,0.,1.\nMOMENT,2,6,,1.-4,1.,0.,0.\n");
    if (s.I1 > 0) {
      EXPECT_NEAR(moved("grid_2").y() / (.09 / (E * s.I1)), 1, .005) << s.type;
    }
    EXPECT_NEAR(moved("grid_4").z() / (.09 / (E * s.I2)), 1, .005) << s.type;
    const auto v = change("body.grid_6*");
    EXPECT_NEAR((v[8] - v[2]) / (3e-4 / (G * s.J)), 1, .1) << s.type << ", twist";
  }
}

// One element of 3 m: I1 falls evenly to a quarter, or the height of a bar to a half, which has its shear too; its weight is that of all of
// it.
TEST_F(ImportBeam, PropertiesThatTaperDoSoEvenly) {
  const auto tip = [&](const std::string& property, const std::string& load) {
    solve(stat + "GRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\nCBEAM,1,5,1,2,0.,1.,0.\n" + steel + property + "SPC1,1,123456,1\n" + load);
    return moved("grid_2").y();
  };
  const std::string push = "FORCE,2,2,,.01,0.,1.,0.\n";
  const double L = 3, end = 2e-7, rise = 6e-7 / L;
  const double bent = .01 / E * (L * L / (2 * rise) - end * L / (rise * rise) + end * end / (rise * rise * rise) * std::log(4.));
  EXPECT_NEAR(tip("PBEAM,5,1,2.-3,8.-7,4.-7,,2.-7,,+\n+,,,,,,,,,+\n+,NO,1.,1.-3,2.-7,1.-7,,5.-8\n", push) / bent, 1, 5e-4);
  const auto held = change("beam.CBEAM_1*");
  EXPECT_NEAR(std::hypot(held[3], held[4]), .03, 1e-6) << "the moment at the root";
  const double h0 = .06, h1 = .03, b = .02, a = (h0 - h1) / L, k = 10 * 1.3 / (12 + 11 * .3);
  const double bar = 12 * .01 / (E * b * a * a * a) * (std::log(h0 / h1) + 2 * h1 / h0 - h1 * h1 / (2 * h0 * h0) - 1.5) +
                     .01 / (k * G * b * a) * std::log(h0 / h1);
  const std::string bars = "PBEAML,5,1,,BAR,,,,,+\n+,.02,.06,0.,YES,1.,.02,.03,0.\n";
  EXPECT_NEAR(tip(bars, push) / bar, 1, 5e-4);
  tip(bars, "GRAV,2,,1.-3,0.,1.,0.\n");
  const auto root = change("beam.CBEAM_1*");
  EXPECT_NEAR(std::hypot(root[0], root[1]), 7850 * b * (h0 + h1) / 2 * L * 1e-3, 1e-9);
}

// A cantilever of 3 m under a force at its tip, then under its weight, by the sums of rectangles in y and z of the element.
TEST_F(ImportBeam, ShapesThatLeanBendAskewAndWeighTheirArea) {
  struct Shape {
    const char *type, *dims;
    std::vector<std::array<double, 4>> parts;  // from y, to y, from z, to z
  };
  const double t = .002;
  const Shape shapes[] = {
      {"L", ".06,.04,.002,.002", {{0, .04, 0, t}, {0, t, t, .06}}},
      {"Z", ".03,.002,.036,.04", {{0, .04, 0, t}, {.04 - t, .04, -.03, 0}, {0, t, t, .03 + t}}},
      {"HAT",
       ".04,.002,.05,.02",
       {{.04 - t, .04, -.025, .025},
        {t, .04 - t, -.025, -.025 + t},
        {t, .04 - t, .025 - t, .025},
        {0, t, -.045, -.025 + t},
        {0, t, .025 - t, .045}}},
      {"HAT1",
       ".09,.044,.05,.002,.004",
       {{0, .004, -.045, .045},
        {.004, .004 + t, -.045, -.025 + t},
        {.004, .004 + t, .025 - t, .045},
        {.004 + t, .042, -.025, -.025 + t},
        {.004 + t, .042, .025 - t, .025},
        {.042, .044, -.025, .025}}},
  };
  for (const Shape& s : shapes) {
    double A = 0;
    Eigen::Vector2d S = Eigen::Vector2d::Zero();
    Eigen::Matrix2d I = Eigen::Matrix2d::Zero();
    for (const auto& [y0, y1, z0, z1] : s.parts) {
      const double a = (y1 - y0) * (z1 - z0);
      const Eigen::Vector2d c((y0 + y1) / 2, (z0 + z1) / 2);
      A += a, S += a * c, I += a * c * c.transpose();
      I.diagonal() += a / 12 * Eigen::Vector2d((y1 - y0) * (y1 - y0), (z1 - z0) * (z1 - z0));
    }
    I -= S * S.transpose() / A;
    const auto tip = [&](const std::string& load) {
      solve(stat + "GRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\nCBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,," + s.type + ",,,,,+\n+," + s.dims + "\n" +
            steel + "SPC1,1,123456,1\n" + load);
      const Vec3 u = moved("grid_2");
      return Eigen::Vector2d(u.y(), u.z());
    };
    for (const auto& along : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)}) {
      const Eigen::Vector2d pushed = I.inverse() * along * .01 * 9 / E, sags = I.inverse() * along * 7850 * A * 1e-3 * 81 / (8 * E);
      EXPECT_LT((tip(fmt::format("FORCE,2,2,,.01,0.,{:.1f},{:.1f}\n", along[0], along[1])) - pushed).norm(), .005 * pushed.norm())
          << s.type;
      EXPECT_LT((tip(fmt::format("GRAV,2,,1.-3,0.,{:.1f},{:.1f}\n", along[0], along[1])) - sags).norm(), .005 * sags.norm()) << s.type;
    }
  }
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

TEST_F(ImportBeam, SecondMomentsBendInTheirPlanesAndI12CouplesThem) {
  const auto run = [&](const std::string& force) {
    solve(stat + "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCBAR,1,5,1,2,0.,0.,1.\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7,,,+\n+,,,,,,,,,+\n+,,,1.-7\n" +
          steel + "SPC1,1,123456,1\nFORCE,2,2,,1.," + force + "\n");
    return moved("grid_2");
  };
  // y of the element is z of the model, its z is -y: int yz dA = 1e-7 turns a load along z towards -y... by the inverse of the moments
  Eigen::Matrix2d I;
  I << 4e-7, 1e-7, 1e-7, 1e-7;
  const Eigen::Vector2d u = I.inverse() * Eigen::Vector2d(1, 0) / (3 * E);  // along element y and z
  const Vec3 z = run("0.,0.,1.");
  EXPECT_NEAR(z.z(), u[0], 1e-4 * u[0]);
  EXPECT_NEAR(z.y(), -u[1], 1e-4 * std::abs(u[1]));
  const Vec3 y = run("0.,1.,0.");
  EXPECT_NEAR(y.z(), z.y(), 1e-6 * std::abs(z.y())) << "Maxwell's reciprocity";
}

// A channel 30 high, 10 wide, web 2, flanges 6, as one of others' decks has it: bends by the moments of its rectangles, and does not twist.
TEST_F(ImportBeam, AChannelOfABarBendsAboutItsCentreOfArea) {
  solve(stat +
        "GRID,1,,0.,0.,0.\nGRID,2,,1000.,0.,0.\nCBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,CHAN,,,,,+\n+,10.,30.,2.,6.\nMAT1,1,3.+7,,.3\n"
        "SPC1,1,123456,1\nFORCE,2,2,,1.,0.,0.,1.\nFORCE,2,2,,1.,0.,1.,0.\n");
  const double A = 30 * 10 - 18 * 8, x = (60 + 2 * 48 * 6) / A,
               Iz = (30 * 8. + 2 * 6 * 512) / 12 + 60 * (x - 1) * (x - 1) + 96 * (6 - x) * (6 - x);
  const double Iy = (10. * 27000 - 8. * 5832) / 12, bend = 1e9 / (3 * 3e7);
  EXPECT_NEAR(moved("grid_2").y(), bend / Iy, 0.01 * bend / Iy);  // shear: 0.3 %
  EXPECT_NEAR(moved("grid_2").z(), bend / Iz, 0.01 * bend / Iz);
  const auto v = change("body.grid_2*");
  EXPECT_NEAR(v[8], v[2], 1e-9) << "no twist";
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

/// A block of nodes 11 to 18 at x = 2 to 3, and the rest of a deck whose beams are in E.
const std::string block =
    "11,2,0,0\n12,3,0,0\n13,3,1,0\n14,2,1,0\n15,2,0,1\n16,3,0,1\n17,3,1,1\n18,2,1,1\n*ELEMENT,TYPE=C3D8,ELSET=S\n50,11,12,13,14,15,16,17,"
    "18\n";
const std::string section =
    "*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=RECT\n.04,.04\n0,1,0\n*SOLID "
    "SECTION,ELSET=S,MATERIAL=M\n*MATERIAL,NAME=M\n*ELASTIC\n2.1e11,.3\n*DENSITY\n7850.\n";

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

TEST_F(ImportBeam, SectionsOfInpDecksBendInTheirDirections) {
  const auto tip = [&](const std::string& section, const std::string& load, const std::string& type = "B31") {
    solve("*NODE,NSET=ALL\n1,0,0,0\n2,.5,0,0\n3,1,0,0\n*ELEMENT,TYPE=" + type +
              ",ELSET=E\n1,1,2\n2,2,3\n*MATERIAL,NAME=M\n*ELASTIC\n2.1e11,.3\n" + section + "*BOUNDARY\n1,1,6\n*STEP\n*STATIC\n*CLOAD\n3," +
              load + "\n*END STEP\n",
          "a.inp");
    return moved("node_3");
  };
  const double P = 1e-3;
  const auto near = [&](double u, double I, double kGA) { EXPECT_NEAR(u, P * (1 / (3 * E * I) + 1 / kGA), 1e-5 * P / (3 * E * I)); };
  const std::string of = "*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=";
  const double k = 10 * 1.3 / (12 + 11 * .3);
  near(tip(of + "RECT\n.02,.05\n0,1,0\n", "2,1e-3").y(), .05 * 8e-6 / 12, k * G * .001);  // .02 along n1 = y
  near(tip(of + "RECT\n.02,.05\n0,1,0\n", "3,1e-3").z(), .02 * 125e-6 / 12, k * G * .001);
  near(tip(of + "CIRC\n.01,.01\n0,1,0\n", "2,1e-3").y(), pi * std::pow(.005, 4) / 4, 7.8 / 8.8 * G * pi * 25e-6);  // CalculiX: diameters
  near(tip("*BEAM GENERAL SECTION,ELSET=E\n1e-3,4e-7,0,1e-7,2e-7\n0,1,0\n2.1e11,8e10\n", "2,1e-3").y(), 1e-7, 8e10 * 1e-3);
  near(tip(of + "RECT\n.02,.05\n0,1,0\n", "3,1e-3", "B33").z(), .02 * 125e-6 / 12, 1e4 * E * .001);  // no shear strain
  // the nodes lie on the lower face, half of .02 below the line: a pull bends the end up
  const Vec3 up = tip(of + "RECT,OFFSET1=-.5\n.02,.05\n0,1,0\n", "1,1.");
  EXPECT_NEAR(up.y(), .01 / (2 * E * .05 * 8e-6 / 12), 1e-4 * 7e-7);
  tip(of + "CIRC\n.01\n0,1,0\n", "2,1e-3");
  EXPECT_NE(told.find("its one number is the radius, as in Abaqus"), std::string::npos) << told;
}

// A node beside an element says its direction 1, before the direction of its section.
TEST_F(ImportBeam, ANodeOfTheOrientationTurnsTheSection) {
  const std::string deck =
      "*NODE,NSET=ALL\n1,0,0,0\n2,.5,0,0\n3,1,0,0\n9,0,1,0\n*ELEMENT,TYPE=B31,ELSET=E\n1,1,2,9\n2,2,3,9\n*MATERIAL,NAME=M\n*ELASTIC\n"
      "2.1e11,.3\n*DENSITY\n7850\n*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=RECT\n.02,.05\n0,0,-1\n*BOUNDARY\n1,1,6\n*STEP\n*STATIC\n";
  solve(deck + "*CLOAD\n3,2,1e-3\n3,3,1e-3\n*END STEP\n", "a.inp");
  const Vec3 u = moved("node_3");
  EXPECT_NEAR(u.y() / (1e-3 / (3 * E * .05 * 8e-6 / 12)), 1, 5e-3) << "shear";
  EXPECT_NEAR(u.z() / (1e-3 / (3 * E * .02 * 125e-6 / 12)), 1, 5e-3);
  // as a rigid region: the second moment about x and y of .02 along y, .05 along z
  place.write("b.inp", deck + "*END STEP\n");
  test::succeeded(place.run("hilo-import --quiet b.inp -o b.h5 --rigid-beams"));
  const auto moments = read_thin_regions(place / "b.h5").at(0).moments;
  EXPECT_NEAR(moments[0], 1e-3, 1e-12);
  EXPECT_NEAR(moments[5], 1e-3 * .0004 / 12, 1e-6 * 1e-3 * .0004 / 12) << "yy";
  EXPECT_NEAR(moments[6], 1e-3 * .0025 / 12, 1e-6 * 1e-3 * .0025 / 12) << "zz";
}

// I of two flanges, a T, and an I whose nodes lie below it: a pull along the nodes bends by the arm of the centre of area; weight.
TEST_F(ImportBeam, AnIOfTwoFlangesLiesWhereItsOriginSays) {
  const double t = .002, h = .06;
  struct Shape {
    double origin, b1, b2;
  };
  for (const auto& [origin, b1, b2] : {Shape{.01, .03, .05}, Shape{0, 0, .05}, Shape{.05, .04, 0}, Shape{0, .04, .04}}) {
    const double t1 = b1 > 0 ? t : 0, t2 = b2 > 0 ? t : 0, hw = h - t1 - t2, A = b1 * t1 + b2 * t2 + hw * t,
                 c = (b1 * t1 * t1 / 2 + b2 * t2 * (h - t2 / 2) + hw * t * (t1 + hw / 2)) / A,
                 I1 = b1 * std::pow(t1, 3) / 12 + b1 * t1 * std::pow(c - t1 / 2, 2) + b2 * std::pow(t2, 3) / 12 +
                      b2 * t2 * std::pow(h - t2 / 2 - c, 2) + t * hw * hw * hw / 12 + t * hw * std::pow(t1 + hw / 2 - c, 2);
    const auto tip = [&](const std::string& load) {
      solve(fmt::format("*NODE,NSET=ALL\n1,0,0,0\n2,1.5,0,0\n3,3,0,0\n*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n2,2,3\n*MATERIAL,NAME=M\n"
                        "*ELASTIC\n2.1e11,.3\n*DENSITY\n7850\n*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=I\n{},{},{},{},{},{},{}\n"
                        "0,1,0\n*BOUNDARY\n1,1,6\n*STEP\n*STATIC\n",
                        origin, h, b1, b2, t1, t2, t) +
                load + "*END STEP\n",
            "a.inp");
      return moved("node_3").z();
    };
    EXPECT_NEAR(tip("*CLOAD\n3,1,.1\n") / (.1 * (c - origin) * 9 / (2 * E * I1)), 1, .003) << b1 << " " << b2;
    EXPECT_NEAR(tip("*DLOAD\nE,GRAV,1e-3,0,0,1\n") / (7850 * A * 1e-3 * 81 / (8 * E * I1)), 1, .005) << b1 << " " << b2;
  }
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
  const auto ran = test::succeeded(place.run("hilo-solve a.toml out.h5 -o b.h5"));
  EXPECT_NE(ran.err.find("out.h5 has no cells: the run goes without it"), std::string::npos) << ran.err;
}

TEST_F(ImportBeam, WhatABeamCannotCarryIsRefusedOrTold) {
  const std::string those =
      " (ROD, TUBE, TUBE2, BAR, BOX, BOX1, I, I1, H, CROSS, T, T1, T2, CHAN, CHAN1, CHAN2, L, Z, HAT and HAT1 are; write the others as "
      "PBAR)";
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\n" + steel;
  place.write("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,DBOX,,,,,+\n+,.2,.4\n");
  refused("a.bdf -o b.h5", 2, "a.bdf:5:12: PBARL 5: TYPE DBOX is not read" + those);
  place.write("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,BOX,,,,,+\n+,.1,.2,.12,.06\n");
  refused("a.bdf -o b.h5", 2, "a.bdf:5:12: PBARL 5: TYPE BOX with such walls is not read" + those);
  place.write("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,BOX1,,,,,+\n+,.1,.2,.02,.01,.02,.01\n");
  refused("a.bdf -o b.h5", 2, "a.bdf:5:12: PBARL 5: TYPE BOX1 that is askew is not read" + those);
  place.write("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,HAT,,,,,+\n+,.2,.03,.05,.1\n");
  refused("a.bdf -o b.h5", 2, "a.bdf:5:12: PBARL 5: TYPE HAT with such walls is not read" + those);
  for (const auto& [type, dims, blank] : {std::tuple{"TUBE", ".1", 2}, std::tuple{"I1", ",.1,.2,.3", 1}}) {
    place.write("a.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,," + type + ",,,,,+\n+," + dims + "\n");
    refused("a.bdf -o b.h5", 2, fmt::format("a.bdf:5:12: PBARL 5: TYPE {} without DIM{} is not read{}", type, blank, those));
  }
  place.write("b.bdf", grids + "CBAR,1,5,1,2,1.,0.,0.\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\n");
  refused("b.bdf -o b.h5", 2, "b.bdf:4:6: beam 1: its orientation lies along it, or is none");
  place.write("c.bdf", grids + "CBAR,1,5,1,2,1.,0.,0.,GOG,+\n+,,,,1.\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\n");
  refused("c.bdf -o b.h5", 2, "c.bdf:4:6: CBAR 1: OFFT GOG, and its orientation lies along the line of its grids, or is none");
  place.write("c.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.,OGG\nPBAR,5,1,1.-3,4.-7,1.-7,2.-7\n");
  refused("c.bdf -o b.h5", 2, "c.bdf:4:23: CBAR: OFFT OGG is not three of G, B, O, the first of them G or B");
  place.write("d.bdf", grids + "CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,9,1.-3,4.-7,1.-7,2.-7\n");
  refused("d.bdf -o b.h5", 2, "d.bdf:5: property 5 of beams has no material (MAT1)");
  place.write("f.bdf", grids +
                           "CBEAM,1,5,1,2,0.,1.,0.\nPBEAM,5,1,1.-3,4.-7,1.-7,,2.-7,,+\n+,,,,,,,,,+\n+,NO,.5,1.-3,4.-7,1.-7,,2.-7,,+\n+,NO,"
                           "1.,2.-3,8.-7,2.-7,,4.-7\n");
  imported("f.bdf", "--scene-out f.toml");
  expect_said("not read: PBEAM with stations between its ends: it varies evenly from end to end");
  place.write("g.bdf", grids + "CBEAM,1,5,1,2,0.,1.,0.\nPBEAML,5,1,,BAR,,,,,+\n+,.1,.1,0.,YES,.5,.1,.1,0.,+\n+,YES,1.,.05,.05,0.\n");
  imported("g.bdf", "--scene-out g.toml");
  expect_said("not read: PBEAML with stations between its ends: it varies evenly from end to end");
  const std::string nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n";
  const std::string beam_section = "*MATERIAL,NAME=M\n*ELASTIC\n2e11,.3\n*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=";
  place.write("a.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2,7\n" + beam_section + "RECT\n.1,.2\n");
  refused("a.inp -o b.h5", 2, "a.inp:10:21: element 1 is turned towards node 7, which does not exist");
  place.write("a.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2,3\n*ELGEN,ELSET=E\n1,2,1,1\n" + beam_section + "RECT\n.1,.2\n");
  refused("a.inp -o b.h5", 2,
          "a.inp:8:1: *ELGEN of element 1, which has a node of its orientation: that of its copies is not clear (write the elements out)");
  place.write("a.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n" + beam_section + "L\n.1,.1,.01,.01\n");
  refused("a.inp -o b.h5", 2,
          "a.inp:10:42: *BEAM SECTION, SECTION=L is not read (RECT, CIRC, PIPE, BOX and I are; a T is an I with one flange of no width)");
  place.write("b.inp", nodes + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,2\n");
  refused("b.inp -o b.h5", 2, "b.inp:6:1: element 1 has no section (beams need *BEAM SECTION)");
  const std::string both = "*NODE\n1,0,0,0\n99,0,3,0\n" + block + "*ELEMENT,TYPE=B31,ELSET=E\n1,1,11\n*ELSET,ELSET=ALL\n1,50\n" + section;
  place.write(
      "c.inp",
      both + "*INITIAL CONDITIONS,TYPE=VELOCITY\n11,3,2.\n12,3,2.\n*RELEASE\n1,S1,M1\n*STEP\n*STATIC\n*DLOAD\nALL,P1,5.\n*END STEP\n");
  imported("c.inp", "--scene-out c.toml");
  for (const char* lost :
       {"*INITIAL CONDITIONS, TYPE=VELOCITY on a node of a beam or a tie", "*RELEASE", "*DLOAD on elements that are no cells"})
    expect_said(lost);
  EXPECT_EQ(place.run("grep -c 'loss = \"tie\"' c.toml").out, "1\n");
  place.write("d.inp", both + "*SURFACE,NAME=U,TYPE=NODE\n99\n*COUPLING,CONSTRAINT NAME=C,REF NODE=1,SURFACE=U\n*KINEMATIC\n1,6\n");
  refused("d.inp -o d.h5", 2, "d.inp:29: *COUPLING: no node of surface \"U\" is of a cell or a beam");
}

// --face meshes a ring of a .geo script as a section, of which the solver finds A, I and J.
TEST_F(ImportBeam, AFaceOfAScriptBecomesASection) {
  const std::string ring =
      "Point(1) = {0, 0, 0}; Point(2) = {50, 0, 0}; Point(3) = {-50, 0, 0}; Point(4) = {30, 0, 0}; Point(5) = {-30, 0, 0};\n"
      "Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 2}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 4};\n"
      "Curve Loop(1) = {1, 2}; Curve Loop(2) = {3, 4}; Plane Surface(1) = {1, 2};\n";
  place.write("ring.geo", ring);
  const auto face = test::succeeded(place.run("hilo-import ring.geo --face -o ring.msh --size 12 --json"));
  place.write(
      "s.toml",
      "section.ring = {kind = \"mesh\", file = \"ring.msh\", scale = 1e-3}\nmaterial.m = {E = 2e11, nu = 0.3}\n"
      "beam.b = {points = [[0, 0, 0], [1, 0, 0]], section = \"ring\", material = \"m\", a = \"ground\"}\ntime.analysis = \"static\"\n");
  const auto solved = test::succeeded(place.run("hilo-solve --quiet s.toml -o s.h5 && hilo-post beam s.h5 --sections"));
  double A = 0, I1 = 0, I2 = 0, I12 = 0, J = 0;
  ASSERT_EQ(std::sscanf(solved.out.substr(solved.out.find('\n') + 1).c_str(), "b %lf %lf %lf %lf %lf", &A, &I1, &I2, &I12, &J), 5)
      << solved.out;
  const double four = std::pow(0.05, 4) - std::pow(0.03, 4);
  EXPECT_NEAR(A, M_PI * (0.05 * 0.05 - 0.03 * 0.03), 1e-3 * A);
  EXPECT_NEAR(I1, M_PI / 4 * four, 1e-3 * I1);
  EXPECT_NEAR(J, M_PI / 2 * four, 1e-3 * J);
  refused("ring.geo --face -o ring.h5", 1, "--face writes a mesh of gmsh: -o ring.h5 does not end in .msh (see hilo-import --help)");
  refused("ring.geo --face -o r.msh --units mm-t-s", 1,
          "--units beside --face: the face keeps the lengths of the file (`scale` in [section.NAME])");
  refused("ring.msh --face -o r.msh", 2,
          "ring.msh: no geometry that a face can be meshed of (a .geo, .step, .brep or .iges file; a scene names a .msh file itself)");
  place.write("lines.geo", "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Line(1) = {1, 2};\n");
  refused("lines.geo --face -o r.msh", 2, "lines.geo: no surface to mesh (the face of a section is a plane surface in x and y)");
  place.write("two.geo",
              ring +
                  "Point(11) = {90, 0, 0}; Point(12) = {99, 0, 0}; Point(13) = {90, 9, 0};\n"
                  "Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 11}; Curve Loop(9) = {11, 12, 13}; Plane Surface(2) = {9};\n");
  expect_end(place.run("hilo-import two.geo --face -o r.msh --size 12"), 2, "the face falls into parts");
}

}  // namespace
}  // namespace hilo
