// SPDX-License-Identifier: GPL-3.0-or-later
// What the scene's schema takes for a word is what makes something of it, and the other way round: no word is the last branch of an if.
#include "dynamics/choose_solver.hpp"
#include "dynamics/record/fields.hpp"
#include "model/local_mesh.hpp"
#include "verify/verify.hpp"

namespace hilo::test::words_test {
namespace {

TEST(Words, OfSolversAreTheSolversAndAuto) {
  std::vector<std::string> words = solver_kinds().words();
  words.insert(words.begin(), "auto");
  EXPECT_EQ(words, choices("solver", "kind"));
}

TEST(Words, OfFieldsAreTheKeysOfTheirSources) {
  const Workplace place;
  write_mesh(place / "mesh.h5", block_mesh({}), {"test"});
  LocalMesh mesh = read_local_mesh(place / "mesh.h5", Comm::world());
  const Scene scene = Scene::parse("[material.m]\nE = 1e9\nnu = 0.3\ndensity = 1\n[region.\"*\"]\nmaterial = \"m\"\n", "scene.toml");
  const auto system = build_system(scene, &mesh, Comm::world());
  std::vector<std::string> keys, words = choices("output", "fields");
  for (const FieldKind& kind : field_kinds())
    for (const Field& f : kind.make(*system, mesh.node_global)->fields()) {
      EXPECT_NE(find_array("run.h5", "/field/000000/" + f.name), nullptr) << f.name;
      keys.push_back(f.key);
    }
  std::sort(keys.begin(), keys.end()), std::sort(words.begin(), words.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  EXPECT_EQ(keys, words);
}

TEST(Words, ThatNoLightSolverHasAreRefused) { EXPECT_THROW(make_light_solver("colesky"), Error); }

}  // namespace
}  // namespace hilo::test::words_test
