// SPDX-License-Identifier: GPL-3.0-or-later
// Histories against exact values and integrals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "base/spline.hpp"
#include "model/scene.hpp"

namespace hilo::test::history_test {
namespace {
using std::numbers::pi;

const History ramp{{0, 2, 3}, {0, 4, 1}, Ramp::linear};
const History step{{0, 1, 1, 2}, {0, 0, 5, 5}, Ramp::linear};
const History smooth{{0, 2, 3}, {0, 4, 1}, Ramp::smooth}, smoother{{0, 2, 3}, {0, 4, 1}, Ramp::smoother};

TEST(History, IsConstantOutsideItsPoints) {
  for (const History* h : {&ramp, &smooth, &smoother}) {
    EXPECT_EQ((*h)(-1), 0);
    EXPECT_EQ((*h)(7), 1);
    EXPECT_EQ(h->mean(-3, -1), 0);
    EXPECT_EQ(h->mean(4, 5), 1);
    EXPECT_EQ(h->slope(-1), 0);
    EXPECT_EQ(h->slope(3.5), 0);
  }
}

TEST(History, InterpolatesLinearlyAndByCosines) {
  EXPECT_DOUBLE_EQ(ramp(0.5), 1);
  EXPECT_DOUBLE_EQ(ramp(2.5), 2.5);
  EXPECT_DOUBLE_EQ(smooth(0.5), 4 * (1 - std::cos(pi / 4)) / 2);
  EXPECT_DOUBLE_EQ(smooth(1), 2);
  EXPECT_EQ(smooth(2), 4);
}

TEST(History, TakesTheRightValueAtAJump) {
  EXPECT_EQ(step(1), 5);
  EXPECT_EQ(step(std::nextafter(1, 0)), 0);
  const History at_start{{0, 0, 1}, {0, 3, 3}, Ramp::linear};
  EXPECT_EQ(at_start(-1e-9), 0);
  EXPECT_EQ(at_start(0), 3);
}

TEST(History, MeanIsTheExactIntegralOfALinearOne) {
  EXPECT_DOUBLE_EQ(ramp.mean(0, 3), (4 + 2.5) / 3);             // triangle 2 x 4 / 2, trapezium (4 + 1)/2
  EXPECT_DOUBLE_EQ(ramp.mean(1, 2.5), (3 + 0.5 * 3.25) / 1.5);  // (2 + 4)/2 x 1, (4 + 2.5)/2 x 0.5
  EXPECT_DOUBLE_EQ(ramp.mean(-1, 1), 0.5);
  EXPECT_DOUBLE_EQ(ramp.mean(2.5, 5), (0.5 * 1.75 + 2 * 1) / 2.5);
  EXPECT_DOUBLE_EQ(ramp.mean(1, 0), ramp.mean(0, 1));
  EXPECT_DOUBLE_EQ(ramp.mean(1, 1), ramp(1));
}

TEST(History, MeanWeighsAJumpByItsTime) {
  EXPECT_DOUBLE_EQ(step.mean(0.5, 1.5), 2.5);
  EXPECT_DOUBLE_EQ(step.mean(0.75, 1), 0);
  EXPECT_DOUBLE_EQ(step.mean(1, 1.25), 5);
  EXPECT_DOUBLE_EQ(step.mean(0.9, 1.3), 5 * 0.3 / 0.4);
}

TEST(History, MeanOfASmoothOneIsTheIntegralOfItsCosines) {
  EXPECT_DOUBLE_EQ(smooth.mean(0, 2), 2);
  // integral of 2 (1 - cos(pi t/2)) from a to b is 2 (b - a) - (4/pi) (sin(pi b/2) - sin(pi a/2))
  const double a = 0.3, b = 1.7;
  EXPECT_NEAR(smooth.mean(a, b), (2 * (b - a) - 4 / pi * (std::sin(pi * b / 2) - std::sin(pi * a / 2))) / (b - a), 1e-15 * 4);
  EXPECT_DOUBLE_EQ(smooth.mean(0, 3), (4 + 2.5) / 3);
}

// Truth: w' = 140 s^3 (1 - s)^3, so that value, slope and two more derivatives vanish at both ends; its integral over [0, 1] is 1/2.
TEST(History, SmootherRampHasThreeContinuousDerivatives) {
  EXPECT_DOUBLE_EQ(smoother(1), 2);
  EXPECT_NEAR(smoother.mean(0, 2), 2, 1e-14);
  EXPECT_DOUBLE_EQ(smoother.slope(1), 2 * 140. / 64);
  const double h = 1e-2;  // s = h/2: 35 s^4 of the height 4, and no lower power
  EXPECT_NEAR(smoother(h) / (4 * 35 * std::pow(h / 2, 4)), 1, 2.5 * h / 2);
  EXPECT_NEAR((4 - smoother(2 - h)) / (4 * 35 * std::pow(h / 2, 4)), 1, 2.5 * h / 2);
}

TEST(History, MeanOverAShortIntervalKeepsItsDigits) {
  const double h = 1e-9, t = 0.7;  // the mean differs from the mid-point value by h^2 f''/24
  EXPECT_NEAR(smooth.mean(t, t + h), smooth(t + h / 2), 1e-15 * 4);
  EXPECT_NEAR(ramp.mean(t, t + h), ramp(t + h / 2), 1e-15 * 4);
}

TEST(History, MeansOfTheHalvesAverageToTheWhole) {
  for (const History* h : {&ramp, &step, &smooth, &smoother})
    for (double t = -0.7; t < 3.5; t += 0.31)
      EXPECT_NEAR(h->mean(t, t + 0.8), (h->mean(t, t + 0.4) + h->mean(t + 0.4, t + 0.8)) / 2, 1e-14);
}

TEST(History, SlopeIsTheDerivative) {
  for (const History* h : {&ramp, &smooth, &smoother})
    for (const double t : {0.1, 0.9, 1.9, 2.2, 2.9}) EXPECT_NEAR(h->slope(t), ((*h)(t + 1e-5) - (*h)(t - 1e-5)) / 2e-5, 1e-8) << t;
  EXPECT_NEAR(smooth.slope(2), 0, 1e-15) << "C1 at its points";
  EXPECT_EQ(ramp.slope(2), -3) << "from the right at a kink";
}

TEST(History, CurvatureIsTheDerivativeOfTheSlope) {
  for (const History* h : {&ramp, &smooth, &smoother})
    for (double t : {0.3, 1.1, 1.9, 2.4})  // central differences of width 1e-6: truncation below 1e-10
      EXPECT_NEAR(h->curvature(t), (h->slope(t + 1e-6) - h->slope(t - 1e-6)) / 2e-6, 1e-8);
}

/// "t:order t:order"
std::string breaks_of(const History& h) {
  std::ostringstream out;
  for (const History::Break& b : h.breaks()) out << (out.str().empty() ? "" : " ") << b.t << ":" << b.order;
  return out.str();
}

TEST(History, BreaksAreWhereADerivativeJumps) {
  EXPECT_EQ(breaks_of(ramp), "0:1 2:1 3:1");
  EXPECT_EQ(breaks_of(step), "1:0");
  EXPECT_EQ(breaks_of(smooth), "0:2 2:2 3:2") << "curvature of a cosine ramp";
  EXPECT_EQ(breaks_of(smoother), "");
  EXPECT_EQ(breaks_of({{0, 1, 2}, {0, 1, 0}, Ramp::smooth}), "0:2 2:2") << "the curvature is the same on both sides of an even summit";
  EXPECT_EQ(breaks_of({{0, 1, 2}, {1, 2, 3}, Ramp::linear}), "0:1 2:1") << "a point on a line is no kink";
  EXPECT_EQ(breaks_of({{0, 1, 1, 2}, {0, 1, 1, 1}, Ramp::linear}), "0:1 1:1") << "the same point twice is no jump";
}

// Truth: the limits from the left and from the right of a point where value, slope or curvature jump.
TEST(History, HasASideWhereItJumps) {
  EXPECT_EQ(step.at(1, 1 - 1e-9).value, 0);
  EXPECT_EQ(step.at(1, 1 + 1e-9).value, 5);
  EXPECT_EQ(ramp.at(2, 2 - 1e-9).slope, 2);
  EXPECT_EQ(ramp.at(2, 2 + 1e-9).slope, -3);
  EXPECT_EQ(ramp.at(3, 3 - 1e-9).slope, -3);
  EXPECT_EQ(ramp.at(3, 3 + 1e-9).slope, 0);
  EXPECT_NEAR(smooth.at(2, 2 - 1e-9).curvature, -pi * pi / 2, 1e-12);
  EXPECT_NEAR(smooth.at(2, 2 + 1e-9).curvature, -3 * pi * pi / 2, 1e-12);
  EXPECT_NEAR(smooth.at(1.3, 1.7).slope, smooth.slope(1.3), 1e-15);
}

TEST(History, OfOnePointIsConstant) {
  const History h{{0}, {3}, Ramp::linear};
  EXPECT_EQ(h(-1), 3);
  EXPECT_EQ(h(1), 3);
  EXPECT_EQ(h.mean(-1, 1), 3);
  EXPECT_TRUE(h.breaks().empty());
}

History spline(const std::function<double(double)>& f, double end, int n, SplineEnds ends, double first = 0, double last = 0) {
  History h;
  for (int i = 0; i < n; ++i) h.t.push_back(end * i / (n - 1)), h.value.push_back(f(h.t.back()));
  if (ends == SplineEnds::periodic) h.value.back() = h.value.front(), h.repeats = true;
  h.ramp = Ramp::cubic, h.slopes = spline_slopes(h.t, h.value, ends, first, last);
  return h;
}

// Truth: a clamped spline of a cubic is the cubic, and its mean the integral; a natural one of a line is the line.
TEST(History, SplineOfACubicIsTheCubic) {
  const auto f = [](double t) { return 1 - 2 * t + 3 * t * t - 0.5 * t * t * t; };
  const History h = spline(f, 3, 5, SplineEnds::clamped, -2, -2 + 18 - 13.5);
  for (const double t : {0.1, 0.7, 1.5, 2.9}) {
    EXPECT_NEAR(h(t), f(t), 1e-13);
    EXPECT_NEAR(h.slope(t), -2 + 6 * t - 1.5 * t * t, 1e-13);
    EXPECT_NEAR(h.curvature(t), 6 - 3 * t, 1e-12);
  }
  const auto integral = [](double t) { return t - t * t + t * t * t - t * t * t * t / 8; };
  EXPECT_NEAR(h.mean(0.2, 2.6), (integral(2.6) - integral(0.2)) / 2.4, 1e-13);
  const History line = spline([](double t) { return 2 - t; }, 4, 3, SplineEnds::natural);
  EXPECT_NEAR(line.slope(1.3), -1, 1e-14);
  EXPECT_NEAR(line(3.3), -1.3, 1e-14);
}

// Truth: a sine.  A spline errs with the fourth power of its spacing, and the mean square of its rate is right, where ramps that rest at
// every point have pi^2/8 of it.
TEST(History, SplineOfADenseSineHasItsRate) {
  const double end = 2 * pi;
  const auto square = [&](const History& h) {
    double sum = 0;
    for (int i = 0; i < 30000; ++i) sum += std::pow(h.slope(end * (i + 0.5) / 30000), 2) / 30000;
    return sum / 0.5;
  };
  const auto worst = [&](const History& h) {
    double off = 0;
    for (int i = 0; i < 1000; ++i) off = std::max(off, std::abs(h(end * i / 1000) - std::sin(end * i / 1000)));
    return off;
  };
  const auto sine = [](double t) { return std::sin(t); };
  for (const SplineEnds ends : {SplineEnds::natural, SplineEnds::clamped, SplineEnds::periodic}) {
    const History coarse = spline(sine, end, 31, ends, 1, 1), fine = spline(sine, end, 301, ends, 1, 1);
    EXPECT_GT(std::log10(worst(coarse) / worst(fine)), 3.9);
    EXPECT_LT(worst(fine), 1e-8);
    EXPECT_NEAR(square(fine), 1, 1e-7);
  }
  History ramps = spline(sine, end, 301, SplineEnds::natural);
  ramps.ramp = Ramp::smooth;
  EXPECT_NEAR(square(ramps), pi * pi / 8, 1e-3);
}

// Truth: a periodic spline is the sine before its table and after it, also its means over many periods; nothing jumps.
TEST(History, PeriodicSplineRepeats) {
  const double end = 2 * pi;
  const History h = spline([](double t) { return std::sin(t); }, end, 101, SplineEnds::periodic);
  for (const double t : {-20.0, -0.3, 1.0, 7.0, 200.0}) {
    EXPECT_NEAR(h(t), std::sin(t), 1e-6);
    EXPECT_NEAR(h.slope(t), std::cos(t), 1e-4);
    EXPECT_NEAR(h.curvature(t), -std::sin(t), 2e-3);
  }
  EXPECT_NEAR(h.mean(-1, 30), (std::cos(-1) - std::cos(30)) / 31, 1e-7);
  EXPECT_NEAR(h.mean(6.2, 6.4), (std::cos(6.2) - std::cos(6.4)) / 0.2, 1e-7);
  EXPECT_NEAR(h.at(end, end - 1e-9).curvature, h.at(end, end + 1e-9).curvature, 1e-9);
  EXPECT_EQ(breaks_of(h), "");
}

// Truth: what is held before the first point and after the last leaves there with a kink, or with a jump of the curvature.
TEST(History, SplineBreaksOnlyAtItsEnds) {
  EXPECT_EQ(breaks_of(spline([](double t) { return std::sin(t); }, 3, 31, SplineEnds::natural)), "0:1 3:1");
  EXPECT_EQ(breaks_of(spline([](double t) { return t * t * (3 - t) * (3 - t); }, 3, 31, SplineEnds::clamped)), "0:2 3:2");
}

// Truth: a monotone one never leaves the values of its neighbours, where a spline swings beyond.
TEST(History, MonotoneStaysBetweenItsPoints) {
  History h{{0, 1, 2, 3, 5, 6}, {0, 0, 1, 1, 4, 2}, Ramp::cubic};
  h.slopes = monotone_slopes(h.t, h.value);
  for (size_t i = 1; i < h.t.size(); ++i)
    for (double s = 0; s <= 1; s += 0.05) {
      const double v = h(h.t[i - 1] + s * (h.t[i] - h.t[i - 1]));
      EXPECT_GE(v, std::min(h.value[i - 1], h.value[i]) - 1e-12);
      EXPECT_LE(v, std::max(h.value[i - 1], h.value[i]) + 1e-12);
    }
  h.slopes = spline_slopes(h.t, h.value, SplineEnds::natural);
  EXPECT_LT(h(0.5), -0.01);
}

}  // namespace
}  // namespace hilo::test::history_test
