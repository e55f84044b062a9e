// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and geometries that go through gmsh, written here by gmsh itself: named groups, shapes, orders and formats survive.
#include <fmt/format.h>

#include "import_case.hpp"

namespace hilo::test::import_gmsh_test {
namespace {

using test::cells_of;
using test::vector_area;
using test::volume;

/// Two unit boxes that share the face x = 1.  `what`: hexahedra, tetrahedra or prisms; the groups are a solid each, faces, a curve, a
/// point.
std::string boxes(const std::string& what, bool groups = true) {
  std::string s = R"(DefineConstant[ N = {2, Name "Parameters/cells"} ];
For i In {0:1}
  p = newp; Point(p) = {i,0,0}; Point(p+1) = {i+1,0,0}; Point(p+2) = {i+1,1,0}; Point(p+3) = {i,1,0};
  l = newl; Line(l) = {p,p+1}; Line(l+1) = {p+1,p+2}; Line(l+2) = {p+2,p+3}; Line(l+3) = {p+3,p};
  c = newll; Curve Loop(c) = {l:l+3}; s = news; Plane Surface(s) = {c};
  base(i) = s;
EndFor
Coherence;
Transfinite Curve{:} = N + 1;
Transfinite Surface{:};
)";
  if (what == "hex") s += "Recombine Surface{:};\n";
  if (what == "tet")
    s += "a() = Extrude {0,0,1} { Surface{base(0)}; };\nb() = Extrude {0,0,1} { Surface{base(1)}; };\n";
  else
    s += "a() = Extrude {0,0,1} { Surface{base(0)}; Layers{N}; Recombine; };\nb() = Extrude {0,0,1} { Surface{base(1)}; Layers{N}; "
         "Recombine; };\n";
  if (groups)
    s += R"(Physical Volume("left") = {a(1)};
Physical Volume(7) = {b(1)};
Physical Surface("inlet") = Surface In BoundingBox{-.1,-.1,-.1,.1,1.1,1.1};
Physical Surface("middle") = Surface In BoundingBox{.9,-.1,-.1,1.1,1.1,1.1};
Physical Curve("edge") = Curve In BoundingBox{-.1,-.1,-.1,.1,1.1,.1};
Physical Point("corner") = Point In BoundingBox{-.1,-.1,-.1,.1,.1,.1};
)";
  return s;
}

class ImportGmsh : public test::Import {
 protected:
  /// gmsh meshes a script that saves itself as `file`.
  void mesh(const std::string& script, const std::string& file, int order = 1, double version = 4.1, bool binary = false,
            bool complete = false) {
    const std::string settings = "Mesh.SecondOrderIncomplete = " + std::to_string(complete ? 0 : 1) +
                                 ";\nMesh.MshFileVersion = " + std::to_string(version) +
                                 ";\nMesh.Binary = " + std::to_string(binary ? 1 : 0) + ";\n";
    place.write("made.geo", script + settings + "Mesh 3;\nSetOrder " + std::to_string(order) + ";\nSave \"" + file + "\";\n");
    succeeded(place.run("hilo-import made.geo --trust -o made.h5 && rm made.geo made.h5"));
  }
  /// Mid-side nodes of a facet stand behind its corners, each in the middle of its edge (gmsh places nodes to 1e-12).
  void expect_middles(const Mesh& m, const std::string& where) {
    for (std::int64_t e = 0; e < m.n_cells(); ++e)
      for (size_t f = 0; f < info(m.shape[e]).facets.size(); ++f) {
        const auto n = m.facet_nodes({e, static_cast<std::int64_t>(f)});
        const size_t k = n.size() / 2;
        for (size_t i = 0; n.size() > 4 && i < k; ++i)
          EXPECT_LT((m.X[n[k + i]] - (m.X[n[i]] + m.X[n[(i + 1) % k]]) / 2).norm(), 1e-9) << where;
      }
  }
  void expect_boxes(const Mesh& m, const std::string& where) {
    EXPECT_NEAR(volume(m), 2, 1e-12) << where;
    EXPECT_EQ(m.region_name, (std::vector<std::string>{"left", "volume_7"})) << where;
    ASSERT_TRUE(m.facet_sets.count("inlet") && m.facet_sets.count("middle")) << where;
    EXPECT_LT((vector_area(m, m.facet_sets.at("inlet")) - Vec3(-1, 0, 0)).norm(), 1e-12) << where;
    EXPECT_NEAR(std::abs(vector_area(m, m.facet_sets.at("middle")).x()), 1, 1e-12) << where;
    ASSERT_TRUE(m.node_sets.count("edge") && m.node_sets.count("corner")) << where;
    for (const auto a : m.node_sets.at("edge")) EXPECT_EQ(m.X[a].z(), 0) << where;
    ASSERT_EQ(m.node_sets.at("corner").size(), 1u) << where;
    EXPECT_EQ(m.X[m.node_sets.at("corner")[0]].norm(), 0) << where;
    for (std::int64_t c = 0; c < m.n_cells(); ++c) {
      double x = 0;
      for (const auto a : m.cell(c)) x += m.X[a].x() / static_cast<double>(m.cell(c).size());
      EXPECT_EQ(m.region[c], x > 1 ? 1 : 0) << where;
    }
  }
};

