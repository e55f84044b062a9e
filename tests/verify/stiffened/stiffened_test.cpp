// SPDX-License-Identifier: GPL-3.0-or-later
// A stiff elastic region is a rigid one with a compliance of 1/E: its tip's distance from the rigid answer falls as 1/E, slope -1 in log E.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::stiffened_test {
namespace {

Mesh two_regions() {
  return block_mesh(
      {.n = {8, 2, 2}, .high = {1, 0.1, 0.1}, .regions = {"root", "arm"}, .region_of = [](const Vec3& x) { return x[0] < 0.5 ? 0 : 1; }});
}

/// Held at its root; the load at the tip grows smoothly.
const std::string scene = solid(1e9, 0.3, 1000, "root") + solid(1e11, 0.3, 1000, "arm") + held("xmin") +
                          force("tip", "xmax", {0, 0, 500}, "history = {t = [0, 0.2], value = [0, 1], interpolation = \"smooth\"}") +
                          probe("tip", "xmax") + in_time(0.2, 2e-3);

TEST(StiffenedRegion, ApproachesTheRigidOneWithSlopeMinusOne) {
  SceneCase c(scene);
  c.use(two_regions(), {Fidelity::nonlinear, Fidelity::rigid});
  const auto rigid = c.solved("", "rigid.h5").history("probe/tip").leftCols(3).eval();
  EXPECT_GT((rigid.row(rigid.rows() - 1) - rigid.row(0)).norm(), 0.01) << "a deflection that matters";
  c.use(two_regions(), {Fidelity::nonlinear, Fidelity::nonlinear});
  std::vector<double> distance;
  for (const char* E : {"1e11", "1e12", "1e13"}) {
    const auto tip = c.solved(std::string("--set material.of_arm.E=") + E).history("probe/tip").leftCols(3).eval();
    ASSERT_EQ(tip.rows(), rigid.rows());
    distance.push_back((tip - rigid).rowwise().norm().maxCoeff());
  }
  for (size_t i = 0; i + 1 < distance.size(); ++i)
    EXPECT_NEAR(std::log10(distance[i + 1] / distance[i]), -1, 0.05) << distance[i] << " m, then " << distance[i + 1] << " m";
}

// Truth: one word per region changes the model and nothing else: with a stiff arm the two runs are the same to the arm's own deflection.
TEST(ToggledRegion, RunsAtEveryLevelAndAgreesWhenStiff) {
  SceneCase c(scene);
  const std::string base = "--set material.of_arm.E=1e12 ";
  std::vector<double> tip;
  const std::pair<Fidelity, Fidelity> levels[] = {
      {Fidelity::nonlinear, Fidelity::nonlinear}, {Fidelity::nonlinear, Fidelity::rigid}, {Fidelity::rigid, Fidelity::nonlinear}};
  for (const auto& [root, arm] : levels) {
    c.use(two_regions(), {root, arm});
    const Results r = c.solved(base);
    EXPECT_TRUE(r.complete());
    tip.push_back(r.at("probe/tip", 0.2)[2] - 0.05);
    EXPECT_EQ(r.file().read_strings("/tags/fidelity"), (std::vector<std::string>{std::string(word(root)), std::string(word(arm))}));
  }
  EXPECT_NEAR(tip[1], tip[0], 2e-3 * tip[0]) << "a rigid arm for a stiff one";
  EXPECT_GT(tip[0], 10 * tip[2]) << "a rigid root leaves only the arm to bend";
}

// Truth: two methods of second order converge to the same motion, so their difference falls with h^2.
TEST(TwoIntegrators, AgreeToSecondOrderOnAFlexibleScene) {
  SceneCase c(scene);
  c.use(two_regions(), {Fidelity::nonlinear, Fidelity::rigid});
  const auto difference = [&](const std::string& step) {
    const std::string common = "--set output.interval=1 --set time.step=" + step + " ";
    const auto a = c.solved(common).history("probe/tip"),
               b = c.solved(common + "--set 'time.integrator=\"generalized-alpha\"' --set time.rho=0.9").history("probe/tip");
    return (a - b).leftCols(3).rowwise().norm().maxCoeff();
  };
  const double coarse = difference("1e-3"), fine = difference("2.5e-4");
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.15) << coarse << " " << fine;
}

}  // namespace
}  // namespace hilo::test::stiffened_test
