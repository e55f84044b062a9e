// SPDX-License-Identifier: GPL-3.0-or-later
// Restitution of contacts: velocities after impacts in closed form, at most what is there is taken, and momenta stay.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "dynamics/kept_run.hpp"
#include "physics/impact_loss.hpp"
#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::contact_restitution_test {
namespace {

constexpr double pi = std::numbers::pi;

struct Place : Case {
  Place() : Case("contact") {}
  Results solved(const std::string& scene, const std::string& options = "") const {
    std::ofstream(*this / "scene.toml") << scene;
    succeeded(Case::run("hilo-solve --quiet scene.toml " + options + " -o run.h5"));
    return Results(*this / "run.h5");
  }
};

/// A ball of 1 kg and 0.1 m above the ground.
std::string ball(double z, double v, double gravity, const std::string& contact, double end, double step) {
  return fmt::format(
      "gravity = [0, 0, {}]\n[[body]]\nname = \"ball\"\nmass = 1\ncom = [0, 0, {}]\ninertia = [4e-3, 4e-3, 4e-3]\n[[obstacle]]\nkind = "
      "\"plane\"\nname = \"ground\"\n[[obstacle]]\nkind = \"sphere\"\nname = \"skin\"\non = \"ball\"\nradius = 0.1\nat = [0, 0, {}]\n"
      "[[contact]]\nname = \"c\"\na = \"ground\"\nb = \"skin\"\n{}\n[[initial]]\non = [\"ball\"]\nvelocity = [0, 0, {}]\n[[probe]]\nname = "
      "\"p\"\non = \"ball\"\n[solver]\ntolerance = 1e-12\n[time]\nend = {:.17g}\nstep = {:.17g}\n",
      gravity, z, z, contact, v, end, step);
}

// Truth: e v, of linear contact and of Hertz; what is dissipated is (1 - e^2) m v^2/2.
TEST(Restitution, OfABallIsAsAsked) {
  const Place c;
  const double Tc = pi / std::sqrt(1e5);  // of the stiffness; the law of Hertz is about as fast
  for (const char* law : {"stiffness = 1e5", "modulus = 1e7"})
    for (const double e : {0.1, 0.5, 0.9}) {
      const Results r = c.solved(ball(0.101, -1, 0, fmt::format("{}\nrestitution = {}", law, e), 8 * Tc, Tc / 100));
      const auto x = r.history("probe/p"), energy = r.history("energy");
      EXPECT_NEAR(x(x.rows() - 1, 5), e, 0.01) << law;
      EXPECT_NEAR(energy(energy.rows() - 1, 4), (1 - e * e) / 2, 0.01) << law;
      EXPECT_LT((energy.col(5).array() - energy(0, 5)).abs().maxCoeff(), 1e-12) << law;
      for (Eigen::Index k = 1; k < energy.rows(); ++k) EXPECT_GE(energy(k, 4), energy(k - 1, 4) - 1e-15) << law << k;
    }
}

// Truth: from a height H, impacts at 1, 1 + 2 e, 1 + 2 e + 2 e^2 times sqrt(2 H/g), and e^2 H, e^4 H between them.
TEST(Restitution, ABallBouncesLower) {
  const Place c;
  const double H = 0.5, g = 9.81, e = 0.6, T = std::sqrt(2 * H / g);
  const Results r = c.solved(ball(0.1 + H, 0, -g, "stiffness = 1e6\nrestitution = 0.6", (1 + 2 * e + 2 * e * e) * T, 2e-4));
  const auto x = r.history("probe/p");
  const auto highest = [&](double from, double to) {
    double out = 0;
    for (Eigen::Index k = 0; k < x.rows(); ++k)
      if (r.t()[k] > from && r.t()[k] < to) out = std::max(out, x(k, 2) - 0.1);
    return out;
  };
  EXPECT_NEAR(highest(1.2 * T, (1 + 2 * e) * T), e * e * H, 0.02 * e * e * H);
  EXPECT_NEAR(highest((1.2 + 2 * e) * T, 9 * T), std::pow(e, 4) * H, 0.03 * std::pow(e, 4) * H);
}

// Truth: nothing acts from outside; steps from a fiftieth of the contact to twice its time.
TEST(Restitution, KeepsMomentaAndGivesNothingBack) {
  const Place c;
  for (const double share : shares) {
    const Results r =
        c.solved(text_of(c.source("two.toml")),
                 fmt::format("--set contact.c.restitution=0.4 --set time.step={} --set solver.tolerance=1e-12", 0.057 * share));
    const Worst w = worst_of(r, 1, 0.1);
    EXPECT_LT(std::max({w.energy, w.momentum, w.angular}), 1e-11) << share;
    EXPECT_LE(w.given_back, 1e-15) << share;
  }
}

// Truth: what slides throughout loses mu (1 + e) v along the surface, and the ball turns by its torque; at any restitution, of linear
// contact and of Hertz, of a ball and of rigid blocks.  The bristle takes its share while it bends: 1 mm/s of it here.
TEST(Restitution, FrictionOfASlidingImpactIsThatOfCoulomb) {
  const Place c;
  const auto expect_coulomb = [](const Results& r, const std::string& probe, const std::string& what) {
    const auto x = r.history(probe), energy = r.history("energy");
    const Eigen::Index last = x.rows() - 1;
    EXPECT_NEAR(1 - x(last, 3), 0.1 * (1 + x(last, 5)), 1e-3) << what;
    EXPECT_LT((energy.col(5).array() - energy(0, 5)).abs().maxCoeff(), 1e-10 * energy(0, 0)) << what;
    for (Eigen::Index k = 1; k < energy.rows(); ++k) EXPECT_GE(energy(k, 4), energy(k - 1, 4) - 1e-15 * energy(0, 0)) << what << k;
  };
  for (const char* law : {"stiffness = 1e7", "modulus = 1e9"})
    for (const double e : {0., 0.05, 0.1, 0.5, 1.}) {
      std::string scene = ball(0.1005, -1, 0, fmt::format("{}\nfriction = 0.1\nrestitution = {}", law, e), 0.01, 1e-5);
      scene.replace(scene.find("velocity = [0,"), 14, "velocity = [1,");
      expect_coulomb(c.solved(scene), "probe/p", fmt::format("{} {}", law, e));
    }
  BlockOptions A, B;
  A.n[0] = A.n[1] = A.n[2] = B.n[0] = B.n[1] = B.n[2] = 1;
  A.regions = {"A"}, B.regions = {"B"}, A.low = Vec3(-1, -1, 0), A.high = Vec3(2, 2, 1), B.low = Vec3(0, 0, 1.0002),
  B.high = Vec3(1, 1, 1.1002);
  Place of_blocks;
  of_blocks.use(together(block_mesh(A), block_mesh(B)), {Fidelity::rigid, Fidelity::rigid});
  for (const double e : {0., 0.5})
    expect_coulomb(
        of_blocks.solved(fmt::format("material.m = {{E = 1e9, nu = 0.3, density = 1000}}\nregion.\"*\".material = \"m\"\n"
                                     "motion = [{{kind = \"fixed\", name = \"f\", on = \"A\"}}]\nprobe = [{{name = \"b\", on = \"B\"}}]\n"
                                     "initial = [{{on = [\"B\"], velocity = [1, 0, -1]}}]\n"
                                     "contact = [{{name = \"c\", a = \"A\", b = \"B\", modulus = 1e9, layer = 0.1, friction = 0.1, "
                                     "restitution = {}}}]\nsolver = {{tolerance = 1e-12}}\ntime = {{end = 0.002, step = 5e-6}}\n",
                                     e),
                         "tags.h5"),
        "probe/b", fmt::format("blocks {}", e));
}

// Truth: of two equal rigid blocks, one at rest, (1 - e) v/2 and (1 + e) v/2 after; of one that falls flat on the ground, e v.
TEST(Restitution, OfSurfacesIsAsAsked) {
  BlockOptions A, B;
  A.n[0] = A.n[1] = A.n[2] = B.n[0] = B.n[1] = B.n[2] = 1;
  A.regions = {"A"}, B.regions = {"B"}, B.low = Vec3(0, 0, 1.002), B.high = Vec3(1, 1, 2.002);
  Place c;
  c.use(together(block_mesh(A), block_mesh(B)), {Fidelity::rigid, Fidelity::rigid});
  const std::string scene =
      "[material.m]\nE = 1e9\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n[[probe]]\nname = \"a\"\non = \"A\"\n"
      "[[probe]]\nname = \"b\"\non = \"B\"\n[solver]\ntolerance = 1e-12\n[time]\nend = 0.06\nstep = 2e-4\n";
  for (const double e : {0.2, 0.7}) {
    const std::string law = fmt::format("modulus = 1e7\nlayer = 0.1\nrestitution = {}\n", e);
    const Results r =
        c.solved(scene + "[[contact]]\nname = \"c\"\na = \"A\"\nb = \"B\"\n" + law + "[[initial]]\non = [\"B\"]\nvelocity = [0, 0, -1]\n",
                 "tags.h5");
    const auto a = r.history("probe/a"), b = r.history("probe/b");
    EXPECT_NEAR(a(a.rows() - 1, 5), -(1 + e) / 2, 0.01);
    EXPECT_NEAR(b(b.rows() - 1, 5), -(1 - e) / 2, 0.01);
    const Worst w = worst_of(r, 1000, 1000);
    EXPECT_LT(std::max({w.energy, w.momentum, w.angular}), 1e-11);
    const Results fallen = c.solved(scene +
                                        "[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\nat = [0, 0, -0.002]\n[[contact]]\nname = "
                                        "\"c\"\na = \"ground\"\nb = \"A\"\n" +
                                        law + "[[initial]]\non = [\"A\"]\nvelocity = [0, 0, -1]\n",
                                    "tags.h5");
    const auto x = fallen.history("probe/a");
    EXPECT_NEAR(x(x.rows() - 1, 5), e, 0.01);
  }
}

// Truth: pressed by 50 N and let go, it leaves with 1 - e y of what was stored.
TEST(Restitution, WhatWasPressedComesBack) {
  const Place c;
  const double e = 0.9, y = hunt_crossley(e), k = 1000, d = 0.05;
  const Results r = c.solved(ball(0.1, 0, 0, "stiffness = 1000\nrestitution = 0.9", 0.3, 1e-4) +
                             "start = \"equilibrium\"\n[[load]]\nkind = \"force\"\nname = \"f\"\non = \"ball\"\nforce = [0, 0, -50]\n"
                             "history = {t = [0, 0.01, 0.0101, 5], value = [1, 1, 0, 0]}\n");
  const auto x = r.history("probe/p");
  EXPECT_NEAR(x(x.rows() - 1, 5), std::sqrt((1 - e * y) * k) * d, 5e-3);
}

// Truth: a ball set down comes to rest at depth m g/k: restitution damps what friction and stiffness do not.
TEST(Restitution, ABallComesToRest) {
  const Place c;
  const Results r = c.solved(ball(0.11, 0, -9.81, "stiffness = 1e4\nrestitution = 0.3\nrest_speed = 0.02", 2, 1e-3));
  const auto x = r.history("probe/p");
  EXPECT_NEAR(x(x.rows() - 1, 2), 0.1 - 9.81 / 1e4, 1e-6);
  EXPECT_LT(std::abs(x(x.rows() - 1, 5)), 1e-3);
}

// Truth: three balls that fall on each other and on the ground come to rest there, and nothing is given back on the way.
TEST(Restitution, APileComesToRest) {
  const Place c;
  std::string scene =
      "gravity = [0, 0, -9.81]\n[[obstacle]]\nkind = \"sphere\"\nname = \"ground\"\nradius = 1\nat = [0, 0, 1]\ninside = true\n";
  const Vec3 at[] = {{0, 0, 0.3}, {0.15, 0.02, 0.6}, {-0.1, 0.05, 0.9}};
  for (int k = 0; k < 3; ++k)
    scene += fmt::format(
        "[[body]]\nname = \"b{0}\"\nmass = 1\ncom = [{1}, {2}, {3}]\ninertia = [4e-3, 4e-3, 4e-3]\n[[obstacle]]\nkind = "
        "\"sphere\"\nname = \"s{0}\"\non = \"b{0}\"\nradius = 0.1\nat = [{1}, {2}, {3}]\n",
        k, at[k][0], at[k][1], at[k][2]);
  const Results r = c.solved(scene +
                             "[[contact]]\nname = \"c\"\na = \"all\"\nb = \"all\"\nstiffness = 1e4\nfriction = 0.3\nrestitution = 0.4\n"
                             "rest_speed = 0.01\n[solver]\ntolerance = 1e-12\n[time]\nend = 6\nstep = 0.004\n");
  const auto e = r.history("energy");
  for (Eigen::Index k = 1; k < e.rows(); ++k) {
    EXPECT_LT(std::abs(e(k, 5) - e(k - 1, 5)), 1e-11 * 30) << k;
    EXPECT_GE(e(k, 4), e(k - 1, 4) - 1e-13) << k;
  }
  EXPECT_LT(e(e.rows() - 1, 0), 1e-2) << "from 18 J";
}

TEST(Restitution, GoesOnBitByBit) {
  const Folder folder;
  const Case c("contact");
  expect_goes_on(folder.path(), text_of(c.source("two.toml")), "", {10, 25, 28, 40}, {"contact.c.restitution=0.4"});
}

}  // namespace
}  // namespace hilo::test::contact_restitution_test
