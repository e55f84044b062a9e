// SPDX-License-Identifier: GPL-3.0-or-later
// Metal that flows: closed forms through the whole program, the balance of energy of a bar that yields as it tumbles, published values.
#include "verify/free_bar.hpp"
#include "verify/plasticity/hill.hpp"
#include "verify/plasticity/uniaxial.hpp"

namespace hilo::test::plasticity_test {
namespace {

/// A block of metal by its keys and what else a scene has.
std::string metal(double E, double nu, const std::string& law) { return solid(E, nu, 7800, "block", "kind = \"j2\"\n" + law); }
std::string pulled(const std::string& name, const std::string& on, const std::string& keys) {
  return motion("translation", name, on, "components = [\"" + name + "\"]\n" + keys);
}
std::string static_to(double end, int steps) { return in_steps(steps, fmt::format("end = {}", end)); }

// Truth: uniaxial stress at finite strain.  ln(l/L) = tau/E + e_p, tau is the Kirchhoff stress, the force tau A/l.  Isotropic hardening H
// and kinematic hardening H_k: tau = +-(Y + H p) + H_k e_p while it flows.
TEST(Plasticity, BlockUnderACycleHasTheForceOfTheClosedForm) {
  constexpr double E = 200e9, Y = 400e6, H = 3e9, Hk = 5e9;
  for (const Shape shape : {Shape::hex8, Shape::hex20r, Shape::hex20, Shape::tet10, Shape::wedge15, Shape::wedge6, Shape::tet4}) {
    // steps that are no part of a second end where the history turns all the same
    const std::string steps = shape == Shape::hex8 ? "--set time.steps=7" : "";
    SceneCase c(uniaxial_cycle());
    c.use(block_mesh({.shape = shape}));
    const Results r = c.solved(steps);
    const auto force = r.history("motion/pull"), energy = r.history("energy");
    double p = 0, ep = 0, worst = 0;
    for (Eigen::Index k = 1; k < r.t().size(); ++k) {
      const double t = r.t()[k], u = t < 1 ? 0.3 * t : t < 2 ? 0.3 - 0.4 * (t - 1) : -0.1 + 0.25 * (t - 2), strain = std::log1p(u);
      double tau = E * (strain - ep);
      if (const double over = std::abs(tau - Hk * ep) - (Y + H * p); over > 0) {
        const double sign = tau > Hk * ep ? 1 : -1, dp = over / (E + H + Hk);
        p += dp, ep += sign * dp, tau = E * (strain - ep);
      }
      worst = std::max(worst, std::abs(force(k, 0) - tau / (1 + u)));
    }
    EXPECT_LT(worst, 1e-8 * Y) << info(shape).name;
    EXPECT_GT(p, 0.5);
    const auto plastic = r.table("/field/" + r.steps().back() + "/cell_plastic_strain");
    for (Eigen::Index e = 0; e < plastic.rows(); ++e) EXPECT_NEAR(plastic(e, 0), p, 1e-9);
    // stored: (tau^2/E + H_k e_p^2)/2; dissipated: Y p + H p^2/2 by the trapezoidal rule, exact for a linear one
    EXPECT_NEAR(energy(energy.rows() - 1, 4), Y * p + H * p * p / 2, 1e-8 * Y * p);
  }
}

/// A free bar, bent by an initial velocity of its middle.
const std::string yielding_bar = tumbling(solid(1e7, 0.3, 1000, "block", "kind = \"j2\"\nyield = 1e5\nhardening = 2e5\nkinematic = 3e5"), 1,
                                          0.005, "interval = 0.1\nfields = [\"displacement\", \"plastic_strain\"]") +
                                 initial("middle", "velocity = [0, 0, 8]\nspin = [3, 15, 10]\nabout = [0.5, 0.05, 0.05]");

/// The balance of energy, and that what flow took is not given back; how often it flows.
int expect_balance(const Results& r, double angular, const std::string& what) {
  const auto e = r.history("energy");
  const double top = e.col(0).maxCoeff();
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * top) << what;
  EXPECT_GE((e.col(4).tail(e.rows() - 1) - e.col(4).head(e.rows() - 1)).minCoeff(), 0) << what;
  EXPECT_LT(drift(r, 0).angular, angular) << what;
  return static_cast<int>((e.col(4).tail(e.rows() - 1).array() > e.col(4).head(e.rows() - 1).array()).count());
}

// Truth: E + D - W stays as it was to 1e-10 over every step, D never falls, momentum stays to 1e-12, on cells of any shape: the stress of a
// step is made so that its work is what is stored and dissipated.
TEST(Plasticity, BarThatTumblesAndYieldsKeepsTheBalanceOfEnergy) {
  for (const Shape shape : {Shape::hex8, Shape::hex20r, Shape::tet10}) {
    SceneCase c(yielding_bar);
    Mesh m = free_bar(shape, 6);
    add_node_set(m, "middle", [](const Vec3& x) { return std::abs(x[0] - 0.5) < 0.1; });
    c.use(m);
    const Results r = c.solved(shape == Shape::hex8 ? "--set time.end=0.6" : "--set time.end=0.1");
    expect_balance(r, 1e-11, std::string(info(shape).name));
    const auto e = r.history("energy");
    EXPECT_GT(e(e.rows() - 1, 4), 0.01 * e.col(0).maxCoeff()) << "a bar that really yields";
  }
}

// Truth: the same over 10 000 steps, some 50 turns of two wedges, whose four points cost least; many steps are cut.
TEST(Plasticity, BalanceOfEnergyHoldsOverTenThousandSteps) {
  SceneCase c(yielding_bar);
  Mesh m = block_mesh({.shape = Shape::wedge6, .high = {0.3, 0.1, 0.1}});
  add_node_set(m, "middle", [](const Vec3& x) { return x[0] > 0.29 && x[1] > 0.09; });
  c.use(m);
  setenv("HILO_LANES", "2", 1);  // both cells at once
  const Results r = c.solved("--set time.end=15 --set time.step=0.003 --set output.interval=15");
  unsetenv("HILO_LANES");
  const auto e = r.history("energy");
  ASSERT_GE(e.rows(), 10001);
  EXPECT_GT(expect_balance(r, 1e-11, "10 000 steps"), 20) << "a bar that yields again and again";
  EXPECT_GT(e(e.rows() - 1, 4), 1e-3 * e.col(0).maxCoeff());
}

// A bar that is pulled slowly until it yields, in short steps: its kinetic energy is a billionth of what it stores, so that rounding is
// most of what the balance misses.  No step may be cut for that.
TEST(Plasticity, OfABarPulledSlowlyIsInBalanceInShortSteps) {
  SceneCase c(metal(200e9, 0.3, "yield = 250e6\nhardening = 2e9") + held("xmin") +
              force("pull", "xmax", {1.1e5, 0, 0}, "history = {t = [0, 0.2], value = [0, 1], interpolation = \"smooth\"}") +
              in_time(0.25, 2.5e-4));
  c.use(block_mesh({.shape = Shape::hex20r, .n = {12, 1, 1}, .high = {0.2, 0.02, 0.02}}));
  const Results r = c.solved("--set 'time.error_estimate=\"never\"'");
  EXPECT_EQ(r.history("energy").rows(), 1001);
  EXPECT_GT(r.history("energy")(1000, 4), 100) << "a bar that yields";
}

// NAFEMS' path of plane strain: E 250 GPa, nu .25, yield stress 5 MPa, steps of .25e-4: x to .5e-4, y to .5e-4, both back.  Truth: a return
// map of its own, three principal axes, since the axes never turn; in logarithmic strain and Kirchhoff stress it holds at any size.
TEST(Plasticity, PathOfPlaneStrainIsThatOfAReturnMap) {
  constexpr double E = 250e9, nu = 0.25, Y = 5e6, size = 0.5e-4, mu = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));
  for (const double H : {0.0, 62.5e9}) {
    const std::string course = "displacement = [0.5e-4, 0.5e-4, 0]\nhistory = {t = [0, 1, 2, 3, 4], value = ";
    SceneCase c(metal(E, nu, fmt::format("yield = 5e6\nhardening = {}", H)) + held("xmin", "x") + held("ymin", "y") + held("block", "z") +
                pulled("x", "xmax", course + "[0, 1, 1, 0, 0]}") + pulled("y", "ymax", course + "[0, 0, 1, 1, 0]}") + static_to(4, 8) +
                fields("\"displacement\", \"plastic_strain\"", "interval = 4"));
    c.use(block_mesh({}));
    const Results r = c.solved();
    const auto fx = r.history("motion/x"), fy = r.history("motion/y");
    ASSERT_EQ(r.t().size(), 9);
    Vec3 plastic = Vec3::Zero();
    double p = 0, worst = 0;
    for (int k = 1; k <= 8; ++k) {
      const double u[2] = {std::min({k, 2, std::max(6 - k, 0)}) * size / 2, std::clamp(std::min(k - 2, 8 - k), 0, 2) * size / 2};
      const Vec3 strain(std::log1p(u[0]), std::log1p(u[1]), 0);
      Vec3 trial = 2 * mu * (strain - plastic);
      trial.array() -= trial.sum() / 3;
      const double q = std::sqrt(1.5) * trial.norm();
      if (const double over = q - (Y + H * p); over > 0) {
        const double dp = over / (3 * mu + H);
        plastic += 1.5 * dp / q * trial, p += dp;
        trial *= 1 - 3 * mu * dp / q;
      }
      const Vec3 stress = (trial.array() + K * strain.sum()).matrix();
      // force over the reference area: Kirchhoff stress over stretch
      worst = std::max({worst, std::abs(fx(k, 0) - stress[0] / (1 + u[0])), std::abs(fy(k, 1) - stress[1] / (1 + u[1]))});
    }
    EXPECT_LT(worst, 1e-8 * Y) << H;
    EXPECT_GT(p, 3e-5);
    const auto at_cells = r.table("/field/" + r.steps().back() + "/cell_plastic_strain"),
               at_nodes = r.table("/field/" + r.steps().back() + "/plastic_strain");
    EXPECT_NEAR(at_cells(0, 0), p, 1e-12);
    for (Eigen::Index a = 0; a < at_nodes.rows(); ++a) EXPECT_NEAR(at_nodes(a, 0), p, 1e-12);
  }
}

