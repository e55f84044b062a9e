// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes moved by the shapes of a run.
#include <gtest/gtest.h>

#include "cli.hpp"
#include "model/store.hpp"
#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test {
namespace {

std::vector<double> displacement(const std::filesystem::path& run, const std::string& step) {
  return Store::open(run.string()).read<double>("/field/" + step + "/displacement");
}

TEST(Bend, nodes_move_by_shapes_of_the_size_asked_for) {
  const Workplace place;
  const Mesh mesh = sample::machine();
  sample::write_run(place.path(), mesh, 3);
  succeeded(place.run("hilo-post bend run.h5 --shape 1=2e-3 --shape 2=-1e-3 -o bent.h5"));
  const Mesh bent = read_mesh_file(place / "bent.h5").mesh;
  ASSERT_EQ(bent.n_nodes(), mesh.n_nodes());
  std::vector<Vec3> expected = mesh.X;
  for (const auto& [step, size] : {std::pair{"000001", 2e-3}, {"000002", -1e-3}}) {
    const auto u = displacement(place / "run.h5", step);
    double most = 0;
    for (size_t n = 0; n < mesh.X.size(); ++n) most = std::max(most, Eigen::Map<const Vec3>(&u[3 * n]).norm());
    for (size_t n = 0; n < mesh.X.size(); ++n) expected[n] += size / most * Eigen::Map<const Vec3>(&u[3 * n]);
  }
  for (size_t n = 0; n < mesh.X.size(); ++n) EXPECT_LT((bent.X[n] - expected[n]).norm(), 1e-15);
  EXPECT_EQ(bent.region_name, mesh.region_name);
  EXPECT_EQ(bent.nodes, mesh.nodes);
}

TEST(Bend, what_cannot_be_is_refused_and_leaves_nothing) {
  const Workplace place;
  sample::write_run(place.path(), sample::cube(2), 3);
  for (const auto& [options, said] : {std::pair{"--shape 1 ", "is not a step and the size"},
                                      {"--shape 1=0", "is not a step and the size"},
                                      {"--shape 1=nan", "is not a step"},
                                      {"--shape 1=2mm", "is not a step"},
                                      {"--shape 0=1e-3", "nothing moves"},
                                      {"--shape all=1e-3", "not one step"},
                                      {"--shape 9=1e-3", "no step"},
                                      {"--shape 1=1e9", "turned inside out"},
                                      {"", "--shape is required"}}) {
    const auto ran = place.run(std::string("hilo-post bend run.h5 ") + options + " -o bent.h5");
    EXPECT_NE(ran.exit, 0) << options;
    EXPECT_NE(ran.err.find(said), std::string::npos) << options << ": " << ran.err;
    EXPECT_FALSE(std::filesystem::exists(place / "bent.h5")) << options;
  }
  EXPECT_EQ(place.run("hilo-post bend run.h5 --shape 1=1e-3 -o mesh.h5").exit, 1) << "the mesh of the run";
}

}  // namespace
}  // namespace hilo::test
