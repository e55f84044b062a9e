// SPDX-License-Identifier: GPL-3.0-or-later
// The filter against published figures.
#include "post/injury/cfc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace hilo::test::cfc_test {
namespace {

TEST(Cfc, coefficients_are_those_of_SAE_J211) {
  struct Case {
    double cfc, rate, a0, b1, b2;
  };
  for (const auto& c : {Case{180, 10e3, 0.011796271, 1.670117463, -0.717302548}, Case{1000, 20e3, 0.071893097, 1.111586176, -0.399158564},
                        Case{60, 10e3, 0.001452367, 1.889343224, -0.895152694}}) {
    const CfcFilter f = cfc_filter(c.cfc, 1 / c.rate);
    EXPECT_NEAR(f.a0, c.a0, 5e-10);  // the source gives nine decimals
    EXPECT_NEAR(f.a1, 2 * c.a0, 1e-9);
    EXPECT_NEAR(f.a2, c.a0, 5e-10);
    EXPECT_NEAR(f.b1, c.b1, 5e-10);
    EXPECT_NEAR(f.b2, c.b2, 5e-10);
  }
}

/// Two-pass gain in dB at a frequency, measured on a long sine away from its ends.
double measured_gain(double cfc, double rate, double frequency) {
  const size_t n = 40000;
  std::vector<double> x(n);
  for (size_t i = 0; i < n; ++i) x[i] = std::sin(2 * M_PI * frequency * static_cast<double>(i) / rate);
  const auto y = filter_both_ways(cfc_filter(cfc, 1 / rate), x, 1000);
  double xx = 0, xy = 0;  // no phase: the projection on the input is the gain
  for (size_t i = n / 4; i < 3 * n / 4; ++i) xx += x[i] * x[i], xy += x[i] * y[i];
  return 20 * std::log10(xy / xx);
}

TEST(Cfc, two_passes_have_the_published_gain_at_their_class) {
  EXPECT_NEAR(measured_gain(180, 10e3, 180), -0.448, 6e-4);  // the source gives three or four decimals
  EXPECT_NEAR(measured_gain(1000, 20e3, 1000), -0.407, 6e-4);
  EXPECT_NEAR(measured_gain(60, 10e3, 60), -0.4535, 2e-4);
}

TEST(Cfc, the_half_power_point_of_class_180_is_300_Hz) { EXPECT_NEAR(measured_gain(180, 100e3, 300), -3.0, 0.15); }

TEST(Cfc, a_pulse_keeps_its_place) {
  std::vector<double> t, x;
  for (int i = 0; i <= 1000; ++i) t.push_back(1e-4 * i), x.push_back(std::exp(-std::pow((t.back() - 0.05) / 0.005, 2)));
  const Filtered f = cfc_filtered(t, x, 180, "test");
  const auto top = std::max_element(f.x.begin(), f.x.end()) - f.x.begin();
  EXPECT_NEAR(f.t[static_cast<size_t>(top)], 0.05, 1e-12);
  for (size_t i = 0; i <= 500; ++i) EXPECT_NEAR(f.x[500 - i], f.x[500 + i], 1e-9);  // round-off of a filter with poles near one
}

TEST(Cfc, a_constant_passes_unchanged_up_to_both_ends) {
  const std::vector<double> x(200, 1.0);
  for (const double y : filter_both_ways(cfc_filter(60, 1e-4), x, 100)) EXPECT_NEAR(y, 1, 1e-11);
}

TEST(Cfc, an_oscillation_above_the_class_does_not_pass_at_the_end_and_a_line_does_inside) {
  std::vector<double> t, ringing, line;
  for (int i = 0; i <= 1200; ++i)
    t.push_back(2.5e-4 * i), ringing.push_back(std::cos(2 * M_PI * 350 * (t.back() - 0.3))), line.push_back(3 - 40 * t.back());
  const Filtered r = cfc_filtered(t, ringing, 60, "test"), l = cfc_filtered(t, line, 60, "test");
  for (size_t i = 0; i < t.size(); ++i) {
    ASSERT_TRUE(t[i] < 0.01 || std::abs(r.x[i]) < 0.2) << t[i];  // the last sample is a crest of 1
    ASSERT_NEAR(l.x[i], line[i], t[i] > 0.04 && t[i] < 0.26 ? 1e-9 : 0.06);
  }
}

// Exact: the same pulse inside a longer record, and a crest is not exceeded.
TEST(Cfc, ends_add_no_peak) {
  const auto peak = [](double begin) {  // of a half sine of 100 g, 5 ms
    std::vector<double> t, x;
    for (int i = 0; i <= 5000; ++i) {
      const double s = 1e-4 * i - begin;
      t.push_back(1e-4 * i), x.push_back(s >= 0 && s <= 0.005 ? 100 * std::sin(M_PI * s / 0.005) : 0);
    }
    const Filtered f = cfc_filtered(t, x, 60, "test");
    const auto top = std::max_element(f.x.begin(), f.x.end());
    return std::pair{*top, f.by_ends[static_cast<size_t>(top - f.x.begin())]};
  };
  const auto [inside, no_share] = peak(0.05);
  EXPECT_NEAR(inside, 70.24, 0.01);
  EXPECT_LT(no_share, 1e-6);
  for (const double begin : {0.0, 0.495}) {
    EXPECT_NEAR(peak(begin).first, inside, 1e-3) << begin;
    EXPECT_GT(peak(begin).second, 0.1) << begin;  // what the mirrored record would add
  }
  for (const double frequency : {20.0, 40.0}) {
    std::vector<double> t, x;
    for (int i = 0; i <= 2125; ++i) t.push_back(1e-4 * i), x.push_back(std::cos(2 * M_PI * frequency * (t.back() - 0.2125)));
    for (const double y : cfc_filtered(t, x, 60, "test").x) ASSERT_LT(std::abs(y), 1.001) << frequency;
  }
}

// Exact: the area times the response to an impulse, wherever the steps lie.
TEST(Cfc, a_shock_shorter_than_other_steps_keeps_its_area) {
  const auto peak = [](double middle) {  // of a triangle of 2000 g, 40 us wide, in rows of 1 ms
    std::vector<double> t, x;
    for (int i = 0; i <= 1000; ++i) {
      t.push_back(1e-3 * i);
      if (i == 500)
        for (int k = -30; k <= 30; ++k)
          if (middle + 2e-6 * k > 0.5 && middle + 2e-6 * k < 0.501) t.push_back(middle + 2e-6 * k);
    }
    for (const double s : t) x.push_back(std::max(0.0, 2000 * (1 - std::abs(s - middle) / 20e-6)));
    const Filtered f = cfc_filtered(t, x, 60, "test");
    return *std::max_element(f.x.begin(), f.x.end());
  };
  std::vector<double> t, x;  // the same in even rows of 2 us
  for (int i = 0; i <= 40000; ++i) t.push_back(2e-6 * i), x.push_back(std::max(0.0, 2000 * (1 - std::abs(t.back() - 0.04) / 20e-6)));
  const Filtered even = cfc_filtered(t, x, 60, "test");
  const double exact = *std::max_element(even.x.begin(), even.x.end());
  EXPECT_NEAR(exact, 11.08, 0.01);
  for (const double middle : {0.50002, 0.50004, 0.50006, 0.50025}) EXPECT_NEAR(peak(middle), exact, 0.003 * exact) << middle;
}

TEST(Cfc, a_record_with_fewer_than_ten_samples_per_class_is_refused) {
  std::vector<double> t, x;
  for (int i = 0; i < 100; ++i) t.push_back(i / 1799.0), x.push_back(0);
  EXPECT_THROW(check_rate(t, 180, "run.h5"), Error);
  for (double& v : t) v *= 1799.0 / 1800.0;
  EXPECT_NO_THROW(check_rate(t, 180, "run.h5"));
  t[50] += 2e-5;  // one long interval is enough
  try {
    check_rate(t, 180, "run.h5");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.exit, Exit::input);
    EXPECT_EQ(e.where, "run.h5");
  }
}

