// SPDX-License-Identifier: GPL-3.0-or-later
// What a guess missed is continued only where the same guess, step and loads go on.
#include "dynamics/integrator/make.hpp"
#include "dynamics/scenes.hpp"
#include "system/system.hpp"

namespace hilo::test::extrapolation_test {
namespace {

/// A pendulum in full swing.
class Pendulum {
 public:
  Pendulum() {
    const Workplace w;
    w.write("pendulum.toml", "gravity = [0, 0, -9.81]\n" + body("bob", 2, {1, 0, 0}, {0.1, 0.1, 0.1}) +
                                 joint("spherical", "pin", "ground", "bob", Vec3::Zero()) +
                                 "[[initial]]\non = [\"bob\"]\nspin = [0, 3, 0]\nabout = [0, 0, 0]\n[time]\nend = 1\nstep = 0.01\n");
    system = build_system(Scene::load(w / "pendulum.toml", {}), nullptr, Comm::world());
    solver->structure(system->layout.cliques, system->layout.map);
    state.q = system->start, state.v = system->start_velocity;
    state.lambda.assign(3 * static_cast<size_t>(system->n_joint_blocks()), 0.0);
  }
  void steps(int n, Predictor predictor) {
    for (int k = 0; k < n; ++k) {
      ASSERT_TRUE(integrator->solve({*system, *solver, {}}, state, 0.01, predictor).converged);
      integrator->accept(state);
      system->commit(state.q, &state.v);
    }
  }
  /// How far Newton's first correction goes from the guess of `by`, over the scene's length.
  double first_correction(Integrator& by) {
    NewtonOptions one;
    one.tolerance = 1e3;
    const NewtonReport r = by.solve({*system, *solver, one}, state, 0.01, Predictor::rigid_rotation);
    EXPECT_EQ(r.iterations, 1);
    return r.correction;
  }
  double without_history() { return first_correction(*make_energy_momentum(0)); }

  std::unique_ptr<System> system;
  std::unique_ptr<KktSolver> solver = make_light_solver("klu");
  std::unique_ptr<Integrator> integrator = make_energy_momentum(0);
  State state;
};

TEST(Extrapolation, ServesTheNextStepOfTheSameKind) {
  Pendulum p;
  p.steps(6, Predictor::rigid_rotation);
  EXPECT_LT(p.first_correction(*p.integrator), 0.05 * p.without_history());
}

TEST(Extrapolation, LeavesOutWhatAnotherPredictorMissed) {
  for (const Predictor other : {Predictor::hold, Predictor::velocity}) {
    Pendulum p;
    p.steps(4, Predictor::rigid_rotation);
    p.steps(2, other);
    const double fresh = p.without_history();
    EXPECT_NEAR(p.first_correction(*p.integrator), fresh, 1e-6 * fresh);
  }
}

TEST(Extrapolation, StartsAnewWhereTheLoadsJump) {
  Pendulum p;
  p.steps(4, Predictor::rigid_rotation);
  p.integrator->restart();
  const double fresh = p.without_history();
  EXPECT_NEAR(p.first_correction(*p.integrator), fresh, 1e-6 * fresh);
}

// Multipliers 1, 2, 3 continue to 4 over an equal step; of a step half as long all that is known is the last.
TEST(Extrapolation, OfMultipliersEndsWithTheStepLengthWherePositionsNeedNone) {
  const Pendulum p;
  const std::vector<double> none(3 * static_cast<size_t>(p.system->first_joint_block()), 0.0);
  std::vector<double> missed = none;
  missed[0] = 1;
  Extrapolation e;
  e.accept(*p.system, 1, missed, {1, 1, 1});
  e.accept(*p.system, 1, none, {2, 2, 2});
  e.accept(*p.system, 1, none, {3, 3, 3});
  const std::vector<double> last{3, 3, 3};
  EXPECT_TRUE(e.increments(*p.system, 1).empty());
  EXPECT_EQ(e.multipliers(last), (std::vector<double>{4, 4, 4}));
  EXPECT_TRUE(e.increments(*p.system, 0.5).empty());
  EXPECT_EQ(e.multipliers(last), last);
}

}  // namespace
}  // namespace hilo::test::extrapolation_test
