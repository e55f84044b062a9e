// SPDX-License-Identifier: GPL-3.0-or-later
// What cells, modes and steps resolve: the told frequency against errors of frequencies known in closed form, and the marks on raw peaks.
#include <numbers>

#include "verify/verify.hpp"

namespace hilo::test::resolved_test {
namespace {

constexpr double pi = std::numbers::pi;

// Exact: shear waves in a free column of 4 m swing at n c/(2 L).  The error of the highest of them below the told frequency is nearly 1 %,
// that of the next one is above.
TEST(Resolved, CellsRunShearWavesToOnePercentUpToTheToldFrequency) {
  for (const auto& [shape, n] : {std::pair{Shape::hex8, 40}, {Shape::hex20, 10}}) {
    const Workplace w;
    const BlockOptions o{.shape = shape, .n = {n, 1, 1}, .high = {4, 0.1, 0.1}};
    write_mesh(w / "mesh.h5", block_mesh(o), {"test"});
    w.write(
        "scene.toml",
        "[material.m]\nE = 2e11\nnu = 0\ndensity = 8000\n[region.\"*\"]\nmaterial = \"m\"\n[[motion]]\nkind = \"fixed\"\nname = \"guide\"\n"
        "on = \"surface\"\ncomponents = [\"x\", \"z\"]\n[time]\nanalysis = \"modes\"\nmodes = 9\n");
    succeeded(w.run("hilo-solve scene.toml mesh.h5 -o run.h5"));
    const Results r(w / "run.h5");
    const Eigen::MatrixXd mode = r.history("mode");
    const double c = std::sqrt(1e11 / 8000), told = r.table("/resolved")(0, 0);
    double below = 0, above = 1;  // errors
    for (int k = 1; k < 8; ++k) {
      const double exact = k * c / 8, error = mode(k + 1, 0) / exact - 1;  // row 0 is the state of rest, row 1 the motion as one
      if (exact < told) below = std::max(below, error);
      if (exact > told) above = std::min(above, error);
    }
    EXPECT_GT(below, 0.005) << told;
    EXPECT_LT(below, 0.0105) << told;
    EXPECT_GT(above, 0.0095) << told;
  }
}

// A linear region resolves no more than its modes hold; a rigid one is not asked.
TEST(Resolved, ModesAndRigidRegionsCount) {
  const Workplace w;
  const BlockOptions o{
      .n = {20, 1, 1}, .high = {2, 0.1, 0.1}, .regions = {"bar", "grip"}, .region_of = [](const Vec3& x) { return x[0] > 1.5; }};
  write_mesh(w / "mesh.h5", block_mesh(o), {"test"});
  write_tags(w / "tags.h5", w / "mesh.h5", {Fidelity::linear, Fidelity::rigid}, {"test"});
  w.write("scene.toml",
          "[material.m]\nE = 2e11\nnu = 0.3\ndensity = 8000\n[region.\"*\"]\nmaterial = \"m\"\n[region.bar]\nmaterial = \"m\"\nmodes = 6\n"
          "[time]\nend = 1e-5\nstep = 1e-5\n");
  succeeded(w.run("hilo-solve scene.toml tags.h5 -o run.h5"));
  const Results r(w / "run.h5");
  const double first_left_out = r.table("/resolved")(0, 0);
  EXPECT_TRUE(std::isinf(r.table("/resolved")(1, 0)));
  succeeded(w.run("hilo-solve scene.toml tags.h5 -o run.h5 --set region.bar.modes=12"));
  EXPECT_GT(Results(w / "run.h5").table("/resolved")(0, 0), 1.2 * first_left_out);
}

// Exact: a mass on a spring swings at 50 Hz.  The period is wrong by 1 % at 18 steps of it; with more of them its acceleration is no raw
// peak, with fewer it is one, alone of all of its weight.
TEST(Resolved, PeaksThatStepsDoNotResolveAreMarked) {
  const Workplace w;
  const double k = std::pow(2 * pi * 50, 2);
  w.write("scene.toml",
          "[[body]]\nname = \"bob\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1]\n[[spring]]\nkind = \"axial\"\nname = \"s\"\na = "
          "\"ground\"\n"
          "b = \"bob\"\nat_a = [-1, 0, 0]\nat_b = [0, 0, 0]\nstiffness = " +
              std::to_string(k) +
              "\n[[initial]]\non = [\"bob\"]\nvelocity = [1, 0, 0]\n[[sensor]]\nname = \"seat\"\non = \"bob\"\n[time]\nend = 0.2\nstep = "
              "1e-3\n");
  for (const int steps : {13, 15, 24, 40}) {  // a period
    const std::string h = std::to_string(0.02 / steps);
    ASSERT_EQ(w.run("hilo-solve --quiet scene.toml -o run.h5 --set time.step=" + h).exit, 0);
    const Ran load = succeeded(w.run("hilo-post gload run.h5 --cfc 60"));
    const Ran row = w.run("hilo-post series run.h5 'sensor.*' -o all.csv");
    EXPECT_EQ(load.out.find('*') != std::string::npos, steps < 18) << steps << load.out;
    EXPECT_EQ(load.err.find("the most that steps of") != std::string::npos, steps < 18) << load.err;
    EXPECT_EQ(row.err.find("sensor.seat") != std::string::npos, steps < 18) << row.err;
  }
  // a method of high order asks for no more than rows that show the wave
  ASSERT_EQ(w.run("hilo-solve --quiet scene.toml -o run.h5 --set time.step=0.0014 --set 'time.integrator=\"gauss\"'").exit, 0);
  EXPECT_EQ(w.run("hilo-post gload run.h5").out.find('*'), std::string::npos);
}

}  // namespace
}  // namespace hilo::test::resolved_test
