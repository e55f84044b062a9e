// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of a script as beams of the scene, run and compared with closed forms.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"

namespace hilo::test::import_curves_test {
namespace {

class ImportCurves : public test::Import {
 protected:
  /// Imports a script to a.toml, and reads what section stands on each group of points.
  void import(const std::string& script, const std::string& options) {
    place.write("a.geo", script);
    (void)test::succeeded(place.run("hilo-import --quiet a.geo -o out.h5 --scene-out a.toml --scale 1e-3 " + options));
    scene = place.run("cat a.toml").out;
    std::istringstream lines(scene);
    for (std::string line; std::getline(lines, line);)
      if (std::istringstream words(line.starts_with("# point ") ? line.substr(8) : ""); words.good()) {
        std::string point, is, section;
        if (words >> point >> is >> section) at[point] = section;
      }
  }
  /// The way of a section under what is added to the scene.
  Vec3 moved(const std::string& section, const std::string& more, double gravity = 0) {
    place.write("b.toml", "gravity = [0, 0, " + std::to_string(-gravity) + "]\n" + scene +
                              "\n[material.beams]\nE = 2.1e11\nnu = 0.3\ndensity = 7850\n" + more + "[[probe]]\nname = \"p\"\non = \"" +
                              section + "\"\n[time]\nanalysis = \"static\"\nsteps = 1\n");
    (void)test::succeeded(place.run("hilo-solve --quiet b.toml -o run.h5"));
    const auto x = Store::open(place / "run.h5").read<double>("/history/probe/p");
    const size_t columns = x.size() / 2;
    return {x[columns] - x[0], x[columns + 1] - x[1], x[columns + 2] - x[2]};
  }
  static std::string clamped(const std::string& section) {
    return fmt::format("[[joint]]\nkind = \"fixed\"\nname = \"foot {0}\"\na = \"ground\"\nb = \"{0}\"\nat = [0, 0, 0]\n", section);
  }
  std::string scene;
  std::map<std::string, std::string> at;
};

// Columns 2 m high, clamped, and a girder as long, all of one section: 24 EI/h^3 (6 + 1)/(6 + 4).
TEST_F(ImportCurves, APortalSwaysAsItShould) {
  import(
      "Point(1) = {0, 0, 0}; Point(2) = {0, 0, 2000}; Point(3) = {2000, 0, 2000}; Point(4) = {2000, 0, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {4, 3};\nMesh.MeshSizeMax = 700;\n"
      "Physical Curve(\"column\") = {1, 3}; Physical Curve(\"girder\") = {2};\n"
      "Physical Point(\"left\") = {1}; Physical Point(\"right\") = {4}; Physical Point(\"top\") = {2};\n",
      "--beams column=tube:diameter=20,thickness=1 --beams 'girder=tube:diameter=20,thickness=1'");
  const double E = 2.1e11, I = std::numbers::pi / 64 * (std::pow(0.02, 4) - std::pow(0.018, 4)), H = 0.1;
  const Vec3 u =
      moved(at.at("top"), clamped(at.at("left")) + clamped(at.at("right")) +
                              fmt::format("[[load]]\nkind = \"force\"\nname = \"H\"\non = \"{}\"\nforce = [{}, 0, 0]\n", at.at("top"), H));
  EXPECT_NEAR(u.x() / (H * 8 / (24 * E * I) * 10 / 7), 1, 2e-3);
}

// An arch of quadratic lines and, in one group with it, a closed ring on no fork and a loop on the crown: what they weigh is their length.
TEST_F(ImportCurves, RingsAndLoopsWeighTheirLength) {
  const std::string script =
      "Point(1) = {-1000, 0, 0}; Point(2) = {0, 0, 1000}; Point(3) = {1000, 0, 0}; Point(4) = {0, 0, 0};\n"
      "Circle(1) = {1, 4, 2}; Circle(2) = {2, 4, 3};\n"
      "Point(5) = {0, 300, 1000}; Point(6) = {0, 300, 1300}; Line(3) = {2, 5}; Line(4) = {5, 6}; Line(5) = {6, 2};\n"
      "Physical Curve(\"arch\") = {1, 2, 3, 4, 5}; Physical Point(\"left\") = {1}; Physical Point(\"right\") = {3};\n"
      "Mesh.MeshSizeMax = 100; Mesh.ElementOrder = 2;\n";
  import(script, "--beams arch=circle:diameter=20");
  (void)moved(at.at("left"), clamped(at.at("left")) + clamped(at.at("right")), 9.81);
  const auto left = Store::open(place / "run.h5").read<double>("/history/joint/foot " + at.at("left"));
  const auto right = Store::open(place / "run.h5").read<double>("/history/joint/foot " + at.at("right"));
  const double length = std::numbers::pi + 0.6 + 0.3 * std::sqrt(2.0), weight = 7850 * std::numbers::pi * 1e-4 * length * 9.81;
  EXPECT_NEAR(std::abs(left[left.size() / 2 + 2]) + std::abs(right[right.size() / 2 + 2]), weight, 1e-3 * weight);
}

TEST_F(ImportCurves, WhatIsNoBeamIsRefused) {
  place.write("a.geo", "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Line(1) = {1, 2}; Physical Curve(\"rail\") = {1};\n");
  const auto refused_by = [&](const std::string& words, const std::string& what) { refused("a.geo -o b.h5 --beams " + words, 1, what); };
  refused_by("rail", "--beams rail: expected GROUP=KIND:KEY=VALUE,... (as in 'rail=tube:diameter=60,thickness=3')");
  refused_by("rail=tube:diameter=1", "--beams rail=tube:diameter=1: section \"rail\": \"thickness\" is missing (of the walls)");
  refused_by("rail=cube:width=1", "--beams rail=cube:width=1: section \"rail\": unknown kind \"cube\" (did you mean \"tube\"?)");
  refused_by("rail=circle:diameter=1,shear=[0.9]",
             "--beams rail=circle:diameter=1,shear=[0.9]: shear is written into the scene (leave it out here)");
  refused_by("beam=circle:diameter=1", "--beams beam: no curve group of this name has lines");
  refused_deck("a.inp", "*NODE\n1,0,0,0\n", "-o b.h5 --beams rail=circle:diameter=1", 1,
               "--beams is for curves of a geometry or .msh file, a.inp is none (beams of a deck stand in its scene)");
}

}  // namespace
}  // namespace hilo::test::import_curves_test
