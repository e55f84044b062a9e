// SPDX-License-Identifier: GPL-3.0-or-later
// VTK files of every encoding, as written by VTK 9.1 (tests/tools/decks).
#include "import/imported.hpp"
#include "import_case.hpp"

namespace hilo::test::import_vtk_test {
namespace {

using test::cells_of;
using test::volume;
using ImportVtk = test::Import;

/// Two cubes (7), a prism on one of them and a quadratic tetrahedron apart (3), and a square that is no solid.
TEST_F(ImportVtk, EveryEncodingGivesTheSameMesh) {
  for (const char* file : {"ascii.vtu", "inline.vtu", "inline_zlib.vtu", "appended_raw.vtu", "appended_base64.vtu", "big_endian.vtu",
                           "ascii_4_2.vtk", "binary_4_2.vtk", "ascii_5_1.vtk", "binary_5_1.vtk"}) {
    const Mesh m = imported(deck(file));
    ASSERT_EQ(m.n_cells(), 4) << file;
    EXPECT_NEAR(volume(m), 2 + 0.5 + 1. / 6, 1e-12) << file;
    EXPECT_EQ(cells_of(m, "region_7"), 2) << file;
    EXPECT_EQ(cells_of(m, "region_3"), 2) << file;
    EXPECT_EQ(static_cast<Shape>(m.shape[1]), Shape::hex8) << "a voxel";
    EXPECT_EQ(static_cast<Shape>(m.shape[3]), Shape::tet10) << file;
    EXPECT_EQ(m.n_nodes(), 25) << file;
    expect_said("not read: VTK cells of type 9 (1, ");
  }
}

TEST_F(ImportVtk, DamagedFilesAreNamedAndLeaveNothing) {
  for (const char* file : {"ascii.vtu", "inline.vtu", "inline_zlib.vtu", "appended_raw.vtu", "ascii_4_2.vtk", "binary_5_1.vtk"}) {
    const std::string whole = test::text_of(deck(file));
    const std::string name = "cut" + std::string(file).substr(std::string(file).rfind('.'));
    for (const double part : {0.1, 0.25, 0.4}) {
      place.write(name, whole.substr(0, static_cast<size_t>(part * static_cast<double>(whole.size()))));
      const auto before = place.files();
      const auto ran = place.run("hilo-import " + name + " -o a.h5");
      EXPECT_EQ(ran.exit, 2) << file << ' ' << part << ran.err;
      EXPECT_EQ(ran.err.rfind("hilo-import: " + name, 0), 0u) << ran.err;
      EXPECT_EQ(place.files(), before);
    }
  }
}

// Truth: volumes by hand.  Two pyramids on one square, and one on a face of a cube; each in two halves that fit.
TEST_F(ImportVtk, PyramidsAreTwoTetrahedraEach) {
  const Mesh m =
      imported_deck("a.vtk",
                    "# vtk DataFile Version 3.0\npyramids\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n1 0 0 1 1 0 0 1 0 0 0 0 .5 .5 "
                    "1 .5 .5 -2\nCELLS 2 12\n5 0 1 2 3 4\n5 1 0 3 2 5\nCELL_TYPES 2\n14\n14\n");
  EXPECT_NEAR(volume(m), 1. / 3 + 2. / 3, 1e-7);
  EXPECT_EQ(m.n_cells(), 4);
  std::vector<std::int64_t> all{0, 1, 2, 3};
  EXPECT_EQ(free_facets(m, all).size(), 8U) << "the four halves of the square meet";
  EXPECT_TRUE(err.find("2 pyramids are two tetrahedra each\n") != std::string::npos && err.find("stand on") == std::string::npos) << err;
  place.write(
      "b.vtk",
      "# vtk DataFile Version 3.0\non a cube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 float\n0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 "
      "1 1 1 0 1 1 .5 .5 2\nCELLS 2 15\n8 0 1 2 3 4 5 6 7\n5 4 5 6 7 8\nCELL_TYPES 2\n12\n14\n");
  EXPECT_NEAR(volume(imported("b.vtk")), 1 + 1. / 3, 1e-7);
  expect_said("warning: 1 pyramids stand on a quadrangle of a hexahedron or prism");
}

TEST_F(ImportVtk, CellsWithoutARegionArrayAreARegionAndThatIsSaid) {
  EXPECT_EQ(
      imported_deck("a.vtk",
                    "# vtk DataFile Version 3.0\none tetrahedron\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 "
                    "1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n")
          .region_name,
      std::vector<std::string>{"rest"});
  expect_said("1 of 1 cells are in no region, the first is cell 0: they are region \"rest\"; --rest gives it another name\n");
  EXPECT_NEAR(volume(imported("a.vtk", "--rest all")), 1. / 6, 1e-7);
  place.write("b.vtk",
              "# vtk DataFile Version 3.0\na polyhedron\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 1 1 0 0 1 0 0 0 "
              "1\nCELLS 1 6\n5 0 1 2 3 4\nCELL_TYPES 1\n42\n");
  refused(
      "b.vtk -o a.h5", 2,
      "b.vtk: cell 0 is of VTK type 42 (supported: lines, tetrahedra, hexahedra, voxels, wedges of order 1 and 2, pyramids of 5 nodes)");
  refused_deck(
      "c.vtk",
      "# vtk DataFile Version 3.0\nbad node\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 1 1 0\nCELLS 1 5\n4 0 1 "
      "2 3\nCELL_TYPES 1\n10\n",
      "-o a.h5", 2, "c.vtk: cell 0 names node 3, which does not exist");
  place.write(
      "d.vtk",
      "# vtk DataFile Version 3.0\nnode 2.7\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 "
      "1 2.7 3\nCELL_TYPES 1\n10\n");
  refused("d.vtk -o a.h5", 2, "d.vtk:8: expected a whole number, found 2.7");
}

}  // namespace
}  // namespace hilo::test::import_vtk_test
