// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of beams of decks: moments, shear centres, directions, tapers, and a face that is meshed.
#include "beam_case.hpp"
#include "model/thin_regions.hpp"

namespace hilo::test::import_beam_sections_test {
namespace {

using namespace beam_decks;

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
  succeeded(place.run("hilo-import --quiet b.inp -o b.h5 --rigid-beams"));
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

// --face meshes a ring of a .geo script as a section, of which the solver finds A, I and J.
TEST_F(ImportBeam, AFaceOfAScriptBecomesASection) {
  const std::string ring =
      "Point(1) = {0, 0, 0}; Point(2) = {50, 0, 0}; Point(3) = {-50, 0, 0}; Point(4) = {30, 0, 0}; Point(5) = {-30, 0, 0};\n"
      "Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 2}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 4};\n"
      "Curve Loop(1) = {1, 2}; Curve Loop(2) = {3, 4}; Plane Surface(1) = {1, 2};\n";
  place.write("ring.geo", ring);
  const auto face = succeeded(place.run("hilo-import ring.geo --face -o ring.msh --size 12 --json"));
  place.write(
      "s.toml",
      "section.ring = {kind = \"mesh\", file = \"ring.msh\", scale = 1e-3}\nmaterial.m = {E = 2e11, nu = 0.3}\n"
      "beam.b = {points = [[0, 0, 0], [1, 0, 0]], section = \"ring\", material = \"m\", a = \"ground\"}\ntime.analysis = \"static\"\n");
  const auto solved = succeeded(place.run("hilo-solve --quiet s.toml -o s.h5 && hilo-post beam s.h5 --sections"));
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
  refused_deck("lines.geo", "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Line(1) = {1, 2};\n", "--face -o r.msh", 2,
               "lines.geo: no surface to mesh (the face of a section is a plane surface in x and y)");
  place.write("two.geo",
              ring +
                  "Point(11) = {90, 0, 0}; Point(12) = {99, 0, 0}; Point(13) = {90, 9, 0};\n"
                  "Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 11}; Curve Loop(9) = {11, 12, 13}; Plane Surface(2) = {9};\n");
  expect_end(place.run("hilo-import two.geo --face -o r.msh --size 12"), 2, "the face falls into parts");
}

}  // namespace
}  // namespace hilo::test::import_beam_sections_test
