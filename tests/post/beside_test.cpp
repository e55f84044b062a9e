// SPDX-License-Identifier: GPL-3.0-or-later
// Runs beside each other and less each other; a run between its outputs; the colours of values.
#include <cmath>

#include "base/error.hpp"
#include "model/store.hpp"
#include "picture_file.hpp"
#include "post/picture/colour.hpp"
#include "post/run/playback.hpp"
#include "post/scene/frames.hpp"
#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::beside_test {
namespace {

Ran post(const Workplace& where, const std::string& rest) { return where.run("unset DISPLAY\nhilo-post " + rest); }

TEST(Playback, follows_a_cubic_motion_exactly_and_fields_linearly) {
  const Workplace place;
  const Mesh mesh = sample::cube(1);
  write_mesh(place / "mesh.h5", mesh, {"test"});
  const auto x = [](const Vec3& X, double t) { return Vec3(X.x() + t * t * t - 2 * t, X.y() * (1 + t * t), X.z() - 0.3 * t * t * t + 1); };
  const auto v = [](const Vec3& X, double t) { return Vec3(3 * t * t - 2, 2 * t * X.y(), -0.9 * t * t); };
  {
    Store run = Store::create_growing(place / "run.h5");
    run.set("/", "format", "hilo run");
    run.link("/mesh", place / "mesh.h5", "/mesh");
    const double times[] = {0, 0.5, 2};
    for (int k = 0; k < 3; ++k) {
      const std::string group = "/field/00000" + std::to_string(k);
      std::vector<double> u, w, s;
      for (const Vec3& X : mesh.X) {
        const Vec3 d = x(X, times[k]) - X, rate = v(X, times[k]);
        u.insert(u.end(), {d.x(), d.y(), d.z()}), w.insert(w.end(), {rate.x(), rate.y(), rate.z()}), s.push_back(10 * times[k] + X.x());
      }
      run.write<double>(group + "/displacement", u, {8, 3}), run.write<double>(group + "/velocity", w, {8, 3});
      run.write<double>(group + "/von_mises", s, {8});
      run.set(group, "t", times[k]);
    }
    run.flush();
  }
  RunFile run(place / "run.h5");
  Playback playback(run);
  for (const double t : {0.0, 0.2, 0.5, 0.9, 1.7, 2.0}) {
    const auto at = playback.positions(t);
    for (size_t n = 0; n < at.size(); ++n) EXPECT_LT((at[n] - x(mesh.X[n], t)).norm(), 1e-13) << t;
    EXPECT_NEAR(playback.field(t, "von_mises").value[1], 10 * t + mesh.X[1].x(), 1e-12);
  }
  EXPECT_THROW(playback.positions(2.1), Error);
}

TEST(Minus, a_run_less_itself_is_zero_and_less_another_is_their_difference) {
  const Workplace a, b;
  const Mesh mesh = sample::machine();
  sample::write_run(a.path(), mesh, 4);
  sample::write_run(b.path(), mesh, 2);  // other outputs: its values rise linearly with time as well
  FrameOptions o;
  o.run = a / "run.h5", o.minus = a / "run.h5";
  std::vector<Vec3> extremes;
  RunView same(o, o.run);
  const Extent none = same.survey(0.06, Fit(View(), 1), extremes);
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 0);
  o.minus = b / "run.h5";
  RunView other(o, o.run);
  const Extent little = other.survey(0.06, Fit(View(), 1), extremes);
  EXPECT_LT(std::max(std::abs(little.low), std::abs(little.high)), 1e-6);  // of 2e8 Pa
  o.field = "velocity.x";                                                  // -0.5 m/s in both
  EXPECT_EQ(RunView(o, o.run).survey(0.06, Fit(View(), 1), extremes).high, 0);
}

TEST(Minus, another_mesh_is_refused) {
  const Workplace place;
  sample::write_run(place.path(), sample::cube(2), 1);
  ASSERT_EQ(place.run("mkdir other && mv run.h5 mesh.h5 other/").exit, 0);
  sample::write_run(place.path(), sample::cube(3), 1);
  expect_end(post(place, "render run.h5 --minus other/run.h5 -o x.png"), 2, "other/run.h5: 27 nodes and 8 cells, but run.h5 has 64 and 27");
  EXPECT_EQ(post(place, "render run.h5 --minus other/run.h5 --field region -o x.png").exit, 1);
  EXPECT_EQ(post(place, "render run.h5 --minus run.h5 -o zero.png").exit, 0);
}