TEST_F(ImportGmsh, GroupsSurviveInEveryVersionOfMsh) {
  for (const double version : {2.2, 4.1})
    for (const bool binary : {false, true}) {
      const std::string where = std::to_string(version) + (binary ? " binary" : " ascii");
      mesh(boxes("hex"), "a.msh", 1, version, binary);
      const Mesh m = imported("a.msh");
      EXPECT_EQ(m.n_cells(), 16) << where;
      EXPECT_EQ(cells_of(m, "left"), 8) << where;
      EXPECT_EQ(m.facet_sets.at("inlet").size(), 4u) << where;
      EXPECT_EQ(m.n_nodes(), 45) << where;
      expect_boxes(m, where);
    }
}

TEST_F(ImportGmsh, EveryShapeAndOrderKeepsItsVolumeAndItsMiddles) {
  const struct {
    const char* what;
    int order;
    bool complete;
    Shape shape;
  } cases[] = {{"tet", 1, false, Shape::tet4},   {"tet", 2, false, Shape::tet10},    {"hex", 1, false, Shape::hex8},
               {"hex", 2, false, Shape::hex20r}, {"prism", 1, false, Shape::wedge6}, {"prism", 2, false, Shape::wedge15},
               {"hex", 2, true, Shape::hex20r},  {"prism", 2, true, Shape::wedge15}};
  for (const auto& c : cases) {
    const std::string where = std::string(c.what) + std::to_string(c.order) + (c.complete ? " complete" : "");
    mesh(boxes(c.what), "a.msh", c.order, 4.1, false, c.complete);
    const Mesh m = imported("a.msh");
    expect_boxes(m, where);
    for (std::int64_t e = 0; e < m.n_cells(); ++e) ASSERT_EQ(static_cast<Shape>(m.shape[e]), c.shape) << where;
    expect_middles(m, where);
    if (c.complete) {
      expect_said("read without the nodes inside faces and cells");
    }
  }
}

TEST_F(ImportGmsh, UnvKeepsGroupsShapesAndMiddles) {
  for (const char* what : {"tet", "hex", "prism"})
    for (const int order : {1, 2}) {
      const std::string where = what + std::to_string(order);
      mesh(boxes(what), "a.unv", order);
      const Mesh m = imported("a.unv");
      EXPECT_EQ(m.region_name.size(), 2u) << where;
      EXPECT_EQ(m.region_name[0], "left") << where;
      EXPECT_NEAR(volume(m), 2, 1e-12) << where;
      EXPECT_LT((vector_area(m, m.facet_sets.at("inlet")) - Vec3(-1, 0, 0)).norm(), 1e-12) << where;
      ASSERT_TRUE(m.node_sets.count("edge")) << where;
      EXPECT_EQ(m.node_sets.at("edge").size(), order == 1 ? 3u : 5u) << where << ": the nodes in the middle too";
      expect_middles(m, where);
      EXPECT_NE(err.find("group \"corner\": 1 of its numbers are no element"), std::string::npos) << "gmsh names points it does not write\n"
                                                                                                  << err;
    }
}

