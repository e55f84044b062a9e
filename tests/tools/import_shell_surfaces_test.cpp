// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of gmsh, of geometry and of universal files that become solid-shells by --thickness.
#include "shell_case.hpp"

namespace hilo::test::import_shell_surfaces_test {
namespace {

using namespace shell_decks;

TEST_F(ImportShell, ASurfaceOfGmshHasItsThickness) {
  const Mesh m = imported_deck("arch.geo", arch, "--thickness 0.1");
  ASSERT_EQ(m.n_cells(), 40);
  ASSERT_EQ(m.n_nodes(), 2 * 55);
  for (std::int64_t c = 0; c < m.n_cells(); ++c) EXPECT_EQ(info(m.shape[c]).name, "shell8");
  const double chord = 2 * std::sin(M_PI / 40);  // of a circle of radius 1
  EXPECT_NEAR(volume(m), 10 * chord * 2 * 0.1 * std::cos(M_PI / 40), 1e-3 * volume(m));
  EXPECT_EQ(m.region_name, std::vector<std::string>{"roof"});
  EXPECT_EQ(m.node_sets.at("corner").size(), 2u) << "a pair";
  EXPECT_EQ(m.facet_sets.at("front").size(), 10u) << "an edge is a strip of facets";
  EXPECT_LT(std::abs(vector_area(m, m.facet_sets.at("front")).y() + volume(m) / 2), 1e-3);
  const Vec3 top = vector_area(m, m.facet_sets.at("roof_top")), bottom = vector_area(m, m.facet_sets.at("roof_bottom"));
  // at a free edge, too, the pair stands along the radius
  EXPECT_NEAR(std::max(top.norm(), bottom.norm()), 1.05 * 2 * std::sqrt(2), 1e-6);
  EXPECT_NEAR(std::min(top.norm(), bottom.norm()), 0.95 * 2 * std::sqrt(2), 1e-6);
  EXPECT_LT(top.dot(bottom), 0);
  EXPECT_NEAR(volume(imported("arch.geo", "--thickness 0.1 --units mm-t-s --scale 1000")), volume(m), 1e-9);
}

// A floor of two plates and a wall, each of its own thickness, a solid beside them, and a group of surfaces on one of them that is a set.
TEST_F(ImportShell, GroupsOfSurfacesHaveTheirOwnThicknessBesideSolids) {
  place.write("room.geo",
              "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\nRectangle(2) = {1, 0, 0, 1, 1};\n"
              "Rectangle(3) = {0.25, 0.25, 0, 0.5, 0.5};\n"
              "Point(101) = {2, 0, 1}; Point(102) = {2, 1, 1};\n"
              "p() = BooleanFragments{ Surface{1, 2}; Delete; }{ Surface{3}; Delete; };\n"
              "c() = Curve In BoundingBox {1.99, -0.01, -0.01, 2.01, 1.01, 0.01};\nw() = Extrude {0, 0, 1} { Curve{c()}; };\n"
              "Box(9) = {0.25, 0.25, 0.1, 0.5, 0.5, 0.5};\nMesh.MeshSizeMax = 0.2;\nd = 0.01;\n"
              "thin() = Surface In BoundingBox {-d, -d, -d, 1 + d, 1 + d, d};\n"
              "Physical Surface(\"thin\") = thin();\nthick() = Surface In BoundingBox {1 - d, -d, -d, 2 + d, 1 + d, d};\n"
              "Physical Surface(\"thick\") = thick();\nPhysical Surface(\"wall\") = {w(1)};\n"
              "foot() = Surface In BoundingBox {0.25 - d, 0.25 - d, -d, 0.75 + d, 0.75 + d, d};\n"
              "Physical Surface(\"foot\") = foot();\nPhysical Volume(\"box\") = {9};\n"
              "under() = Surface In BoundingBox {0, 0, 0.1 - d, 1, 1, 0.1 + d};\nPhysical Surface(\"under\") = under();\n"
              "Recombine Surface { thin(), thick(), w(1) };\nMesh.RecombinationAlgorithm = 0;\n");
  const std::string named = "--thickness thin=0.02 --thickness thick=0.04 --thickness wall=0.05";
  const Mesh m = imported("room.geo", named);
  EXPECT_EQ(m.region_name, (std::vector<std::string>{"box", "thin", "thick", "wall"}));
  std::map<std::string, double> volume;
  for (std::int64_t c = 0; c < m.n_cells(); ++c) volume[m.region_name[m.region[c]]] += quality(m, c).volume;
  EXPECT_NEAR(volume["box"], 0.125, 1e-12);
  EXPECT_NEAR(volume["thin"], 0.02, 1e-12) << "its middle, to where it meets the other's";
  EXPECT_NEAR(volume["thick"], 0.04, 1e-12);
  EXPECT_NEAR(volume["wall"], 0.05, 1e-12);
  EXPECT_NEAR(vector_area(m, m.facet_sets.at("foot")).norm(), 0.25, 1e-12) << "one face of it";
  EXPECT_NEAR(vector_area(m, m.facet_sets.at("under")).z(), -0.25, 1e-12) << "a face of the solid";
  EXPECT_FALSE(m.block_name.empty()) << "the step of thickness and the fold";
  refused("room.geo -o a.h5 --thickness 0.1", 1,
          "--thickness makes shells of surfaces, and room.geo has volumes (name the groups of surfaces: --thickness NAME=T)");
  refused("room.geo -o a.h5 --thickness wal=0.1", 1, "--thickness wal=0.1: no group of surfaces has this name (did you mean \"wall\"?)");
  refused("room.geo -o a.h5 --thickness wall=0.1 --thickness wall=0.2", 1, "--thickness wall=0.2: stated twice (see hilo-import --help)");
  refused("room.geo -o a.h5 --thickness wall=", 1, "--thickness wall=: expected T or NAME=T (see hilo-import --help)");
  expect_end(place.run("hilo-import room.geo -o a.h5 --thickness thin=0.1 --thickness foot=0.1"), 1,
             "is in two groups that become shells, \"foot\" the second (name one of them: --thickness NAME=T)");
  // msh 2 lists an element once for each of its groups
  const std::string nodes = "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n",
                    names = "$PhysicalNames\n2\n2 1 \"plate\"\n2 2 \"foot\"\n$EndPhysicalNames\n",
                    cells = "$Elements\n3\n1 3 2 1 1 1 2 5 4\n2 3 2 1 2 2 3 6 5\n3 3 2 2 1 1 2 5 4\n$EndElements\n";
  const Mesh two = imported_deck("two.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + nodes + cells, "--thickness plate=0.1");
  EXPECT_EQ(two.n_cells(), 2);
  EXPECT_NEAR(vector_area(two, two.facet_sets.at("foot")).z(), 1, 1e-12);
  refused("two.msh -o a.h5 --thickness plate=0.1 --thickness foot=0.2", 1,
          "--thickness: surface 1 is in two groups that become shells, \"foot\" the second (name one of them: --thickness NAME=T)");
  // a mistake of a mesher: an element turned over onto its neighbour
  imported_deck("over.inp",
                "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,.4,0,0\n6,.4,1,0\n*ELEMENT, TYPE=S4, ELSET=P\n1,1,2,3,4\n"
                "2,2,5,6,3\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,.3\n*SHELL SECTION, ELSET=P, MATERIAL=M\n.01\n",
                "--thicken");
  expect_said("warning: 1 shells lie on a neighbour, edge on edge, as those of a mesher's mistake do: the first is element 2");
}

// A quarter of a clamped square in triangles of gmsh, under pressure: Kirchhoff's 0.00126532 p a^4/D.
TEST_F(ImportShell, APlateOfTrianglesIsAsExactWhenThin) {
  place.write(
      "plate.geo",
      "Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0.5, 0.5, 0}; Point(4) = {0, 0.5, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\nCurve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
      "Mesh.MeshSizeMax = 0.1;\nPhysical Surface(\"plate\") = {1}; Physical Curve(\"x\") = {4}; Physical Curve(\"y\") = {1};\n"
      "Physical Curve(\"edge\") = {2, 3}; Physical Point(\"middle\") = {1};\n");
  for (const double h : {0.01, 0.001}) {
    const Mesh m = imported("plate.geo", fmt::format("--thickness {}", h));
    EXPECT_EQ(info(m.shape[0]).name, "shell8");
    const double p = 1e8 * h * h * h, w = 0.00126532 * p * 12 * (1 - 0.09) / (2.1e11 * h * h * h);
    std::string scene = "mesh = \"out.h5\"\n[material.m]\nE = 2.1e11\nnu = 0.3\ndensity = 7850\n[region.plate]\nmaterial = \"m\"\n";
    for (const auto& [on, components] : {std::pair{"edge", "\"x\", \"y\""}, {"edge", "\"z\""}, {"x", "\"x\""}, {"y", "\"y\""}})
      scene += fmt::format("[[motion]]\nkind = \"fixed\"\nname = \"{0} {2}\"\non = \"{0}\"\ncomponents = [{1}]\n", on, components,
                           std::string(components).size());
    place.write("scene.toml", scene + fmt::format("[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"plate_top\"\npressure = {}\n", p) +
                                  "[[probe]]\nname = \"middle\"\non = \"middle\"\n[time]\nanalysis = \"static\"\nsteps = 1\n");
    succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
    const double share = std::abs(way("middle").z()) / w;
    std::printf("h %g: %.4f of Kirchhoff's, %d cells\n", h, share, static_cast<int>(m.n_cells()));
    EXPECT_NEAR(share, 1, 0.01);
  }
}

// The hull of the firing vehicle in plates of the thicknesses that data/firing/Makefile names, beside its solid of tetrahedra: of equal
// density, so the masses are as the volumes.
TEST_F(ImportShell, TheHullOfTheVehicleWeighsWhatItsSolidDoes) {
  const std::string folder = std::string(HILO_SOURCE) + "/data/firing/", make = text_of(folder + "Makefile"), key = "PLATES := ";
  const size_t at = make.find(key);
  ASSERT_NE(at, make.npos);
  std::istringstream plates(make.substr(at + key.size(), make.find('\n', at) - at - key.size()));
  std::string options = folder + "vehicle.geo --quiet --define SIZE=0 --define HULL=1";
  for (std::string plate; plates >> plate;) {
    options += " --thickness hull_" + plate;
    if (!plate.starts_with("side")) options += " --thickness hull_rim_" + plate;
  }
  const auto hull = [](const Mesh& m) {
    double V = 0;
    for (std::int64_t c = 0; c < m.n_cells(); ++c)
      if (m.region_name[m.region[c]].starts_with("hull")) V += quality(m, c).volume;
    return V;
  };
  const double of_plates = hull(imported(options)), of_solid = hull(imported(folder + "vehicle.geo --quiet --define SIZE=0"));
  std::printf("%.4f and %.4f m^3\n", of_plates, of_solid);
  EXPECT_GT(of_solid, 2);
  EXPECT_NEAR(of_plates / of_solid, 1, 0.01);
}

// A floor and a wall of two thicknesses that meet at a fold, and an edge with a name, by a universal file as by gmsh's own.
TEST_F(ImportShell, SurfacesOfAUniversalFileAreShellsAsThoseOfGmsh) {
  place.write("made.geo",
              "Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Point(4)={0,1,0}; Point(5)={1,0,1}; Point(6)={1,1,1};\n"
              "Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1}; Line(5)={2,5}; Line(6)={5,6}; Line(7)={6,3};\n"
              "Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1}; Curve Loop(2)={5,6,7,-2}; Plane Surface(2)={2};\n"
              "Transfinite Curve{:}=4; Transfinite Surface{:}; Recombine Surface{1};\n"
              "Physical Surface(\"floor\")={1}; Physical Surface(\"wall\")={2}; Physical Curve(\"edge\")={4};\n"
              "Mesh 2;\nSave \"a.unv\";\nSave \"a.msh\";\n");
  ASSERT_EQ(place.run("hilo-import made.geo --trust --thickness 0.1 -o made.h5").exit, 0);
  const std::string thick = "--thickness floor=0.1 --thickness wall=0.05";
  const Mesh other = imported("a.msh", thick), m = imported("a.unv", thick);
  for (const char* region : {"floor", "wall"}) EXPECT_EQ(cells_of(m, region), cells_of(other, region)) << region;
  EXPECT_EQ(cells_of(m, "floor"), 9 * 4);  // the wall's triangles become quadrangles, and with them all surfaces
  EXPECT_EQ(m.X.size(), other.X.size());
  EXPECT_NEAR(volume(m), volume(other), 1e-12);
  EXPECT_NEAR(volume(m), 0.15, 0.01);
  EXPECT_EQ(m.block_name.size(), other.block_name.size());
  EXPECT_EQ(m.facet_sets.at("edge").size(), other.facet_sets.at("edge").size());  // across the thickness
  refused("a.unv -o a.h5 --thickness walls=0.1", 1, "--thickness walls=0.1: no group of surfaces has this name (did you mean \"wall\"?)");
  EXPECT_EQ(cells_of(imported("a.unv", "--thickness 0.1"), "wall"), cells_of(m, "wall"));
}

TEST_F(ImportShell, ThicknessIsForSurfacesAndThickenForDecks) {
  refused_deck("arch.geo", arch, "-o a.h5 --thicken", 1,
               "--thicken is for shells of a deck, arch.geo is none (--thickness makes shells of its surfaces)");
  refused_deck("strip.bdf", cquad4_strip("SPC1,1,123456,1,2\n"), "-o a.h5 --thickness 0.3", 1,
               "--thickness is for surfaces of a geometry, .msh, .unv, .med or Exodus file, strip.bdf is none (--thicken makes shells of a "
               "deck, with the deck's "
               "thickness)");
  refused_deck("a.vtk", "# vtk DataFile Version 3.0\n", "-o a.h5 --thickness 0.3", 1,
               "--thickness is for surfaces of a geometry, .msh, .unv, .med or Exodus file, a.vtk is none");
}

}  // namespace
}  // namespace hilo::test::import_shell_surfaces_test
