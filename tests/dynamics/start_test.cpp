// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities and accelerations to start from, by solvers that stop early.  Truth: factors.
#include "dynamics/scenes.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test::start_test {
namespace {

// CG solves to four digits, which is enough for Newton.  A start has no Newton: initial velocities that a hinge does not allow, then
// accelerations, which generalized-alpha begins with and gauss solves for at each end.
TEST(Start, IsAsExactByCgAsByFactors) {
  const Workplace w;
  write_mesh(w / "mesh.h5", block_mesh({.n = {6, 1, 1}, .high = {1, 0.2, 0.2}}), {"test"});
  w.write("scene.toml",
          "mesh = \"mesh.h5\"\ngravity = [0, 0, -9.81]\n[material.soft]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = "
          "\"soft\"\n" +
              body("bob", 3, {1.2, 0.1, 0.1}, {0.1, 0.1, 0.1}) +
              joint("revolute", "hinge", "ground", "xmin", {0, 0.1, 0.1}, "axis = [0, 1, 0]\n") +
              joint("spherical", "ball", "xmax", "bob", {1, 0.1, 0.1}) +
              "[[initial]]\non = [\"block\", \"bob\"]\nvelocity = [0.3, 0.5, 0.2]\nspin = [1, 2, 0.5]\nabout = [0, 0, 0]\n[[probe]]\n"
              "name = \"bob\"\non = \"bob\"\nat = [1.2, 0.1, 0.1]\n[time]\nend = 0.01\nstep = 0.005\n[solver]\ntolerance = 1e-11\n");
  for (const char* method : {"energy-momentum", "generalized-alpha", "gauss"}) {
    const auto probe = [&](const std::string& solver) {
      succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 --set 'solver.kind=\"" + solver + "\"' " + integrator(method)));
      return Eigen::MatrixXd(Results(w / "run.h5").history("probe/bob"));
    };
    const Eigen::MatrixXd truth = probe("light"), found = probe("cg");
    ASSERT_EQ(truth.rows(), 3);
    for (int k = 0; k < 9; k += 3)  // position, velocity, acceleration, to which a jerk by differences belongs
      EXPECT_LT((found - truth).middleCols(k, 3).cwiseAbs().maxCoeff(),
                (k < 6 ? 1e-8 : 1e-7) * truth.middleCols(k, 3).cwiseAbs().maxCoeff())
          << method << " " << k;
  }
}

}  // namespace
}  // namespace hilo::test::start_test
