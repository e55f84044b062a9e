// SPDX-License-Identifier: GPL-3.0-or-later
// Nastran files as they are written: tabs, included files, continuations, and grids in systems of their own.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"

namespace hilo::test::import_bdf_fields_test {
namespace {

using test::volume;
using ImportBdfFields = test::Import;

const std::string tet = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\nCTETRA,1,1,1,2,3,4\n";
const std::string steel = "PSOLID,1,1\nMAT1,1,2.1+11,,0.3,7850.\n";

std::string field(const std::string& text, size_t width) { return text + std::string(width - std::min(width, text.size()), ' '); }

/// An entry in one of six forms: small, large, free, large free, small with tabs, small with named continuations.
std::string entry(int form, const std::string& name, const std::vector<std::string>& f) {
  const bool large = form == 1 || form == 3, free = form == 2 || form == 3;
  const size_t per_line = large ? 4 : 8, width = large ? 16 : 8;
  std::string s;
  for (size_t from = 0, n = 0; from < f.size(); from += per_line, ++n) {
    const std::string mark = form == 5 ? fmt::format("+E{}", n) : large ? "*" : free ? "" : "+";
    const std::string first = from == 0 ? name + (large ? "*" : "") : mark;
    s += free ? first : form == 4 ? first : field(first, 8);
    for (size_t i = from; i < from + per_line; ++i) {
      const std::string text = i < f.size() ? f[i] : "";
      s += free ? "," + text : form == 4 ? "\t" + text : field(text, width);
    }
    if (form == 5) s += fmt::format("+E{}", n + 1);
    s += form == 2 && n == 0 ? ",+\n" : "\n";
  }
  return s;
}

// One cell of twenty nodes, bent, and its material; every form says the same.
TEST_F(ImportBdfFields, EveryFormOfFieldsSaysTheSameModel) {
  const double corner[8][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 3}, {2, 0, 3}, {2, 1, 3}, {0, 1, 3}};
  const int edge[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};  // Nastran's
  for (int form = 0; form < 6; ++form) {
    std::string text;
    std::vector<std::string> hexa{"7", "5"};
    for (int a = 0; a < 20; ++a) {
      std::vector<std::string> grid{fmt::format("{}", a + 1), ""};
      for (int k = 0; k < 3; ++k)
        grid.push_back(fmt::format("{:.3f}", a < 8 ? corner[a][k] : (corner[edge[a - 8][0]][k] + corner[edge[a - 8][1]][k]) / 2));
      text += entry(form, "GRID", grid);
      hexa.push_back(grid[0]);
    }
    text += entry(form, "CHEXA", hexa) + entry(form, "PSOLID", {"5", "9"}) + entry(form, "MAT1", {"9", "2.1+11", "", ".3", "7.85+3"});
    const Mesh m = imported_deck("a.bdf", text);
    ASSERT_EQ(m.n_cells(), 1) << form;
    EXPECT_EQ(static_cast<Shape>(m.shape[0]), Shape::hex20r) << form;
    EXPECT_NEAR(volume(m), 6, 1e-12) << form;
    EXPECT_EQ(m.cell_id[0], 7) << form;
    EXPECT_DOUBLE_EQ(m.region_data[0].E, 2.1e11) << form;
    EXPECT_DOUBLE_EQ(m.region_data[0].density, 7850) << form;
    EXPECT_EQ(err, "") << form;
  }
}

TEST_F(ImportBdfFields, ADensityOfZeroOrNoneIsAbsentAndToldOnce) {
  for (const char* rho : {"0.", "", "0.0"}) {
    const Mesh m = imported_deck("a.bdf", tet + "PSOLID,1,1\nMAT1,1,2.1+11,,0.3," + rho + "\nMAT1,2,7.+10,,0.3\n");
    EXPECT_TRUE(std::isnan(m.region_data[0].density)) << rho;
    EXPECT_DOUBLE_EQ(m.region_data[0].E, 2.1e11) << rho;
    expect_said("a.bdf:7: RHO is 0 or blank in 2 of 2 materials (1, 2): no density\n");
    EXPECT_EQ(err.find("RHO"), err.rfind("RHO")) << err;
  }
}

TEST_F(ImportBdfFields, IncludedFilesAreFoundFromTheFileThatNamesThem) {
  std::filesystem::create_directories(place.path() / "sub/deep");
  place.write("a.bdf", "SOL 101\nCEND\nINCLUDE 'sub/case.txt'\nBEGIN BULK\nINCLUDE 'sub/mesh.bdf'\n" + steel + "ENDDATA\n");
  place.write("sub/case.txt", "TITLE = included\n");
  place.write("sub/mesh.bdf", "include \"deep\\\n grids.bdf\"\nCTETRA,1,1,1,2,3,4\n");  // over two lines, as other systems write paths
  place.write("sub/deep/grids.bdf", tet.substr(0, tet.find("CTETRA")));
  const Mesh m = imported("a.bdf", "--scene-out s.toml");
  EXPECT_NEAR(volume(m), 1. / 6, 1e-15);
  EXPECT_DOUBLE_EQ(m.region_data[0].density, 7850);
  EXPECT_NE(test::text_of(place / "s.toml").find("title = \"included\""), std::string::npos);

  place.write("sub/mesh.bdf", "INCLUDE 'gone.bdf'\n");
  refused("a.bdf -o a.h5", 2, "sub/mesh.bdf:1: no file \"sub/gone.bdf\"");
  place.write("sub/mesh.bdf", "INCLUDE 'mesh.bdf'\n");
  refused("a.bdf -o a.h5", 2, "sub/mesh.bdf:1: INCLUDE of \"mesh.bdf\", which is being read (a file cannot include itself)");
  place.write("sub/mesh.bdf", "$\nINCLUDE '../a.bdf'\n");
  refused("a.bdf -o a.h5", 2, "sub/mesh.bdf:2: INCLUDE of \"../a.bdf\", which is being read (a file cannot include itself)");
  place.write("sub/mesh.bdf", "GRID,1,,0.,zero,0.\n");
  refused("a.bdf -o a.h5", 2, "sub/mesh.bdf:1:12: expected a number, found \"zero\"");
}

// r, theta, z and r, theta, phi of a point are its coordinates by the closed form, in a system that is turned and moved, by points and by
// grids, and in a chain of such systems.
TEST_F(ImportBdfFields, GridsOfEverySystemAreWhereTheClosedFormPutsThem) {
  const double degree = std::numbers::pi / 180;
  const std::string systems =
      "CORD2R,1,0,1.,2.,3.,1.,2.,4.\n,1.,3.,3.\n"     // axes y, -x, z at (1, 2, 3)
      "CORD2C,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"     // cylindrical in system 1
      "CORD2S,3,2,2.,90.,0.,2.,90.,1.\n,3.,90.,0.\n"  // spherical, its points given in system 2
      "CORD1C,4,101,102,103\n"                        // by grids, two of which are in other systems
      "CORD1R,5,101,102,103,6,101,103,102\n"          // two on a line
      "GRID,101,,5.,0.,0.\nGRID,102,1,0.,-4.,0.\nGRID,103,2,1.,0.,0.\n";
  // system 1: origin (1,2,3), x' = +y, y' = -x, z' = z
  const auto one = [](const Vec3& x) { return Vec3(1 - x[1], 2 + x[0], 3 + x[2]); };
  const auto cylinder = [&](double r, double t, double z) { return Vec3(r * std::cos(t * degree), r * std::sin(t * degree), z); };
  const auto sphere = [&](double r, double t, double p) {
    return Vec3(r * std::sin(t * degree) * std::cos(p * degree), r * std::sin(t * degree) * std::sin(p * degree), r * std::cos(t * degree));
  };
  // system 3: origin at (0, 2, 0) of 1, z along z', its x from (2, 90) to (3, 90): along y' of 1
  const auto three = [&](const Vec3& x) { return one(Vec3(-x[1], 2 + x[0], x[2])); };
  // system 4: origin (5,0,0), z towards grid 102 = one(0,-4,0) = (5,2,3), x in the plane of grid 103 = one(1,0,0) = (1,3,3)
  const Vec3 o(5, 0, 0), to(5, 2, 3), in(1, 3, 3);
  const Vec3 z = (to - o).normalized(), y = z.cross(in - o).normalized(), x = y.cross(z);
  const auto four = [&](const Vec3& v) { return Vec3(o + v[0] * x + v[1] * y + v[2] * z); };
  const Vec3 expected[] = {one(Vec3(.5, .25, -1)), one(cylinder(2, 30, 1)), three(sphere(2, 40, 70)), four(cylinder(1.5, 200, 4))};
  const std::string grids = "GRID,1,1,.5,.25,-1.\nGRID,2,2,2.,30.,1.\nGRID,3,3,2.,40.,70.\nGRID,4,4,1.5,200.,4.\n";
  Vec3 a = expected[1] - expected[0], b = expected[2] - expected[0], c = expected[3] - expected[0];
  const bool right = a.cross(b).dot(c) > 0;
  const std::string cell = right ? "CTETRA,1,1,1,2,3,4\n" : "CTETRA,1,1,1,3,2,4\n";
  for (const std::string& text : {systems + grids, grids + systems}) {
    const Mesh m = imported_deck("a.bdf", text + cell + steel);
    ASSERT_EQ(m.n_nodes(), 4);
    for (size_t i = 0; i < 4; ++i) EXPECT_LT((m.X[i] - expected[m.node_id[i] - 1]).norm(), 1e-13) << m.node_id[i];
  }
  // by default of GRDSET; a 0 is the basic system all the same
  place.write(
      "a.bdf",
      "GRDSET,,2\nCORD2C,2,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,0,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,90.,0.\nGRID,4,,0.,45.,1.\n"
      "CTETRA,1,1,1,2,3,4\n" +
          steel);
  EXPECT_NEAR(volume(imported("a.bdf")), 1. / 6, 1e-15);
}

TEST_F(ImportBdfFields, WhatCannotBeMeantIsRefusedByLine) {
  const struct {
    std::string text, message;
  } cases[] = {
      {"GRID,5,3,0.,0.,2.\n", "a.bdf:6:6: GRID 5: no coordinate system 3 (give it by CORD2R or another CORD)"},
      {"CORD2R,3,4,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,4,3,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n",
       "a.bdf:6:8: coordinate system 3 depends on itself"},
      {"CORD1R,3,1,2,5\nGRID,5,3,0.,0.,2.\n", "a.bdf:7:6: GRID 5: its coordinate system depends on it"},
      {"CORD2R,3,,0.,0.,0.,0.,0.,1.\n,0.,0.,3.\n", "a.bdf:6:8: coordinate system 3: its three points lie on a line"},
      {"CORD1R,3,1,2,9\n", "a.bdf:6:8: coordinate system 3: no GRID 9"},
      {"CORD2R,3,,0.,0.,0.,0.,0.,1.\n,1.,0.,3.\nCORD2C,3\n", "a.bdf:8:8: coordinate system 3 is given twice (number each system once)"},
      {"GRID*,5,,0.,0.,2.\n", "a.bdf:6:16: more than 4 fields after the name on a line (go on in a line that begins with a comma)"},
      {"CHEXA,2,1,1,2,3,4,5,6,7,8\n", "a.bdf:6:23: more than 8 fields after the name on a line (go on in a line that begins with a comma)"},
      {"CHEXA   2       1       1       2       3       4       5       6       +A\n+B      7       8\n",
       "a.bdf:7: continuation \"+B\" follows a line that goes on at \"+A\" (sort the continuations after their entries)"},
      {"MAT1,1,2.+11,,0.3\nMAT1,1,2.+11,,0.3\n", "a.bdf:7:6: MAT1 1 is given twice (number each material once)"},
      {"MAT1,1,nan,,0.3\n", "a.bdf:6:8: expected a number, found \"nan\""},
      {"GRID*   5                               0.0             0.0\n        2.\n",
       "a.bdf:7: a line of large fields goes on in small ones (begin the line with *)"},
      {"FORCE,1,2,,1.\n", "a.bdf:6:1: FORCE: the direction has no length"},
      {"CONM2,7,2,,1.\n,-1.\n", "a.bdf:6:2: CONM2 7: a moment of inertia of -1"},
      {"BEGIN SUPER=2\n", "a.bdf:6: BEGIN SUPER=2: superelements are not read (write one model without superelements)"},
  };
  for (const auto& c : cases) {
    refused_deck("a.bdf", tet + c.text, "-o a.h5", 2, c.message);
  }
}

// Weights over PARAM WTMASS are masses.
TEST_F(ImportBdfFields, WeightsBecomeMasses) {
  const Mesh m =
      imported_deck("a.bdf", tet + "PSOLID,1,1\nMAT1,1,3.+7,,0.3,0.283\nPARAM,WTMASS,.00259\nPARAM,POST,-1\n", "--units in-lbf-s");
  // 0.283 lb/in^3 by WTMASS is lbf s^2/in^4
  const double density = 0.283 * 0.00259 * 4.4482216152605 / std::pow(0.0254, 4);
  EXPECT_NEAR(m.region_data[0].density, density, 1e-9 * density);
  expect_said("not read: PARAM POST (1, a.bdf:9");
}

}  // namespace
}  // namespace hilo::test::import_bdf_fields_test
