// SPDX-License-Identifier: GPL-3.0-or-later
// Bricard's mechanism: six revolutes whose thirty rows have rank 29 in every position, so that a Grübler count gives no freedom where
// there is one.  Truth: energy, the rows that were dropped, and the same motion by Radau IIA5.
#include "verify/verify.hpp"

namespace hilo::test::bricard_test {
namespace {

TEST(Bricard, RunsAsGivenNamesTheRedundantJointAndKeepsTheDroppedRow) {
  const Case c("bricard");
  const Ran ran = c.solve();
  ASSERT_EQ(ran.exit, 0);
  EXPECT_NE(ran.err.find("1 of 30 joint rows are redundant"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("depends on R"), std::string::npos) << ran.err;
  EXPECT_NE(text_of(c / "run.json").find("\"redundant_rows\": 1"), std::string::npos);
  const Results r = c.results();
  EXPECT_LT(r.history("constraint").maxCoeff(), 1e-12) << "the dropped row counts too";
  const auto e = r.history("energy");
  const double top = e.col(0).maxCoeff();
  EXPECT_GT(top, 1) << "it swings";
  EXPECT_LT((e.col(0).array() + e.col(2).array() - e(0, 0) - e(0, 2)).abs().maxCoeff(), 1e-10 * top);
}

TEST(Bricard, ConvergesToTheMotionOfRadau) {
  const Case c("bricard");
  const Vec3 truth =
      c.solved("--set time.end=2 --set time.step=0.005 --set 'time.integrator=\"radau\"'", "truth.h5").at("probe/far", 2).head<3>();
  double error[2];
  for (int k = 0; k < 2; ++k)
    error[k] =
        (c.solved(std::string("--set time.end=2 --set time.step=") + (k ? "0.02" : "0.04")).at("probe/far", 2).head<3>() - truth).norm();
  EXPECT_NEAR(std::log2(error[0] / error[1]), 4, 0.3) << error[0] << " " << error[1];
  EXPECT_LT(error[1], 1e-3) << "the best peer of solvers.md is 1e-3 off at half this step, over ten seconds";
}

}  // namespace
}  // namespace hilo::test::bricard_test
