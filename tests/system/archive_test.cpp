// SPDX-License-Identifier: GPL-3.0-or-later
// What springs and joints remember can be kept and restored: a run that goes on from restored values goes on bit by bit.
#include "base/archive.hpp"

#include "dynamics/integrator/make.hpp"
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::archive_test {
namespace {

const std::string scene =
    "gravity = [0, 0, -9.81]\n" + body("arm", 2, {0.3, 0, 0}, {0.01, 0.05, 0.05}) + body("nut", 1, {0, 0, 1}, {0.02, 0.02, 0.02}) +
    body("bead", 0.5, {1, 1, 0}, {0.001, 0.001, 0.001}) + initial("arm", "spin = [0, 9, 0]\nabout = [0, 0, 0]") +
    initial("nut", "spin = [0, 0, 20]\nvelocity = [0, 0, 1]") + axial("revolute", "pin", "ground", "arm", Vec3::Zero(), {0, 1, 0}) +
    spring("torsion", "coil", "ground", "arm", "axis = [0, 1, 0]\nstiffness = 3") + R"([[stop]]
kind = "angle"
name = "limit"
joint = "pin"
lower = -0.4
upper = 0.4
stiffness = 5e3
restitution = 0.6
)" + axial("screw", "thread", "ground", "nut", {0, 0, 1}, {0, 0, 1}, "pitch = 0.31415926535897931") +
    joint("point-on-curve", "wire", "ground", "bead", {1, 1, 0},
          "points = [[1, 1, 0], [1.4, 1.2, -0.3], [1.8, 1, -0.5], [2.4, 0.7, -0.9], [3, 1, -1.2]]") +
    in_time(1, 0.005);

/// Steps from a state, with a method that has no history yet.
State go_on(System& system, State s, int n) {
  const auto method = make_mid_point();
  const auto solver = make_light_solver();
  solver->structure(system.layout.cliques, system.layout.map);
  const StepTools tools{system, *solver, {}};
  for (int k = 0; k < n; ++k) {
    EXPECT_TRUE(method->solve(tools, s, 0.005, Predictor::rigid_rotation).converged);
    method->accept(s);
    system.commit(s.q, &s.v);
  }
  return s;
}

bool same_bits(const State& a, const State& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return same(a.q.x, b.q.x) && same(a.q.c, b.q.c) && same(a.q.R, b.q.R) && same(a.v.c, b.v.c) && same(a.v.R, b.v.R) &&
         same(a.lambda, b.lambda);
}

TEST(ArchiveTest, ARunThatGoesOnFromRestoredValuesGoesOnBitByBit) {
  const Scene parsed = Scene::parse(scene, "scene.toml", {});
  const auto system = build_system(parsed, nullptr, Comm::world());
  State s;
  s.q = system->start, s.v = system->start_velocity;
  s.lambda.assign(3 * static_cast<size_t>(system->n_joint_blocks()), 0.0);
  s = go_on(*system, s, 60);
  Archive kept;
  system->archive(kept);
  const State once = go_on(*system, s, 60), forgetful = go_on(*system, s, 60);
  EXPECT_FALSE(same_bits(once, forgetful)) << "the scene remembers nothing: the test would see nothing";
  Archive back(kept.kept());
  system->archive(back);
  EXPECT_TRUE(back.is_at_end());
  EXPECT_TRUE(same_bits(once, go_on(*system, s, 60)));
  // into another system of the same scene
  const auto other = build_system(parsed, nullptr, Comm::world());
  Archive again(kept.kept());
  other->archive(again);
  EXPECT_TRUE(same_bits(once, go_on(*other, s, 60)));
}

TEST(ArchiveTest, ValuesOfAnotherSceneAreRefused) {
  std::string renamed = scene;
  renamed.replace(renamed.find("\"thread\""), 8, "\"spindle\"");
  const Scene one = Scene::parse(scene, "scene.toml", {}), two = Scene::parse(renamed, "scene.toml", {});
  const auto a = build_system(one, nullptr, Comm::world()), b = build_system(two, nullptr, Comm::world());
  Archive kept;
  a->archive(kept);
  Archive other(kept.kept());
  EXPECT_THROW(b->archive(other), Error);
  Kept less = kept.kept();
  less.bytes.pop_back();
  Archive cut(less);
  EXPECT_THROW(a->archive(cut), Error);
}

}  // namespace
}  // namespace hilo::test::archive_test
