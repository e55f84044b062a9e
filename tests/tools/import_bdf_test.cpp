// SPDX-License-Identifier: GPL-3.0-or-later
// Nastran bulk data in its three field formats.
#include "import_case.hpp"

namespace hilo::test::import_bdf_test {
namespace {

using test::cells_of;
using test::vector_area;
using test::volume;
using ImportBdf = test::Import;

const std::string small = R"($ a cube and a prism on it
SOL 101
CEND
TITLE = not bulk
SPC = 1
LOAD = 1
BEGIN BULK
$HMNAME PROP                   5"lower hull"
GRID           1              0.      0.      0.
GRID           2              1.      0.      0.
GRID           3              1.      1.      0.
GRID           4              0.      1.      0.
GRID           5              0.      0.      1.
GRID           6              1.      0.      1.
GRID           7              1.      1.      1.
GRID           8              0.      1.      1.
GRID,11,,0.,0.,2.
GRID,12,,1.,0.,2.
GRID*                 13                              1.              1.
*                   2.+0
CHEXA          1       5       1       2       3       4       5       6+
+              7       8
CPENTA,2,6,5,6,7,11,12,13
CQUAD4         3       9       1       4       3       2
PSOLID         5       1
PSOLID         6       2
MAT1           1  2.1+11             0.3   7850.
MAT1    2       7.E10   2.6E10          2700.
SPC1           1     123       1    THRU       4
FORCE          1      13       0    100.      1.      0.      0.
ENDDATA
)";

TEST_F(ImportBdf, SmallLargeAndFreeFieldsAreRead) {
  const Mesh m = imported_deck("a.bdf", small);
  EXPECT_EQ(m.region_name, (std::vector<std::string>{"lower hull", "pid_6"}));
  EXPECT_NEAR(volume(m), 1.5, 1e-14);
  EXPECT_DOUBLE_EQ(m.region_data[0].E, 2.1e11);
  EXPECT_DOUBLE_EQ(m.region_data[0].density, 7850);
  EXPECT_NEAR(m.region_data[1].nu, 7 / 5.2 - 1, 1e-14);  // from E and G
  EXPECT_EQ(m.node_sets.at("SPC_1").size(), 4u);
  EXPECT_LT((vector_area(m, m.facet_sets.at("pid_9")) - Vec3(0, 0, -1)).norm(), 1e-14);
  EXPECT_EQ(err.find("not read"), std::string::npos) << err;
}

TEST_F(ImportBdf, WhatGmshWritesKeepsShapesVolumesAndProperties) {
  for (const int format : {0, 1, 2})  // free, small, large
    for (const int order : {1, 2})
      for (const bool hex : {false, true}) {
        place.write("a.geo",
                    std::string("SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 2, 3};\nPhysical Volume(4) = {1};\n") +
                        (hex ? "Transfinite Curve{:} = 4;\nTransfinite Surface{:};\nRecombine Surface{:};\nTransfinite Volume{:};\n" : "") +
                        "Mesh.SecondOrderIncomplete = 1;\nMesh.BdfFieldFormat = " + std::to_string(format) + ";\nMesh 3;\nSetOrder " +
                        std::to_string(order) + ";\nSave \"a.bdf\";\n");
        ASSERT_EQ(place.run("hilo-import a.geo --trust -o geo.h5").exit, 0);
        const std::string where = std::to_string(format) + ' ' + std::to_string(order) + (hex ? " hex" : " tet");
        const Mesh m = imported("a.bdf");
        ASSERT_GT(m.n_cells(), 0) << where;
        EXPECT_NEAR(volume(m), 6, 1e-4) << where;  // its fields hold five digits or more
        EXPECT_EQ(m.region_name.size(), 1u) << where;
        const Shape expected = hex ? (order == 2 ? Shape::hex20r : Shape::hex8) : order == 2 ? Shape::tet10 : Shape::tet4;
        EXPECT_EQ(static_cast<Shape>(m.shape[0]), expected) << where;
      }
}

TEST_F(ImportBdf, WrongEntriesAreNamedByLine) {
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\nCTETRA,1,1,1,2,3,4\n";
  const struct {
    std::string text, message;
  } cases[] = {
      {grids + "GRID,4,,0.,0.,2.\n", "a.bdf:6:6: node 4 is given twice (number each node once)"},
      {grids + "CTETRA,1,1,1,2,3,4\n", "a.bdf:6:8: element 1 is given twice (number each element once)"},
      {grids + "CTETRA,2,1,1,2,3,9\n", "a.bdf:6:8: element 2 names node 9, which does not exist"},
      {grids + "CTETRA,2,1,1,2,3,4,1\n", "a.bdf:6: CTETRA 2 has mid-side nodes on some edges only (give all of them or none)"},
      {grids + "CBAR,2,1,1,2\n", "a.bdf:6:6: beam 2: no property 1 (PBAR, PBARL, PBEAM, PBEAML)"},
      {grids + "MAT1,1,-1.,,0.3\n", "a.bdf:6:8: MAT1 1: Young's modulus -1 is not positive"},
      {grids + "GRID,5,,0.,zero,2.\n", "a.bdf:6:12: expected a number, found \"zero\""},
      {"GRID,1,,0.,0.,0.\n",
       "a.bdf: no elements (supported: CTETRA, CPENTA, CHEXA, CROD, CONROD; as rigid regions CTRIA3, CTRIA6, CQUAD4, CQUAD8, CBAR, CBEAM)"},
  };
  for (const auto& c : cases) {
    refused_deck("a.bdf", c.text, "-o a.h5", 2, c.message);
  }
}

}  // namespace
}  // namespace hilo::test::import_bdf_test
