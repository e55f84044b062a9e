// SPDX-License-Identifier: GPL-3.0-or-later
// Car axis of the IVP test set [mazzia-magherini-2008]: what moves by a table of a sampled course, and the multipliers that its second
// derivative makes.
#include "verify/verify.hpp"

namespace hilo::test::car_axis_test {
namespace {

// Truth: the published solution at t = 3, computed with 1e-14 there: positions of both wheels and the two multipliers.
TEST(CarAxis, RoadOfASplineThrough300PointsHasItsMultipliers) {
  const Case c("car_axis");
  const Results r = c.solved();
  const auto left = r.at("probe/left", 3), right = r.at("probe/right", 3);
  EXPECT_NEAR(left[0], 0.0493455784275402809, 1e-4);
  EXPECT_NEAR(left[1], 0.496989460230171154, 1e-4);
  EXPECT_NEAR(right[0], 1.04174252488542152, 1e-4);
  EXPECT_NEAR(right[1], 0.373911027265361257, 1e-4);
  EXPECT_LT(std::abs(left[2]) + std::abs(right[2]), 1e-9);
  EXPECT_NEAR(r.at("joint/guide", 3)[0], -0.00473688659084893325, 0.01 * 0.0047);
  EXPECT_NEAR(r.at("joint/rod", 3).head<3>().norm(), 2 * 0.00110468033125734369, 0.01 * 0.0022);
}

}  // namespace
}  // namespace hilo::test::car_axis_test
