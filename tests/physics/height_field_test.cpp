// SPDX-License-Identifier: GPL-3.0-or-later
// Heights over a grid as a surface, and distances from it.
#include "physics/contact/height_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "physics/contact/distance.hpp"

namespace hilo::test::height_field_test {
namespace {

using Function = std::function<double(double, double)>;

HeightField field_of(const std::vector<double>& x, const std::vector<double>& y, const Function& f) {
  std::vector<double> heights;
  for (const double v : y)
    for (const double u : x) heights.push_back(f(u, v));
  return {x, y, heights};
}
std::vector<double> even(double low, double high, int n) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(low + (high - low) * i / (n - 1));
  return out;
}
Distance over(HeightField field) {
  Distance out;
  out.kind = Distance::Kind::height_field, out.field = std::make_shared<HeightField>(std::move(field)), out.reach = 10;
  return out;
}

class HeightFieldTest : public ::testing::Test {
 protected:
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  std::mt19937 random_{5};
};

// Truth: the polynomial that the heights are of, of degree three in each coordinate; a parabola through three points, a line through two.
TEST_F(HeightFieldTest, HasTheHeightsSlopesAndCurvaturesOfCubics) {
  const auto far = field_of({-1, -0.6, 0.1, 0.2, 1.1, 2}, {0, 1, 1.5, 3, 3.1}, [](double u, double v) {
    return 1 + u - 2 * v + u * v + u * u * u * v * v - 0.3 * v * v * v * u + 0.1 * u * u * u * v * v * v;
  });
  const auto few = field_of({0, 1, 3}, {0, 2}, [](double u, double v) { return 2 - u * u + 0.5 * u * u * v - v; });
  for (int k = 0; k < 300; ++k) {
    const double u = in(-1, 2), v = in(0, 3.1);
    const HeightField::Height s = far.at(u, v);
    EXPECT_NEAR(s.h, 1 + u - 2 * v + u * v + u * u * u * v * v - 0.3 * v * v * v * u + 0.1 * std::pow(u * v, 3), 1e-11);
    EXPECT_NEAR(s.hx, 1 + v + 3 * u * u * v * v - 0.3 * v * v * v + 0.3 * u * u * v * v * v, 1e-10);
    EXPECT_NEAR(s.hy, -2 + u + 2 * u * u * u * v - 0.9 * v * v * u + 0.3 * u * u * u * v * v, 1e-10);
    EXPECT_NEAR(s.hxx, 6 * u * v * v + 0.6 * u * v * v * v, 1e-9);
    EXPECT_NEAR(s.hxy, 1 + 6 * u * u * v - 0.9 * v * v + 0.9 * u * u * v * v, 1e-9);
    EXPECT_NEAR(s.hyy, 2 * u * u * u - 1.8 * v * u + 0.6 * u * u * u * v, 1e-9);
    const double a = in(0, 3), b = in(0, 2);
    EXPECT_NEAR(few.at(a, b).h, 2 - a * a + 0.5 * a * a * b - b, 1e-12);
    EXPECT_NEAR(few.at(a, b).hxx, -2 + b, 1e-11);
  }
}

// Truth: a spline converges with the fourth power of the spacing, its curvature with the second; at points of the grid it is the height.
TEST_F(HeightFieldTest, ConvergesToASmoothSurface) {
  const auto f = [](double u, double v) { return std::sin(2 * u) * std::cos(3 * v); };
  double error[2] = {0, 0}, curved[2] = {0, 0};
  for (const int k : {0, 1}) {
    const int n = 21 + 20 * k;
    const auto field = field_of(even(0, 2, n), even(0, 2, n), f);
    EXPECT_DOUBLE_EQ(field.at(0.1, 0.2).h, f(0.1, 0.2));
    for (int i = 0; i < 400; ++i) {
      const double u = in(0, 2), v = in(0, 2);
      error[k] = std::max(error[k], std::abs(field.at(u, v).h - f(u, v)));
      curved[k] = std::max(curved[k], std::abs(field.at(u, v).hyy + 9 * f(u, v)));
    }
  }
  EXPECT_LT(error[1], error[0] / 10) << error[0];
  EXPECT_LT(curved[1], curved[0] / 3) << curved[0];
}

// Truth: of all points of a fine grid of the surface none is nearer; the gradient is a unit normal, and its derivative that of differences.
TEST_F(HeightFieldTest, FindsTheNearestPoint) {
  const Distance d = over(
      field_of(even(-2, 2, 21), even(-2, 2, 25), [](double u, double v) { return 0.3 * std::sin(3 * u) + 0.2 * std::cos(2 * v + u); }));
  for (int k = 0; k < 60; ++k) {
    const Vec3 p(in(-1.2, 1.2), in(-1.2, 1.2), in(-0.6, 1.2));
    double phi, least = 1e300;
    Triple<double> n;
    d(triple<double>(p), phi, n);
    const auto [u, v] = d.field->nearest(p);
    for (double du = -0.9; du <= 0.9; du += 0.01)
      for (double dv = -0.9; dv <= 0.9; dv += 0.01)
        least = std::min(least, (Vec3(p[0] + du, p[1] + dv, d.field->at(p[0] + du, p[1] + dv).h) - p).norm());
    EXPECT_LT(std::abs(phi), least + 1e-12) << k;
    EXPECT_NEAR((Vec3(u, v, d.field->at(u, v).h) - p).norm(), std::abs(phi), 1e-12);
    EXPECT_EQ(phi < 0, p[2] < d.field->at(p[0], p[1]).h);
    EXPECT_NEAR(values(n).norm(), 1, 1e-14);
    if (std::abs(phi) > 0.1) continue;  // a nearest point may be another one soon
    using T = Jet<3>;
    Triple<T> x = triple<T>(p), slope;
    for (int i = 0; i < 3; ++i) x[i].d[i] = 1;
    T phi_of;
    d(x, phi_of, slope);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(phi_of.d[i], n[i], 1e-10);
      Triple<double> before, after;
      double unused;
      const double step = 1e-6;
      d(triple<double>(p - step * Vec3::Unit(i)), unused, before), d(triple<double>(p + step * Vec3::Unit(i)), unused, after);
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(slope[j].d[i], (after[j] - before[j]) / (2 * step), 2e-5 * (1 + std::abs(slope[j].d[i])));
    }
  }
}

