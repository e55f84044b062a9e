// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene of four times as many springs or regions costs to read and to build: four times as much, not sixteen.
#include <sys/resource.h>

#include "model/local_mesh.hpp"
#include "system/contact/untouched.hpp"
#include "system/system.hpp"
#include "verify/verify.hpp"

namespace hilo::test::growth_test {
namespace {

double processor_seconds(int who) {
  rusage used{};
  getrusage(who, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/// What `large` takes over what `small` takes, processor seconds of `who`: the least of each over ten rounds at most.  A quarter of the
/// size each, so that 4 is linear and 16 the square; another process delays single rounds only.
template <class Small, class Large>
double growth(int who, Small small, Large large) {
  double least[2] = {1e300, 1e300};
  const auto time = [&](double* of, auto& work) {
    const double before = processor_seconds(who);
    work();
    *of = std::min(*of, processor_seconds(who) - before);
  };
  for (int round = 0; round < 10 && !(least[1] < 6 * least[0] && round > 0); ++round) time(&least[0], small), time(&least[1], large);
  return least[1] / least[0];
}

/// n springs to the ground at as many nodes of a block of 8000 hexahedra, each node a set.
struct Springs {
  explicit Springs(int n) {
    Mesh mesh = block_mesh({.n = {20, 20, 20}});
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

TEST(Growth, OfSpringsAtManyNodesIsLinear) {
  const Springs few(2000), many(8000);
  const auto read = [](const Springs& s) { return [&s] { Scene::parse(s.text, "scene.toml"); }; };
  EXPECT_LT(growth(RUSAGE_SELF, read(few), read(many)), 6);
  const auto build = [](const Springs& s) {
    return [scene = Scene::parse(s.text, "scene.toml"), mesh = read_local_mesh(s.folder / "mesh.h5", Comm::world())]() mutable {
      build_system(scene, &mesh, Comm::world());
    };
  };
  EXPECT_LT(growth(RUSAGE_SELF, build(few), build(many)), 6);
}

/// n bars of one hexahedron each, regions of their own, on revolutes at sets of their nodes.
struct Bars {
  explicit Bars(int n) {
    text = "[material.m]\nE = 1e6\nnu = 0.3\ndensity = 1000\n[time]\nend = 1e-3\nstep = 1e-3\n";
    Mesh mesh;
    for (int i = 0; i < n; ++i) {
      const std::string number = std::to_string(i);
      std::vector<std::int64_t> nodes;
      for (int k = 0; k < 8; ++k) {
        nodes.push_back(8 * i + k);
        mesh.X.push_back(Vec3(i + k / 4, k % 4 % 3 ? 0.1 : -0.1, k % 4 / 2 ? 0.1 : -0.1)), mesh.node_id.push_back(8 * i + k + 1);
      }
      mesh.add_cell(Shape::hex8, nodes, i, i + 1);
      mesh.region_name.push_back("r" + number), mesh.region_data.emplace_back();
      mesh.node_sets["left" + number] = {nodes.begin(), nodes.begin() + 4};
      mesh.node_sets["right" + number] = {nodes.begin() + 4, nodes.end()};
      text += fmt::format(
          "[region.r{}]\nmaterial = \"m\"\n[[joint]]\nkind = \"revolute\"\nname = \"j{}\"\na = \"{}\"\nb = \"left{}\"\n"
          "at = [{}, 0, 0]\naxis = [0, 0, 1]\n",
          i, i, i == 0 ? "ground" : "right" + std::to_string(i - 1), i, i);
    }
    write_mesh(folder / "mesh.h5", mesh, {"test"});
  }
  Folder folder;
  std::string text;
};

// 10 000 took 32 s and 2.5 GB: tables of regions by regions, and of regions by bodies.
TEST(Growth, OfRegionsOnJointsIsLinear) {
  const Bars few(500), many(2000);
  const auto build = [](const Bars& b) {
    return [scene = Scene::parse(b.text, "scene.toml"), path = b.folder / "mesh.h5"] {
      LocalMesh mesh = read_local_mesh(path, Comm::world());
      EXPECT_EQ(untouched(*build_system(scene, &mesh, Comm::world())).size(), 0u);
    };
  };
  EXPECT_LT(growth(RUSAGE_SELF, build(few), build(many)), 6);
}

// On one body, as the report had it: 20 000 did not end in 30 s, where 4000 took .6 s.
TEST(Growth, OfSpringsOnOneBodyIsLinear) {
  const auto with = [](int n) {
    std::string text = "[[body]]\nname = \"b\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[time]\nend = 1e-3\nstep = 1e-3\n";
    for (int i = 0; i < n; ++i)
      text += "[[spring]]\nkind = \"bushing\"\nname = \"s" + std::to_string(i) +
              "\"\nb = \"b\"\nat = [0, 0, 1]\nstiffness = [1, 1, 1]\nangular_stiffness = [1, 1, 1]\n";
    return [text] { build_system(Scene::parse(text, "scene.toml"), nullptr, Comm::world()); };
  };
  EXPECT_LT(growth(RUSAGE_SELF, with(2000), with(8000)), 6);
}

// hilo-import of a deck whose springs stand at as many nodes.
TEST(Growth, OfADecksSpringsIsLinear) {
  const Workplace w;
  for (const int n : {2000, 8000}) {
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
    w.write("deck-" + std::to_string(n) + ".inp", text);
  }
  const auto import = [&w](int n) {
    return [&w, n] { succeeded(w.run("hilo-import --quiet deck-" + std::to_string(n) + ".inp -o mesh.h5")); };
  };
  EXPECT_LT(growth(RUSAGE_CHILDREN, import(2000), import(8000)), 6);
}

}  // namespace hilo::test::growth_test
