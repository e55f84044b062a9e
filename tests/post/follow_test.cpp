// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras that follow, deformations, ways of points, arrows of forces.
#include <cmath>

#include "moving_run.hpp"
#include "picture_file.hpp"
#include "post/scene/annotations.hpp"
#include "post/scene/run_view.hpp"
#include "succeeded.hpp"

namespace hilo::test::follow_test {
namespace {

/// Half a turn about z in four seconds, about (2, 0, 0), going along y.
Mat3 turned(double t) { return Eigen::AngleAxisd(M_PI / 4 * t, Vec3::UnitZ()).toRotationMatrix(); }
Vec3 spin(const Vec3& X, double t) { return Vec3(2, 0.3 * t, 0) + turned(t) * (X - Vec3(2, 0, 0)); }
Vec3 glide(const Vec3& X, double t) { return X + Vec3(0.5 * t, -t, 0.2 * t); }

int differing(const PictureFile& a, const PictureFile& b) {  // below the title, left of the colour bar, above the cross of axes
  int n = 0;
  for (int y = 80; y < 590; ++y)
    for (int x = 0; x < 1100; ++x) n += a.at(x, y) != b.at(x, y);
  return n;
}

TEST(Track, keeps_a_body_that_glides_and_ride_one_that_turns_where_they_are_in_the_picture) {
  const Workplace place;
  write_moving_run(place, glide, 2);
  ASSERT_EQ(place.run("hilo-post render run.h5 --show arm --track arm --steps all -o t").exit, 0);
  ASSERT_EQ(place.run("hilo-post render run.h5 --show arm --steps all -o fixed").exit, 0);
  const PictureFile t0(place / "t-000000.png"), t2(place / "t-000002.png");
  EXPECT_GT(t0.ink(100, 80, 1090, 600), 0.1);
  EXPECT_LT(differing(t0, t2), 40);
  EXPECT_GT(differing(PictureFile(place / "fixed-000000.png"), PictureFile(place / "fixed-000002.png")), 20000);
  write_moving_run(place, spin, 2);
  ASSERT_EQ(place.run("hilo-post render run.h5 --show arm --ride arm --steps all -o r").exit, 0);
  ASSERT_EQ(place.run("hilo-post render run.h5 --show arm --track arm --steps all -o t").exit, 0);
  EXPECT_LT(differing(PictureFile(place / "r-000000.png"), PictureFile(place / "r-000002.png")), 40);
  EXPECT_GT(differing(PictureFile(place / "t-000000.png"), PictureFile(place / "t-000002.png")), 20000);
}

TEST(Track, names_that_are_not_there_get_a_suggestion) {
  const Workplace place;
  write_moving_run(place, glide, 1);
  struct Fault {
    const char *rest, *text;
    int exit;
  };
  for (const Fault& f :
       {Fault{"--track arn", "--track: no region, set, probe, sensor or body \"arn\" (did you mean \"arm\"?)", 2},
        Fault{"--trace ent", "--trace: no region, set, probe, sensor or body \"ent\" (did you mean \"end\"?)", 2},
        Fault{"--forces pim", "--forces: no joint or spring \"pim\" (did you mean \"pin\"?)", 2},
        Fault{"--ride arm --track arm", "give one", 1}, Fault{"--scale 2 --trace tip", "leave --scale or --deformed out", 1},
        Fault{"--scale 2 --deformed 2", "give one", 1}}) {
    const Ran ran = place.run(std::string("hilo-post render run.h5 -o x.png ") + f.rest);
    EXPECT_EQ(ran.exit, f.exit) << f.rest;
    EXPECT_NE(ran.err.find(f.text), std::string::npos) << ran.err;
  }
}

TEST(Deformed, enlarges_what_is_no_rigid_motion) {
  const Workplace place;
  FrameOptions o;
  o.run = place / "run.h5", o.deformed = 100, o.field = "displacement", o.show = {"arm"};
  const auto box = [&] {
    RunView view(o, o.run);
    std::vector<Vec3> at;
    view.survey(1, Fit(View(), 1), at);
    Vec3 low = Vec3::Constant(1e9), high = -low;
    for (const Vec3& x : at) low = low.cwiseMin(x), high = high.cwiseMax(x);
    return std::pair{low, high};
  };
  write_moving_run(place, spin, 1);  // nothing but a rigid motion: nothing changes
  const auto turned_arm = box();
  o.deformed = 1;
  const auto as_it_is = box();
  EXPECT_LT((turned_arm.first - as_it_is.first).norm() + (turned_arm.second - as_it_is.second).norm(), 1e-10);
  o.deformed = 100;
  // A stretch of 0.1 % along x about the arm's middle (3, ...) while it glides: enlarged to 10 %.
  write_moving_run(
      place, [](const Vec3& X, double t) { return Vec3(glide(X, t) + Vec3(1e-3 * t * (X.x() - 3), 0, 0)); }, 1);
  const auto stretched = box();
  EXPECT_NEAR(stretched.second.x() - stretched.first.x(), 2 * 1.1, 1e-9);
  EXPECT_NEAR(stretched.second.y() - stretched.first.y(), 0.5, 1e-9);
}

// In a mode of a mechanism parts move and deform by one amplitude: what enlarges one enlarges the other, or their joint is torn.
TEST(Deformed, of_a_mode_is_the_whole_shape) {
  const Workplace place;
  const std::string path = write_moving_run(
      place, [](const Vec3& X, double t) { return Vec3(X + 1e-7 * t * Vec3(X.x() - 2, 5, 0)); }, 1);
  {
    Store run = Store::open_growing(path);
    run.write<double>("/history/mode", std::vector<double>(110, 1.0), {11, 10});
    run.flush();
  }
  FrameOptions o;
  o.run = path, o.field = "displacement", o.show = {"arm"};
  const auto moved = [&](double factor) {  // the corner farthest along x and along y
    o.deformed = factor;
    RunView view(o, o.run);
    std::vector<Vec3> at;
    view.survey(1, Fit(View(), 1), at);
    Vec3 high = Vec3::Constant(-1e9);
    for (const Vec3& x : at) high = high.cwiseMax(x);
    return Vec3(high - Vec3(4, 0.5, 0.5));
  };
  const Vec3 once = moved(1), larger = moved(7);
  EXPECT_GT(once.x(), 1e-7);
  EXPECT_NEAR(once.y() / once.x(), 2.5, 1e-6);
  EXPECT_NEAR((larger - 7 * once).norm(), 0, 1e-9);
}

TEST(Marker, finds_the_pose_of_regions_sets_probes_sensors_and_points) {
  const Workplace place;
  RunFile run(write_moving_run(place, spin, 3));
  Playback playback(run);
  for (const double t : {0.0, 1.0, 3.0}) {
    const auto& x = playback.positions(t);
    const Pose arm = Marker(run, "arm", "--track").pose(t, x);
    EXPECT_LT((arm.R - turned(t)).norm(), 1e-12);
    EXPECT_LT((arm({2, 0, 0}) - spin({2, 0, 0}, t)).norm(), 1e-12);
    EXPECT_LT((arm.back(spin({3, 1, 2}, t)) - Vec3(3, 1, 2)).norm(), 1e-12);
    EXPECT_LT((Marker(run, "tip", "--track").pose(t, x).to - spin({4, 0.25, 0.25}, t)).norm(), 1e-12);
    EXPECT_LT((Marker(run, "end", "--track").pose(t, x).to - spin({4, 0.25, 0.25}, t)).norm(), 1e-12);
    EXPECT_LT((Marker(run, "eye", "--track").pose(t, x).to - spin({4, 0.25, 0.25}, t)).norm(), 1e-12);
    EXPECT_LT((Marker(run, "3.9,0.1,0.1", "--track").pose(t, x).to - spin({4, 0, 0}, t)).norm(), 1e-12);
  }
  // The way of the probe has a point for each of its rows, that of the set one for each output; both end where the point is.
  const auto fine = Marker(run, "end", "--trace").way(2.05, playback);
  ASSERT_EQ(fine.size(), 22u);
  EXPECT_LT((fine[7] - spin({4, 0.25, 0.25}, 0.7)).norm(), 1e-12);
  Marker tip(run, "tip", "--trace");
  ASSERT_EQ(tip.way(2, playback).size(), 3u);
  EXPECT_LT((tip.way(3, playback)[2] - spin({4, 0.25, 0.25}, 2)).norm(), 1e-12);
}

TEST(Forces, turn_with_the_frame_of_a_and_act_at_the_point_of_b) {
  const Workplace place;
  RunFile run(write_moving_run(place, spin, 3));
  Playback playback(run);
  const auto arrows = force_arrows(run, {"*"});
  ASSERT_EQ(arrows.size(), 2u);
  for (const double t : {0.0, 1.0, 3.0}) {
    const auto& x = playback.positions(t);
    // 5 N along the first axis of the joint frame, y at the start, carried by the arm; at its point on the base, which rests.
    EXPECT_LT((arrows[0].force(t, x) - 5 * turned(t).col(1)).norm(), 1e-11);
    EXPECT_LT((arrows[0].point(t, x) - Vec3(0.5, 0.5, 1)).norm(), 1e-12);
    EXPECT_LT((arrows[1].force(t, x) - Vec3(0, 0, -40)).norm(), 1e-12);
    EXPECT_LT((arrows[1].point(t, x) - spin({4, 0.25, 0.25}, t)).norm(), 1e-12);
  }
}

TEST(Forces, are_drawn_from_the_point_in_their_direction_with_a_scale) {
  const Workplace place;
  write_moving_run(
      place, [](const Vec3& X, double) { return X; }, 1);
  // From the right: x to the right, z up.  40 N downwards at the tip, an arrow of a fifth of the picture.
  ASSERT_EQ(place.run("hilo-post render run.h5 --camera right --forces pull --force-scale 20 --edges none -o f.png").exit, 0);
  const PictureFile p(place / "f.png");
  const auto is_arrow = [](const std::array<int, 3>& c) {
    return std::abs(c[0] - 13) < 12 && std::abs(c[1] - 92) < 12 && std::abs(c[2] - 92) < 12;
  };
  int best = 0, top = 0, bottom = 0, upright = 0;  // the column with most of it is its axis
  for (int x = 130; x < 1100; ++x) {
    int n = 0, first = 720, last = 0;
    for (int y = 80; y < 660; ++y)
      if (is_arrow(p.at(x, y))) ++n, first = std::min(first, y), last = std::max(last, y);
    if (n > best) best = n, top = first, bottom = last;
    upright += n > 100;
  }
  EXPECT_NEAR(bottom - top, 144, 4);  // pixels: two tenths of 720
  EXPECT_LT(upright, 8);              // no wider than its shaft
  EXPECT_GT(upright, 0);
  EXPECT_GT(p.ink(150, 680, 180, 690), 0.2);  // the scale
}

TEST(Bodies, without_a_mesh_fall_as_they_should_and_are_drawn) {
  const Workplace place;
  place.write("scene.toml", R"(
gravity = [0, 0, -10]
body = [{name = "ball", mass = 5, com = [1, 2, 3], inertia = [0.5, 0.4, 0.3]},
  {name = "stone", mass = 1, com = [0, 0, 0], inertia = [1e-3, 1e-3, 1e-3]}]
time = {end = 0.5, step = 0.01}
)");
  ASSERT_EQ(place.run("hilo-solve --quiet scene.toml -o run.h5").exit, 0);
  RunFile run(place / "run.h5");
  EXPECT_FALSE(run.has_mesh());
  run.stand_in_bodies();
  ASSERT_EQ(run.steps.size(), 51u);
  Playback playback(run);
  const auto& x = playback.positions(0.3);
  const Vec3 fall(0, 0, -10 * 0.3 * 0.3 / 2);  // exact for a mid-point method
  for (size_t n = 0; n < x.size(); ++n) EXPECT_LT((x[n] - run.mesh().X[n] - fall).norm(), 1e-12);
  EXPECT_LT((Marker(run, "ball", "--track").pose(0.3, x).to - Marker(run, "ball", "--track").reference() - fall).norm(), 1e-12);
  double far = 0;  // the ellipsoid of this inertia: J_x + J_y - J_z = 2/5 m r_z^2
  for (const Vec3& X : run.mesh().X) far = std::max(far, X.z() - 3);
  EXPECT_NEAR(far, std::sqrt(2.5 * (0.5 + 0.4 - 0.3) / 5), 1e-9);
  succeeded(place.run("hilo-post render run.h5 --field displacement --times 0.3 --size 320x180 -o b.png"));
  EXPECT_GT(PictureFile(place / "b.png").ink(20, 25, 260, 160), 0.02);
  const Ran movie = succeeded(place.run("hilo-post movie run.h5 --fps 5 --size 320x180 --speed 0.5 -o b.mp4"));
  EXPECT_NE(movie.err.find("warning: run.h5: bodies without a mesh have no stress: drawn by their names"), std::string::npos) << movie.err;
}

}  // namespace
}  // namespace hilo::test::follow_test