// Parabolic beams (22, and 24) are lines on an edge of the cell: where that is linear, their corner nodes are the set.
TEST_F(ImportGmsh, LinesOfThreeNodesOfAUniversalFileOnLinearCellsAreTheirCorners) {
  std::string nodes;
  const int y[] = {0, 0, 1, 1}, x[] = {0, 1, 1, 0};
  for (int a = 0; a < 8; ++a) nodes += fmt::format("{} 1 1 11\n{} {} {}\n", a + 1, x[a % 4], y[a % 4], a / 4);
  nodes += "9 1 1 11\n0.5 0 0\n";
  const auto file = [&](int descriptor, const std::string& line) {
    return "    -1\n  2411\n" + nodes + "    -1\n    -1\n  2412\n1 115 1 1 7 8\n1 2 3 4 5 6 7 8\n" +
           fmt::format("2 {} 1 1 7 {}\n0 1 1\n{}\n", descriptor, std::count(line.begin(), line.end(), ' ') + 1, line) +
           "    -1\n    -1\n  2467\n1 0 0 0 0 0 0 1\nrail\n8 2 0 0\n    -1\n";
  };
  for (const int descriptor : {22, 24}) {
    const Mesh m = imported_deck("a.unv", file(descriptor, "1 9 2"));
    ASSERT_TRUE(m.node_sets.contains("rail")) << descriptor << err;
    const auto& rail = m.node_sets.at("rail");
    ASSERT_EQ(rail.size(), 2u) << descriptor;
    EXPECT_EQ(m.X[rail[0]], Vec3(0, 0, 0)) << descriptor;
    EXPECT_EQ(m.X[rail[1]], Vec3(1, 0, 0)) << descriptor << ": the middle is of no cell";
    refused_deck("a.unv", file(descriptor, "1 2"), "-o b.h5", 2,
                 fmt::format("a.unv:26:1: element 2: descriptor {} has 3 nodes, not 2", descriptor));
  }
}

TEST_F(ImportGmsh, UnitsOfAUniversalFileAreTakenAndEmptyGroupsAreTold) {
  mesh(boxes("hex"), "a.unv");
  const std::string text = test::text_of(place / "a.unv");
  const auto units = [](const std::string& factor) {
    return "    -1\n   164\n         5mm (milli-newton)            2\n  " + factor +
           "  1.0000000000000000D+03  1.0000000000000000D+00\n  2.7314999999999998D+02\n    -1\n";
  };
  EXPECT_NEAR(volume(imported_deck("mm.unv", units("1.0000000000000000D+03") + text)), 2e-9, 1e-20);
  EXPECT_NEAR(volume(imported("mm.unv", "--units m-kg-s")), 2, 1e-12);
  expect_said("the file says that its unit of length is 0.001 m (dataset 164); taken as m-kg-s, as --units says");
  EXPECT_NEAR(
      volume(imported_deck(
          "empty.unv",
          text + "    -1\n  2467\n        99         0         0         0         0         0         0         0\nnothing\n    -1\n")),
      2, 1e-12);
  expect_said("group \"nothing\" is empty: left out");
}

TEST_F(ImportGmsh, MirroredCellsAreTurnedWithTheirFacets) {
  for (const char* what : {"tet", "hex", "prism"})
    for (const int order : {1, 2}) {
      const std::string where = what + std::to_string(order);
      mesh(boxes(what), "a.msh", order);
      std::string text = test::text_of(place / "a.msh"), mirrored;
      // every node at -z: the cells are inside out
      bool nodes = false;
      for (size_t at = 0; at < text.size();) {
        const size_t end = text.find('\n', at);
        std::string line = text.substr(at, end - at);
        at = end + 1;
        if (line == "$Nodes") nodes = true;
        if (line == "$EndNodes") nodes = false;
        std::istringstream in(line);
        double x = 0, y = 0, z = 0;
        std::string rest;
        const bool three = static_cast<bool>(in >> x >> y >> z) && !(in >> rest);
        mirrored += nodes && three ? fmt::format("{:.17g} {:.17g} {:.17g}\n", x, y, -z) : line + "\n";
      }
      const Mesh m = imported_deck("b.msh", mirrored);
      EXPECT_NE(err.find("cells were numbered as in a mirror: turned"), std::string::npos) << where << err;
      EXPECT_NEAR(volume(m), 2, 1e-12) << where;
      EXPECT_LT((vector_area(m, m.facet_sets.at("inlet")) - Vec3(-1, 0, 0)).norm(), 1e-12) << where;
      expect_middles(m, where);
      for (std::int64_t c = 0; c < m.n_cells(); ++c) EXPECT_GT(quality(m, c).scaled_jacobian, 0) << where;
    }
}

