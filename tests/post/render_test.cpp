// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures through the command line, with DISPLAY unset, read back pixel by pixel.
#include "picture_file.hpp"
#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::render_test {
namespace {

/// A run in a folder, made once for all tests here.
const Workplace& sample_place() {
  static const Workplace place;
  static const std::string run = sample::write_run(place.path(), sample::machine(), 4);
  return place;
}

Ran post(const Workplace& place, const std::string& rest) { return place.run("unset DISPLAY\nhilo-post " + rest); }

bool yellow(const std::array<int, 3>& c) { return c[0] > 150 && c[1] > 120 && c[2] < 90; }
bool blue_or_violet(const std::array<int, 3>& c) { return c[2] > c[0] + 10 && c[2] > c[1] - 20; }

TEST(Render, without_a_display_draws_the_model_the_colour_bar_and_the_title) {
  const auto& place = sample_place();
  const Ran ran = post(place, "render run.h5 -o stress.png");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.out, "stress.png\n");
  EXPECT_EQ(ran.err, "");
  const PictureFile picture(place / "stress.png");
  ASSERT_EQ(picture.width, 1280);
  ASSERT_EQ(picture.height, 720);
  EXPECT_GT(picture.ink(20, 80, 1090, 700), 0.2);  // the model
  EXPECT_GT(picture.ink(20, 10, 400, 40), 0.05);   // the title
  EXPECT_TRUE(yellow(picture.at(1126, 160)));      // the colour bar from yellow ...
  const auto low = picture.at(1126, 610);          // ... to dark violet
  EXPECT_LT(low[0] + low[1] + low[2], 260);
  EXPECT_GT(low[2], low[1] + 30);
  EXPECT_EQ(picture.at(3, 300), (std::array{255, 255, 255}));  // white paper
}

TEST(Render, paints_the_hot_end_hot_the_cold_end_cold_and_rigid_regions_neutral) {
  const auto& place = sample_place();
  ASSERT_EQ(post(place, "render run.h5 --camera right --edges none -o side.png").exit, 0);
  const PictureFile picture(place / "side.png");
  // From the right, x grows to the right: the muzzle is the rightmost drawn column of the model, the breech the left end of the barrel.
  int right = 1090, row = 0;
  for (; right > 0 && row == 0; --right)
    for (int y = 80; y < 700 && row == 0; ++y)
      if (picture.at(right, y) != std::array{255, 255, 255}) row = y;
  EXPECT_TRUE(yellow(picture.at(right - 6, row + 20))) << right << " " << row;
  int neutral = 0, cold = 0, black = 0;
  for (int y = 80; y < 700; ++y)
    for (int x = 20; x < 1090; ++x) {
      const auto c = picture.at(x, y);
      neutral += std::abs(c[0] - c[1]) < 8 && std::abs(c[1] - c[2]) < 8 && c[0] > 100 && c[0] < 235;
      cold += blue_or_violet(c);
      black += c[0] + c[1] + c[2] < 60;
    }
  EXPECT_GT(neutral, 50000);  // the hull
  EXPECT_GT(cold, 2000);      // foot and support
  EXPECT_LT(black, 50);       // no black faces
}

TEST(Render, gives_the_same_bytes_twice) {
  const auto& place = sample_place();
  ASSERT_EQ(post(place, "render run.h5 --field acceleration --edges all -o one.png").exit, 0);
  ASSERT_EQ(post(place, "render run.h5 --field acceleration --edges all -o two.png").exit, 0);
  EXPECT_EQ(text_of(place / "one.png"), text_of(place / "two.png"));
}

TEST(Render, a_frame_of_a_series_has_the_range_of_the_series) {
  const auto& place = sample_place();
  const Ran ran = post(place, "render run.h5 --steps all --camera right -o frames/f");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.out, "frames/f-000000.png\nframes/f-000001.png\nframes/f-000002.png\nframes/f-000003.png\nframes/f-000004.png\n");
  // At the start nothing is stressed: nothing is yellow, though the colour bar is.
  const PictureFile start(place / "frames/f-000000.png"), end(place / "frames/f-000004.png");
  int yellow_at_start = 0, yellow_at_end = 0;
  for (int y = 80; y < 700; ++y)
    for (int x = 20; x < 1090; ++x) yellow_at_start += yellow(start.at(x, y)), yellow_at_end += yellow(end.at(x, y));
  EXPECT_EQ(yellow_at_start, 0);
  EXPECT_GT(yellow_at_end, 1000);
  EXPECT_EQ(start.at(1126, 160), end.at(1126, 160));
}

