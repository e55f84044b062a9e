// SPDX-License-Identifier: GPL-3.0-or-later
// Random machines against the default integrator: 418 rigid and 100 flexible runs, of these half a day, judged by machines/judge and not by
// the program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "folder.hpp"
#include "machines/judge.hpp"
#include "share.hpp"

namespace hilo::test {
namespace {

constexpr int steps = 100, rigid_seeds = 19, flexible_seeds = 6;

class RandomMachines : public testing::TestWithParam<std::tuple<Family, double>> {};

/// A run either keeps energy, momentum and joints, or stops and says so; at a step that a user would choose it hardly ever stops.
TEST_P(RandomMachines, ARunThatIsCompleteKeepsWhatIsKept) {
  const auto& [family, coarse] = GetParam();
  const int seeds = family.flexible ? flexible_seeds : rigid_seeds;
  int stopped = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    if (family.flexible && !today(seed, 2)) continue;
    const Folder folder;
    const Machine m = random_machine(family.name, static_cast<std::uint64_t>(seed));
    const double h = coarse * sensible_step(m, folder.path().string());
    const Outcome o = run_machine(m, {h, steps * h, ""}, folder.path().string());
    const std::string again = fmt::format("machines --family {0} --from {1} --to {1} --coarse {2:g}", family.name, seed, coarse);
    if (o.complete)
      EXPECT_TRUE(o.verdict.right()) << again << "\n" << o.verdict.text();
    else if (o.exit == 3)
      ++stopped, fmt::print("stopped at t = {:.4g} of {:.4g} s, {}: {}\n", o.t, steps * h, o.reason, again);
    else
      ADD_FAILURE() << again << ": exit " << o.exit << ", " << o.reason;
  }
  fmt::print("{} x{:g}: seeds 1 to {}, {} stopped\n", family.name, coarse, seeds, stopped);
  EXPECT_LE(stopped, coarse > 1 ? seeds / 4 : 1);
}

std::vector<Family> of_the_suite() {
  std::vector<Family> list = families();
  std::erase_if(list, [](const Family& f) { return !f.suite; });
  return list;
}
INSTANTIATE_TEST_SUITE_P(Families, RandomMachines, testing::Combine(testing::ValuesIn(of_the_suite()), testing::Values(1., 10.)),
                         [](const auto& info) {
                           std::string name = std::get<0>(info.param).name + (std::get<1>(info.param) > 1 ? "_coarse" : "");
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// A metal block of one hex20r cell between two bodies: at its eight points det F stays above .97 while the cell folds at its centre.
TEST(OneMachine, ACellThatFoldsBetweenItsPointsStopsTheRun) {
  const Folder folder;
  const Machine m = random_machine("metal-block", 7009);
  const double h = sensible_step(m, folder.path().string());
  const Outcome o = run_machine(m, {h, steps * h, ""}, folder.path().string());
  EXPECT_EQ(o.exit, 3);
  EXPECT_NE(o.reason.find("folded between its points"), std::string::npos) << o.reason;
}

/// A run judged by data that are not its own: what the judge would say of a solver that is wrong by as much.
class Judge : public testing::Test {
 protected:
  Verdict of_changed(const std::string& family, std::uint64_t seed, const std::function<void(Machine&)>& change) {
    const Folder folder;
    Machine m = random_machine(family, seed);
    const double h = sensible_step(m, folder.path().string());
    const Outcome o = run_machine(m, {h, 30 * h, ""}, folder.path().string());
    EXPECT_TRUE(o.complete && o.verdict.right()) << o.reason << o.verdict.text();
    change(m);
    return judge(m, folder.path().string() + "/run.h5");
  }
};

TEST_F(Judge, SeesAJointThatOpens) {
  const Verdict v = of_changed("chain", 2, [](Machine& m) {
    for (auto& b : m.bodies) b.com += Vec3(2e-6, -1e-6, 1e-6);
    m.bodies[0].com -= Vec3(4e-6, 0, 0);
  });
  EXPECT_GT(v.joint, 1e-7);
  EXPECT_FALSE(v.right());
}
TEST_F(Judge, SeesAnEnergyThatChanges) {
  EXPECT_GT(of_changed("tree", 3, [](Machine& m) { m.bodies[1].mass *= 1.001; }).energy, 1e-8);
  EXPECT_GT(of_changed("sprung", 1, [](Machine& m) { m.springs[0].stiffness *= 1 + 1e-4; }).energy, 1e-8);
  EXPECT_GT(of_changed("block", 6, [](Machine& m) { m.blocks[0].E *= 1 + 1e-4; }).energy, 1e-8);
}
TEST_F(Judge, SeesAMomentumThatChanges) {
  const Verdict v = of_changed("floating", 4, [](Machine& m) { m.bodies[0].mass *= 1.001; });
  EXPECT_GT(std::max(v.momentum, v.angular), 1e-8);
}

}  // namespace
}  // namespace hilo::test
