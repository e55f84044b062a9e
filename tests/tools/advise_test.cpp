// SPDX-License-Identifier: GPL-3.0-or-later
// The gate of hilo-advise: rates, jumps and frequencies whose values are known.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "advise/gate.hpp"

namespace hilo::test {
namespace {

LoadHistory sampled(double T, int n, const std::function<double(double)>& F) {
  LoadHistory h;
  for (int i = 0; i <= n; ++i) h.t.push_back(T * i / n), h.F.push_back({0, F(T * i / n), 0});
  return h;
}

TEST(Advise, rate_of_a_sine_is_its_frequency_on_any_mean) {
  for (const double mean : {0., 1e4})
    EXPECT_NEAR(load_frequency(sampled(1, 4000, [&](double t) { return mean + 50 * std::sin(2 * M_PI * 7 * t); })), 7, 7e-3);
  // two sines: sqrt of the mean square of their frequencies, weighted with their power
  const auto two = [](double t) { return std::sin(2 * M_PI * 3 * t) + 2 * std::sin(2 * M_PI * 20 * t); };
  EXPECT_NEAR(load_frequency(sampled(1, 8000, two)), std::sqrt((9 + 4 * 400) / 5.), 0.02);
  EXPECT_EQ(load_frequency(sampled(1, 100, [](double) { return 300.; })), 0);
}

TEST(Advise, jump_is_what_the_first_step_brings) {
  EXPECT_NEAR(load_jump(sampled(1, 100, [](double t) { return 20 * std::sin(M_PI * t); })), std::sin(M_PI / 100), 1e-12);
  EXPECT_DOUBLE_EQ(load_jump(sampled(1, 100, [](double) { return -5.; })), 1);
  EXPECT_EQ(load_jump(sampled(1, 100, [](double) { return 0.; })), 0);
}

TEST(Advise, ratio_grows_with_the_claim_and_doubles_with_a_jump) {
  EXPECT_EQ(least_ratio(0.05, 0), 4);
  EXPECT_EQ(least_ratio(0.02, 0), 12);
  EXPECT_EQ(least_ratio(0.005, 0), 16);
  EXPECT_EQ(least_ratio(0.02, 0.1), 24);
  EXPECT_EQ(least_ratio(0.02, 0.09), 12);
}

TEST(Advise, an_elastic_frequency_is_one_that_rigid_parts_do_not_have) {
  EXPECT_EQ(elastic_frequency({0, 0, 5, 30}, {0, 0, 4.95, 12, 29.9}), 12);  // springs stay where they are
  EXPECT_EQ(elastic_frequency({0, 5}, {0, 4.9, 5.1}), 5.1);                 // one for one
  EXPECT_EQ(elastic_frequency({0, 5}, {0, 5}), 0);
}

}  // namespace
}  // namespace hilo::test
