// SPDX-License-Identifier: GPL-3.0-or-later
// Beams as pictures draw them: swept sections with the stress of their points.
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <numbers>

#include "post/run/playback.hpp"
#include "succeeded.hpp"

namespace hilo::test::beams_test {
namespace {

constexpr double pi = std::numbers::pi;

class DrawnBeams : public testing::Test {
 protected:
  RunFile solved(const std::string& scene) {
    work.write("scene.toml", scene);
    succeeded(work.run("hilo-solve --quiet scene.toml -o run.h5"));
    RunFile run(work / "run.h5");
    run.stand_in_bodies();
    run.draw_beams();
    return run;
  }
  Workplace work;
};

constexpr const char* steel = "[material.m]\nE = 2e11\nnu = 0.3\n[time]\nanalysis = \"static\"\nsteps = 4\n";

double volume(const Mesh& mesh, const char* name) {
  const int region = mesh.find_region(name);
  double sum = 0;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    if (mesh.region[static_cast<size_t>(c)] == region) sum += quality(mesh, c).volume;
  return sum;
}

// The face of each section is swept along its axis: area times length, of rectangles to round-off, of a circle as of its 36 sides.
TEST_F(DrawnBeams, HaveTheVolumeOfTheirSections) {
  RunFile run = solved(
      std::string(steel) +
      "[section.i]\nkind = \"I\"\nwidth = 0.1\nheight = 0.2\nflange = 0.01\nweb = 0.008\n[section.c]\nkind = \"circle\"\ndiameter = 0.04\n"
      "[section.g]\nkind = \"general\"\narea = 0.01\nI1 = 1e-5\nI2 = 4e-6\nJ = 1e-6\n"
      "[beam.one]\npoints = [[0, 0, 0], [1, 2, 2]]\nsection = \"i\"\nmaterial = \"m\"\na = \"ground\"\n"
      "[beam.two]\npoints = [[1, 2, 2], [1, 2, 3]]\nsection = \"c\"\nmaterial = \"m\"\na = \"one.end\"\n"
      "[beam.three]\npoints = [[1, 2, 3], [2, 2, 3]]\nsection = \"g\"\nmaterial = \"m\"\na = \"two.end\"\n");
  const double sides = 18 / pi * std::sin(pi / 18);
  EXPECT_NEAR(volume(run.mesh(), "one"), 3 * (2 * 0.1 * 0.01 + 0.18 * 0.008), 1e-9);
  EXPECT_NEAR(volume(run.mesh(), "two"), pi * 0.02 * 0.02 * sides, 1e-9);
  EXPECT_NEAR(volume(run.mesh(), "three"), 12 * std::sqrt(1e-5 * 4e-6) / 0.01, 1e-9) << "of the same radii of gyration";
  const auto region = [&](const char* name) { return static_cast<size_t>(run.mesh().find_region(name)); };
  EXPECT_TRUE(run.gives(region("one"), "axial_stress"));
  EXPECT_FALSE(run.gives(region("three"), "axial_stress"));
  EXPECT_FALSE(run.gives(region("one"), "acceleration"));
}

// An obstacle with a file beside beams: its file may be elsewhere by now.
TEST_F(DrawnBeams, AreDrawnBesideAFieldOfHeights) {
  work.write("road.csv", "y\\x,-9,9\n-9,0,0\n9,0,0\n");
  (void)solved(
      "[material.m]\nE = 2e11\nnu = 0.3\ndensity = 7850\n[time]\nend = 0.002\nstep = 0.001\n"
      "[section.s]\nkind = \"circle\"\ndiameter = 0.1\n[beam.one]\npoints = [[0, 0, 5], [2, 0, 5]]\nsection = \"s\"\nmaterial = \"m\"\n"
      "[[obstacle]]\nkind = \"height-field\"\nname = \"road\"\nfile = \"road.csv\"\n"
      "[[obstacle]]\nkind = \"sphere\"\nname = \"skin\"\non = \"one.0\"\nradius = 0.1\nat = [0, 0, 5]\n"
      "[[contact]]\nname = \"c\"\na = \"road\"\nb = \"skin\"\nstiffness = 1e4\n");
  std::filesystem::remove(work / "road.csv");
  RunFile run(work / "run.h5");
  run.stand_in_bodies();
  run.draw_beams();
  EXPECT_NEAR(volume(run.mesh(), "one"), 2 * pi * 0.05 * 0.05 * 18 / pi * std::sin(pi / 18), 1e-9);
}

// The peak of a cantilever under a force at its tip is at the root, at its outer fibres: 6 F L/(b h^2).
TEST_F(DrawnBeams, HaveTheirPeaksInTheTable) {
  (void)solved(std::string(steel) + "[section.s]\nkind = \"rectangle\"\nwidth = 0.1\nheight = 0.2\n" +
               "[beam.one]\npoints = [[0, 0, 0], [2, 0, 0]]\nsection = \"s\"\nmaterial = \"m\"\na = \"ground\"\n"
               "[[load]]\nkind = \"force\"\nname = \"f\"\non = \"one.end\"\nforce = [0, 0, 100]\n");
  for (const char* field : {"axial_stress", "von_mises"}) {
    const Ran ran = succeeded(work.run(std::string("hilo-post peak run.h5 --unit Pa --field ") + field));
    char name[20];
    double value = 0, t = 0, X = 0, Y = 0, Z = 0;
    ASSERT_EQ(std::sscanf(ran.out.substr(ran.out.find('\n') + 1).c_str(), "%19s %lf %lf - %lf %lf %lf", name, &value, &t, &X, &Y, &Z), 6)
        << ran.out;
    EXPECT_NEAR(std::abs(value), 6 * 100 * 2 / (0.1 * 0.2 * 0.2), 1) << field;
    EXPECT_EQ(std::string(name), "one");
    EXPECT_NEAR(X, 0, 1e-9);
    EXPECT_NEAR(std::abs(Z), 0.1, 1e-9);
  }
}

// A meshed section is drawn by its cells, holes too: of a ring of 12 quadrangles of 9 nodes a tube of 24 sides.
TEST_F(DrawnBeams, HaveTheOutlineOfTheirMesh) {
  std::string nodes, cells;
  const int n = 12;  // quadrangles of 9 nodes around
  int number = 0;
  for (int i = 0; i < 2 * n; ++i)
    for (const double r : {0.03, 0.04, 0.05}) {
      nodes += std::to_string(++number) + " " + std::to_string(r * std::cos(pi * i / n)) + " " + std::to_string(r * std::sin(pi * i / n)) +
               " 0\n";
    }
  for (int i = 0; i < n; ++i) {
    const auto at = [&](int j, int k) { return " " + std::to_string(3 * ((2 * i + j) % (2 * n)) + k + 1); };
    cells += std::to_string(i + 1) + " 10 2 0 1" + at(0, 0) + at(0, 2) + at(2, 2) + at(2, 0) + at(0, 1) + at(1, 2) + at(2, 1) + at(1, 0) +
             at(1, 1) + "\n";
  }
  work.write("tube.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(number) + "\n" + nodes +
                             "$EndNodes\n$Elements\n" + std::to_string(n) + "\n" + cells + "$EndElements\n");
  RunFile run = solved(std::string(steel) + "[section.t]\nkind = \"mesh\"\nfile = \"tube.msh\"\n" +
                       "[beam.one]\npoints = [[0, 0, 0], [0, 2, 0]]\nsection = \"t\"\nmaterial = \"m\"\na = \"ground\"\n");
  const double sides = n / pi * std::sin(pi / n);
  EXPECT_NEAR(volume(run.mesh(), "one"), 2 * pi * (0.05 * 0.05 - 0.03 * 0.03) * sides, 1e-6);
  EXPECT_TRUE(run.gives(static_cast<size_t>(run.mesh().find_region("one")), "axial_stress"));
}

// Rolled to a circle of radius R, a fibre at the height y is bent to R - y, wherever between two sections, and its stress is E y/R.
TEST_F(DrawnBeams, FollowTheHelixOfEachCell) {
  const double L = 10, h = 0.2, b = 0.1, R = L / (2 * pi), M = 2e11 * b * h * h * h / 12 / R;
  RunFile run = solved(std::string("[section.s]\nkind = \"rectangle\"\nwidth = 0.1\nheight = 0.2\n[material.m]\nE = 2e11\nnu = 0.3\n"
                                   "[time]\nanalysis = \"static\"\nsteps = 8\n"
                                   "[beam.arm]\npoints = [[0, 0, 0], [10, 0, 0]]\ncells = [5]\nsection = \"s\"\nmaterial = \"m\"\n"
                                   "a = \"ground\"\n[[load]]\nkind = \"torque\"\nname = \"t\"\non = \"arm.end\"\ntorque = [0, ") +
                       std::to_string(-M) + ", 0]\n");
  Playback playback(run);
  const std::vector<Vec3> x = playback.positions(playback.last());
  const RunFile::Field stress = run.field(run.steps.back(), "axial_stress");
  ASSERT_EQ(stress.value.size(), x.size());
  for (size_t n = 0; n < x.size(); ++n) {
    const double up = run.mesh().X[n].z();
    EXPECT_NEAR(std::hypot(x[n].x(), x[n].z() - R), R - up, 1e-6);
    EXPECT_NEAR(stress.value[n], -2e11 * up / R, 1e-5 * 2e11 * h / 2 / R);
  }
  // an export holds what the pictures draw
  succeeded(work.run("hilo-post export run.h5 --deformed -o run.vtu"));
  const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
  reader->SetFileName((work / "run.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ASSERT_EQ(static_cast<size_t>(grid->GetNumberOfPoints()), x.size());
  EXPECT_EQ(grid->GetNumberOfCells(), run.mesh().n_cells());
  for (size_t n = 0; n < x.size(); ++n) {
    const auto at = static_cast<vtkIdType>(n);
    EXPECT_LT((Eigen::Map<const Vec3>(grid->GetPoint(at)) - x[n]).norm(), 1e-12);
    EXPECT_EQ(grid->GetPointData()->GetArray("axial_stress")->GetTuple1(at), stress.value[n]);
  }
}

}  // namespace
}  // namespace hilo::test::beams_test
