// SPDX-License-Identifier: GPL-3.0-or-later
// Mid-surfaces that become solid-shells: of gmsh with --thickness, of decks with --thicken; what has no clear pair of nodes
// is refused by name.
#include <fmt/format.h>

#include <sstream>

#include "import_case.hpp"
#include "model/store.hpp"
#include "model/thin_regions.hpp"
#include "succeeded.hpp"

namespace hilo::test::import_shell_test {
namespace {

class ImportShell : public test::Import {
 protected:
  /// Length of the last way of a probe of run.h5.
  Vec3 way(const std::string& probe) {
    const Store run = Store::open(place / "run.h5");
    const auto x = run.read<double>("/history/probe/" + probe);
    const size_t n = x.size() / run.shape("/history/probe/" + probe)[0];
    return Vec3(x[x.size() - n] - x[0], x[x.size() - n + 1] - x[1], x[x.size() - n + 2] - x[2]);
  }
};

/// A quarter of a cylinder of radius 1 about y, 2 long.
const std::string arch =
    "Point(1) = {1, 0, 0}; Point(2) = {0, 0, 1}; Point(3) = {0, 0, 0}; Circle(1) = {1, 3, 2};\n"
    "e[] = Extrude {0, 2, 0} { Curve{1}; Layers{4}; Recombine; };\nTransfinite Curve{1} = 11;\n"
    "Physical Surface(\"roof\") = {e[1]}; Physical Curve(\"front\") = {1}; Physical Point(\"corner\") = {1};\n";

TEST_F(ImportShell, ASurfaceOfGmshHasItsThickness) {
  place.write("arch.geo", arch);
  const Mesh m = imported("arch.geo", "--thickness 0.1");
  ASSERT_EQ(m.n_cells(), 40);
  ASSERT_EQ(m.n_nodes(), 2 * 55);
  for (std::int64_t c = 0; c < m.n_cells(); ++c) EXPECT_EQ(info(m.shape[c]).name, "shell8");
  const double chord = 2 * std::sin(M_PI / 40);  // of a circle of radius 1
  EXPECT_NEAR(test::volume(m), 10 * chord * 2 * 0.1 * std::cos(M_PI / 40), 1e-3 * test::volume(m));
  EXPECT_EQ(m.region_name, std::vector<std::string>{"roof"});
  EXPECT_EQ(m.node_sets.at("corner").size(), 2u) << "a pair";
  EXPECT_EQ(m.facet_sets.at("front").size(), 10u) << "an edge is a strip of facets";
  EXPECT_LT(std::abs(test::vector_area(m, m.facet_sets.at("front")).y() + test::volume(m) / 2), 1e-3);
  const Vec3 top = test::vector_area(m, m.facet_sets.at("roof_top")), bottom = test::vector_area(m, m.facet_sets.at("roof_bottom"));
  // at a free edge the pair stands on its own cell, half a cell's angle off the radius
  const double turned = 0.05 * (std::cos(M_PI / 40) - std::sin(M_PI / 40));
  EXPECT_NEAR(std::max(top.norm(), bottom.norm()), (1 + turned) * 2 * std::sqrt(2), 1e-6);
  EXPECT_NEAR(std::min(top.norm(), bottom.norm()), (1 - turned) * 2 * std::sqrt(2), 1e-6);
  EXPECT_LT(top.dot(bottom), 0);
  EXPECT_NEAR(test::volume(imported("arch.geo", "--thickness 0.1 --units mm-t-s --scale 1000")), test::volume(m), 1e-9);
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
  EXPECT_NEAR(test::vector_area(m, m.facet_sets.at("foot")).norm(), 0.25, 1e-12) << "one face of it";
  EXPECT_NEAR(test::vector_area(m, m.facet_sets.at("under")).z(), -0.25, 1e-12) << "a face of the solid";
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
  place.write("two.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + nodes + cells);
  const Mesh two = imported("two.msh", "--thickness plate=0.1");
  EXPECT_EQ(two.n_cells(), 2);
  EXPECT_NEAR(test::vector_area(two, two.facet_sets.at("foot")).z(), 1, 1e-12);
  refused("two.msh -o a.h5 --thickness plate=0.1 --thickness foot=0.2", 1,
          "--thickness: surface 1 is in two groups that become shells, \"foot\" the second (name one of them: --thickness NAME=T)");
  // a mistake of a mesher: an element turned over onto its neighbour
  place.write("over.inp",
              "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,.4,0,0\n6,.4,1,0\n*ELEMENT, TYPE=S4, ELSET=P\n1,1,2,3,4\n"
              "2,2,5,6,3\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,.3\n*SHELL SECTION, ELSET=P, MATERIAL=M\n.01\n");
  imported("over.inp", "--thicken");
  expect_said("warning: 1 shells lie on a neighbour, edge on edge, as those of a mesher's mistake do: the first is element 2");
}

TEST_F(ImportShell, WhatHasNoClearPairsIsRefused) {
  place.write("arch.geo", arch);
  refused("arch.geo -o a.h5", 2, "arch.geo: no volume to mesh (the geometry holds points, curves or surfaces only)");
  refused("arch.geo -o a.h5 --thickness 0", 1, "--thickness must be positive (see hilo-import --help)");
  refused("arch.geo -o a.h5 --thickness 0.1 --order 2", 1, "--thickness makes linear shells (leave --order away)");
  const std::string quads = "*ELEMENT, TYPE=S4, ELSET=P\n",
                    rest = "*MATERIAL, NAME=M\n*ELASTIC\n1e9, .3\n*SHELL SECTION, ELSET=P, MATERIAL=M\n.1\n",
                    nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,0,1,0\n5,1,1,0\n6,2,1,0\n7,1,0,1\n8,1,1,1\n9,1,0,-1\n10,1,1,-1\n";
  place.write("apart.inp", nodes +
                               "11,.5,0,0\n12,.5,.5,0\n13,0,.5,0\n14,.5,0,0\n15,.5,-.5,0\n16,0,-.5,0\n17,0,-1,0\n"
                               "*ELEMENT, TYPE=S6, ELSET=P\n1,1,2,4,11,12,13\n2,2,1,17,14,16,15\n" +
                               rest);
  refused("apart.inp -o a.h5 --thicken", 2,
          "apart.inp: element 2: nodes 11 and 14 stand in the middle of one edge (--merge-nodes, where they are one)");
  const std::string plate =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nCQUAD4,1,7,1,2,3,4\nMAT1,1,2.1+11,,.3,7850.\n";
  place.write("membrane.bdf", plate + "PSHELL,7,1,.1\n");
  refused("membrane.bdf -o a.h5 --thicken", 2,
          "membrane.bdf: element 1: PSHELL with another material in bending, or none is no plate of one material (leave them as they are: "
          "regions that are rigid)");
  place.write("soft.bdf", plate + "PSHELL,7,1,.1,1,.5\n");
  refused("soft.bdf -o a.h5 --thicken", 2,
          "soft.bdf: element 1: PSHELL with 12I/T^3 other than 1, or MID4 is no plate of one material (leave them as they are: regions "
          "that are "
          "rigid)");
}

/// A strip 10 x 1 x 0.1 along x, clamped at x = 0, with 2 N along z at its end: tip P L^3/(3 E I), and what shear adds.
constexpr double strip_tip = 2. * 1000 / (3 * 1e9 * 1e-3 / 12) + 2. * 10 / (5. / 6 * 0.5e9 * 0.1);

TEST_F(ImportShell, AClampedDeckOfS4BendsAsItsBeam) {
  std::string nodes = "*NODE\n", cells = "*ELEMENT, TYPE=S4R, ELSET=STRIP\n";
  for (int i = 0; i <= 20; ++i) nodes += fmt::format("{},{},0,0\n{},{},1,0\n", 2 * i + 1, i / 2., 2 * i + 2, i / 2.);
  for (int i = 0; i < 20; ++i) {
    const int a = 2 * i + 1;
    cells += i % 2 ? fmt::format("{},{},{},{},{}\n", i + 1, a, a + 2, a + 3, a + 1)
                   : fmt::format("{},{},{},{},{}\n", i + 1, a, a + 1, a + 3, a + 2);
  }
  place.write("strip.inp",
              nodes + cells +
                  "*NSET, NSET=ROOT\n1,2\n*NSET, NSET=END\n41,42\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,0.\n*DENSITY\n1000\n"
                  "*SHELL SECTION, ELSET=STRIP, MATERIAL=M\n.1\n*BOUNDARY\nROOT,1,6\n*STEP\n*STATIC\n*CLOAD\nEND,3,1.\n*END STEP\n");
  imported("strip.inp", "--thicken --scene-out scene.toml");
  expect_said("20 quadrangles became solid-shells, 42 nodes pairs");
  place.write("scene.toml", test::text_of(place / "scene.toml") + "\n[[probe]]\nname = \"END\"\non = \"END\"\n");
  succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
  EXPECT_NEAR(way("END").z() / strip_tip, 1, 2e-3);
}

/// The strip in 10 fields of 1 x 1, its elements by this function of the field and of the node at (2 i, 2 j) halves; loads at its end.
void write_strip(const Workplace& place, const std::function<std::string(int, const std::function<int(int, int)>&)>& field, bool middles) {
  std::string text = "*NODE\n";
  const auto node = [](int i, int j) { return 3 * i + j + 1; };
  std::set<int> used;
  std::string cells;
  for (int k = 0; k < 10; ++k) cells += field(k, [&](int i, int j) { return used.insert(node(2 * k + i, j)), node(2 * k + i, j); });
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 2; ++j)
      if (used.contains(node(i, j))) text += fmt::format("{},{},{},0\n", node(i, j), i / 2., j / 2.);
  const char* middle = middles ? ",2" : "";
  place.write("strip.inp", text + cells + "*NSET, NSET=ROOT\n1,3" + middle + "\n*NSET, NSET=END\n61,63\n" +
                               (middles ? "*NSET, NSET=MID\n62\n" : "") +
                               "*ELSET, ELSET=STRIP\nT,Q\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,0.\n*DENSITY\n1000\n"
                               "*SHELL SECTION, ELSET=STRIP, MATERIAL=M\n.1\n*BOUNDARY\nROOT,1,6\n*STEP\n*STATIC\n*CLOAD\n" +
                               (middles ? "END,3,.3333333333\nMID,3,1.3333333333\n" : "END,3,1.\n") + "*END STEP\n");
}

// Triangles, triangles beside quadrangles and both with mid-side nodes: all become quadrangles that share the deck's nodes.
TEST_F(ImportShell, TrianglesAndMidSideNodesBendAsTheBeam) {
  const auto solved_tip = [&] {
    place.write("scene.toml", test::text_of(place / "scene.toml") + "\n[[probe]]\nname = \"END\"\non = \"END\"\n");
    const auto ran = succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
    return ran.exit == 0 ? way("END").z() / strip_tip : 0.;
  };
  const std::string t = "*ELEMENT, TYPE=S3, ELSET=T\n", q = "*ELEMENT, TYPE=S4, ELSET=Q\n";
  write_strip(
      place,
      [&](int k, const auto& n) {
        return k % 2 ? q + fmt::format("{},{},{},{},{}\n", 100 + k, n(0, 0), n(2, 0), n(2, 2), n(0, 2))
                     : t + fmt::format("{},{},{},{}\n{},{},{},{}\n", 2 * k + 1, n(0, 0), n(2, 0), n(2, 2), 2 * k + 2, n(0, 0), n(2, 2),
                                       n(0, 2));
      },
      false);
  const Mesh mixed = imported("strip.inp", "--thicken --scene-out scene.toml");
  EXPECT_EQ(mixed.n_cells(), 5 * 6 + 5 * 4);
  EXPECT_NEAR(test::volume(mixed), 1, 1e-12);
  expect_said("15 surfaces have triangles or mid-side nodes among them: 50 quadrangles");
  const double linear = solved_tip();
  EXPECT_NEAR(linear, 1, 0.005);
  write_strip(
      place,
      [&](int k, const auto& n) {
        return k % 2 ? "*ELEMENT, TYPE=S8R, ELSET=Q\n" + fmt::format("{},{},{},{},{},{},{},{},{}\n", 100 + k, n(0, 0), n(2, 0), n(2, 2),
                                                                     n(0, 2), n(1, 0), n(2, 1), n(1, 2), n(0, 1))
                     : "*ELEMENT, TYPE=S6, ELSET=T\n" + fmt::format("{},{},{},{},{},{},{}\n{},{},{},{},{},{},{}\n", 2 * k + 1, n(0, 0),
                                                                    n(2, 0), n(2, 2), n(1, 0), n(2, 1), n(1, 1), 2 * k + 2, n(0, 0),
                                                                    n(2, 2), n(0, 2), n(1, 1), n(1, 2), n(0, 1));
      },
      true);
  EXPECT_EQ(imported("strip.inp", "--thicken --scene-out scene.toml").n_nodes(), 2 * (63 + 10)) << "a centre of each, middles of the deck";
  const double quadratic = solved_tip();
  std::printf("tip of the beam's: S3 and S4 %.4f, S6 and S8R %.4f\n", linear, quadratic);
  EXPECT_NEAR(quadratic, linear, 2e-3) << "the same quadrangles, the load on three nodes instead of two";
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

/// The strip of CQUAD4 with its load and these lines.
std::string cquad4_strip(const std::string& lines) {
  std::string deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,1.+9,,0.,1000.\nPSHELL,7,1,.1,1,,1\n" + lines;
  for (int i = 0; i <= 20; ++i) deck += fmt::format("GRID,{},,{:.1f},0.,0.\nGRID,{},,{:.1f},1.,0.\n", 2 * i + 1, i / 2., 2 * i + 2, i / 2.);
  for (int i = 0; i < 20; ++i) deck += fmt::format("CQUAD4,{},7,{},{},{},{}\n", i + 1, 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2);
  return deck + "FORCE,2,41,,1.,0.,0.,1.\nFORCE,2,42,,1.,0.,0.,1.\nENDDATA\n";
}

TEST_F(ImportShell, AClampedDeckOfCquad4BendsAsItsBeam) {
  place.write("strip.bdf", cquad4_strip("SPC1,1,123456,1,2\n"));
  const Mesh m = imported("strip.bdf", "--thicken --scene-out scene.toml");
  std::string end;
  for (const auto& [name, set] : m.facet_sets)
    if (std::abs(m.X[m.facet_nodes(set[0])[0]].x() - 10) < 1e-9 && set.size() == 1) end = name;
  ASSERT_NE(end, "");
  place.write("scene.toml", test::text_of(place / "scene.toml") + "\n[[probe]]\nname = \"end\"\non = \"" + end + "\"\n");
  succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
  EXPECT_NEAR(way("end").z() / strip_tip, 1, 2e-3);
}

// The hull of the firing vehicle in plates of the thicknesses that data/firing/Makefile names, beside its solid of tetrahedra: of equal
// density, so the masses are as the volumes.
TEST_F(ImportShell, TheHullOfTheVehicleWeighsWhatItsSolidDoes) {
  const std::string folder = std::string(HILO_SOURCE) + "/data/firing/", make = test::text_of(folder + "Makefile"), key = "PLATES := ";
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

// T1 to T4, as numbers, as shares of the property's and of triangles: a strip whose thickness falls to half from root to end.  Volume,
// centre, and what a force at its end does: the integral of P (L - x)^2/(E I(x)).
TEST_F(ImportShell, ThicknessesAtCornersTaperAStrip) {
  const double L = 10, h = .1, P = 2, E = 1e9;
  double tip = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = (i + .5) * L / 1000;
    tip += P * (L - x) * (L - x) / (E * std::pow(h * (1 - x / 20), 3) / 12) * L / 1000;
  }
  const std::string plain = cquad4_strip("SPC1,1,123456,1,2\n");
  for (const std::string form : {"numbers", "shares", "triangles"}) {
    std::string deck;
    std::istringstream lines(plain);
    for (std::string line; std::getline(lines, line);) {
      int e = 0, n[4];
      if (std::sscanf(line.c_str(), "CQUAD4,%d,7,%d,%d,%d,%d", &e, n, n + 1, n + 2, n + 3) != 5) {
        deck += line + "\n";
        continue;
      }
      const auto t = [&](int grid) { return (form == "shares" ? 1 : h) * (1 - (grid - 1) / 2 / 40.); };
      if (form == "triangles")
        for (const auto& [id, a, b, c] : {std::array{e, n[0], n[1], n[2]}, std::array{100 + e, n[0], n[2], n[3]}})
          deck += fmt::format("CTRIA3,{},7,{},{},{},,,,+\n+,,,{:.6f},{:.6f},{:.6f}\n", id, a, b, c, t(a), t(b), t(c));
      else
        deck +=
            line + fmt::format(",,,+\n+,,{},{:.6f},{:.6f},{:.6f},{:.6f}\n", form == "shares" ? 1 : 0, t(n[0]), t(n[1]), t(n[2]), t(n[3]));
    }
    place.write("strip.bdf", deck);
    test::succeeded(place.run("hilo-import --quiet strip.bdf -o rigid.h5"));
    const auto moments = read_thin_regions(place / "rigid.h5").at(0).moments;
    EXPECT_NEAR(moments[0], .75 * h * L, 1e-7) << form;
    EXPECT_NEAR(moments[1], h * (L * L / 2 - L * L * L / 60), 1e-6) << form;
    const Mesh m = imported("strip.bdf", "--thicken --scene-out scene.toml");
    double across = 0;
    EXPECT_NEAR(volume(m), .75 * h * L, 1e-6) << form;
    for (const Vec3& X : m.X) across = std::max(across, std::abs(std::abs(X.z()) - h / 2 * (1 - X.x() / 20)));
    EXPECT_LT(across, 1e-6) << form;
    EXPECT_TRUE(m.block.empty()) << form << ": it is one sheet";
    place.write("scene.toml",
                test::text_of(place / "scene.toml") +
                    "\n[set.end]\nkind = \"box\"\nlow = [9.99, -1, -1]\nhigh = [10.01, 2, 1]\n[[probe]]\nname = \"end\"\non = \"end\"\n");
    succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
    std::printf("%s: %.4f\n", form.c_str(), way("end").z() / tip);
    EXPECT_NEAR(way("end").z() / tip, 1, form == "triangles" ? 1e-2 : 5e-3) << form;
  }
  const std::string head = plain.substr(0, plain.find("CQUAD4"));
  for (const auto& [entry, why] : {std::pair{"CQUAD4,1,7,1,3,4,2,,,+\n+,,,.1,-.1,.1,.1\n", "CQUAD4 1: T2 -0.1 is not above 0"},
                                   std::pair{"CQUAD4,1,7,1,3,4,2,,,+\n+,,2,.1\n", "CQUAD4 1: TFLAG 2 is neither 0 nor 1"}}) {
    place.write("bad.bdf", head + entry);
    expect_end(place.run("hilo-import bad.bdf -o bad.h5"), 2, why);
  }
}

// A quarter of a clamped square under a force in its middle, in CTRIA3: 0.00560 P a^2/D [timoshenko-1959].  Nodes between the supports of
// symmetry and the corners, which are held in more, are held as on both sides.
TEST_F(ImportShell, AQuarterOfAPlateOfCtria3HasTheSymmetryOfTheWhole) {
  const int n = 8;
  const auto grid = [&](int i, int j) { return i * (n + 1) + j + 1; };
  std::string deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,2.1+11,,.3,7850.\nPSHELL,7,1,.01,1,,1\n";
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      deck += fmt::format("GRID,{},,{:.5f},{:.5f},0.\n", grid(i, j), 0.5 * i / n, 0.5 * j / n);
      if (i == n || j == n) deck += fmt::format("SPC1,1,123456,{}\n", grid(i, j));
      if (i == 0) deck += fmt::format("SPC1,1,156,{}\n", grid(i, j));
      if (j == 0) deck += fmt::format("SPC1,1,246,{}\n", grid(i, j));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      deck += fmt::format("CTRIA3,{},7,{},{},{}\nCTRIA3,{},7,{},{},{}\n", 2 * (i * n + j) + 1, grid(i, j), grid(i + 1, j),
                          grid(i + 1, j + 1), 2 * (i * n + j) + 2, grid(i, j), grid(i + 1, j + 1), grid(i, j + 1));
  place.write("plate.bdf", deck + "FORCE,2,1,,25.,0.,0.,1.\nENDDATA\n");
  const Mesh m = imported("plate.bdf", "--thicken --scene-out scene.toml");
  EXPECT_EQ(m.n_cells(), 3 * 2 * n * n);
  std::set<std::int64_t> held;
  const std::string scene = test::text_of(place / "scene.toml");
  const auto take = [&](const std::string& name) {
    if (m.node_sets.contains(name)) held.insert(m.node_sets.at(name).begin(), m.node_sets.at(name).end());
    if (m.facet_sets.contains(name))
      for (const Facet& f : m.facet_sets.at(name))
        for (const auto a : m.facet_nodes(f)) held.insert(a);
  };
  for (size_t at = scene.find("[[motion]]"); at != scene.npos; at = scene.find("[[motion]]", at + 1)) {
    const size_t from = scene.find("on = \"", at) + 6;
    take(scene.substr(from, scene.find('"', from) - from));
  }
  for (std::int64_t a = 0; a < m.n_nodes(); ++a)
    if (m.X[a].x() * m.X[a].y() * (0.5 - m.X[a].x()) * (0.5 - m.X[a].y()) < 1e-12) {
      EXPECT_TRUE(held.contains(a)) << m.X[a].transpose();
    }
  place.write("scene.toml", scene +
                                "\n[set.middle]\nkind = \"ball\"\nat = [0, 0, 0]\nradius = 0.006\n[[probe]]\nname = \"middle\"\non = "
                                "\"middle\"\n");
  succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"));
  const double share = way("middle").z() / (0.0056 * 100 * 12 * (1 - 0.09) / (2.1e11 * 1e-6));
  std::printf("middle %.4f of Timoshenko's\n", share);
  EXPECT_NEAR(share, 1, 0.02);
}

// Grids of no element, and grids that are merged, leave a support on its own node.
TEST_F(ImportShell, ASupportStaysWithItsNode) {
  const std::string pinned = "SPC1,1,123,41,42\nSPC1,1,123456,1,2\n";
  std::string unused, twins;
  for (int i = 0; i < 6; ++i) unused += fmt::format("GRID,{},,{}.,0.,0.\n", 900 + i, -5 - i);
  twins = "GRID,901,,0.,0.,0.\nGRID,902,,.5,0.,0.\nGRID,903,,.5,1.,0.\nGRID,904,,0.,1.,0.\nCQUAD4,900,7,901,902,903,904\n";
  const auto check = [&](const std::string& deck, const std::string& options = "") {
    const Mesh m = imported(deck, "--thicken " + options);
    ASSERT_EQ(m.block_name, (std::vector<std::string>{"grid_41", "grid_42"})) << "hinges";
    EXPECT_LT((m.block_at[0] - Vec3(10, 0, 0)).norm(), 1e-12);
    EXPECT_LT((m.block_at[1] - Vec3(10, 1, 0)).norm(), 1e-12);
    for (size_t a = 0; a < m.block.size(); ++a)
      if (m.block[a] >= 0) {
        EXPECT_NEAR((m.X[a] - m.block_at[static_cast<size_t>(m.block[a])]).norm(), 0.05, 1e-12);
      }
    EXPECT_EQ(std::ranges::count(m.block, 0), 2);
  };
  place.write("alone.bdf", cquad4_strip(pinned));
  check("alone.bdf");
  place.write("unused.bdf", cquad4_strip(unused + pinned));
  check("unused.bdf");
  // the four twins lie before the strip's nodes, which lose four of theirs
  std::string apart = cquad4_strip(twins + pinned);
  apart.replace(apart.find("CQUAD4,1,7,1,3,4,2\n"), 19, "");
  place.write("twins.bdf", apart);
  check("twins.bdf", "--merge-nodes 1e-6");
  place.write("clamped.bdf", cquad4_strip(unused + "SPC1,1,123456,1,2\n"));
  EXPECT_EQ(imported("clamped.bdf", "--thicken").n_cells(), 20);
}

// What turns a beam that is a cell is left out by name beside --thicken too: pairs of nodes are of shells alone.
TEST_F(ImportShell, SupportsThatHoldRigidBeamsFromTurningAreNamed) {
  place.write("beam.bdf",
              "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,1.+9,,0.,1000.\nPSHELL,7,1,.1,1,,1\nPBAR,8,1,.01,1.-5,1.-5\n"
              "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\n"
              "CQUAD4,1,7,1,2,3,4\nCBAR,2,8,5,6,0.,0.,1.\nSPC1,1,123456,1,4\nSPC1,1,123456,5\nFORCE,2,6,,1.,0.,0.,1.\nENDDATA\n");
  imported("beam.bdf", "--thicken --rigid-beams --scene-out scene.toml");
  expect_said("turns and moments of grids of shells and beams (1, beam.bdf:18)");
  EXPECT_NE(test::text_of(place / "scene.toml").find("card = \"turns and moments of grids of shells and beams\""), std::string::npos);
  place.write("beam.inp",
              "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n*ELEMENT, TYPE=S4, ELSET=P\n1,1,2,3,4\n"
              "*ELEMENT, TYPE=B31, ELSET=R\n2,5,6\n*MATERIAL, NAME=M\n*ELASTIC\n1e9,.3\n*DENSITY\n1000\n"
              "*SHELL SECTION, ELSET=P, MATERIAL=M\n.1\n*BEAM SECTION, ELSET=R, MATERIAL=M, SECTION=RECT\n.1,.1\n0,0,1\n"
              "*BOUNDARY\n1,1,6\n4,1,6\n5,1,6\n*STEP\n*STATIC\n*CLOAD\n6,5,1.\n*END STEP\n");
  imported("beam.inp", "--thicken --rigid-beams --scene-out scene.toml");
  expect_said("turns and moments of nodes of shells and beams (2, beam.inp:25)");
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
  place.write("arch.geo", arch);
  refused("arch.geo -o a.h5 --thicken", 1,
          "--thicken is for shells of a deck, arch.geo is none (--thickness makes shells of its surfaces)");
  place.write("strip.bdf", cquad4_strip("SPC1,1,123456,1,2\n"));
  refused("strip.bdf -o a.h5 --thickness 0.3", 1,
          "--thickness is for surfaces of a geometry, .msh, .unv, .med or Exodus file, strip.bdf is none (--thicken makes shells of a "
          "deck, with the deck's "
          "thickness)");
  place.write("a.vtk", "# vtk DataFile Version 3.0\n");
  refused("a.vtk -o a.h5 --thickness 0.3", 1, "--thickness is for surfaces of a geometry, .msh, .unv, .med or Exodus file, a.vtk is none");
}

}  // namespace
}  // namespace hilo::test::import_shell_test