TEST_F(ImportGmsh, AScriptIsMeshedWithItsParametersSizeAndOrder) {
  EXPECT_EQ(imported_deck("a.geo", boxes("hex")).n_cells(), 16);
  EXPECT_EQ(imported("a.geo", "--define N=3").n_cells(), 54);
  const Mesh m = imported("a.geo", "--define N=1 --order 2");
  EXPECT_EQ(static_cast<Shape>(m.shape[0]), Shape::hex20r);
  EXPECT_EQ(m.n_nodes(), 12 + 20);
  place.write("b.geo", "SetFactory(\"OpenCASCADE\"); Box(1) = {0,0,0,1,1,1};\n");
  EXPECT_GT(imported("b.geo", "--size 0.05").n_cells(), 4 * imported("b.geo", "--size 0.1").n_cells());
}

TEST_F(ImportGmsh, OptionsThatWouldDoNothingAreErrors) {
  refused_deck("a.geo", boxes("hex"), "-o a.h5 --define M=3", 1, "--define M: the script has no such name (did you mean \"N\"?)");
  refused_deck("b.geo", "Include \"a.geo\";\n", "-o a.h5 --define M=3", 1, "--define M: the script has no such name (did you mean \"N\"?)");
  mesh(boxes("hex"), "a.msh");
  refused("a.msh -o a.h5 --define N=3", 1, "--define is for .geo scripts");
  refused("a.msh -o a.h5 --size 3", 1, "--size is for a geometry, a.msh is a mesh");
}

TEST_F(ImportGmsh, AGeometryWithoutGroupsHasARegionPerVolume) {
  const Mesh m = imported_deck("a.geo", boxes("tet", false));
  EXPECT_EQ(m.region_name, (std::vector<std::string>{"volume_1", "volume_2"}));
  expect_said("no volume groups: each of 2 volumes is a region");
  EXPECT_EQ(imported("a.geo", "--rest all").region_name, std::vector<std::string>{"all"});
}

TEST_F(ImportGmsh, CadFilesAreMeshedAndNothingButTheTableIsOnStdout) {
  place.write("box.geo", "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 10, 20, 30};\nSave \"a.step\";\nSave \"a.brep\";\n");
  ASSERT_EQ(place.run("hilo-import box.geo --trust -o box.h5").exit, 0);
  for (const char* file : {"a.step", "a.brep"}) {
    const Mesh m = imported(file, std::string("--size 10") + (std::string(file) == "a.brep" ? " --scale 1e-3" : ""));
    EXPECT_NEAR(volume(m), 6e-6, 1e-15) << file;
    EXPECT_EQ(out.rfind("region", 0), 0u) << out;
    EXPECT_GT(imported(file, "--size 3").n_cells(), 8 * m.n_cells()) << file;
  }
}

TEST_F(ImportGmsh, CurvedCellsThatTurnInsideOutGetStraightEdges) {
  const Mesh m = imported_deck(
      "ring.geo",
      "SetFactory(\"OpenCASCADE\");\nCylinder(1) = {0,0,0, 0,0,0.3, 1};\nCylinder(2) = {0,0,0, 0,0,0.3, 0.95};\n"
      "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\nMesh.MeshSizeMin = 0.5;\nMesh.MeshSizeMax = 0.8;\n",
      "--order 2");
  expect_said("cells that a curved surface turned inside out have straight edges");
  for (std::int64_t c = 0; c < m.n_cells(); ++c) EXPECT_GT(quality(m, c).scaled_jacobian, 0);
}

