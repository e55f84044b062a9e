// SPDX-License-Identifier: GPL-3.0-or-later
// Solid-shells in motion: natural frequencies against closed forms, what coarse steps keep, linear regions, several ranks.
#include "base/shell_shape.hpp"
#include "verify/beams/beam_scene.hpp"
#include "verify/natural_modes/natural_modes.hpp"
#include "verify/shells/shell_scene.hpp"

namespace hilo::test::shells_dynamics_test {
namespace {

class ShellDynamics : public ShellPlace {
 protected:
  /// Half a cylinder of L/h 25 and two layers or one, thrown by a hat of forces.
  std::string thrown(const std::string& material, double step, int steps) {
    use([&] {
      Mesh m = shell_mesh(cylinder(0.5, M_PI, 1), 8, 4, 0.02);
      add_stack(m, "A", 0, 0, 8, 4), add_stack(m, "B", 8, 4, 8, 4), add_stack(m, "C", 4, 0, 8, 4);
      return m;
    }());
    const double hat = 10 * step;
    const std::string history = fmt::format("history = {{t = [0, {}, {}], value = [0, {}, 0]}}\n", hat, 2 * hat, 0.02 / step);
    return "[material.m]\ndensity = 1000\n" + material + "[region.shell]\nmaterial = \"m\"\nshell = true\n" +
           push("A", Vec3(0, 40, 60), history) + push("B", Vec3(30, 0, -40), history) + push("C", Vec3(10, 30, 50), history) +
           fmt::format("[time]\nend = {}\nstep = {}\n", step * steps, step);
  }
};

TEST_F(ShellDynamics, AThrownHalfCylinderKeepsEnergyAndMomenta) {
  for (const auto& [law, step, steps] : {std::tuple{"kind = \"stvk\"\nE = 2e7\nnu = 0.3\n", 0.03, 200},
                                         std::tuple{"kind = \"neo-hookean\"\nE = 2e7\nnu = 0.3\n", 0.02, 100}}) {
    const Drift c = drift(solved(thrown(law, step, steps)), 20.5 * step);
    std::printf("%.17s: E %.1e, P %.1e, L %.1e, strained %.2f\n", law, c.energy, c.momentum, c.angular, c.strained);
    EXPECT_LT(c.energy, 1e-12);
    EXPECT_LT(c.momentum, 1e-12);
    EXPECT_LT(c.angular, 1e-12);
    EXPECT_GT(c.strained, 0.02);
  }
}

class DISABLED_LongThinShells : public ShellDynamics {};  // a minute and a half
TEST_F(DISABLED_LongThinShells, AThrownHalfCylinderKeepsThemOverTenThousandSteps) {
  const Drift c = drift(solved(thrown("kind = \"stvk\"\nE = 2e7\nnu = 0.3\n", 0.03, 10000)), 20.5 * 0.03);
  std::printf("E %.1e, P %.1e, L %.1e, strained %.2f\n", c.energy, c.momentum, c.angular, c.strained);
  EXPECT_LT(c.energy, 1e-10);
  EXPECT_LT(c.momentum, 1e-10);
  EXPECT_LT(c.angular, 1e-10);
}

// What flow takes is in the balance, and momenta stay.
TEST_F(ShellDynamics, AThrownSheetOfMetalKeepsItsBalance) {
  const Results r = solved(thrown("kind = \"j2\"\nE = 2e7\nnu = 0.3\nyield = 1e5\nhardening = 2e5\n", 0.02, 30));
  const Eigen::MatrixXd E = r.history("energy");
  const Drift c = drift(r, 0.41);
  EXPECT_GT(E(E.rows() - 1, 4), 0.01 * E.col(0).maxCoeff()) << "it flows";
  EXPECT_GE((E.col(4).tail(E.rows() - 1) - E.col(4).head(E.rows() - 1)).minCoeff(), 0);
  EXPECT_LT(E.col(5).cwiseAbs().maxCoeff(), 1e-9 * E.col(0).maxCoeff());
  EXPECT_LT(c.momentum, 1e-10);
  EXPECT_LT(c.angular, 1e-10);
}

// A strip of L/h 100, clamped, pushed at its end, with both dampings: the damped cantilever.
TEST_F(ShellDynamics, ADampedStripRespondsByItsClosedForm) {
  const double E = 2e9, b = 0.05, h = 0.01, rho = 1000, beta = 2e-3, alpha = 3;
  use(shell_mesh(plate(1, b), 40, 2, h));
  solved(shell_of(E, 0, "density = 1000") + fmt::format("damping = {}\nmass_damping = {}\n", beta, alpha) + held("xmin") +
         probe("tip", "xmax") + "[time]\nanalysis = \"modes\"\nmodes = 14\n");
  const std::vector<Answer> found = answers(work.run("hilo-post response run.h5 --force tip.z --at tip.z --from 0.3 --to 20 --points 60"));
  double most = 0;
  for (const Answer& a : found)
    most = std::max(most, std::abs(std::polar(a.size, a.phase * M_PI / 180) /
                                       damped_cantilever(E * b * h * h * h / 12, rho * b * h, beta, alpha, 1, 2 * M_PI * a.f) -
                                   1.0));
  std::printf("%.1e\n", most);
  EXPECT_EQ(found.size(), 60U);
  EXPECT_LT(most, 0.025);
}

// All nodes of a face move along its normal alone: Navier's plate, with Mindlin's shear and rotary inertia.
TEST_F(ShellDynamics, FrequenciesOfASupportedPlateAreMindlins) {
  const double E = 2e11, nu = 0.3, rho = 8000, h = 0.01;
  const auto mindlin = [&](int m, int n) {
    const double k2 = M_PI * M_PI * (m * m + n * n), D = E * h * h * h / (12 * (1 - nu * nu)), S = 5. / 6 * E / (2 * (1 + nu)) * h,
                 I = rho * h * h * h / 12, a = I * rho * h / S, b = rho * h + k2 * (I + rho * h * D / S), c = D * k2 * k2;
    return std::sqrt((b - std::sqrt(b * b - 4 * a * c)) / (2 * a)) / (2 * M_PI);
  };
  std::string scene = shell_of(E, nu, "density = 8000");
  for (const char* face : {"xmin", "xmax", "ymin", "ymax"}) scene += held(face, face[0] == 'x' ? "yz" : "xz");
  double off[2] = {};
  for (const int n : {12, 24}) {
    use(shell_mesh(plate(1, 1), n, n, h));
    const Eigen::VectorXd f = frequencies(scene, 4);
    std::printf("%d: %.4f %.4f %.4f of Mindlin's\n", n, f[0] / mindlin(1, 1), f[1] / mindlin(1, 2), f[3] / mindlin(2, 2));
    off[n / 24] = f[0] / mindlin(1, 1) - 1;
    if (n < 24) continue;
    EXPECT_NEAR(f[0] / mindlin(1, 1), 1, 0.003);
    EXPECT_NEAR(f[1] / mindlin(1, 2), 1, 0.008);
    EXPECT_NEAR(f[2] / f[1], 1, 1e-6) << "twice, by symmetry";
    EXPECT_NEAR(f[3] / mindlin(2, 2), 1, 0.01);
  }
  EXPECT_GT(std::log2(off[0] / off[1]), 1.8) << "of second order";
}

// A linear region of shells has the frequencies of a nonlinear one, those of the cantilever's beam, and carries a body.
TEST_F(ShellDynamics, ALinearRegionHasTheModesOfItsShell) {
  const Mesh m = shell_mesh(plate(1, 0.02), 24, 1, 0.01);
  const std::string scene = shell_of(2e11, 0, "density = 8000") + held("xmin");
  use(m);
  const Eigen::VectorXd nonlinear = frequencies(scene, 3);
  use(m, {Fidelity::linear});
  const Eigen::VectorXd linear = frequencies(scene, 3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(linear[k] / nonlinear[k], 1, 2e-4) << k;
  const auto beam = [](double bl, double h) { return bl * bl * h / std::sqrt(12) * std::sqrt(2e11 / 8000) / (2 * M_PI); };
  EXPECT_NEAR(nonlinear[0] / beam(1.87510407, 0.01), 1, 1e-3);
  EXPECT_NEAR(nonlinear[1] / beam(1.87510407, 0.02), 1, 3e-3);
  EXPECT_NEAR(nonlinear[2] / beam(4.69409113, 0.01), 1, 5e-3);
}

// By name, also where the mesh says that its cells are shells.
TEST_F(ShellDynamics, StiffeningOfLinearShellsIsRefused) {
  Mesh m = shell_mesh(plate(1, 0.1), 4, 1, 0.01);
  std::string scene = shell_of(2e11, 0.3, "density = 8000") + "stiffening = true\n" + held("xmin") + "[time]\nend = 1\nstep = 0.1\n";
  const auto refused = [&](int line) {
    use(m, {Fidelity::linear});
    work.write("scene.toml", scene);
    const Ran r = work.run("hilo-solve scene.toml tags.h5 -o no.h5");
    EXPECT_EQ(r.exit, 2);
    EXPECT_EQ(r.err,
              fmt::format("hilo-solve: scene.toml:{}:1: region \"shell\": shells have no strains of the second degree in modes (leave out "
                          "stiffening, or tag the region nonlinear)\n",
                          line));
  };
  refused(8);
  scene.erase(scene.find("shell = true\n"), 13);
  std::fill(m.shape.begin(), m.shape.end(), static_cast<std::uint8_t>(shell8));
  refused(7);
}

TEST_F(ShellDynamics, RanksFlyTheSameWay) {
  const std::string scene = thrown("kind = \"neo-hookean\"\nE = 2e7\nnu = 0.3\n", 0.02, 30);
  const Results one = solved(scene);
  const auto alone = one.field("displacement");
  for (const int n : {2, 3}) {
    const Ran r = succeeded(mpirun(n, fmt::format("hilo-solve --quiet scene.toml mesh.h5 -o r{}.h5", n), work.path()));
    const auto apart = Results(work / fmt::format("r{}.h5", n)).field("displacement");
    ASSERT_EQ(apart.size(), alone.size());
    double most = 0, off = 0;
    for (size_t i = 0; i < alone.size(); ++i) most = std::max(most, alone[i].norm()), off = std::max(off, (alone[i] - apart[i]).norm());
    EXPECT_LT(off, 1e-8 * most);
  }
}

// Which of its axes a cell is thick along follows from the mesh, not from how it is numbered.
TEST_F(ShellDynamics, HowCellsAreNumberedDoesNotCount) {
  Mesh m = shell_mesh(cylinder(0.5, M_PI, 1), 6, 4, 0.02);
  const std::string scene = shell_of(2e7, 0.3, "density = 1000");
  use(m);
  const Eigen::VectorXd plain = frequencies(scene, 9);
  m.facet_sets.clear();
  constexpr int turned[3][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {0, 3, 7, 4, 1, 2, 6, 5}, {0, 4, 5, 1, 3, 7, 6, 2}};
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    std::vector<std::int64_t> own(m.cell(c).begin(), m.cell(c).end());
    for (int a = 0; a < 8; ++a) m.nodes[m.offset[c] + a] = own[turned[c % 3][a]];
  }
  use(m);
  const Eigen::VectorXd mixed = frequencies(scene, 9);
  for (int k = 6; k < 9; ++k) EXPECT_NEAR(mixed[k] / plain[k], 1, 1e-7) << k;
}

TEST_F(ShellDynamics, WhatHasNoClearThicknessIsRefusedByName) {
  const auto refused = [&](const Mesh& m, const std::string& why) {
    use(m);
    work.write("scene.toml", shell_of(2e7, 0.3) + in_steps(1));
    const Ran r = work.run("hilo-solve scene.toml mesh.h5 -o no.h5");
    expect_end(r, 2, why);
    EXPECT_NE(r.err.find("scene.toml:7:"), std::string::npos) << r.err;
  };
  refused(shell_mesh(plate(1, 1), 10, 10, 0.2, 2), "region \"shell\": the thickness of the cell at (0.05, 0.05, -0.05) is not clear");
  refused(shell_mesh(plate(1, 1), 30, 10, 0.06), "between its only two outer faces");
  refused(block_mesh({.shape = Shape::tet4, .regions = {"shell"}}), "shells are of hex8, and it has tet4");
}

}  // namespace
}  // namespace hilo::test::shells_dynamics_test
