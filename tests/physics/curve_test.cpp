// SPDX-License-Identifier: GPL-3.0-or-later
// The spline of point-on-curve: exact for what a cubic holds, of fourth order for what it does not, smooth at its points.
#include "physics/curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hilo::test::curve_test {
namespace {

using std::numbers::pi;

std::vector<Vec3> circle(int n) {
  std::vector<Vec3> x;
  for (int i = 0; i < n; ++i) x.emplace_back(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0);
  return x;
}

double off_circle(int n) {
  const Curve c(circle(n), true);
  double worst = 0;
  for (int i = 0; i < 50 * n; ++i) worst = std::max(worst, std::abs(c.at(c.length() * i / (50 * n)).x.norm() - 1));
  return worst;
}

// Truth: a cubic spline has an error of fourth order in the distance of its points.
TEST(Curve, ClosedOneNearsACircleWithFourthOrder) {
  const double rate = std::log2(off_circle(16) / off_circle(32));
  EXPECT_NEAR(rate, 4, 0.1);
  EXPECT_LT(off_circle(128), 1e-7);
}

// Truth: with not-a-knot ends the spline through points of a cubic at equal distances is that cubic.
TEST(Curve, OpenOneReproducesACubic) {
  // points whose chord lengths are equal to first order only: take a straight x and a parameter that is the chord itself
  std::vector<Vec3> x;
  for (int i = 0; i < 6; ++i) x.emplace_back(i, 0, 0);
  const Curve line(x, false);
  for (double s : {0.0, 0.3, 2.5, 4.9, 5.0}) EXPECT_LT((line.at(s).x - Vec3(s, 0, 0)).norm(), 1e-15);
  const Curve parabola({{-1, 1, 0}, {0, 0, 0}, {1, 1, 0}}, false);  // chords of equal length: the parameter is proportional to x
  for (double s : {0.2, 1.0, 2.0, 2.7}) {
    const Vec3 p = parabola.at(s).x;
    EXPECT_NEAR(p[1], p[0] * p[0], 1e-15);
  }
}

TEST(Curve, DerivativesAreThoseOfThePositionAndTheSecondIsContinuous) {
  std::vector<Vec3> x;
  for (int i = 0; i < 7; ++i) x.emplace_back(i, std::sin(1.3 * i), 0.2 * i * i);
  for (const bool closed : {false, true}) {
    const Curve c(x, closed);
    for (int k = 1; k < 40; ++k) {
      const double s = c.length() * k / 40, d = 1e-5;
      EXPECT_LT(((c.at(s + d).x - c.at(s - d).x) / (2 * d) - c.at(s).dx).norm(), 1e-8);
      EXPECT_LT(((c.at(s + d).dx - c.at(s - d).dx) / (2 * d) - c.at(s).ddx).norm(), 1e-4) << "third derivatives jump at the points";
    }
    double s = 0;
    for (size_t i = 1; i + 1 < x.size(); ++i) {
      s += (x[i] - x[i - 1]).norm();
      EXPECT_LT((c.at(s).x - x[i]).norm(), 1e-14);
      EXPECT_LT((c.at(s + 1e-9).ddx - c.at(s - 1e-9).ddx).norm(), 1e-7);
    }
    if (closed) {
      EXPECT_LT((c.at(-1e-9).ddx - c.at(1e-9).ddx).norm(), 1e-7);
    }
  }
}

TEST(Curve, OpenOneGoesOnStraight) {
  const Curve c({{0, 0, 0}, {1, 0.5, 0}, {2, 0, 0}, {3, 1, 0}}, false);
  const Curve::Point end = c.at(c.length()), beyond = c.at(c.length() + 0.7);
  EXPECT_LT((beyond.x - end.x - 0.7 * end.dx).norm(), 1e-14);
  EXPECT_EQ(beyond.ddx.norm(), 0);
}

TEST(Curve, NearestPointIsNormal) {
  const Curve c(circle(20), true);
  const Vec3 x(0.3, -0.9, 0.4);
  const Curve::Point p = c.at(c.nearest(x));
  EXPECT_NEAR(p.dx.dot(x - p.x), 0, 1e-14);
  EXPECT_GT(p.x.dot(x), 0);
}

}  // namespace
}  // namespace hilo::test::curve_test
