// SPDX-License-Identifier: GPL-3.0-or-later
// ANSYS VM65: impact at 0.0719816 s with 27.78489 in/s, deepest 0.5506656 in below the spring's top at 0.1004449 s.
#include "verify/verify.hpp"

namespace hilo::test::drop_on_spring_test {
namespace {

TEST(DropOnSpring, HitsAndTurnsWhereTheClosedFormSays) {
  const Case c("drop_on_spring");
  const Results r = c.solved();
  const auto x = r.history("probe/mass");
  constexpr double inch = 0.0254;
  Eigen::Index deepest = 0;
  EXPECT_NEAR(x.col(2).minCoeff(&deepest) / inch, -0.5506656, 1e-5);
  EXPECT_NEAR(r.t()[deepest], 0.1004449, 1e-5);
  EXPECT_NEAR(x.col(5).minCoeff() / inch, -std::sqrt(27.78489 * 27.78489 + 386 * 386 * 0.5 / 1973.92), 1e-3)
      << "fastest where the spring carries the weight";
  EXPECT_NEAR(x(r.index(0.07198), 5) / inch, -386 * 0.07198, 1e-6) << "free fall until contact";
  const auto e = r.history("energy");
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-9 * e.col(0).maxCoeff()) << "11000 steps, each solved to 1e-10 of its forces";
  EXPECT_GE(r.history("spring/floor").col(2).minCoeff(), -1e-9) << "never a pull";
  EXPECT_NEAR(r.history("spring/floor").col(2).maxCoeff(), 1973.92 * 0.5506656 * 4.4482216152605, 1e-2);
}

}  // namespace
}  // namespace hilo::test::drop_on_spring_test
