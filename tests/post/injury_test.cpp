// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of injury against closed forms.
#include "post/injury/injury.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "post/injury/cfc.hpp"

namespace hilo::test::injury_test {
namespace {

struct Signal {
  std::vector<double> t, a;
};

template <class F>
Signal sampled(double end, double rate, F f) {
  Signal s;
  const int n = static_cast<int>(std::lround(end * rate));
  for (int i = 0; i <= n; ++i) s.t.push_back(i / rate), s.a.push_back(f(i / rate));
  return s;
}
Signal half_sine(double peak, double T, double end, double rate = 1e5) {
  return sampled(end, rate, [=](double t) { return t < T ? peak * std::sin(M_PI * t / T) : 0.0; });
}

TEST(DynamicResponse, of_a_step_of_10_g_is_the_closed_form) {
  const Signal s = sampled(0.3, 1e3, [](double) { return 10.0; });  // the first sample is 10 g already: a step
  EXPECT_NEAR(dynamic_response_index(s.t, s.a), 10 * (1 + std::exp(-M_PI * 0.224 / std::sqrt(1 - 0.224 * 0.224))), 1e-9);
  EXPECT_NEAR(dynamic_response_index(s.t, s.a), 14.857481, 5e-7);
}
TEST(DynamicResponse, of_a_half_sine_is_the_published_one) {
  const Signal s = half_sine(20, 0.05, 0.3);
  EXPECT_NEAR(dynamic_response_index(s.t, s.a), 20.8850, 5e-5);
  EXPECT_NEAR(model_response(s.t, s.a, 52.9, 0.224).t_highest, 52.54e-3, 1e-5);  // the source gives two decimals
}
TEST(DynamicResponse, of_an_impulse_is_3_96_per_metre_per_second) {
  const double g = 9.80665, T = 1e-3;  // 1 m/s in 1 ms
  const Signal sine = half_sine(M_PI / 2 / T / g, T, 0.2, 1e6);
  EXPECT_NEAR(dynamic_response_index(sine.t, sine.a), 3.9597, 5e-5);
  Signal box = sampled(0.2, 1e6, [=](double t) { return t < T - 1e-9 ? 1 / T / g : 0.0; });
  box.t.insert(box.t.begin() + 1000, T), box.a.insert(box.a.begin() + 1000, 1 / T / g);  // two samples at T: the jump back
  EXPECT_NEAR(dynamic_response_index(box.t, box.a), 3.9595, 5e-5);
}
TEST(DynamicResponse, does_not_depend_on_the_sampling_of_a_straight_signal) {
  const Signal fine = sampled(0.5, 1e4, [](double t) { return 40 * t; });
  const std::vector<double> t{0, 0.5}, a{0, 20};
  EXPECT_NEAR(dynamic_response_index(t, a), dynamic_response_index(fine.t, fine.a), 1e-9);
}

TEST(HeadInjury, of_a_half_sine_is_the_closed_form_with_its_window) {
  const Signal s = half_sine(100, 0.02, 0.02, 1e5);
  const HeadInjury h = head_injury(s.t, s.a, 1);
  EXPECT_NEAR(h.value, 829.29, 5e-3);
  EXPECT_NEAR(h.t1, 3.30e-3, 2e-5);
  EXPECT_NEAR(h.t2, 16.70e-3, 2e-5);
}
TEST(HeadInjury, of_a_triangle_is_the_closed_form) {
  const Signal s = sampled(0.02, 1e5, [](double t) { return 100 * (1 - std::abs(t - 0.01) / 0.01); });
  EXPECT_NEAR(head_injury(s.t, s.a, 1).value, 492.80, 5e-3);
}
TEST(HeadInjury, of_a_long_plateau_is_limited_by_the_window) {
  const Signal s = sampled(0.2, 1e4, [](double) { return 50.0; });
  EXPECT_NEAR(head_injury(s.t, s.a, 0.015).value, 0.015 * std::pow(50, 2.5), 1e-6);
  EXPECT_NEAR(head_injury(s.t, s.a, 0.036).value, 0.036 * std::pow(50, 2.5), 1e-6);
}
TEST(Severity, of_a_plateau_is_its_length_times_the_power) {
  const Signal s = sampled(0.1, 1e4, [](double) { return 30.0; });
  EXPECT_NEAR(severity_index(s.t, s.a), 0.1 * std::pow(30, 2.5), 1e-9);
}
TEST(Clip, of_a_half_sine_is_the_closed_form) {
  const Signal s = half_sine(100, 0.02, 0.02);
  EXPECT_NEAR(clip_level(s.t, s.a), 97.237, 5e-4);
}

// Truth: along one axis beta is the response over its limit; a slow pulse is followed without overshoot.
TEST(Brinkley, along_one_axis_is_the_response_over_its_limit) {
  const Signal s = sampled(4, 1e3, [](double t) { return 9 * (1 - std::cos(M_PI * t / 2)) / 2; });
  const std::vector<double> none(s.t.size(), 0.0);
  const Brinkley b = brinkley(s.t, {none, none, s.a});
  EXPECT_NEAR(b.axis[2].highest, 9, 0.02);
  EXPECT_NEAR(b.beta[0], b.axis[2].highest / 15.2, 1e-3);
  EXPECT_NEAR(b.beta[2], b.axis[2].highest / 22.8, 1e-3);
}

TEST(Pulse, of_a_half_sine_lies_above_half_of_its_peak_for_two_thirds_of_it) {
  const Signal s = half_sine(-8, 0.03, 0.1);
  const Pulse p = pulse(s.t, s.a);
  EXPECT_NEAR(p.peak, -8, 1e-6);
  EXPECT_NEAR(p.t_peak, 0.015, 1e-5);
  EXPECT_NEAR(p.begin, 0.005, 1e-7);
  EXPECT_NEAR(p.end, 0.025, 1e-7);
}
TEST(Pulse, ends_where_the_signal_first_falls_below) {
  const std::vector<double> t{0, 1, 2, 3, 4, 5}, a{0, 4, 0, 3, 0, 0};
  EXPECT_NEAR(pulse(t, a).end, 1.5, 1e-12);
}
TEST(LevelHeld, of_a_trapezoid_is_its_plateau_for_as_long_as_that_lasts) {
  // up in 10, 20 at the top, down in 10: held for 20 + 2 (1 - level) 10
  std::vector<double> x;
  for (int i = 0; i <= 60; ++i) x.push_back(std::clamp(std::min(i - 10, 50 - i) / 10.0, 0.0, 1.0));
  EXPECT_EQ(level_held(x, 1), 1);
  EXPECT_EQ(level_held(x, 20), 1);
  EXPECT_NEAR(level_held(x, 30), 0.5, 1e-12);
  EXPECT_EQ(level_held(x, 41), 0);
  EXPECT_TRUE(std::isnan(level_held(x, 61)));
}

}  // namespace
}  // namespace hilo::test::injury_test