TEST(Render, a_frame_does_not_depend_on_the_frames_before_it) {
  const auto& place = sample_place();
  ASSERT_EQ(post(place, "render run.h5 --steps 1,2,3 --range 0,200 --zoom '*' -o alone/f").exit, 0);
  ASSERT_EQ(post(place, "render run.h5 --steps 3,2,1 --range 0,200 --zoom '*' -o other/f").exit, 0);
  EXPECT_EQ(text_of(place / "alone/f-000002.png"), text_of(place / "other/f-000002.png"));
}

TEST(Render, names_get_colours_and_a_legend) {
  const auto& place = sample_place();
  for (const char* field : {"region", "fidelity", "partition"}) {
    const Ran ran = post(place, std::string("render run.h5 --field ") + field + " --edges none -o names.png");
    ASSERT_EQ(ran.exit, 0) << ran.err;
    const PictureFile picture(place / "names.png");
    EXPECT_GT(picture.ink(20, 80, 1020, 700), 0.2) << field;
    EXPECT_GT(picture.ink(1040, 75, 1265, 230), 0.05) << field;
  }
}

TEST(Render, hidden_regions_are_not_drawn_and_zoom_fills_the_picture) {
  const auto& place = sample_place();
  ASSERT_EQ(post(place, "render run.h5 --field displacement --show barrel -o barrel.png").exit, 0);
  ASSERT_EQ(post(place, "render run.h5 --field displacement --hide hull --hide foot --hide strut --hide support -o same.png").exit, 0);
  EXPECT_EQ(text_of(place / "barrel.png"), text_of(place / "same.png"));
  ASSERT_EQ(post(place, "render run.h5 --field displacement --zoom support -o zoom.png").exit, 0);
  EXPECT_GT(PictureFile(place / "zoom.png").ink(20, 80, 1090, 700), PictureFile(place / "barrel.png").ink(20, 80, 1090, 700));
}

TEST(Render, a_run_in_progress_can_be_drawn) {
  const Workplace place;
  sample::write_run(place.path(), sample::cube(2), 2, false);
  const Ran ran = post(place, "render run.h5 --size 640x360 -o now.png");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(PictureFile(place / "now.png").width, 640);
}

struct Fault {
  const char *command, *text;
  int exit;
};

TEST(Render, wrong_input_is_named_in_one_line_and_leaves_nothing) {
  const auto& place = sample_place();
  const auto before = place.files();
  for (const Fault& f :
       {Fault{"run.h5 --field von_misess", "no field \"von_misess\" (did you mean \"von_mises\"?)", 2},
        Fault{"run.h5 --field stress.xx", "no field \"stress\" in step 000004", 2},
        Fault{"run.h5 --show barel", "no region \"barel\" (did you mean \"barrel\"?)", 2},
        Fault{"run.h5 --show hull", "all regions shown are rigid", 2}, Fault{"run.h5 --steps 40", "no step 40 (there are 0 to 4)", 2},
        Fault{"run.h5 --times 5", "no output near t = 5 s (there are 0 to 0.1 s)", 2},
        Fault{"run.h5 --camera isoo", "no view \"isoo\" (did you mean \"iso\"?)", 1}, Fault{"run.h5 --size 12", "is no picture size", 1},
        Fault{"run.h5 --range 5,1", "is no range", 1}, Fault{"run.h5 --unit MPa --field velocity", "choose one of", 1},
        Fault{"mesh.h5", "not a run", 2}, Fault{"none.h5", "no such file", 2}}) {
    const Ran ran = post(place, std::string("render ") + f.command + " -o wrong.png");
    EXPECT_EQ(ran.exit, f.exit) << f.command;
    EXPECT_NE(ran.err.find(f.text), std::string::npos) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
  EXPECT_EQ(place.files(), before);
}

TEST(Render, without_EGL_says_what_to_install_and_exits_with_4) {
  const auto& place = sample_place();
  expect_end(place.run("__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere hilo-post render run.h5 -o none.png"), 4, "cannot draw without a display");
  EXPECT_EQ(place.files().count("none.png"), 0u);
}

TEST(Render, a_mesh_that_has_gone_is_named) {
  const Workplace place;
  sample::write_run(place.path(), sample::cube(2), 1);
  std::filesystem::remove(place / "mesh.h5");
  expect_end(post(place, "render run.h5 -o x.png"), 2, "mesh.h5, is missing");
}

}  // namespace
}  // namespace hilo::test::render_test
