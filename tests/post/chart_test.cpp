// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "base/error.hpp"
#include "picture_file.hpp"
#include "post/charts/ticks.hpp"
#include "post/files/csv.hpp"
#include "post/scene/names.hpp"
#include "succeeded.hpp"

namespace hilo::test::chart_test {
namespace {

TEST(Ticks, are_round_inside_the_range_and_near_the_wanted_number) {
  for (const auto& [low, high] : {std::pair{0.0, 1.0}, {-3.7, 12.2}, {0.0, 231.4}, {1e-4, 7e-4}, {99.0, 101.0}}) {
    const Ticks ticks = linear_ticks(low, high, 6);
    ASSERT_GE(ticks.at.size(), 3u);
    ASSERT_LE(ticks.at.size(), 8u);
    for (size_t i = 0; i < ticks.at.size(); ++i) {
      EXPECT_GE(ticks.at[i], low - 1e-12);
      EXPECT_LE(ticks.at[i], high + 1e-12);
      EXPECT_NEAR(std::stod(ticks.text[i]), ticks.at[i], 1e-9 * (high - low));  // the text is the place
    }
  }
}

TEST(Ticks, of_a_logarithmic_axis_are_powers_of_ten) {
  const Ticks ticks = log_ticks(3e-6, 2e3, 10);
  EXPECT_EQ(ticks.text.front(), "10^-5");
  EXPECT_EQ(ticks.text.back(), "10^3");
}

TEST(Units, are_chosen_by_the_largest_value) {
  EXPECT_EQ(handy_unit("Pa", 2.3e8).name, "MPa");
  EXPECT_EQ(handy_unit("Pa", 4e4).name, "kPa");
  EXPECT_EQ(handy_unit("m", 0.004).name, "mm");
  EXPECT_EQ(handy_unit("m/s^2", 1e4).name, "m/s^2");
  EXPECT_NEAR(9.80665 * wanted_unit("m/s^2", "g").factor, 1, 1e-15);
  EXPECT_THROW(wanted_unit("Pa", "mm"), Error);
}

TEST(Names, that_differ_in_numbers_and_sides_are_one_group_when_there_are_many) {
  std::vector<std::string> names{"hull"};
  for (const char* side : {"l", "r"})
    for (int i = 1; i <= 8; ++i) names.push_back("wheel_" + std::string(side) + std::to_string(i));
  const auto groups = grouped(names);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[1].members.size(), 16u);
  EXPECT_EQ(grouped({"wheel_1", "wheel_2"}).size(), 2u);
}

TEST(Csv, reads_quotes_units_and_comments) {
  const Workplace place;
  place.write("a.csv", "# made by hand\nt [s],\"force, axial [N]\",name\n0,1.5,a\n1,,\"b \"\"c\"\"\"\n");
  const CsvTable table = read_csv(place / "a.csv");
  EXPECT_EQ(table.header[1], "force, axial [N]");
  EXPECT_EQ(table.find("t"), 0u);
  EXPECT_EQ(table.find("3"), 2u);
  EXPECT_EQ(table.column[2][1], "b \"c\"");
  EXPECT_TRUE(std::isnan(table.numbers(1)[1]));
  EXPECT_THROW(table.numbers(2), Error);
  EXPECT_THROW(table.find("forc"), Error);
}

TEST(Csv, numbers_read_back_as_they_were) {
  const Workplace place;
  const std::vector<double> x{1.0 / 3, -2e-300, 6.02214076e23, 0.1};
  place.write("a.csv", csv_text({"x"}, {x}));
  EXPECT_EQ(read_csv(place / "a.csv").numbers(0), x);
}

// Truth: RFC 4180, and that what is written reads back.
TEST(Csv, names_with_commas_and_quotes_are_written_in_quotes) {
  const Workplace place;
  const std::vector<std::string> names{"t [s]", "seat, left.x [g]", "5\" gun", "#1", " a"};
  const std::string text = csv_text(names, {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {8, 9}});
  EXPECT_EQ(text.substr(0, text.find('\n')), "t [s],\"seat, left.x [g]\",\"5\"\" gun\",\"#1\",\" a\"");
  place.write("a.csv", text);
  const CsvTable table = read_csv(place / "a.csv");
  ASSERT_EQ(table.header.size(), names.size());
  for (size_t c = 0; c + 1 < names.size(); ++c) EXPECT_EQ(table.header[c], names[c]);
  EXPECT_EQ(table.numbers(4), (std::vector<double>{8, 9}));
  place.write("b.csv", "5\" gun,b [m],c[m],d (m),e (old)\n1,2,3,4,5\n");
  const CsvTable b = read_csv(place / "b.csv");
  EXPECT_EQ(b.header[0], "5\" gun") << "a quote within a cell is a sign like others";
  for (const auto& [name, column] : {std::pair{"b", 1}, {"c", 2}, {"d", 3}, {"e (old)", 4}}) EXPECT_EQ(b.find(name), column) << name;
}

TEST(Chart, has_the_curve_where_its_numbers_are) {
  const Workplace place;
  std::string text = "x,y\n";
  for (int i = 0; i <= 100; ++i) text += std::to_string(i / 100.0) + "," + std::to_string(i < 50 ? 0 : 1) + "\n";
  place.write("step.csv", text);
  succeeded(place.run("unset DISPLAY\nhilo-post chart step.csv -o step.png"));
  const PictureFile picture(place / "step.png");
  const auto coloured = [&](int x0, int x1, int y0, int y1) {
    int n = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const auto c = picture.at(x, y);
        n += c[2] > c[0] + 60;
      }
    return n;
  };
  // low in the left half, high in the right one
  EXPECT_GT(coloured(150, 550, 500, 660), 300);
  EXPECT_EQ(coloured(150, 550, 30, 300), 0);
  EXPECT_GT(coloured(750, 1200, 20, 150), 300);
  EXPECT_EQ(coloured(750, 1200, 300, 640), 0);
}

