// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method believes no solver that leaves forces open and calls that solved.
#include "dynamics/start/start.hpp"
#include "scene_parts.hpp"
#include "system/dense_kkt.hpp"
#include "verify/verify.hpp"

namespace hilo::test::newton_test {
namespace {

/// A dense solver, or one that answers zero to all and calls it solved.
class Idle final : public DenseKkt {
 public:
  bool idle = false;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override {
    if (!idle) return DenseKkt::solve(b, x, tolerance);
    std::fill(x.begin(), x.end(), 0.0);
    return {};
  }
};

TEST(Newton, BelievesNoSolverThatMovesNothing) {
  const Scene scene = Scene::parse(
      "gravity = [0, 0, -9.81]\n[[body]]\nname = \"stone\"\nmass = 2\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n"
      "[[spring]]\nkind = \"bushing\"\nname = \"seat\"\nb = \"stone\"\nat = [0, 0, 0]\nstiffness = [500, 500, 1000]\n"
      "angular_stiffness = [1, 1, 1]\n[time]\nend = 1\nstep = 0.1\n",
      "scene.toml");
  const auto system = build_system(scene, nullptr, Comm::world());
  Idle solver;
  solver.structure(system->layout.cliques, system->layout.map);
  const auto settle = [&](bool idle, Config& q) {
    solver.idle = idle;
    std::vector<double> none;
    q = system->start;
    return equilibrium(*system, solver, q, none, 0, 1, false, {});
  };
  Config q;
  EXPECT_TRUE(settle(false, q).converged);
  EXPECT_NEAR(q.c.back().z(), -2 * 9.81 / 1000, 1e-12);
  const NewtonReport idle = settle(true, q);
  EXPECT_FALSE(idle.converged);
  EXPECT_NE(idle.reason.find("moves nothing"), std::string::npos) << idle.reason;
}

}  // namespace
}  // namespace hilo::test::newton_test