// Truth: a sphere's own distance, of heights of it; beyond the border walls, whose distance is that of a box.
TEST_F(HeightFieldTest, IsADistance) {
  const Distance bowl =
      over(field_of(even(-0.5, 0.5, 81), even(-0.5, 0.5, 81), [](double u, double v) { return 1 - std::sqrt(1 - u * u - v * v); }));
  EXPECT_NEAR(bowl.field->least_hollow(), 1, 1e-3);
  for (int k = 0; k < 200; ++k) {
    const Vec3 p(in(-0.2, 0.2), in(-0.2, 0.2), in(-0.1, 0.3));
    EXPECT_NEAR(bowl.at(p), 1 - (p - Vec3(0, 0, 1)).norm(), 1e-8);
  }
  const Distance flat = over(field_of({0, 1, 2}, {0, 3}, [](double, double) { return 0.5; }));
  EXPECT_EQ(flat.field->least_hollow(), HUGE_VAL);
  EXPECT_NEAR(flat.at({1, 1, 0.75}), 0.25, 1e-15);
  EXPECT_NEAR(flat.at({1, 1, -3}), -1, 1e-15) << "the nearest wall";
  EXPECT_NEAR(flat.at({2.5, 1, -3}), 0.5, 1e-15);
  EXPECT_NEAR(flat.at({1, -0.25, -3}), 0.25, 1e-15);
  EXPECT_GT(flat.at({-0.1, 1, 0.5}), 0);
}

// Truth: the distance by the search.  What is taken as far is farther than what meets the surface reaches, and its distance that of a
// plane.
TEST_F(HeightFieldTest, WhatIsFarIsFar) {
  const auto f = [](double u, double v) { return 0.2 * std::sin(4 * u) * std::cos(3 * v) - 0.4 * u; };
  const Distance exact = over(field_of(even(-2, 2, 41), even(-2, 2, 41), f));
  Distance quick = exact;
  int far = 0;
  for (const double reach : {0., 0.1, 0.3})
    for (int k = 0; k < 500; ++k) {
      quick.reach = reach;
      const Vec3 p(in(-1.5, 1.5), in(-1.5, 1.5), in(-0.5, 2.5));
      const double truth = exact.at(p), found = quick.at(p);
      if (quick.field->is_beyond(p, reach)) {
        ++far;
        EXPECT_GT(truth, reach);
        EXPECT_GT(found, reach);
      } else {
        EXPECT_EQ(truth, found);
      }
    }
  EXPECT_GT(far, 300);
  EXPECT_LT(far, 1200);
  Distance tilted = over(field_of({-1, 1}, {-1, 1}, [](double u, double v) { return 0.5 * u - v; }));
  tilted.reach = 0;
  EXPECT_NEAR(tilted.at({0.1, 0.2, 20}), (20 - 0.05 + 0.2) / 1.5, 1e-13);
}

}  // namespace
}  // namespace hilo::test::height_field_test
