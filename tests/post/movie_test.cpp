// SPDX-License-Identifier: GPL-3.0-or-later
// Movies: what their header says, what their pictures show, and that a failure leaves nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "cli.hpp"
#include "movie_file_reader.hpp"
#include "picture_file.hpp"
#include "post/picture/workers.hpp"
#include "sample_run.hpp"

namespace hilo::test::movie_test {
namespace {

const Workplace& place() {  // outputs at 0, 25, 50, 75, 100 ms
  static const Workplace folder;
  static const std::string run = sample::write_run(folder.path(), sample::machine(), 4);
  return folder;
}

Ran post(const Workplace& where, const std::string& rest) { return where.run("unset DISPLAY\nhilo-post " + rest); }

TEST(Movie, has_the_frames_the_duration_and_the_even_size_that_were_asked_for) {
  const Ran ran = post(place(), "movie run.h5 --fps 20 --speed 0.05 --times 0.01:0.06 --size 321x201 -o movie.mp4");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.out, "movie.mp4: 21 frames, 1.1 s, 0.01 to 0.06 s of the run, slowed 20 times\n");
  const MovieHeader h = movie_header(text_of(place() / "movie.mp4"));
  EXPECT_EQ(h.codec, "avc1");
  EXPECT_EQ(h.frames, 21u);  // 0.05 s / 0.05 x 20 and the first
  EXPECT_NEAR(h.duration, 21 / 20.0, 1e-3);
  EXPECT_EQ(h.width, 322);
  EXPECT_EQ(h.height, 202);
  ASSERT_GE(h.top.size(), 3u);
  EXPECT_EQ(h.top[0], "ftyp");
  EXPECT_EQ(h.top[1], "moov");  // before the pictures: a browser starts at once
}

TEST(Movie, of_the_outputs_shows_what_render_draws) {
  const Ran ran = post(place(), "movie run.h5 --outputs --size 640x360 --range 0,200 -o outputs.mp4");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  ASSERT_EQ(post(place(), "render run.h5 --steps all --size 640x360 --range 0,200 -o still").exit, 0);
  const auto frames = decoded(place() / "outputs.mp4");
  ASSERT_EQ(frames.size(), 5u);
  for (size_t k = 0; k < frames.size(); ++k) {
    const PictureFile still(place() / ("still-00000" + std::to_string(k) + ".png"));
    double sum = 0;
    for (int y = 0; y < 360; ++y)
      for (int x = 0; x < 640; ++x)
        for (size_t c = 0; c < 3; ++c) sum += std::abs(frames[k].at(x, y)[c] - still.at(x, y)[c]);
    EXPECT_LT(sum / (3 * 640 * 360), 2.0) << "frame " << k;  // of 255: what H.264 and 4:2:0 leave of it
    EXPECT_NEAR(frames[k].t, static_cast<double>(k) / 25, 1e-6);
  }
}

TEST(Movie, by_default_lasts_about_ten_seconds_and_says_its_speed) {
  const Ran ran = post(place(), "movie run.h5 --fps 2 --size 160x120 -o default.mp4");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.out.find("10.5 s, 0 to 0.1 s of the run, slowed 100 times"), std::string::npos) << ran.out;
}

TEST(Movie, does_not_depend_on_the_number_of_processes) {
  ASSERT_EQ(post(place(), "movie run.h5 --outputs --size 320x180 --jobs 1 -o one.mp4").exit, 0);
  ASSERT_EQ(post(place(), "movie run.h5 --outputs --size 320x180 --jobs 3 -o three.mp4").exit, 0);
  EXPECT_EQ(text_of(place() / "one.mp4"), text_of(place() / "three.mp4"));
  ASSERT_EQ(post(place(), "render run.h5 --steps all --jobs 1 --size 320x180 -o jobs1").exit, 0);
  ASSERT_EQ(post(place(), "render run.h5 --steps all --jobs 2 --size 320x180 -o jobs2").exit, 0);
  for (const char* k : {"0", "1", "2", "3", "4"})
    EXPECT_EQ(text_of(place() / ("jobs1-00000" + std::string(k) + ".png")), text_of(place() / ("jobs2-00000" + std::string(k) + ".png")));
}

TEST(Movie, that_fails_or_is_stopped_leaves_nothing) {
  const Workplace own;
  sample::write_run(own.path(), sample::machine(), 4);
  const auto before = own.files();
  struct Fault {
    const char *rest, *text;
    int exit;
  };
  for (const Fault& f :
       {Fault{"--times 0.2:0.3", "0.2:0.3 is not within the run (there is 0:0.1)", 2}, Fault{"--times 5", "is no span of time", 1},
        Fault{"--speed 1e-9", "frames", 1}, Fault{"--speed 0", "--speed: 0 is not above 0", 1},
        Fault{"--speed 1 --outputs", "--speed excludes --outputs", 1}, Fault{"--field von_misess", "did you mean \"von_mises\"?", 2}}) {
    const Ran ran = post(own, std::string("movie run.h5 ") + f.rest + " -o wrong.mp4");
    EXPECT_EQ(ran.exit, f.exit) << f.rest << ran.err;
    EXPECT_NE(ran.err.find(f.text), std::string::npos) << ran.err;
  }
  const Workplace still;
  sample::write_run(still.path(), sample::cube(1), 1, true, {1, 5e-4});  // ends where it starts
  EXPECT_NE(post(still, "movie run.h5 -o run.mp4").err.find("run.h5: has a single output: nothing moves"), std::string::npos);
  EXPECT_NE(post(own, "movie run.h5 -o run.avi").err.find("run.avi: movies are MP4"), std::string::npos);
  const Ran killed = own.run("timeout -s TERM 1 hilo-post movie run.h5 --speed 1e-4 -o stopped.mp4");
  EXPECT_NE(killed.exit, 0);
  EXPECT_EQ(own.files(), before);
  EXPECT_EQ(own.run("sleep 0.5; pgrep -f '[s]topped.mp4'").out, "");  // nor a process
}

TEST(Workers, give_their_results_in_order_and_their_errors_as_they_were) {
  std::string all;
  const auto start = [] { return [pid = ::getpid()](size_t k) { return std::to_string(k * k) + (pid == ::getpid() ? " " : "?"); }; };
  in_processes(7, 3, start, [&](size_t, const std::string& r) { all += r; });
  EXPECT_EQ(all, "0 1 4 9 16 25 36 ");
  const auto failing = [] {
    return [](size_t k) -> std::string {
      if (k == 2) throw Error("file:3", "what", "hint", Exit::not_converged);
      return "fine";
    };
  };
  size_t taken = 0;
  try {
    in_processes(5, 2, failing, [&](size_t, const std::string&) { ++taken; });
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.where, "file:3");
    EXPECT_EQ(e.message, "what");
    EXPECT_EQ(e.hint, "hint");
    EXPECT_EQ(e.exit, Exit::not_converged);
  }
  EXPECT_EQ(taken, 2u);
  const auto dying = [] { return [](size_t) -> std::string { std::abort(); }; };
  EXPECT_THROW(in_processes(2, 2, dying, [](size_t, const std::string&) {}), Error);
}

}  // namespace
}  // namespace hilo::test::movie_test
