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

}  // namespace
}  // namespace hilo::test::moved_test
