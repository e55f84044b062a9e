// SPDX-License-Identifier: GPL-3.0-or-later
// Tables through the command line: what is written is what was stored.
#include <algorithm>
#include <cmath>

#include "model/store.hpp"
#include "picture_file.hpp"
#include "post/files/csv.hpp"
#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::series_test {
namespace {

const Workplace& sample_place() {
  static const Workplace place;
  static const std::string run = sample::write_run(place.path(), sample::cube(2), 1);
  return place;
}

Ran post(const Workplace& place, const std::string& rest) { return place.run("unset DISPLAY\nhilo-post " + rest); }

TEST(Series, csv_holds_the_very_numbers_that_were_stored) {
  const auto& place = sample_place();
  const Ran ran = post(place, "series run.h5 joint.trunnion energy -o out.csv");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const CsvTable table = read_csv(place / "out.csv");
  const Store store = Store::open(place / "run.h5");
  const auto t = store.read<double>("/history/t"), energy = store.read<double>("/history/energy"),
             joint = store.read<double>("/history/joint/trunnion");
  ASSERT_EQ(table.header.size(), 13u);
  EXPECT_EQ(table.header[0], "t [s]");
  EXPECT_EQ(table.numbers(0), t);
  const auto column = [&](const std::string& name) { return table.numbers(table.find(name)); };
  const auto fx = column("joint.trunnion.Fx [N]"), my = column("joint.trunnion.My [N m]"), balance = column("energy.balance [J]");
  for (size_t i = 0; i < t.size(); ++i) {
    EXPECT_EQ(fx[i], joint[6 * i]);
    EXPECT_EQ(my[i], joint[6 * i + 4]);
    EXPECT_EQ(balance[i], energy[6 * i + 5]);
  }
}

TEST(Series, takes_single_columns_and_globs_and_writes_to_stdout) {
  const Ran ran = post(sample_place(), "series run.h5 sensor.seat.x 'joint.*.Fz'");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.out.substr(0, ran.out.find('\n')), "t [s],sensor.seat.x [g],joint.trunnion.Fz [N]");
  EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), '\n'), 202);
}

TEST(Series, resultants_of_forces_and_moments) {
  const auto& place = sample_place();
  ASSERT_EQ(post(place, "series run.h5 joint.trunnion.F 'joint.*.M' 'half [N] = joint.trunnion.F/2' -o r.csv").exit, 0);
  const CsvTable table = read_csv(place / "r.csv");
  const auto joint = Store::open(place / "run.h5").read<double>("/history/joint/trunnion");
  const auto F = table.numbers(table.find("joint.trunnion.F [N]")), M = table.numbers(table.find("joint.trunnion.M [N m]")),
             half = table.numbers(table.find("half [N]"));
  ASSERT_EQ(6 * F.size(), joint.size());
  for (size_t i = 0; i < F.size(); ++i) {
    const double* f = joint.data() + 6 * i;
    EXPECT_NEAR(F[i] * F[i], f[0] * f[0] + f[1] * f[1] + f[2] * f[2], 1e-12 * F[i] * F[i]);
    EXPECT_NEAR(M[i] * M[i], f[3] * f[3] + f[4] * f[4] + f[5] * f[5], 1e-12 * M[i] * M[i]);
    EXPECT_EQ(half[i], F[i] / 2);
  }
}

TEST(Series, lists_what_there_is) {
  const Ran ran = post(sample_place(), "series run.h5 --list");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  for (const char* name : {"energy", "joint.trunnion", "probe.muzzle", "sensor.seat"})
    EXPECT_NE(ran.out.find(name), std::string::npos) << ran.out;
}

TEST(Series, an_unknown_name_is_an_error_with_the_nearest_one) {
  const Ran ran = post(sample_place(), "series run.h5 joint.trunion");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_EQ(ran.err, "hilo-post: run.h5: no history \"joint.trunion\" (did you mean \"joint.trunnion\"?)\n");
  EXPECT_EQ(ran.out, "");
}

TEST(Series, a_group_is_an_error_with_the_histories_in_it) {
  EXPECT_EQ(post(sample_place(), "series run.h5 joint").err,
            "hilo-post: run.h5: no history \"joint\" (\"joint.*\" for all of: joint.trunnion)\n");
  EXPECT_EQ(post(sample_place(), "series run.h5 energy --times 0:0").err,
            "hilo-post: --times: \"0:0\" is no span of time (its two ends are one instant: TO comes after FROM)\n");
}

TEST(Series, a_chart_has_curves_on_white) {
  const auto& place = sample_place();
  ASSERT_EQ(post(place, "series run.h5 joint.trunnion --png joint.png").exit, 0);
  const PictureFile picture(place / "joint.png");
  EXPECT_EQ(picture.at(2, 2), (std::array{255, 255, 255}));
  EXPECT_GT(picture.ink(80, 60, 1190, 320), 0.005);   // upper panel: forces
  EXPECT_GT(picture.ink(80, 390, 1190, 650), 0.005);  // lower panel: moments
  EXPECT_LT(picture.ink(80, 60, 1190, 320), 0.5);
}

TEST(Gload, table_has_the_peaks_and_the_clip_of_the_stored_pulse) {
  const auto& place = sample_place();
  const Ran ran = post(place, "gload run.h5 --cfc 180 -o g.csv --png g.png --quiet --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.out.find("\"sensor\": \"seat\", \"raw_x\": 100.000"), std::string::npos) << ran.out;
  const CsvTable table = read_csv(place / "g.csv");
  ASSERT_EQ(table.header.size(), 9u);
  EXPECT_EQ(table.header[1], "seat.raw_x [g]");
  EXPECT_EQ(table.header[8], "seat.cfc180_resultant [g]");
  const auto t = table.numbers(0), raw = table.numbers(1), filtered = table.numbers(5), rattle = table.numbers(6), z = table.numbers(7);
  double top = 0, loudest = 0;
  for (size_t i = 0; i < t.size(); ++i) {
    EXPECT_NEAR(raw[i], sample::seat(t[i]).x(), 1e-12);
    EXPECT_NEAR(z[i], 1, 1e-9);  // 1 g at rest passes unchanged
    top = std::max(top, filtered[i]);
    if (i > 50 && i < 150) loudest = std::max(loudest, std::abs(rattle[i]));
  }
  EXPECT_NEAR(top, 100, 0.1);  // a 20 ms pulse lies well below 300 Hz
  // 400 Hz through CFC 180 twice at 2 kHz: |H|^2 = 1/(1 + (tan(w T/2)/w_a)^4), with the samples at sin(36 deg k) up to 4.755 of 5 g.
  const double T = 5e-4, ratio = std::tan(M_PI * 400 * T) / std::tan(M_PI * 180 * 2.0775 * T), gain = 1 / (1 + std::pow(ratio, 4));
  EXPECT_NEAR(loudest, gain * 5 * std::sin(2 * M_PI / 5), 0.01);
  EXPECT_GT(PictureFile(place / "g.png").ink(80, 80, 1070, 650), 0.01);
}

TEST(Gload, refuses_a_class_the_record_cannot_hold) {
  const Ran ran = post(sample_place(), "gload run.h5 --cfc 600");
  expect_end(ran, 2, "sensor \"seat\": sampled every 0.0005 s, too seldom for CFC 600");
  EXPECT_EQ(ran.out, "");
}

TEST(Gload, an_unknown_sensor_is_an_error_with_the_nearest_one) {
  expect_end(post(sample_place(), "gload run.h5 --sensor sest"), 2, "no sensor \"sest\" (did you mean \"seat\"?)");
}

}  // namespace
}  // namespace hilo::test::series_test