TEST_F(ImportGmsh, CellsInTwoGroupsGoToTheFirstAndBothStayNamed) {
  const Mesh m = imported_deck("a.geo", boxes("hex") + "Physical Volume(\"both\", 20) = {a(1), b(1)};\n");
  EXPECT_EQ(m.region_name, (std::vector<std::string>{"left", "volume_7"})) << "the groups with the lower tags";
  EXPECT_EQ(m.cell_sets.at("both").size(), 16u);
  expect_said("16 of 16 cells of \"both\" belong to another region too");
}

TEST_F(ImportGmsh, ACurveApartFromTheSolidsIsARegionOfBars) {
  const std::string cable =
      "p = newp; Point(p) = {2,1,1}; Point(p+1) = {5,1,1}; l = newl; Line(l) = {p,p+1}; Transfinite Curve{l} = 4;\nPhysical "
      "Curve(\"cable\") = {l};\n";
  const Mesh m = imported_deck("a.geo", boxes("hex") + cable);
  EXPECT_EQ(cells_of(m, "cable"), 3);
  EXPECT_TRUE(m.node_sets.count("edge")) << "a curve on a solid is a node set";
  const Mesh bars = imported_deck("b.geo", cable);  // without solids every curve group is one
  EXPECT_EQ(bars.region_name, std::vector<std::string>{"cable"});
  EXPECT_NEAR(volume(bars), 3, 1e-12) << "the length";
}

// The edges of a square came in as trusses.
TEST_F(ImportGmsh, AFlatMeshIsRefusedByEveryFormat) {
  place.write("a.geo",
              "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 2, 1};\nTransfinite Curve{:} = 3;\nTransfinite Surface{:};\n"
              "Recombine Surface{:};\nPhysical Surface(\"plate\") = {1};\nPhysical Curve(\"edges\") = {1:4};\nMesh 2;\n"
              "Save \"a.msh\";\nSave \"a.unv\";\nSave \"a.vtk\";\nSave \"a.mesh\";\nSave \"a.bdf\";\n");
  place.run("hilo-import a.geo --trust -o geo.h5");
  for (const char* file : {"a.msh", "a.unv", "a.vtk", "a.mesh"}) {
    ASSERT_TRUE(std::filesystem::exists(place / file)) << file;
    refused(std::string(file) + " -o a.h5", 2,
            std::string(file) +
                ": 4 flat cells (triangles, quadrangles) and no volume (a surface alone, as in an STL, has no volume: mesh "
                "its inside; lines beside flat cells are their edges, not bars)");
  }
  EXPECT_EQ(place.run("hilo-import a.bdf -o a.h5").exit, 2);
  EXPECT_EQ(place.run("hilo-import a.geo --trust -o a.h5").exit, 2);
}

TEST_F(ImportGmsh, WrongFilesAreNamedAndLeaveNothing) {
  refused("absent.msh -o a.h5", 2, "absent.msh: no such file");
  refused_deck(
      "a.xyz", "x", "-o a.h5", 2,
      "a.xyz: no reader for \".xyz\" files (there is one for .inp .bdf .nas .dat .fem .unv .vtk .vtu .msh .mesh .med .rmed .exo .ex2 "
      ".exii .e "
      ".g .gen .stl .geo .step .stp "
      ".brep .iges .igs .inp.gz)");
  refused_deck("a.stl",
               "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n",
               "-o a.h5", 2,
               "a.stl: 1 flat cells (triangles, quadrangles) and no volume (a surface alone, as in an STL, has no volume: mesh its inside; "
               "lines beside flat cells are their edges, not bars)");
  refused_deck("a.geo", "Point(1) = {0,0,0};\n", "-o a.h5", 2,
               "a.geo: no volume to mesh (the geometry holds points, curves or surfaces only)");
  mesh(boxes("hex") + "Physical Volume(\"rest\") = {};\n", "whole.msh");
  const std::string text = test::text_of(place / "whole.msh");
  place.write("cut.msh", text.substr(0, text.size() / 2));
  const auto before = place.files();
  const auto ran = place.run("hilo-import cut.msh -o a.h5");
  EXPECT_EQ(ran.exit, 2) << ran.err;
  EXPECT_EQ(ran.err.rfind("hilo-import: cut.msh", 0), 0u) << ran.err;
  EXPECT_EQ(place.files(), before);
  place.write("b.geo", "Point(1) = {0,0,0\n");
  expect_end(place.run("hilo-import b.geo -o a.h5"), 2, "b.geo");
}