TEST(Chart, one_curve_for_each_name_of_a_column) {
  const Workplace place;
  place.write("work.csv", "method,cpu [s],error [m]\na,1,0.1\na,10,0.01\nb,1,0.3\nb,10,0.003\n");
  succeeded(place.run("unset DISPLAY\nhilo-post chart work.csv -x cpu -y error --by method --log xy --markers -o work.png"));
  const PictureFile picture(place / "work.png");
  int blue = 0, red = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const auto c = picture.at(x, y);
      blue += c[2] > c[0] + 100, red += c[0] > c[2] + 100;
    }
  EXPECT_GT(blue, 500);
  EXPECT_GT(red, 500);
}

// Points that are no course: the marks are there, no line between them.
TEST(Chart, points_without_lines) {
  const Workplace place;
  place.write("models.csv", "cost [s],error,choice\n1,0.1,other\n9,0.9,other\n5,0.1,chosen\n");
  ASSERT_EQ(place
                .run("unset DISPLAY\nhilo-post chart models.csv -y error --by choice --points -o points.png\n"
                     "hilo-post chart models.csv -y error --by choice --markers -o lines.png")
                .exit,
            0);
  const auto blue = [&](const std::string& file) {  // in the middle of the panel, and in all of it
    const PictureFile picture(place / file);
    std::array<int, 2> n{};
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width * 3 / 4; ++x) {
        const auto c = picture.at(x, y);
        if (c[2] > c[0] + 100) ++n[1], n[0] += std::abs(x - picture.width / 2) < 200;
      }
    return n;
  };
  const auto points = blue("points.png"), lines = blue("lines.png");
  EXPECT_EQ(points[0], 0);
  EXPECT_GT(points[1], 60);
  EXPECT_GT(lines[0], 200);
}

// Truth: the same chart with the second table in seconds.
TEST(Chart, abscissae_are_drawn_in_the_unit_of_the_first) {
  const Workplace place;
  std::filesystem::create_directory(place / "s"), std::filesystem::create_directory(place / "ms");
  place.write("a.csv", "t [s],x [m]\n0,0\n2,2\n");
  place.write("s/b.csv", "t [s],x [m]\n0,0\n1,1.5\n");
  place.write("ms/b.csv", "t [ms],x [m]\n0,0\n1000,1.5\n");
  succeeded(place.run("unset DISPLAY\nhilo-post chart a.csv s/b.csv -o s.png\nhilo-post chart a.csv ms/b.csv -o ms.png"));
  EXPECT_TRUE(text_of(place / "s.png") == text_of(place / "ms.png"));
}

