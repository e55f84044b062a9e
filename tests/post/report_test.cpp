// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post injury as a user runs it: one truth in text, CSV and JSON, and pages that nothing runs out of.
#include <fmt/format.h>

#include <cmath>

#include "picture_file.hpp"
#include "post/files/csv.hpp"
#include "sample_run.hpp"
#include "succeeded.hpp"

namespace hilo::test::report_test {
namespace {

const Workplace& sample_place() {
  static const Workplace place;
  static const std::string run = sample::write_run(place.path(), sample::cube(2), 1, true, {2001, 5e-5});  // 20 kHz
  return place;
}

// The sample's seat feels a half sine of 100 g and 20 ms along x from 10 ms on.
TEST(InjuryReport, csv_and_json_hold_the_closed_forms_of_a_half_sine) {
  const auto& place = sample_place();
  const Ran ran = succeeded(place.run("hilo-post injury run.h5 --cfc 1000 --json -o injury.csv"));
  const CsvTable table = read_csv(place / "injury.csv");
  const auto value = [&](const std::string& key) { return table.numbers(table.find(key)).front(); };
  EXPECT_NEAR(value("peak_x"), 100, 0.5);
  EXPECT_NEAR(value("t_x"), 20, 0.1);
  EXPECT_NEAR(value("width_x"), 40.0 / 3, 0.1) << "two thirds of 20 ms";
  EXPECT_NEAR(value("HIC15"), 829.29, 8) << "its window is 13.4 ms; the rattle along y adds a little";
  EXPECT_NEAR(value("DRI"), 0, 1e-9) << "1 g upward all the time is no change";
  EXPECT_NE(ran.out.find("\"HIC15\": "), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("\"sensor\": \"seat\""), std::string::npos) << ran.out;
}

// A record of a sled: the same numbers as the run that it was written from, in g and seconds or in m/s^2 and ms.
TEST(InjuryReport, a_measured_signal_is_judged_as_that_of_a_run_is) {
  const auto& place = sample_place();
  ASSERT_EQ(place.run("hilo-post --quiet series run.h5 sensor.seat.x sensor.seat.y sensor.seat.z -o seat.csv").exit, 0);
  const CsvTable g = read_csv(place / "seat.csv");
  std::vector<std::vector<double>> columns;
  for (size_t c = 0; c < 4; ++c) {
    columns.push_back(g.numbers(c));
    for (double& x : columns.back()) x *= c == 0 ? 1e3 : 9.80665;
  }
  place.write("metric.csv", csv_text({"t [ms]", "x (m/s^2)", "y (m/s^2)", "z (m/s^2)"}, columns));
  const auto table = [&](const std::string& command) {
    succeeded(place.run("hilo-post --quiet " + command + " -o out.csv"));
    return read_csv(place / "out.csv");
  };
  for (const std::string command : {"injury", "gload"}) {
    const CsvTable run = table(command + " run.h5"), same = table(command + " seat.csv"), metric = table(command + " metric.csv");
    EXPECT_EQ(same.column, run.column) << command;
    ASSERT_EQ(metric.column.size(), run.column.size()) << command;
    for (size_t c = 1; c < run.column.size(); ++c) {
      const auto a = metric.numbers(c), b = run.numbers(c);
      for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-3 * std::max(1.0, std::abs(b[i]))) << run.header[c];
    }
  }
  const auto refused = [&](const std::string& csv) {
    place.write("odd.csv", csv);
    const Ran ran = place.run("hilo-post injury odd.csv");
    EXPECT_EQ(ran.exit, 2);
    return ran.err;
  };
  EXPECT_NE(refused("t [s],x\n0,1\n1,2\n").find("column \"x\" has no unit ([g] or [m/s^2])"), std::string::npos);
  EXPECT_NE(refused("t [s],head [g]\n0,1\n1,2\n").find("column \"head [g]\" is no axis of a sensor"), std::string::npos);
  EXPECT_NE(refused("t [s],x [g]\n1,1\n0,2\n").find("time does not rise in row 2"), std::string::npos);
}

TEST(InjuryReport, a_peak_that_an_end_of_the_record_makes_and_axes_without_a_column_are_told) {
  const auto& place = sample_place();
  const auto told = [&](double begin) {  // half sine of 100 g, 5 ms
    std::string csv = "t [s],z [g]\n";
    for (int i = 0; i <= 2000; ++i) {
      const double s = 1e-4 * i - begin;
      csv += fmt::format("{:.4f},{:.9g}\n", 1e-4 * i, s >= 0 && s <= 0.005 ? 100 * std::sin(M_PI * s / 0.005) : 0);
    }
    place.write("ends.csv", csv);
    return succeeded(place.run("hilo-post gload ends.csv")).err;
  };
  EXPECT_NE(told(-0.0025).find(" g at 0 s, lies near the start of the record"), std::string::npos);
  EXPECT_EQ(told(0.05).find("of the record"), std::string::npos);
  EXPECT_NE(told(0.05).find("sensor \"ends\": no column for x and y, taken as 0 g"), std::string::npos);
}

TEST(InjuryReport, tells_how_far_a_pulse_leaves_its_corridor) {
  const auto& place = sample_place();
  place.write("hole.csv", "t [s],x_low [g],x_high [g]\n0,-1,1\n0.01,,80\n");
  EXPECT_NE(place.run("hilo-post injury run.h5 --corridor hole.csv").err.find("x_low has an empty cell at t = 0.01"), std::string::npos);
  place.write("corridor.csv", "t [s],x_low [g],x_high [g]\n0,-1,1\n0.0199,-1,80\n0.0201,-1,80\n");  // over by the time of the peak
  succeeded(place.run("hilo-post --quiet injury run.h5 --cfc 1000 --corridor corridor.csv --png within.png -o out.csv"));
  const CsvTable table = read_csv(place / "out.csv");
  // half sine 100 sin(pi (t - 0.01)/0.02) over 1 + 79 t/0.0199: farthest at 17.2 ms
  double most = 0;
  for (double t = 0.01; t < 0.0199; t += 1e-6) most = std::max(most, 100 * std::sin(M_PI * (t - 0.01) / 0.02) - 1 - 79 * t / 0.0199);
  EXPECT_NEAR(table.numbers(table.find("outside_x")).front(), most, 0.5);
  // Truth: the same corridor in ms and m/s^2
  place.write("other.csv",
              fmt::format("t [ms],x_low [m/s^2],x_high [m/s^2]\n0,{0},{1}\n19.9,{0},{2}\n20.1,{0},{2}\n", -9.80665, 9.80665, 80 * 9.80665));
  succeeded(place.run("hilo-post --quiet injury run.h5 --cfc 1000 --corridor other.csv -o other_out.csv"));
  EXPECT_EQ(text_of(place / "other_out.csv"), text_of(place / "out.csv"));
  place.write("empty.csv", "t,a\n0,1\n1,2\n");
  expect_end(place.run("hilo-post injury run.h5 --corridor empty.csv"), 2,
             "empty.csv: column \"a\" is none of a corridor (it has t, x_low, x_high, y_low, y_high, z_low, z_high)");
}

// Truth: the half sine of 100 g has its peak at 20 ms; before 10 ms and after 30 ms it is nothing.
TEST(InjuryReport, tells_where_a_corridor_is_not) {
  const auto& place = sample_place();
  const auto outside = [&](const std::string& corridor, const std::string& key, const std::string& warning) {
    place.write("part.csv", corridor);
    const Ran ran = succeeded(place.run("hilo-post injury run.h5 --cfc 1000 --corridor part.csv -o part_out.csv"));
    EXPECT_EQ(ran.err.find("part.csv: ") != ran.err.npos, !warning.empty()) << ran.err;
    EXPECT_NE(ran.err.find(warning), ran.err.npos) << ran.err;
    const CsvTable table = read_csv(place / "part_out.csv");
    return table.numbers(table.find(key)).front();
  };
  EXPECT_NEAR(outside("t [s],x_low[g],x_high[g],z_low [g],z_high [g]\n0,-1,1,-1,1\n0.1,-1,1,-1,1\n", "outside_x", ""), 99, 0.5)
      << "no blank";
  const std::string told = "lies outside the corridor's 0.04 to 0.1 s: 40 % of the record is not compared";
  EXPECT_NEAR(outside("t,x_low,x_high\n0.04,-1,1\n0.1,-1,1\n", "outside_x", told), 0, 1e-9);
  EXPECT_TRUE(std::isnan(outside("t,x_low,x_high\n1,-1,1\n2,-1,1\n", "outside_x", "1 to 2 s: 100 % of the record is not compared")));
  EXPECT_NEAR(outside("t,x_low,x_high\n0.01,-1,101\n0.03,-1,101\n", "outside_x", ""), 0, 1e-9) << "the peak lies within";
}

// A comma in a name: what is written reads back, and no column moves.
TEST(InjuryReport, names_with_commas_stay_in_their_cells) {
  const auto& place = sample_place();
  std::string record = "t [s],\"seat, left.x [g]\",seat (right).x [g]\n";
  for (int i = 0; i <= 100; ++i) record += fmt::format("{},{},0\n", 1e-3 * i, i > 20 && i < 40 ? 10 : 0);
  place.write("comma.csv", record);
  succeeded(place.run("hilo-post --quiet injury comma.csv -o comma_injury.csv && hilo-post --quiet gload comma.csv -o comma_gload.csv"));
  const CsvTable injury = read_csv(place / "comma_injury.csv"), gload = read_csv(place / "comma_gload.csv");
  EXPECT_EQ(injury.column[0], (std::vector<std::string>{"seat, left", "seat (right)"}));
  EXPECT_EQ(gload.header[1], "seat, left.raw_x [g]");
  EXPECT_EQ(gload.numbers(1)[30], 10);
}

TEST(InjuryReport, page_has_the_ratio_of_A4_and_white_margins) {
  const auto& place = sample_place();
  succeeded(place.run("unset DISPLAY\nhilo-post injury run.h5 --png page.png --eiband eiband.png"));
  const PictureFile page(place / "page.png");
  EXPECT_NEAR(static_cast<double>(page.height) / page.width, std::sqrt(2), 1e-3);
  const int edge = page.width / 60;
  EXPECT_EQ(page.ink(0, 0, edge, page.height), 0);
  EXPECT_EQ(page.ink(page.width - edge, 0, page.width, page.height), 0);
  EXPECT_EQ(page.ink(0, page.height - edge, page.width, page.height), 0);
  EXPECT_GT(page.ink(0, page.height / 2, page.width, page.height), 0.02);
  EXPECT_GT(PictureFile(place / "eiband.png").ink(0, 0, 1280, 1600), 0.01);
}

}  // namespace
}  // namespace hilo::test::report_test