TEST(Beside, a_run_beside_itself_is_the_same_picture_twice) {
  const Workplace place;
  sample::write_run(place.path(), sample::machine(), 2);
  // Seen from the front the model is narrow: two in a row.
  const Ran ran = post(place, "render run.h5 --beside run.h5 --camera front --label left --label right -o both.png");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const PictureFile p(place / "both.png");
  // Columns that hold the model, in two stretches.
  std::vector<std::pair<int, int>> stretches;
  const auto inked = [&](int x) {
    for (int y = 110; y < 600; ++y)
      if (p.at(x, y) != std::array{255, 255, 255}) return true;
    return false;
  };
  for (int x = 0; x < 1095; ++x)
    if (inked(x)) {
      if (stretches.empty() || stretches.back().second < x - 1) stretches.emplace_back(x, x);
      stretches.back().second = x;
    }
  ASSERT_EQ(stretches.size(), 2u);
  ASSERT_EQ(stretches[0].second - stretches[0].first, stretches[1].second - stretches[1].first);
  const int width = stretches[0].second - stretches[0].first + 1, shift = stretches[1].first - stretches[0].first;
  EXPECT_GT(width, 150);
  int differing = 0;
  for (int y = 110; y < 600; ++y)
    for (int x = stretches[0].first; x <= stretches[0].second; ++x) differing += p.at(x, y) != p.at(x + shift, y);
  EXPECT_LT(differing, 20);  // of more than 150 x 490: an edge on the border of a pixel
}

TEST(Beside, runs_are_named_by_what_tells_them_apart) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(distinct_names({"out/soft.h5", "out/stiff.h5"}), (Names{"soft", "stiff"}));
  EXPECT_EQ(distinct_names({"out/soft/run.h5", "out/stiff/run.h5"}), (Names{"soft", "stiff"}));
  EXPECT_EQ(distinct_names({"a/soft/run.h5", "b/soft/run.h5"}), (Names{"a/soft", "b/soft"}));
  EXPECT_EQ(distinct_names({"run.h5", "run.h5"}), (Names{"run", "run"}));
}

TEST(Beside, a_run_that_does_not_reach_the_instant_is_named) {
  const Workplace place;
  sample::write_run(place.path(), sample::cube(2), 2, true, {21, 5e-4});  // to 0.01 s
  ASSERT_EQ(place.run("mkdir short && mv run.h5 mesh.h5 short/").exit, 0);
  sample::write_run(place.path(), sample::cube(2), 2);
  expect_end(post(place, "render run.h5 --beside short/run.h5 -o x.png"), 2,
             "short/run.h5: no output around t = 0.1 s (there are 0 to 0.01 s)");
  EXPECT_EQ(post(place, "render run.h5 --beside short/run.h5 --label a --label b --label c -o x.png").exit, 1);
}

/// Colours as seen without the green-sensitive or the red-sensitive cones, in linear light [vienot-1999].
Vec3 without_cones(const Rgb& c, bool green) {
  const auto linear = [](double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
  const Vec3 rgb(linear(c.r), linear(c.g), linear(c.b));
  Mat3 m;
  if (green)
    m << 0.29275, 0.70725, 0, 0.29275, 0.70725, 0, -0.02234, 0.02234, 1;
  else
    m << 0.11238, 0.88762, 0, 0.11238, 0.88762, 0, 0.00401, -0.00401, 1;
  return m * rgb;
}

TEST(Colours, of_the_default_and_cividis_keep_their_order_in_grey_print) {
  for (const ColourMap map : {ColourMap::viridis, ColourMap::cividis}) {
    double before = -1;
    for (int i = 0; i <= 256; ++i) {
      const double y = luminance(map_colour(map, i / 256.0));
      EXPECT_GT(y, before) << i;
      before = y;
    }
    EXPECT_GT(before - luminance(map_colour(map, 0)), 0.6);
  }
}

TEST(Colours, that_diverge_fall_evenly_from_white_and_tell_signs_apart_without_red_or_green) {
  EXPECT_GT(luminance(map_colour(ColourMap::diverging, 0.5)), 0.85);
  for (int i = 1; i <= 128; ++i) {
    const double s = 0.5 * i / 128;
    const Rgb low = map_colour(ColourMap::diverging, 0.5 - s), high = map_colour(ColourMap::diverging, 0.5 + s);
    const double inner = 0.5 * (i - 1) / 128;
    EXPECT_LT(luminance(low), luminance(map_colour(ColourMap::diverging, 0.5 - inner))) << i;
    EXPECT_LT(luminance(high), luminance(map_colour(ColourMap::diverging, 0.5 + inner))) << i;
    EXPECT_NEAR(std::cbrt(luminance(low)), std::cbrt(luminance(high)), 0.06) << i;  // the same grey: neither sign looks larger
    if (s < 0.1) continue;
    for (const bool green : {true, false}) {  // blue stays blue and orange yellow: the sign of blue less yellow
      const Vec3 a = without_cones(low, green), b = without_cones(high, green);
      EXPECT_GT(a.z() - a.x(), 0.03) << i;
      EXPECT_LT(b.z() - b.x(), -0.03) << i;
    }
  }
}

}  // namespace
}  // namespace hilo::test::beside_test
