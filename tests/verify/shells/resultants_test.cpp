// SPDX-License-Identifier: GPL-3.0-or-later
// Forces, moments and stress of shells against equilibrium and published plates.
#include "verify/shells/shell_scene.hpp"

namespace hilo::test::shells_resultants_test {
namespace {

struct Bears {
  Eigen::MatrixXd force, moment, stress, axis, von_mises;
};

class ShellResultants : public ShellPlace {
 protected:
  static std::string asked() { return "[output]\nfields = [\"displacement\", \"stress\", \"von_mises\", \"shell\"]\n"; }
  Bears bears(const std::string& scene, const std::string& options = "") {
    const Results r = solved(scene + asked(), options);
    const std::string at = "/field/" + r.steps().back() + "/";
    moved = r.field("displacement");
    return {r.table(at + "shell_force"), r.table(at + "shell_moment"), r.table(at + "shell_stress"), r.table(at + "shell_axis"),
            r.table(at + "von_mises")};
  }
  std::vector<Vec3> moved;
};

// In the small and where the tip moves by two thirds of the length ([sze-2004] 3.1): equilibrium alone says what each place bears.
TEST_F(ShellResultants, AStripUnderAnEndForceIsInEquilibrium) {
  const Mesh m = shell_mesh(plate(10, 1), 20, 2, 0.1);
  use(m);
  for (const double P : {1e-3, 4.}) {
    const Bears b = bears(shell_of(1.2e6, 0) + held("xmin") + push("xmax", Vec3(0, 0, P)) + in_steps(P < 1 ? 1 : 4));
    const auto column = [&](std::int64_t i) { return i % (m.n_nodes() / 2); };  // the lower node of a pair
    const auto place = [&](std::int64_t i) {
      const std::int64_t below = column(i), above = below + m.n_nodes() / 2;
      return Vec3((m.X[below] + moved[below] + m.X[above] + moved[above]) / 2);
    };
    const double tip = place(20)[0], root = P * 10;
    for (std::int64_t i = 0; i < m.n_nodes(); ++i) {
      const double moment = -P * (tip - place(i)[0]);
      const bool edge = m.X[i][0] < 0.4 || m.X[i][0] > 9.6;
      EXPECT_NEAR(b.moment(i, 0), moment, (edge ? 0.02 : 0.004) * root) << m.X[i].transpose();
      EXPECT_NEAR(b.moment(i, 1), 0, 0.004 * root);
      EXPECT_NEAR(b.moment(i, 2), 0, 0.004 * root);
      const double sine = b.axis(i, 2), cosine = b.axis(i, 0);
      EXPECT_NEAR(sine * sine + cosine * cosine, 1, 1e-9);
      if (edge) continue;
      EXPECT_NEAR(b.force(i, 0), P * sine, 0.02 * P) << m.X[i].transpose();
      EXPECT_NEAR(b.force(i, 3), P * cosine, 0.02 * P) << m.X[i].transpose();
      EXPECT_NEAR(b.stress(i, 0), b.stress(i, 3) + (m.X[i][2] > 0 ? 6 : -6) * moment / 0.01, 0.01 * 6 * root / 0.01);
    }
    EXPECT_GT(P < 1 ? 1. : b.axis(20, 2), 0.8) << "the tip stands upright";
  }
}

// A quarter of a tube with free ends: n22 = p R_i around, none along; the stress of the faces is Lame's.
TEST_F(ShellResultants, ATubeUnderPressure) {
  const double R = 1, h = 0.02, p = 1e3;
  const Mesh m = shell_mesh(cylinder(R, M_PI / 2, 0.5), 16, 4, h);
  use(m);
  const Bears b = bears(shell_of(2e11, 0.3) + held("xmin", "x") + held("xmax", "z") + held("ymin", "y") +
                        "[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"zmin\"\npressure = 1e3\n" + in_steps(1));
  const double a = R - h / 2, o = R + h / 2, lame = p * a * a / (o * o - a * a);
  for (std::int64_t i = 0; i < m.n_nodes(); ++i) {
    EXPECT_NEAR(std::abs(b.axis(i, 1)), 1, 1e-6) << "x and z are normal to the tube somewhere, y nowhere";
    EXPECT_NEAR(b.force(i, 1), p * a, 0.005 * p * a);
    EXPECT_NEAR(b.force(i, 0), 0, 0.003 * p * a);
    EXPECT_NEAR(b.force(i, 2), 0, 0.003 * p * a);
    const double r2 = m.X[i][0] * m.X[i][0] + m.X[i][2] * m.X[i][2];
    EXPECT_NEAR(b.stress(i, 1), lame * (1 + o * o / r2), 0.008 * p * R / h) << m.X[i].transpose();
  }
}

// Clamped square under pressure, nu 0.3: 0.0231 p a^2 in the middle, -0.0513 p a^2 in the middle of an edge [timoshenko-1959, table 35].
TEST_F(ShellResultants, AClampedPlateUnderPressure) {
  for (const double h : {0.01, 0.001}) {
    const int n = 24;
    Mesh m = shell_mesh(plate(1, 1), n, n, h);
    for (int i = 0; i < m.n_nodes(); ++i)
      if (const Vec3 x = m.X[i]; x[0] * (1 - x[0]) * x[1] * (1 - x[1]) < 1e-9) m.node_sets["edge"].push_back(i);
    use(m);
    const double p = 1e9 * h * h * h;
    const Bears b = bears(shell_of(2.1e11, 0.3) + held("edge") +
                          fmt::format("[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"zmax\"\npressure = {}\n", p) + in_steps(1));
    const auto at = [&](int i, int j) { return i + (n + 1) * j; };
    const Eigen::RowVectorXd middle = b.moment.row(at(n / 2, n / 2)) / p, edge = b.moment.row(at(0, n / 2)) / p,
                             side = b.moment.row(at(n / 2, n)) / p;
    std::printf("h %g: middle %.5f %.5f, edge %.5f %.5f, other edge %.5f %.5f\n", h, middle[0], middle[1], edge[0], edge[1], side[0],
                side[1]);
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(middle[c], -0.0231, 0.0003);  // pushed down: its lower face is pulled in the middle
    EXPECT_NEAR(edge[0], 0.0513, 0.001);
    EXPECT_NEAR(edge[1], 0.3 * 0.0513, 0.001);
    EXPECT_NEAR(side[1], 0.0513, 0.001);
    EXPECT_NEAR(b.force(at(0, n / 2), 3) / p, -0.441, 0.03) << "reaction of the middle of an edge [timoshenko-1959]";
  }
}

// The moment at each place of a cantilever follows from its load, yielding or not; the faces stay near the yield stress.
TEST_F(ShellResultants, WhatHasYieldedIsInEquilibriumToo) {
  Mesh m = shell_mesh(plate(1, 0.1), 20, 1, 0.02);
  m.node_sets["side"] = {0};
  use(m);
  const double yield = 2.5e8, limit = yield * 0.02 * 0.02 / 4;  // moment per length
  const Bears b = bears(
      "[material.m]\nkind = \"j2\"\nE = 2e11\nnu = 0.3\nyield = 2.5e8\nhardening = 1e7\ndensity = 7800\n"
      "[region.shell]\nmaterial = \"m\"\nshell = true\n" +
      held("xmin", "xz") + held("side", "y") + push("xmax", Vec3(0, 0, 0.98 * limit * 0.1)) + in_steps(10));
  double most = 0;
  for (std::int64_t i = 0; i < m.n_nodes(); ++i) {
    EXPECT_NEAR(b.moment(i, 0), -0.98 * limit * (1 - m.X[i][0] - moved[i][0]), 0.02 * limit) << m.X[i].transpose();
    most = std::max(most, b.von_mises(i, 0));
  }
  std::printf("largest von Mises stress %.3f of yield\n", most / yield);
  EXPECT_GT(most, 0.95 * yield);
  EXPECT_LT(most, 1.17 * yield);
}

// The same in a linear region, on two ranks and as hilo-post gives it.
TEST_F(ShellResultants, AreTheSameInLinearRegionsOnRanksAndInPost) {
  const Mesh m = shell_mesh(plate(1, 0.2), 10, 2, 0.01);
  const std::string scene = shell_of(2e11, 0.3) + held("xmin") + push("xmax", Vec3(0, 0, 1)) + in_steps(1);
  use(m);
  const Bears one = bears(scene);
  succeeded(mpirun(2, "hilo-solve --quiet scene.toml mesh.h5 -o two.h5", work.path()));
  const Results two(work / "two.h5");
  const Eigen::MatrixXd moment = two.table("/field/" + two.steps().back() + "/shell_moment");
  const Ran post = succeeded(work.run("hilo-post at run.h5 shell_moment --point 0.5,0.1,0 --steps last --unit N -o -"));
  double t, m11 = 0;
  ASSERT_EQ(std::sscanf(post.out.c_str() + post.out.find('\n') + 1, "%lf,%lf", &t, &m11), 2) << post.out;
  EXPECT_NEAR(m11, -5 * 0.5, 0.05) << "of a force of 5 per length";
  succeeded(work.run("hilo-post peak run.h5 --field shell_stress.s11 --steps last"));
  use(m, {Fidelity::linear});
  const Bears linear = bears(scene);
  for (std::int64_t i = 0; i < m.n_nodes(); ++i)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(moment(i, c), one.moment(i, c), 1e-7);
      EXPECT_NEAR(linear.moment(i, c), one.moment(i, c), 0.02) << m.X[i].transpose();
    }
}

TEST_F(ShellResultants, AreRefusedWhereTheyAreNotOfOneLayer) {
  const std::string rest = held("xmin") + in_steps(1) + asked();
  use(shell_mesh(plate(1, 0.2), 4, 2, 0.02, 2));
  work.write("scene.toml", shell_of(2e11, 0.3) + rest);
  expect_end(work.run("hilo-solve --quiet scene.toml mesh.h5 -o run.h5"), 2, "region \"shell\" has more than one layer of shells at");
  std::string solid = shell_of(2e11, 0.3) + rest;
  solid.replace(solid.find("shell = true\n"), 13, "");
  work.write("scene.toml", solid);
  const Ran none = work.run("hilo-solve --quiet scene.toml mesh.h5 -o run.h5");
  expect_end(none, 2, "scene.toml:");
  EXPECT_NE(none.err.find("\"shell\": the run has no shells that deform"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace hilo::test::shells_resultants_test
