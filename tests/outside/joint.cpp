// SPDX-License-Identifier: GPL-3.0-or-later
// A kind of joint: b keeps its attitude to a and is free to move (3 rows).  A function that makes it, and a row of joint_kinds().
#include "outside.hpp"
#include "physics/joint_maker.hpp"

namespace outside {
namespace {

using namespace hilo;

Joint keep_attitude(const JointPlace& place, const Config& q) {
  JointMaker m(place, q);
  m.dot(m.u(0), m.v(1)), m.dot(m.u(1), m.v(2)), m.dot(m.u(2), m.v(0));
  return m.with();
}

}  // namespace

void add_joint() {
  joint_kinds().add({.name = "attitude",
                     .meaning = "b keeps its attitude to a and is free to move (3 rows)",
                     .keys = giving_way(joint_keys(false)),
                     .make = keep_attitude,
                     .holds = "CAB",
                     .freedoms = {},
                     .pressing = {}});
}

namespace {

const std::string scene = R"(
[[body]]
name = "box"
mass = 2
com = [1, 0, 0]
inertia = [0.2, 0.25, 0.3, 0.01, 0.02, -0.03]
[[joint]]
kind = "attitude"
name = "hold"
b = "box"
at = [1, 0, 0]
JOINT
[[load]]
kind = "force"
name = "push"
on = "box"
at = [1, 0.5, -0.2]
force = [3, 4, 5]
[[probe]]
name = "box"
on = "box"
[[probe]]
name = "corner"
on = "box"
at = [1.5, 0.5, 0.5]
[time]
end = 0.5
step = 0.01
)";

// Exact: the force moves the box by F t^2/(2 m), corners like the centre; the joint carries the moment of its arm, and no force.
TEST(OutsideJoint, KeepsTheAttitudeWithTheMomentOfTheLoad) {
  const test::Workplace place;
  const auto r = run_scene(place, std::string(scene).replace(scene.find("JOINT"), 5, ""));
  const Vec3 F(3, 4, 5), arm(0, 0.5, -0.2);
  const auto box = r.at("probe/box", 0.5), corner = r.at("probe/corner", 0.5), hold = r.at("joint/hold", 0.5);
  const Vec3 moved = F * 0.5 * 0.5 / (2 * 2);
  EXPECT_LT((box.head<3>() - Vec3(1, 0, 0) - moved).norm(), 1e-12);
  EXPECT_LT((corner.head<3>() - Vec3(1.5, 0.5, 0.5) - moved).norm(), 1e-12);
  EXPECT_LT(hold.head<3>().norm(), 1e-10);
  EXPECT_LT((hold.tail<3>() + arm.cross(F)).norm(), 1e-9) << hold.transpose();
}

// Exact, for small angles: on springs about its axes it swings as J w' = M - k sin(angle), about the first axis 2 sin^2(w t/2) M/k.
TEST(OutsideJoint, GivesWayLikeThoseOfTheTree) {
  const test::Workplace place;
  std::string text = scene;
  text.replace(text.find("JOINT"), 5, "angular_stiffness = 1e3\n");
  text.replace(text.find(", 0.01, 0.02, -0.03"), 19, "");
  text.replace(text.find("force = [3, 4, 5]"), 17, "force = [0, 0, 0.01]");
  text.replace(text.find("step = 0.01"), 11, "step = 0.0005");
  const auto r = run_scene(place, text);
  const double k = 1e3, M = 0.5 * 0.01, w = std::sqrt(k / 0.2), t = 0.0305, angle = 2 * std::pow(std::sin(w * t / 2), 2) * M / k;
  EXPECT_NEAR(r.at("joint/hold", t)[3], -k * angle, 1e-3 * M);
}

TEST(OutsideJoint, IsAWordOfTheSceneWithASuggestion) {
  std::string text = scene;
  text.replace(text.find("JOINT"), 5, "");
  text.replace(text.find("\"attitude\""), 10, "\"atitude\"");
  try {
    Scene::parse(text, "scene.toml");
    ADD_FAILURE() << "accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.hint, "did you mean \"attitude\"?");
  }
}

}  // namespace
}  // namespace outside
