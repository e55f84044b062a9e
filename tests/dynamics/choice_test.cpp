// SPDX-License-Identifier: GPL-3.0-or-later
// What the choice of an integrator says and needs.
#include "dynamics/integrator/make.hpp"
#include "dynamics/scenes.hpp"

namespace hilo::test::choice_test {
namespace {

// Truth: the multipliers of a step are unknowns, and energy-momentum keeps none from the step before; where Newton starts does not matter.
TEST(Multipliers, WrongAtTheStartDoNotChangeAStepOfTheDefault) {
  const Workplace w;
  pend3d(w);
  const Scene scene = Scene::load(w / "pend3d.toml");
  const auto system = build_system(scene, nullptr, Comm::world());
  const auto solver = make_light_solver();
  solver->structure(system->layout.cliques, system->layout.map);
  NewtonOptions options;
  options.tolerance = 1e-12;
  State state;
  state.q = system->start, state.v = system->start_velocity;
  const auto after_ten_steps = [&](double lambda) {
    State s = state;
    s.lambda.assign(3 * system->n_joint_blocks(), lambda);
    const auto em = make_energy_momentum(0);
    for (int i = 0; i < 10; ++i) {
      const NewtonReport r = em->solve({*system, *solver, options}, s, 0.01, Predictor::rigid_rotation);
      EXPECT_TRUE(r.converged) << r.reason;
      em->accept(s);
    }
    return s;
  };
  const State right = after_ten_steps(0), wrong = after_ten_steps(1e6);
  EXPECT_LT((right.q.c[1] - wrong.q.c[1]).norm(), 1e-12);
  EXPECT_LT((right.q.R[1] - wrong.q.R[1]).norm(), 1e-12);
  for (size_t i = 0; i < right.lambda.size(); ++i) EXPECT_NEAR(right.lambda[i], wrong.lambda[i], 1e-6);
}

// A method that is known to fail says so where it does (docs/stability.md), and is silent elsewhere.
TEST(Integrator, KnownToFailWarnsWhereItDoes) {
  const Workplace w;
  pend3d(w);
  const auto warns = [&](const std::string& options) {
    const Ran ran = succeeded(w.run("hilo-solve pend3d.toml -o run.h5 --set time.step=0.01 --set time.end=0.05 " + options));
    std::istringstream said(ran.err);
    for (std::string line; std::getline(said, line);)
      if (line.find("warning") != line.npos && line.find("integrator") != line.npos) return true;
    return false;
  };
  EXPECT_TRUE(warns(integrator("newmark")));
  EXPECT_TRUE(warns(integrator("generalized-alpha") + "--set time.rho=0.95"));
  EXPECT_TRUE(warns(integrator("hht") + "--set time.rho=1"));
  EXPECT_TRUE(warns(integrator("V0")));
  EXPECT_TRUE(warns(integrator("bathe"))) << "accelerations of what a joint holds are of first order (methods_test)";
  EXPECT_TRUE(warns(integrator("U0") + "--set time.rho1=1 --set time.rho2=1 --set time.rho3=0.5"));
  EXPECT_FALSE(warns(integrator("energy-momentum")));
  EXPECT_FALSE(warns(integrator("generalized-alpha") + "--set time.rho=0.6"));
  EXPECT_FALSE(warns(integrator("U0")));
  EXPECT_FALSE(warns(integrator("mid-point"))) << "on bodies it is energy-momentum";
  dpsmooth(w);
  std::filesystem::rename(w / "dpsmooth.toml", w / "pend3d.toml");
  EXPECT_TRUE(warns(integrator("mid-point"))) << "not where parts are flexible";
  EXPECT_TRUE(warns(integrator("U0") + "--set time.averaged=false"));
}

TEST(Integrator, RefusesWhatItCannotBe) {
  const Workplace w;
  pend3d(w);
  expect_end(w.run("hilo-solve pend3d.toml -o run.h5 --set time.step=0.01 --set time.rho=0.3 " + integrator("hht")), 2, "1/2 to 1");
  expect_end(w.run("hilo-solve pend3d.toml -o run.h5 --set time.step=0.01 " + integrator("newmrk")), 2, "newmark");
  expect_end(w.run("hilo-solve pend3d.toml -o run.h5"), 2, "tolerance");
}

}  // namespace
}  // namespace hilo::test::choice_test
