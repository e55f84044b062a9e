// SPDX-License-Identifier: GPL-3.0-or-later
// Polynomials through points, whatever the points determine.
#include "physics/patch_fit.hpp"

#include <gtest/gtest.h>

#include "verify/block_mesh.hpp"

namespace hilo::test::patch_fit_test {
namespace {

using Points = std::vector<Vec3>;

/// Gauss points of a block of unit cells with its first corner at `low`.
Points grid(int nx, int ny, int nz, const Vec3& low) {
  Points p;
  for (int i = 0; i < 2 * nx; ++i)
    for (int j = 0; j < 2 * ny; ++j)
      for (int k = 0; k < 2 * nz; ++k) {
        const auto at = [](int m) { return m / 2 + 0.5 + (m % 2 ? 0.28867513459481287 : -0.28867513459481287); };
        p.push_back(low + Vec3(at(i), at(j), at(k)));
      }
  return p;
}

struct Fit {
  PatchFit patch;
  std::vector<double> p;
  Vec6 at(const Vec3& y) const {
    Vec6 s = Vec6::Zero();
    patch.add_at(p.data(), y, 1, s);
    return s;
  }
};

/// The polynomial through `stress` at the points.
Fit fitted(int degree, const Points& points, const std::function<Vec6(const Vec3&)>& stress) {
  std::vector<double> shape(PatchFit::n_shape), moments(PatchFit::n_moments(degree)), sums(PatchFit::n_sums(degree));
  for (const Vec3& y : points) PatchFit::add_sample(y, shape.data()), PatchFit::add_extent(y, 1, shape.data());
  PatchFit fit(degree, shape.data());
  for (const Vec3& y : points) fit.add_moments(y, moments.data());
  fit.finish(moments.data());
  for (const Vec3& y : points) fit.add_stress(y, stress(y), sums.data());
  std::vector<double> p(static_cast<size_t>(PatchFit::n_rows(degree)) * 6);
  fit.solve(sums.data(), p.data());
  return {fit, p};
}

Vec6 linear(const Vec3& y) {
  Vec6 s;
  for (int c = 0; c < 6; ++c) s[c] = c + 1 + (c - 2) * y[0] + 3 * y[1] - c * y[2];
  return s;
}
Vec6 quadratic(const Vec3& y) {
  Vec6 s = linear(y);
  for (int c = 0; c < 6; ++c) s[c] += c * y[0] * y[0] - y[1] * y[2] + (1 - c) * y[2] * y[2] + 2 * y[0] * y[1];
  return s;
}

Vec6 cubic(const Vec3& y) {
  Vec6 s = quadratic(y);
  for (int c = 0; c < 6; ++c)
    s[c] += y[0] * y[0] * (c * y[0] - y[2]) + y[1] * y[2] * (y[0] + c * y[2]) + y[2] * y[2] * y[2] - y[1] * y[1] * y[1];
  return s;
}

double worst(const Fit& fit, const std::function<Vec6(const Vec3&)>& exact, double reach = 2) {
  double off = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec3 y = reach * Vec3(scatter(3 * i), scatter(3 * i + 1), scatter(3 * i + 2));
    off = std::max(off, (fit.at(y) - exact(y)).norm());
  }
  return off;
}

// Truth: a polynomial through points that tell one of its degree is that polynomial, also on flat, long and skew patches.
TEST(PatchFit, OfACubicIsTheCubic) {
  const Points round = grid(2, 2, 2, {-1, -1, -1});
  EXPECT_EQ(fitted(3, round, cubic).patch.rank(), 20);
  EXPECT_LT(worst(fitted(3, round, cubic), cubic), 1e-10);
  EXPECT_EQ(fitted(2, round, quadratic).patch.rank(), 10);
  EXPECT_LT(worst(fitted(2, round, quadratic), quadratic), 1e-10);
  Points skew = grid(2, 3, 2, {0, -1, -2});
  for (Vec3& y : skew) y = Vec3(y[0] + 0.5 * y[1], y[1], 1e-2 * y[2] + 0.1 * y[0]);
  EXPECT_EQ(fitted(3, skew, cubic).patch.rank(), 20);
  EXPECT_LT(worst(fitted(3, skew, cubic), cubic), 1e-4);
}

// Truth: linear stress is found by every patch whose points span space, however few; what they do not determine is left at nothing.
TEST(PatchFit, OfALinearStressIsExactFromOneCellOn) {
  for (const Points& points : {grid(1, 1, 1, {0, 0, 0}), grid(2, 2, 1, {-1, -1, 0}), grid(1, 2, 1, {0, -1, 0}), grid(5, 1, 1, {0, 0, 0})})
    for (const int degree : {1, 2, 3}) EXPECT_LT(worst(fitted(degree, points, linear), linear), 1e-11);
  EXPECT_EQ(fitted(3, grid(1, 1, 1, {0, 0, 0}), linear).patch.rank(), 8)
      << "1, x, y, z, their products: squares are constant on its points";
  EXPECT_EQ(fitted(3, grid(2, 2, 1, {-1, -1, 0}), linear).patch.rank(), 16) << "all but those with z^2";
}

// Truth: rough data on points that nearly leave a term open do not blow up: a warped layer one cell deep.
TEST(PatchFit, NeverMultipliesNoise) {
  for (const double warp : {0.0, 1e-8, 1e-4, 1e-2, 0.1, 0.3}) {
    Points points = grid(2, 2, 1, {-1, -1, 0});
    for (Vec3& y : points) y[2] += warp * y[0] * y[0];
    int seed = 0;
    const Fit fit = fitted(3, points, [&](const Vec3&) {
      Vec6 s;
      for (int c = 0; c < 6; ++c) s[c] = scatter(++seed);
      return s;
    });
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double z : {0.0, 0.5, 1.0})
        for (const double y : {-1.0, 0.0, 1.0})
          EXPECT_LT(fit.at({x, y, z + warp * x * x}).cwiseAbs().maxCoeff(), 10)
              << "noise of size 1, warp " << warp << ", at the cells' nodes";
  }
}

// Truth: points in a plane, on a line or in one place give a finite polynomial through what they hold.
TEST(PatchFit, OfDegeneratePointsIsFinite) {
  for (const Points& points : {Points{Vec3(0.1, 0.2, 0.3)}, Points{Vec3::Zero(), Vec3::UnitX()},
                               Points{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3(1, 1, 0)}})
    for (const int degree : {1, 2, 3}) {
      const Fit fit = fitted(degree, points, linear);
      for (const double value : fit.p) ASSERT_TRUE(std::isfinite(value));
      Vec3 middle = Vec3::Zero();
      for (const Vec3& y : points) middle += y / static_cast<double>(points.size());
      EXPECT_LT((fit.at(middle) - linear(middle)).norm(), 1e-6);
    }
}

}  // namespace
}  // namespace hilo::test::patch_fit_test
