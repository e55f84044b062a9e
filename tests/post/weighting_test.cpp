// SPDX-License-Identifier: GPL-3.0-or-later
// Frequency weighting against the standard's table of factors at third-octave bands [iso-2631, table 3], and what it does to a signal in
// time against what it does at a frequency.
#include "post/injury/weighting.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hilo::test::weighting_test {
namespace {

constexpr double bands[] = {0.5, 0.63, 0.8, 1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8, 10, 12.5, 16, 20, 25, 31.5, 40, 50, 63, 80};
constexpr double table_k[] = {0.418, 0.459, 0.477, 0.482, 0.484, 0.494, 0.531, 0.631, 0.804, 0.967, 1.039, 1.054,
                              1.036, 0.988, 0.902, 0.768, 0.636, 0.513, 0.405, 0.314, 0.246, 0.186, 0.132};
constexpr double table_d[] = {0.853, 0.944, 0.992, 1.011, 1.008, 0.968, 0.890,  0.776,  0.642,  0.512,  0.409, 0.323,
                              0.253, 0.212, 0.161, 0.125, 0.100, 0.080, 0.0632, 0.0494, 0.0388, 0.0295, 0.0211};

TEST(Weighting, factors_are_those_of_the_standards_table) {
  for (size_t n = 0; n < std::size(bands); ++n) {
    EXPECT_NEAR(weighting_factor(weighting_k, bands[n]), table_k[n], 7e-4) << bands[n] << " Hz";  // three decimals are given
    // At 10 Hz the table has 0.212 for Wd, the standard's own filter 0.2017: 5 % below, a slip of the table.
    EXPECT_NEAR(weighting_factor(weighting_d, bands[n]), bands[n] == 10 ? 0.2017 : table_d[n], bands[n] < 31 ? 6e-4 : 6e-5)
        << bands[n] << " Hz";
  }
}
TEST(Weighting, factor_at_100_rad_per_s_is_the_published_one) {  // reference value of ISO 8041 as an analyser's manual gives it
  EXPECT_NEAR(weighting_factor(weighting_d, 100 / (2 * M_PI)), 0.1261, 5e-5);
}

/// Amplitude of the answer to a sine of 1, once it has settled.
double answer(const FrequencyWeighting& w, double frequency, double h) {
  std::vector<double> t, a;
  for (int i = 0; i * h <= 30; ++i) t.push_back(i * h), a.push_back(std::sin(2 * M_PI * frequency * t.back()));
  const auto y = weighted(w, t, a);
  double in = 0, out = 0;  // projections on sine and cosine over whole periods
  const auto periods = std::floor(10 * frequency), from = 20.0, to = from + periods / frequency;
  for (size_t i = 0; i < t.size(); ++i)
    if (t[i] >= from && t[i] < to - h / 2)
      in += y[i] * std::sin(2 * M_PI * frequency * t[i]), out += y[i] * std::cos(2 * M_PI * frequency * t[i]);
  return 2 * std::hypot(in, out) * h / (to - from);
}

TEST(Weighting, a_sine_in_time_comes_out_with_its_factor) {
  for (const double f : {0.5, 1.0, 4.0, 8.0, 25.0, 80.0})  // a line between samples falls short by (w h)^2/12
    for (const auto* w : {&weighting_k, &weighting_d}) {
      const double h = 1e-3 / std::max(1.0, f / 8), bound = std::pow(2 * M_PI * f * h, 2) / 12 + 2e-5;
      EXPECT_NEAR(answer(*w, f, h) / weighting_factor(*w, f), 1, bound) << f;
    }
}

TEST(Weighting, of_a_straight_signal_does_not_depend_on_the_samples) {
  std::vector<double> fine_t, fine_a;
  for (int i = 0; i <= 1000; ++i) fine_t.push_back(1e-3 * i), fine_a.push_back(3 * fine_t.back() - 1);
  const std::vector<double> t{0, 0.1, 0.35, 1}, a{-1, -0.7, 0.05, 2};
  const auto coarse = weighted(weighting_k, t, a), fine = weighted(weighting_k, fine_t, fine_a);
  EXPECT_NEAR(coarse[1], fine[100], 1e-9);
  EXPECT_NEAR(coarse[2], fine[350], 1e-9);
  EXPECT_NEAR(coarse[3], fine[1000], 1e-9);
}

TEST(Vibration, of_a_sine_is_the_closed_form) {
  std::vector<double> t, a;
  for (int i = 0; i <= 40000; ++i) t.push_back(1e-4 * i), a.push_back(5 * std::sin(2 * M_PI * 10 * t.back()));
  const Vibration v = vibration(t, a);
  EXPECT_NEAR(v.rms, 5 / std::sqrt(2), 2e-5);  // lines between samples: (w h)^2/12 of it
  EXPECT_NEAR(v.running, 5 / std::sqrt(2), 1e-4);
  EXPECT_NEAR(v.dose, std::pow(4 * 3.0 / 8 * 625, 0.25), 1e-4);  // integral of sin^4 over whole periods: 3/8
}
TEST(Vibration, running_value_finds_the_loud_second) {
  std::vector<double> t, a;
  for (int i = 0; i <= 4000; ++i) t.push_back(1e-3 * i), a.push_back(t.back() >= 1.5 && t.back() < 2 ? 2 : 0);
  EXPECT_NEAR(vibration(t, a).running, 2 * std::sqrt(0.5), 2e-3);
  EXPECT_NEAR(vibration(t, a).rms, 2 * std::sqrt(0.125), 1e-3);
}

}  // namespace
}  // namespace hilo::test::weighting_test
