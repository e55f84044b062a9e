// SPDX-License-Identifier: GPL-3.0-or-later
// Positions, rates and reactions of single-joint pendulums as ADAMS gives them (Chrono data/testing/joints).  Rforce is
// the force on the ground, minus ours, which is on b in the joint frame.  Chrono accepts 1e-3 m, 1e-4 m/s and 2e-2 N; here h = 1e-3 s.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::joints_test {
namespace {

constexpr double position_limit = 1e-4, force_limit = 1e-2;

/// Scene with another joint; vectors as TOML.
Results run_case(const Case& c, const std::string& kind, const std::string& at, const std::string& axis, const std::string& com,
                 const std::string& inertia, const std::string& x = "[1,0,0]") {
  std::string scene = text_of(c.source("scene.toml"));
  const auto replace = [&](const std::string& from, const std::string& to) {
    const auto p = scene.find(from);
    EXPECT_NE(p, std::string::npos) << from;
    scene.replace(p, from.size(), to);
  };
  replace("kind = \"revolute\"", "kind = \"" + kind + "\"");
  replace("at = [0, 0, 0]", "at = " + at);
  replace("axis = [0, 1, 0]\nx = [1, 0, 0]", kind == "spherical" ? "" : "axis = " + axis + "\nx = " + x);
  replace("com = [2, 0, 0]", "com = " + com);
  replace("inertia = [0.04, 0.1, 0.1]", "inertia = " + inertia);
  c.write("scene.toml", scene);
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  return c.results();
}

void expect_position(const Results& r, double t, const Vec3& x) {
  EXPECT_LT((r.at("probe/cg", t).head<3>() - x).norm(), position_limit) << "t = " << t;
}
void expect_force_on_ground(const Results& r, double t, const Vec3& f, const Mat3& frame) {
  EXPECT_LT((-frame * r.at("joint/joint", t).head<3>() - f).norm(), force_limit) << "t = " << t;
}

TEST(SingleJoint, Revolute01SwingsAsInAdamsWithItsReactions) {
  const Case c("joints");
  const Results r = run_case(c, "revolute", "[0,0,0]", "[0,1,0]", "[2,0,0]", "[0.04,0.1,0.1]");
  expect_position(r, 1, {-0.892381, 0, -1.789880}), expect_position(r, 2, {-1.951120, 0, -0.439479}),
      expect_position(r, 3, {1.869170, 0, -0.711481});
  expect_position(r, 4, {1.296960, 0, -1.522460}), expect_position(r, 5, {-1.999680, 0, -0.0355587});
  const Mat3 frame = frame_of_axis({0, 1, 0}, {1, 0, 0});
  expect_force_on_ground(r, 0, {0, 0, -0.239187}, frame), expect_force_on_ground(r, 1, {-11.4612, 0, -23.2273}, frame);
  expect_force_on_ground(r, 2, {-6.15295, 0, -1.62512}, frame), expect_force_on_ground(r, 3, {9.54282, 0, -3.87156}, frame);
  expect_force_on_ground(r, 4, {14.1691, 0, -16.8718}, frame), expect_force_on_ground(r, 5, {-0.510225, 0, -0.248259}, frame);
  // v = omega x r gives omega_y back: 1 s 2.92614, 2 s -1.44995, 3 s -1.84487, 4 s 2.69871, 5 s 0.412436; Chrono accepts 1e-4 m/s
  const double omega[5] = {2.92614, -1.44995, -1.84487, 2.69871, 0.412436};
  for (int i = 0; i < 5; ++i) {
    const auto p = r.at("probe/cg", i + 1);
    EXPECT_NEAR((p[2] * p[3] - p[0] * p[5]) / 4, omega[i], 1e-4);
  }
}

TEST(SingleJoint, Revolute02SwingsAboutAnInclinedAxis) {
  const Case c("joints");
  const Results r = run_case(c, "revolute", "[1,2,3]", "[0,1,1]", "[3,2,3]", "[0.04,0.1,0.1]");
  expect_position(r, 0, {3, 2, 3}), expect_position(r, 5, {1.20996, 3.40640, 1.59360});
  const Mat3 frame = frame_of_axis({0, 1, 1}, {1, 0, 0});
  expect_force_on_ground(r, 0, {0, -4.78373, -5.02292}, frame), expect_force_on_ground(r, 5, {2.11895, 9.40977, -19.2164}, frame);
}

TEST(SingleJoint, Spherical02SwingsInTheVerticalPlane) {
  const Case c("joints");
  const Results r = run_case(c, "spherical", "[1,2,3]", "", "[3,2,3]", "[0.04,0.1,0.1]");
  expect_position(r, 1, {0.107619, 2, 1.210120}), expect_position(r, 2, {-0.951117, 2, 2.560520}),
      expect_position(r, 5, {-0.999684, 2, 2.964440});
}

TEST(SingleJoint, Universal01SwingsAboutItsCrossArm) {
  const Case c("joints");
  const Results r = run_case(c, "universal", "[0,0,0]", "[0,0,1]", "[0,2,0]", "[0.1,0.04,0.1]");
  // ADAMS' universal 01 is off its own revolute 01, the same motion in the x-z plane, by 2.4e-4 m at 2 s and 6.4e-4 m at 5 s: Chrono's 1e-3
  // m
  const auto near = [&](double t, const Vec3& x, double limit) {
    EXPECT_LT((r.at("probe/cg", t).head<3>() - x).norm(), limit) << "t = " << t;
  };
  near(1, {0, -0.892369, -1.789880}, 1e-3), near(2, {0, -1.951060, -0.439720}, 1e-3), near(5, {0, -1.999670, -0.0361929}, 1e-3);
  near(1, {0, -0.892381, -1.789880}, 1e-4), near(2, {0, -1.951120, -0.439479}, 1e-4), near(5, {0, -1.999680, -0.0355587}, 1e-4);
}

TEST(SingleJoint, Cylindrical02SwingsAndDoesNotSlide) {
  const Case c("joints");
  const Results r = run_case(c, "cylindrical", "[0,0,0]", "[0,1,0]", "[2,0,0]", "[0.04,0.1,0.1]");
  expect_position(r, 1, {-0.892381, 0, -1.789880}), expect_position(r, 5, {-1.999680, 0, -0.0355587});
  EXPECT_LT(r.history("probe/cg").col(1).cwiseAbs().maxCoeff(), 1e-12);
}

// Exact: a = g/sqrt 2 along the inclined axis; the guide carries the rest of the weight.
TEST(SingleJoint, Prismatic02SlidesDownItsGuideExactly) {
  const Case c("joints");
  const Results r = run_case(c, "prismatic", "[1,2,3]", "[0,1,1]", "[3,2,3]", "[0.04,0.1,0.1]");
  for (double t : {1.0, 2.0, 5.0})
    EXPECT_LT((r.at("probe/cg", t).head<3>() - Vec3(3, 2 - 9.80665 * t * t / 4, 3 - 9.80665 * t * t / 4)).norm(), 1e-8)
        << "round-off of 5000 steps";
  expect_position(r, 1, {3, -0.451662, 0.548338}), expect_position(r, 2, {3, -7.80665, -6.80665}),
      expect_position(r, 5, {3, -59.2916, -58.2916});
  const Mat3 frame = frame_of_axis({0, 1, 1}, {1, 0, 0});
  for (double t : {0.0, 1.0, 5.0}) expect_force_on_ground(r, t, {0, 4.90332, -4.90332}, frame);
}

// No row of the joint moves anything.
TEST(SingleJoint, OfABodyThatIsHeldHasNoForce) {
  SceneCase c(body("b", 1, {0, 0, 0}, {1, 1, 1}) + motion("fixed", "base", "b", "") +
              axial("revolute", "guide", "ground", "b", {0, 0, 0}, {0, 0, 1}) + push("b", {0, 5, 0}) + in_time(0.06, 1e-3));
  const Ran o = c.run("hilo-solve --quiet scene.toml");
  EXPECT_EQ(o.exit, 0);
  EXPECT_EQ(o.err, "");
  EXPECT_EQ(c.results("run.h5").history("joint/guide").cwiseAbs().maxCoeff(), 0);
}

// Truth: at rest a joint carries the weight at the joint point and its moment r x m g; on b, and with the opposite sign when the ends are
// swapped.
// A top of a millimetre 1.4 km away: positions have four digits less than the tolerance asks for.
TEST(SingleJoint, FarFromTheOriginSaysSo) {
  const Vec3 at(1000, 1000, 0), com = at + Vec3(0, 0, 7e-4);
  SceneCase c("gravity = [0, 0, -9.81]\n" + body("top", 1, com, {2e-7, 2e-7, 2e-7}) + joint("spherical", "tip", "ground", "top", at) +
              initial("top", "spin = [100, 0, 500]\nabout = " + list(at)) + in_time(0.03, 5e-5));
  const Ran o = c.run("hilo-solve --quiet scene.toml");
  EXPECT_EQ(o.exit, 3);
  EXPECT_NE(o.err.find("the scene lies 1.4e+03 m from its origin"), o.err.npos) << o.err;
}

TEST(FixedJoint, CarriesWeightAndMomentWithTheirSigns) {
  const Case c("joints");
  const std::string scene = text_of(c.source("scene.toml"));
  const auto at = scene.find("[[joint]]"), end = scene.find("[[probe]]");
  for (const bool swapped : {false, true}) {
    const std::string ends = swapped ? "a = \"pendulum\"\nb = \"ground\"\n" : "a = \"ground\"\nb = \"pendulum\"\n";
    c.write("scene.toml",
            scene.substr(0, at) + "[[joint]]\nkind = \"fixed\"\nname = \"joint\"\n" + ends + "at = [0.5, 0, 0]\n\n" + scene.substr(end));
    succeeded(c.run("hilo-solve --quiet scene.toml --set time.end=0.01 -o run.h5"));
    const auto f = c.results().history("joint/joint");
    Eigen::Matrix<double, 6, 1> exact;
    exact << 0, 0, 9.80665, 0, -1.5 * 9.80665, 0;
    for (Eigen::Index i = 0; i < f.rows(); ++i) ASSERT_LT((f.row(i).transpose() - (swapped ? -1 : 1) * exact).norm(), 1e-7) << f.row(i);
  }
}

}  // namespace
}  // namespace hilo::test::joints_test