TEST_F(ImportGmsh, CellsInNoGroupAreARegionAndThatIsSaid) {
  mesh(boxes("hex"), "a.msh", 1, 2.2);
  // physical tag 7 of the second box becomes 0: its cells are in no group
  std::string text = test::text_of(place / "a.msh");
  for (size_t at = 0; (at = text.find(" 5 2 7 ", at)) != std::string::npos;) text.replace(at, 7, " 5 2 0 ");
  EXPECT_EQ(test::cells_of(imported_deck("a.msh", text), "rest"), 8);
  expect_said("8 of 16 cells are in no region, the first is cell 20: they are region \"rest\"; --rest gives it another name\n");
  const Mesh m = imported("a.msh", "--rest hub");
  EXPECT_EQ(cells_of(m, "hub"), 8);
}

TEST_F(ImportGmsh, AGroupThatGmshLeavesEmptyIsTold) {
  place.write(
      "box.geo",
      "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\nPhysical Volume(\"block\") = {1};\nPhysical Surface(\"hole\") = {};\n"
      "Physical Surface(\"gone\", 500) = {77};\n");
  imported("box.geo");
  for (const char* name : {"hole", "gone"}) expect_said("warning: surface group \"" + std::string(name) + "\" is empty: left out");
  EXPECT_EQ(err.find("\"block\""), std::string::npos) << err;
}

// Two tetrahedra on a triangle, in two partitions as gmsh writes them: each has an entity of its own, and their border another.
TEST_F(ImportGmsh, PartitionsArePutTogether) {
  const auto file = [](int n_partitions, const char* second) {
    return std::string("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 8 \"foot\"\n3 9 \"part\"\n$EndPhysicalNames\n") +
           "$Entities\n0 0 1 1\n1 0 0 0 1 1 1 1 8 0\n1 0 0 0 1 1 1 1 9 0\n$EndEntities\n$PartitionedEntities\n" +
           std::to_string(n_partitions) +
           "\n0\n0 0 2 2\n2 2 1 1 1 0 0 0 1 1 0 1 8 0\n3 3 1 2 1 2 0 0 0 1 1 1 0 0\n2 3 1 1 1 0 0 0 1 1 1 1 9 0\n3 3 1 1 2 0 0 0 1 1 1 1 9 "
           "0\n"
           "$EndPartitionedEntities\n$Nodes\n1 5 1 5\n3 2 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n" +
           second;
  };
  const Mesh m = imported_deck(
      "a.msh", file(2, "$Elements\n4 4 1 4\n2 2 2 1\n1 1 2 3\n2 3 2 1\n2 2 3 4\n3 2 4 1\n3 1 2 3 4\n3 3 4 1\n4 2 3 4 5\n$EndElements\n"));
  EXPECT_EQ(cells_of(m, "part"), 2);
  EXPECT_NEAR(volume(m), 1. / 6 + 1. / 3, 1e-15);
  EXPECT_EQ(m.facet_sets.at("foot").size(), 1U);
  EXPECT_EQ(m.facet_sets.size(), 1U) << "the border between the parts is no set";
  expect_said("the mesh is in 2 parts, which are put together");
  imported_deck("b.msh", file(2, "$Elements\n1 1 3 3\n3 2 4 1\n3 1 2 3 4\n$EndElements\n"));
  expect_said("warning: the file holds 1 of the 2 parts of its mesh");
}

}  // namespace
}  // namespace hilo::test::import_gmsh_test
