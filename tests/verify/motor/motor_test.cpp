// SPDX-License-Identifier: GPL-3.0-or-later
// M = M0 (1 - w/w0) on an inertia J: w = w0 (1 - exp(-M0 t/(J w0))).
#include "verify/verify.hpp"

namespace hilo::test::motor_test {
namespace {

TEST(Motor, RunsUpAsTheExponentialOfItsLine) {
  const Case c("motor");
  const double M0 = 20, w0 = 50, J = 0.4;
  const auto error = [&](const std::string& step) {
    const Results r = c.solved("--set time.step=" + step);
    const auto x = r.history("probe/rim"), m = r.history("motor/drive");
    double worst = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const double w = w0 * (1 - std::exp(-M0 * r.t()[i] / (J * w0)));
      worst = std::max(worst, std::abs(x.row(i).segment(3, 3).norm() / 0.2 - w));
      EXPECT_NEAR(m(i, 5), M0 * (1 - w / w0), 5e-3 * M0);
    }
    const auto e = r.history("energy");
    EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * e.col(0).maxCoeff()) << "what the motor supplies is what the wheel has";
    EXPECT_NEAR(e(e.rows() - 1, 3), e(e.rows() - 1, 0), 1e-9 * e(e.rows() - 1, 0));
    return worst;
  };
  const double coarse = error("4e-3"), fine = error("2e-3");
  EXPECT_LT(fine, 3e-4 * w0) << "the method's own: w (w h)^2/12 = 1.7e-4 w0";
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

// Truth: a motor between two bodies changes neither momentum nor angular momentum of the two, and supplies M times the relative turn.
TEST(Motor, ReactsOnWhatCarriesIt) {
  const Case c("motor");
  const Ran ran = c.solve("--quiet", "run.h5", 0, "free");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  const auto p = r.history("momentum"), e = r.history("energy");
  for (Eigen::Index i = 0; i < p.rows(); ++i) EXPECT_LT((p.row(i) - p.row(0)).norm(), 1e-12);
  EXPECT_GT(e(e.rows() - 1, 3), 1);
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * e.col(0).maxCoeff());
}

}  // namespace
}  // namespace hilo::test::motor_test
