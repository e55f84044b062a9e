// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness-proportional damping acts as a stress eta C (E1 - E0)/h: energy falls in every step, and neither momentum nor a steady rotation
// is touched.
#include "verify/free_bar.hpp"

namespace hilo::test::damping_test {
namespace {

std::string bar_of(const std::string& of_region, const std::string& law = "stvk") {
  return tumbling(soft_bar(law, 0.3, of_region), 4, 0.02, "interval = 4");
}

void expect_decay(const std::string& scene, const std::string& options = "") {
  SceneCase c(scene);
  c.use(free_bar());
  const Results r = c.solved(options);
  const auto e = r.history("energy"), p = r.history("momentum");
  const double top = e.col(0).maxCoeff();
  double rise = 0;
  for (Eigen::Index i = 1; i < e.rows(); ++i) rise = std::max(rise, e(i, 0) + e(i, 1) - e(i - 1, 0) - e(i - 1, 1));
  EXPECT_LT(rise, 1e-12 * top) << scene << options;
  const auto n = e.rows() - 1;
  EXPECT_LT(e(n, 0) + e(n, 1), e(0, 0) * (1 - 1e-4)) << "it does damp: " << scene << options;
  EXPECT_NEAR(e(n, 4), e(0, 0) + e(0, 1) - e(n, 0) - e(n, 1), 1e-10 * top) << "what is gone is what was dissipated";
  for (Eigen::Index i = 0; i < p.rows(); ++i)
    ASSERT_LT((p.row(i).tail<3>() - p.row(0).tail<3>()).norm(), 1e-12 * p.row(0).tail<3>().norm());
}

TEST(Damping, OfTheMaterialNeverRaisesTheEnergy) { expect_decay(bar_of("damping = 1e-3")); }
TEST(Damping, OfTheNeoHookeanMaterialNeverRaisesTheEnergy) { expect_decay(bar_of("damping = 1e-3", "neo-hookean")); }
TEST(Damping, ByStressDissipationNeverRaisesTheEnergy) { expect_decay(bar_of(""), "--set time.dissipation=0.1"); }

// Truth: once the bar turns steadily about its stiffest axis nothing changes shape, and the damping takes nothing more: the spin stays.
TEST(Damping, LeavesASteadyRotationAlone) {
  SceneCase c(bar_of("damping = 0.01"));
  c.use(free_bar());
  const Results r = c.solved("--set initial.1.spin=[0,0,10] --set time.end=20");
  const auto e = r.history("energy");
  const Eigen::Index n = e.rows() - 1;
  EXPECT_LT(std::abs(e(n, 0) - e(n / 2, 0)), 1e-6 * e(n, 0)) << "between 10 s and 20 s, 32 turns";
  EXPECT_GT(e(n, 0), 0.98 * e(0, 0));
}

// A soft cantilever is pushed aside for a moment and swings out.  Truth: its cells by themselves.  A force by rates of the amplitudes alone
// takes two thirds more at 400 N.
TEST(Damping, OfARegionThatStiffensTakesWhatItsCellsTake) {
  for (const double F : {20., 200., 400.}) {
    const std::string scene =
        solid(2e9, 0.3, 8000, "*", "", "damping = 2e-3") + held("xmin") + probe("tip", "xmax") +
        force("f", "xmax", {0, 0, F}, "history = {t = [0, 0.05, 0.1], value = [0, 1, 0], interpolation = \"smooth\"}") + in_time(0.5, 1e-3);
    SceneCase c(scene);
    const Mesh m = block_mesh({.shape = Shape::hex20r, .n = {8, 1, 1}, .high = {1, 0.05, 0.05}});
    double taken[2];
    for (const bool stiffens : {false, true}) {
      c.use(m, {stiffens ? Fidelity::linear : Fidelity::nonlinear});
      const Eigen::MatrixXd e = c.solved(stiffens ? "--set 'region.*.stiffening=true'" : "").history("energy");
      taken[stiffens] = e(e.rows() - 1, 4);
      EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-9 * taken[stiffens]) << "the balance of energy";
      for (Eigen::Index i = 1; i < e.rows(); ++i) ASSERT_GE(e(i, 4), e(i - 1, 4) - 1e-12 * taken[stiffens]) << i;
    }
    EXPECT_NEAR(taken[1] / taken[0], 1, 0.02) << F << ": " << taken[1] << " J, cells " << taken[0] << " J";
  }
}

// Truth: mass-proportional damping is a drag alpha m v: a free body's velocity falls as exp(-alpha t).
TEST(Damping, ProportionalToMassBrakesRigidMotionAsADrag) {
  SceneCase c(bar_of("mass_damping = 0.5"));
  c.use(free_bar());
  const Results r = c.solved("--set initial.1.spin=[0,0,0] --set initial.1.velocity=[2,0,0] --set time.end=2");
  EXPECT_NEAR(r.at("momentum", 2)[0], 10 * 2 * std::exp(-1.), 1e-3);
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * r.history("energy").col(0).maxCoeff());
}

// Truth: moving and spinning about a principal axis, everything of a free part falls as exp(-alpha t), its energy as exp(-2 alpha t), at
// any fidelity and with any integrator.
TEST(Damping, ProportionalToMassTakesTheSameOfRigidLinearAndNonlinear) {
  SceneCase c(bar_of("mass_damping = 0.7"));
  const double left = std::exp(-2 * 0.7 * 1);
  for (const Fidelity fidelity : {Fidelity::rigid, Fidelity::linear, Fidelity::nonlinear}) {
    c.use(free_bar(), {fidelity});
    for (const std::string method : {"energy-momentum", "generalized-alpha", "radau", "bdf2", "gauss"}) {
      if (fidelity == Fidelity::nonlinear && method == "gauss") continue;
      const Results r = c.solved(
          "--set initial.1.spin=[0,0,2] --set initial.1.velocity=[1,0,0] --set material.of_block.E=1e9 --set time.end=1 "
          "--set time.step=0.005 --set time.integrator=" +
          method);
      const auto e = r.history("energy");
      EXPECT_NEAR(e(e.rows() - 1, 0) / e(0, 0), left, 2e-3 * left) << word(fidelity) << " " << method;
      EXPECT_NEAR(e(e.rows() - 1, 4), e(0, 0) * (1 - left), 1e-2 * e(0, 0)) << word(fidelity) << " " << method;
    }
  }
}

}  // namespace
}  // namespace hilo::test::damping_test