// 250 MPa and 250 kN stood at one height: each unit has a panel, and there the curve that falls and the one that rises.
TEST(Chart, each_unit_has_a_panel_of_its_own) {
  const Workplace place;
  place.write("two.csv", "t [s],stress [MPa],force [kN]\n0,0,250\n1,250,0\n");
  ASSERT_EQ(place.run("unset DISPLAY\nhilo-post chart two.csv -o two.png\nhilo-post chart two.csv --ylabel both -o one.png").exit, 0);
  const auto halves = [&](const std::string& file) {  // pixels of the first and of the second curve in the upper and the lower half
    const PictureFile picture(place / file);
    std::array<int, 4> n{};
    for (int y = 0; y < picture.height; ++y)
      for (int x = 120; x < 1000; ++x) {  // beside the legend
        const auto c = picture.at(x, y);
        const size_t lower = y > picture.height / 2;
        n[lower] += c[2] > c[0] + 100, n[2 + lower] += c[0] > c[2] + 100;
      }
    return n;
  };
  const auto two = halves("two.png"), one = halves("one.png");
  EXPECT_GT(two[0], 1000);
  EXPECT_EQ(two[1], 0);
  EXPECT_GT(two[3], 1000);
  EXPECT_EQ(two[2], 0);
  EXPECT_GT(one[1], 500);
  EXPECT_GT(one[2], 500);
}

// The ordinate shown is 0.5 .. 1.5: the half of the curve at 0 is below it, the half at 1 in the middle.
TEST(Chart, shows_the_range_that_was_asked_for) {
  const Workplace place;
  std::string text = "x,y\n";
  for (int i = 0; i <= 100; ++i) text += std::to_string(i / 100.0) + "," + std::to_string(i < 50 ? 0 : 1) + "\n";
  place.write("step.csv", text);
  succeeded(place.run("unset DISPLAY\nhilo-post chart step.csv --yrange 0.5,1.5 -o step.png"));
  const PictureFile picture(place / "step.png");
  const auto blue = [&](int x0, int x1, int y0, int y1) {
    int n = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) n += picture.at(x, y)[2] > picture.at(x, y)[0] + 60;
    return n;
  };
  EXPECT_EQ(blue(150, 550, 20, 660), 0);
  EXPECT_GT(blue(750, 1200, 300, 380), 300);
  EXPECT_EQ(place.run("hilo-post chart step.csv --yrange 1,0 -o no.png").exit, 1);
  EXPECT_EQ(place.run("hilo-post chart step.csv --slope 2 -o no.png").exit, 1) << "slopes need logarithmic axes";
}

// A guide of slope -2 between decades: as steep on the picture as the curve y = x^-2 it stands beside.
TEST(Chart, draws_guides_of_a_slope) {
  const Workplace place;
  place.write("work.csv", "steps,error\n10,1e-2\n100,1e-4\n1000,1e-6\n");
  succeeded(place.run("unset DISPLAY\nhilo-post chart work.csv --log xy --slope -2 -o work.png"));
  const PictureFile picture(place / "work.png");
  // rows of the curve (blue) and of the guide (grey, to the right of it): mean columns at two heights
  const auto column = [&](int y0, bool curve) {
    double sum = 0, n = 0;
    for (int y = y0; y < y0 + 12; ++y)
      for (int x = 100; x < 1250; ++x) {
        const auto c = picture.at(x, y);
        const bool is_blue = c[2] > c[0] + 60, is_grey = !is_blue && std::abs(c[0] - c[2]) < 12 && c[0] > 90 && c[0] < 140;
        if (curve ? is_blue : is_grey && x > 700) sum += x, ++n;
      }
    return n > 0 ? sum / n : 0;
  };
  const double curve = column(200, true) - column(60, true), guide = column(200, false) - column(60, false);
  ASSERT_GT(curve, 50);
  EXPECT_NEAR(guide, curve, 0.1 * curve);
}

TEST(Chart, a_mistyped_column_is_an_error_with_the_nearest_one) {
  const Workplace place;
  place.write("a.csv", "time [s],force [N]\n0,1\n");
  const Ran ran = place.run("hilo-post chart a.csv -y forse -o a.png");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_EQ(ran.err, "hilo-post: a.csv: no column \"forse\" (did you mean \"force\"?)\n");
  EXPECT_EQ(place.files(), (std::set<std::string>{"a.csv"}));
}

}  // namespace
}  // namespace hilo::test::chart_test