TEST(Cfc, unequal_steps_give_the_answer_of_equal_ones) {
  std::vector<double> even, uneven;
  for (int i = 0; i <= 4000; ++i) even.push_back(2.5e-5 * i);
  for (double t = 0; t < 0.1; t += (uneven.size() % 3 == 0 ? 2.5e-5 : 5e-5)) uneven.push_back(t);
  uneven.push_back(0.1);
  const auto signal = [](double t) { return std::sin(2 * M_PI * 40 * t) + 0.2 * std::sin(2 * M_PI * 90 * t); };
  std::vector<double> xe, xu;
  for (const double t : even) xe.push_back(signal(t));
  for (const double t : uneven) xu.push_back(signal(t));
  const Filtered a = cfc_filtered(even, xe, 180, ""), b = cfc_filtered(uneven, xu, 180, "");
  const auto at = interpolate(b.t, b.x, a.t);
  for (size_t i = 0; i < a.t.size(); ++i)  // error of linear resampling: (w h)^2/8; at the ends a sample's width of the continuation
    EXPECT_NEAR(at[i], a.x[i], a.t[i] < 2e-3 || a.t[i] > 0.098 ? 1e-3 : 2e-4);
}

TEST(Clip, of_a_half_sine_is_the_published_level) {
  std::vector<double> t, x;
  for (int i = 0; i <= 20000; ++i) t.push_back(1e-6 * i), x.push_back(100 * std::sin(M_PI * t.back() / 0.02));
  EXPECT_NEAR(clip_level(t, x), 97.237, 5e-4);
  EXPECT_NEAR(clip_level(t, x), 100 * std::cos(M_PI * 1.5e-3 / 0.02), 1e-5);
}

TEST(Clip, counts_two_peaks_together) {
  const std::vector<double> t{0, 1e-3, 3e-3, 4e-3, 6e-3, 7e-3}, x{0, 50, 50, 0, 0, 50};  // above 0 for 3, then 1 ms
  // time above L: (50 - L)/50 (1 + 1 + 1) ms + 2 ms = 3 ms at L = 100/3
  EXPECT_NEAR(clip_level(t, x), 100.0 / 3, 1e-9);
}

TEST(Clip, of_a_record_shorter_than_three_milliseconds_is_not_a_number) {
  const std::vector<double> t{0, 1e-3, 2e-3}, x{1, 2, 3};
  EXPECT_TRUE(std::isnan(clip_level(t, x)));
}

}  // namespace
}  // namespace hilo::test::cfc_test
