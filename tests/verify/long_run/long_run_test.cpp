// SPDX-License-Identifier: GPL-3.0-or-later
// A million steps: what must be kept is kept to round-off, judged from the results file alone.
#include "verify/verify.hpp"

namespace hilo::test::long_run_test {
namespace {

constexpr double eps = 2.220446049250313e-16;

// Done when, issue 3: violation <= 50 eps max(|x|, L), energy balance <= 1e-10 over 1e6 steps.  The corner of the brick is found from its
// four recorded points, energy from the probe at the centre and the turning of the points.
TEST(LongRun, OfAMillionStepsKeepsEnergyAndJointToRoundOff) {
  const Case c("long_run");
  const Results r = c.solved();
  const auto x = r.history("body/brick"), e = r.history("energy");
  ASSERT_EQ(x.rows(), 1000001);
  // the corner in terms of the points: weights from the first row, which the scene itself fixes
  Mat3 arms;
  for (int k = 0; k < 3; ++k) arms.col(k) = (x.row(0).segment(3 + 3 * k, 3) - x.row(0).head(3)).transpose();
  const Vec3 weight = arms.inverse() * -x.row(0).head(3).transpose();
  double gap = 0, reach = 0, energy = 0, top = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    Vec3 corner = x.row(i).head(3).transpose();
    for (int k = 0; k < 3; ++k) corner += weight[k] * (x.row(i).segment(3 + 3 * k, 3) - x.row(i).head(3)).transpose();
    gap = std::max(gap, corner.norm());
    reach = std::max(reach, x.row(i).head(3).norm());
    top = std::max(top, e(i, 0));
    energy = std::max(energy, std::abs(e(i, 0) + e(i, 2) - e(0, 0) - e(0, 2)));
  }
  EXPECT_LT(gap, 50 * eps * std::max(reach, 1.0));
  EXPECT_LT(energy / top, 1e-10);
  EXPECT_LT(r.history("constraint").maxCoeff(), 50 * eps * std::max(reach, 1.0));
}

// Truth: nothing acts on a free body, so its angular momentum is what it was (issue 3: to 1e-12), energy too.
TEST(LongRun, OfAFreeBodyKeepsAngularMomentum) {
  const Case c("long_run");
  const Results r = c.solved("--set time.end=1000", "run.h5", "free");
  const auto m = r.history("momentum"), e = r.history("energy");
  ASSERT_EQ(m.rows(), 100001);
  const Vec3 start = m.row(0).tail(3).transpose();
  EXPECT_NEAR(start.norm(), std::hypot(0.2 * 0.5, 0.3 * 4, 0.4 * 0.3), 1e-12) << "J w";
  double worst = 0;
  for (Eigen::Index i = 0; i < m.rows(); ++i) worst = std::max(worst, (m.row(i).tail(3).transpose() - start).norm());
  EXPECT_LT(worst / start.norm(), 1e-12);
  EXPECT_LT((e.col(0).array() - e(0, 0)).abs().maxCoeff() / e(0, 0), 1e-11);
}

}  // namespace
}  // namespace hilo::test::long_run_test