// Hill, exact: P/Y = ln(c/a) + (1 - c^2/b^2)/2 with Y = 2 yield/sqrt3, u_b = Y c^2 (1 - nu^2)/(E b): 0.1533015 mm at 0.18 GPa;
// here at a hundredth of loads and yield stress, since the theory is of small strain.
TEST(Plasticity, ThickCylinderWidensAsHillSays) {
  SceneCase c(hill_cylinder(1e7));
  Mesh m = block_mesh({.shape = Shape::hex20r, .n = {8, 12, 1}, .high = {1, 1, 0.1}, .map = [](const Vec3& s) {
                         const double r = 0.1 + 0.1 * s[0], a = M_PI / 2 * s[1];
                         return Vec3(r * std::cos(a), r * std::sin(a), 0.1 * s[2]);
                       }});
  for (auto& x : m.X)  // middles of the arcs on the circle
    if (const double r = std::hypot(x[0], x[1]), on = std::round(r * 160) / 160; std::abs(r - on) < 6e-4) x[0] *= on / r, x[1] *= on / r;
  const auto near = [](double a) { return std::abs(a) < 1e-9; };
  add_node_set(m, "left", [&](const Vec3& x) { return near(x[0]); });
  add_node_set(m, "bottom", [&](const Vec3& x) { return near(x[1]); });
  add_node_set(m, "outer", [&](const Vec3& x) { return near(x[1]) && near(x[0] - 0.2) && near(x[2]); });
  c.use(m);
  const Results r = c.solved();
  const auto at = r.history("probe/outer");
  EXPECT_NEAR(at(at.rows() - 1, 0) - 0.2, 0.1533015e-5, 0.005 * 0.1533015e-5);
}

