// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene of four times as many springs costs to read and to build: four times as much, not sixteen.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include "model/local_mesh.hpp"
#include "system/system.hpp"
#include "verify/verify.hpp"

namespace hilo::test {
namespace {

double processor_seconds(int who) {
  rusage used{};
  getrusage(who, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/// The least of three times [s] that `work` takes in this process.
template <class Work>
double seconds(const Work& work) {
  double least = 1e300;
  for (int k = 0; k < 3; ++k) {
    const double before = processor_seconds(RUSAGE_SELF);
    work();
    least = std::min(least, processor_seconds(RUSAGE_SELF) - before);
  }
  return least;
}

/// n springs to the ground at as many nodes of a block of 8000 hexahedra, each node a set.
struct Springs {
  explicit Springs(int n) {
    BlockOptions o;
    o.n[0] = o.n[1] = o.n[2] = 20;
    Mesh mesh = block_mesh(o);
    text = "[material.m]\nE = 1e9\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n[time]\nanalysis = \"static\"\n";
    for (int i = 0; i < n; ++i) {
      const std::string name = "n" + std::to_string(i);
      mesh.node_sets[name] = {i};
      const Vec3& x = mesh.X[static_cast<size_t>(i)];
      text += fmt::format(
          "[[spring]]\nkind = \"axial\"\nname = \"s{}\"\nb = \"{}\"\nat_a = [{}, {}, {}]\nat_b = [{}, {}, {}]\nstiffness = 1e3\n", i, name,
          x[0], x[1], x[2] - 1, x[0], x[1], x[2]);
    }
    write_mesh(folder / "mesh.h5", mesh, {"test"});
  }
  Folder folder;
  std::string text;
};

}  // namespace

// Wide margins: 4 is linear, 16 the square.
TEST(Growth, OfSpringsAtManyNodesIsLinear) {
  double of_scene[2], of_system[2];
  for (const int large : {0, 1}) {
    const Springs s(large ? 8000 : 2000);
    of_scene[large] = seconds([&] { Scene::parse(s.text, "scene.toml"); });
    const Scene scene = Scene::parse(s.text, "scene.toml");
    LocalMesh mesh = read_local_mesh(s.folder / "mesh.h5", Comm::world());
    of_system[large] = seconds([&] { build_system(scene, &mesh, Comm::world()); });
  }
  EXPECT_LT(of_scene[1] / of_scene[0], 6) << of_scene[0] << " and " << of_scene[1] << " s";
  EXPECT_LT(of_system[1] / of_system[0], 6) << of_system[0] << " and " << of_system[1] << " s";
}

// On one body, as the report had it: 20 000 did not end in 30 s, where 4000 took .6 s.
TEST(Growth, OfSpringsOnOneBodyIsLinear) {
  double of_all[2];
  for (const int large : {0, 1}) {
    std::string text = "[[body]]\nname = \"b\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[time]\nend = 1e-3\nstep = 1e-3\n";
    for (int i = 0; i < (large ? 8000 : 2000); ++i)
      text += "[[spring]]\nkind = \"bushing\"\nname = \"s" + std::to_string(i) +
              "\"\nb = \"b\"\nat = [0, 0, 1]\nstiffness = [1, 1, 1]\nangular_stiffness = [1, 1, 1]\n";
    of_all[large] = seconds([&] {
      const Scene scene = Scene::parse(text, "scene.toml");
      build_system(scene, nullptr, Comm::world());
    });
  }
  EXPECT_LT(of_all[1] / of_all[0], 6) << of_all[0] << " and " << of_all[1] << " s";
}

// hilo-import of a deck whose springs stand at as many nodes.
TEST(Growth, OfADecksSpringsIsLinear) {
  const Workplace w;
  double of_import[2];
  for (const int large : {0, 1}) {
    const int n = large ? 8000 : 2000;
    std::string text = "*NODE\n";
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k < 4; ++k)
        text += std::to_string(4 * i + k + 1) + ", " + std::to_string(i) + ", " + (k % 3 ? "1" : "0") + ", " + (k / 2 ? "1" : "0") + "\n";
    text += "*ELEMENT, TYPE=C3D8, ELSET=bar\n";
    for (int i = 0; i < n; ++i) {
      text += std::to_string(i + 1);
      for (int k = 0; k < 8; ++k) text += ", " + std::to_string(4 * (i + (k > 3)) + k % 4 + 1);
      text += "\n";
    }
    text += "*MATERIAL, NAME=m\n*ELASTIC\n1e9, 0.3\n*DENSITY\n1000\n*SOLID SECTION, ELSET=bar, MATERIAL=m\n";
    text += "*ELEMENT, TYPE=SPRING1, ELSET=feet\n";
    for (int i = 0; i < n; ++i) text += std::to_string(n + i + 1) + ", " + std::to_string(4 * i + 1) + "\n";
    text += "*SPRING, ELSET=feet\n2\n1e3\n";
    w.write("deck.inp", text);
    double least = 1e300;
    for (int k = 0; k < 2; ++k) {
      const double before = processor_seconds(RUSAGE_CHILDREN);
      const Ran ran = w.run("hilo-import --quiet deck.inp -o mesh.h5");
      ASSERT_EQ(ran.exit, 0) << ran.err;
      least = std::min(least, processor_seconds(RUSAGE_CHILDREN) - before);
    }
    of_import[large] = least;
  }
  EXPECT_LT(of_import[1] / of_import[0], 6) << of_import[0] << " and " << of_import[1] << " s";
}

}  // namespace hilo::test
