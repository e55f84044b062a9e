// SPDX-License-Identifier: GPL-3.0-or-later
// IFToMM A02: the published end point; the mechanism passes its singular position, rods in one line, eight times in ten
// seconds.
#include "verify/verify.hpp"

namespace hilo::test::double_four_bar_test {
namespace {

TEST(DoubleFourBar, PassesItsSingularPositionsAndEndsWhereItShould) {
  const Case c("double_four_bar");
  const Ran ran = c.solve();
  ASSERT_EQ(ran.exit, 0);
  EXPECT_NE(ran.err.find("redundant"), std::string::npos) << ran.err;
  const Results r = c.results();
  EXPECT_LT((r.at("probe/B0", 10).head<2>() - Eigen::Vector2d(0.3284577, 0.9445187)).norm(), 1e-4) << "Exudyn at this step: 5e-5";
  EXPECT_LT((r.at("probe/B0", 10).segment<2>(3) - Eigen::Vector2d(1.423051, -0.494868)).norm(), 3e-4);
  const std::pair<int, Eigen::Vector2d> path[] = {{1, {-0.195020, -0.980799}},
                                                  {2, {0.057816, 0.998327}},
                                                  {3, {-0.549340, -0.835599}},
                                                  {4, {0.117616, 0.993059}},
                                                  {5, {-0.811310, -0.584616}}};
  for (const auto& [t, x] : path) EXPECT_LT((r.at("probe/B0", t).head<2>() - x).norm(), 1e-4) << "t = " << t;
  const auto e = r.history("energy");
  EXPECT_NEAR(e(0, 0) + e(0, 2), 35.835, 1e-10);
  double drift = 0;
  for (Eigen::Index i = 0; i < e.rows(); ++i) drift = std::max(drift, std::abs(e(i, 0) + e(i, 2) - 35.835));
  EXPECT_LT(drift, 1e-8) << "IFToMM allows 0.1 J";
}

}  // namespace
}  // namespace hilo::test::double_four_bar_test