// Corner 6.9227 mm with 32 x 32 cells of enhanced strain [simo-armero-1992], 6.94 taken as converged; within 1 %.
TEST(Plasticity, CookMembraneFallsAsPublished) {
  SceneCase c("units = \"mm-t-s\"\n" +
              metal(206.9e3, 0.29, "yield = 0.45e3\nsaturation = 0.715e3\nsaturation_rate = 16.93\nhardening = 0.12924e3") +
              held("xmin", "xy") + held("block", "z") + load("traction", "shear", "xmax", "traction = [0, 312.5, 0]") + probe("corner") +
              in_steps(10));
  Mesh m = block_mesh({.n = {32, 32, 1}, .high = {1, 1, 1e-3}, .map = [](const Vec3& s) {  // mm, in m
                         const double x = 48 * s[0], low = 44 * s[0], high = 44 + 16 * s[0];
                         return Vec3(1e-3 * Vec3(x, low + s[1] * (high - low), 1000 * s[2]));
                       }});
  add_node_set(m, "corner", [](const Vec3& x) { return x[0] > 0.048 - 1e-9 && x[1] > 0.06 - 1e-9; });
  c.use(m);
  const Results r = c.solved();
  const auto at = r.history("probe/corner");
  EXPECT_NEAR(at(at.rows() - 1, 1) - at(0, 1), 6.9227e-3, 0.01 * 6.9227e-3);
}

// An integrator that would not carry the plastic strain through its stages is refused, and so is a bar.
TEST(Plasticity, WhatDoesNotCarryPlasticStrainIsRefused) {
  SceneCase c(yielding_bar);
  Mesh m = block_mesh({.n = {2, 1, 1}});
  m.node_sets["middle"] = {0};
  c.use(m);
  for (const char* method : {"mid-point", "U0", "V0", "bathe", "radau"}) {
    expect_words(c.solve(std::string("--set 'time.integrator=\"") + method + "\"'", "run.h5", 2).err,
                 "cannot keep the plastic strain of a material");
  }
  for (const char* method : {"newmark", "hht", "wbz", "generalized-alpha", "bdf2"})
    c.solve(std::string("--quiet --set time.end=0.02 --set time.rho=0.8 --set 'time.integrator=\"") + method + "\"'");
}

}  // namespace
}  // namespace hilo::test::plasticity_test
