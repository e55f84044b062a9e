// SPDX-License-Identifier: GPL-3.0-or-later
// A step that is too large is cut and the run goes on; one that cannot be cut further ends the run with exit 3 and the last good state on
// disk.
#include "verify/free_bar.hpp"

namespace hilo::test::cutting_test {
namespace {

/// Free, and turned by six radians in a step.
const std::string scene = soft_bar("neo-hookean") + initial("block", "spin = [3, 10, 7]") + in_time(2, 0.5);

TEST(StepControl, CutsAStepThatIsTooLargeAndGoesOn) {
  SceneCase c(scene);
  c.use(free_bar());
  const Ran ran = c.solve();
  ASSERT_EQ(ran.exit, 0);
  EXPECT_NE(ran.err.find("step cut"), std::string::npos) << ran.err;
  const std::string json = text_of(c / "run.json");
  EXPECT_EQ(json.find("\"cuts\": 0,"), std::string::npos) << json;
  EXPECT_NE(json.find("\"complete\": true"), std::string::npos);
  const Results r = c.results();
  EXPECT_TRUE(r.complete());
  EXPECT_NEAR(r.t()[r.t().size() - 1], 2, 1e-12);
  double shortest = 1e300;
  for (Eigen::Index i = 1; i < r.t().size(); ++i) shortest = std::min(shortest, r.t()[i] - r.t()[i - 1]);
  EXPECT_LT(shortest, 0.6 * 0.5);
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-9 * r.history("energy").col(0).maxCoeff());
}

TEST(StepControl, StopsWithExitThreeAndAReadableFileWhenItMayNotCut) {
  SceneCase c(scene);
  c.use(free_bar());
  const Ran ran = c.solve("--set solver.cuts=0 --set solver.iterations=4", "run.h5", 3);
  EXPECT_NE(ran.err.find("stopped at t ="), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("run.h5"), std::string::npos);
  const Results r = c.results();
  EXPECT_FALSE(r.complete());
  EXPECT_GE(r.t().size(), 1);
  EXPECT_EQ(r.history("energy").rows(), r.t().size());
  EXPECT_NE(text_of(c / "run.json").find("\"complete\": false"), std::string::npos);
}

}  // namespace
}  // namespace hilo::test::cutting_test
