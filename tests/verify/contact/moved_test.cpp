// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles that a law moves: on a body that a [[motion]] drives.
#include <gtest/gtest.h>

#include <cmath>

#include "verify/contact/collision.hpp"

namespace hilo::test::moved_test {
namespace {

/// Largest change of the balance in a step over the largest energy.
double unbalanced(const Results& r) {
  const auto e = r.history("energy");
  return (e.col(5).tail(e.rows() - 1) - e.col(5).head(e.rows() - 1)).cwiseAbs().maxCoeff() / e.col(0).maxCoeff();
}

// Truth: a belt at v takes a block along at mu g until both are equally fast: the block stays v^2/(2 mu g) behind, and friction takes half
// of the work of the motion, m v^2.
TEST(Moved, ABeltTakesABlockAlong) {
  BlockOptions o;
  o.n[0] = o.n[1] = 2, o.high = Vec3(0.4, 0.4, 0.1);
  Case c("contact");
  c.use(block_mesh(o));
  const Results r = c.solved("--set solver.tolerance=1e-12", "run.h5", "belt");
  const auto x = r.history("probe/b"), f = r.history("contact/c"), e = r.history("energy");
  const double v = 2, m = 16, mu_g = 5;
  const Eigen::Index last = x.rows() - 1;
  EXPECT_NEAR(x(last, 0) - x(0, 0), v - v * v / (2 * mu_g), 1e-3);
  EXPECT_NEAR(x(r.index(0.2), 3), mu_g * 0.2, 5e-3);
  EXPECT_NEAR(f(last, 6), m * v * v / 2, 1e-3 * m * v * v);
  EXPECT_NEAR(e(last, 3), m * v * v, 1e-3 * m * v * v) << "work of the motion";
  EXPECT_LT(unbalanced(r), 1e-11);
}

// Truth: on a table that turns at W a ball that rolls goes round a circle at 2 W/7, of radius v/(2 W/7).
TEST(Moved, ABallOnATurntableGoesRoundACircle) {
  Case c("contact");
  const Results r = c.solved("", "run.h5", "turntable");
  const auto x = r.history("probe/b");
  for (Eigen::Index k = 0; k < x.rows(); ++k) {
    EXPECT_NEAR(x(k, 0), 0.1 + 0.2 * std::cos(2 * r.t()[k]), 5e-5) << k;
    EXPECT_NEAR(x(k, 1), 0.2 * std::sin(2 * r.t()[k]), 5e-5) << k;
  }
  EXPECT_LT(unbalanced(r), 1e-11);
}

// Truth: mu p (r2^2 - r1^2) sin(a) across and mu p 2a (r2^3 - r1^3)/3 of torque, of a pad between radii r1, r2 and angles -a, a on a disc
// that turns under it.  Rigid and flat, so that nothing gives way to points that should be open: those beyond a corner of the pad were
// pressed, as the side that is nearest to them was one of two.
TEST(Moved, ARigidPadOnARigidDisc) {
  BlockOptions disc, pad;
  disc.regions = {"disc"}, disc.n[0] = 5, disc.n[1] = 25, disc.low = Vec3(0.06, -3, -0.02), disc.high = Vec3(0.26, 0.9, 0);
  pad.regions = {"pad"}, pad.n[0] = 3, pad.n[1] = 6, pad.n[2] = 2, pad.low = Vec3(0.1, -0.3, 0), pad.high = Vec3(0.2, 0.3, 0.02);
  disc.map = pad.map = [](const Vec3& x) { return Vec3(x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), x[2]); };
  Case c("contact");
  c.use(together(block_mesh(disc), block_mesh(pad)), {Fidelity::rigid, Fidelity::rigid});
  c.write("scene.toml",
          "[material.m]\nE = 1e9\nnu = 0\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n"
          "[[motion]]\nkind = \"rotation\"\nname = \"drive\"\non = \"disc\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\nangle = 2\n"
          "history = {t = [0, 0.2, 1], value = [0, 0, 1]}\n[[contact]]\nname = \"c\"\na = \"disczmax\"\nb = \"padzmin\"\nfriction = 0.4\n"
          "modulus = 1e9\nlayer = 0.02\n[[joint]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"ground\"\nb = \"pad\"\nat = [0.15, 0, "
          "0.02]\naxis = [0, 0, 1]\n[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"padzmax\"\npressure = 1000\n"
          "history = {t = [0, 0.2, 1], value = [0, 1, 1]}\n[time]\nend = 1\nstep = 0.02\n");
  succeeded(c.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
  const Results r(c / "run.h5");
  const double across = 400 * (0.04 - 0.01) * std::sin(0.3), torque = 400 * 0.6 * (0.008 - 0.001) / 3;
  for (const double t : {0.4, 0.6, 0.8, 1.0}) {
    const Eigen::VectorXd f = r.at("contact/c", t);
    EXPECT_NEAR(f[1], across, 0.01 * across) << t;
    EXPECT_NEAR(f[0], 0, 0.03 * across) << t;
  }
  EXPECT_NEAR((r.at("contact/c", 1)[6] - r.at("contact/c", 0.4)[6]) / 1.5, torque, 0.01 * torque) << "work over the angle";
}

}  // namespace
}  // namespace hilo::test::moved_test
