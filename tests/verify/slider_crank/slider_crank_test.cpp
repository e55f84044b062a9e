// SPDX-License-Identifier: GPL-3.0-or-later
// FEBio rj02-05: x = r cos a + sqrt(l^2 - r^2 sin^2 a); after a whole turn everything is back where it was.
#include "verify/verify.hpp"

namespace hilo::test::slider_crank_test {
namespace {

TEST(SliderCrank, SliderIsWhereTheTriangleSays) {
  const Case c("slider_crank");
  const Results r = c.solved();
  const std::pair<int, double> table[] = {{0, 130}, {1, 124.849362}, {2, 111.566040}, {3, 95.393920}, {4, 81.566040}, {6, 70}};
  for (const auto& [step, x] : table) EXPECT_NEAR(1e3 * r.at("probe/slider", step / 12.)[0], x, 1e-6) << 30 * step << " degrees";
  for (const char* body : {"body/crank", "body/rod", "body/slider"})
    EXPECT_LT((r.at(body, 1) - r.at(body, 0)).norm(), 1e-10) << body << " after a turn";
}

}  // namespace
}  // namespace hilo::test::slider_crank_test
