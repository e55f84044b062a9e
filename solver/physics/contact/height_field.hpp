// SPDX-License-Identifier: GPL-3.0-or-later
// Heights over a grid as a surface of two continuous derivatives, and the point of it that is nearest.
//
// Along each line of the grid a cubic spline through the heights, which ends with the slope of the cubic through its last four points: it
// is exact for heights of degree three in each coordinate [de-boor-1978].  Beyond the border it goes straight on.
#pragma once
#include <array>
#include <vector>

#include "base/math.hpp"

namespace hilo {

class HeightField {
 public:
  /// x (nx) and y (ny) rise, two at least; heights ny x nx, rows along x [m].
  HeightField(std::vector<double> x, std::vector<double> y, const std::vector<double>& heights);

  /// A height and its derivatives.
  struct Height {
    double h, hx, hy, hxx, hxy, hyy;
  };
  Height at(double u, double v) const;
  /// Place (u, v) of the point of the surface that is nearest to p.
  std::array<double, 2> nearest(const Vec3& p) const;
  /// How far outside the border of the grid, below zero within, and the direction outward.
  struct Outside {
    double distance;
    int axis;  // 0: x, 1: y
    double sign;
  };
  Outside outside(const Vec3& p) const;
  /// Whether p is above the surface by more than a distance and two pieces of the grid; quick.
  bool is_beyond(const Vec3& p, double distance) const;
  double low() const { return low_; }
  double high() const { return high_; }
  double extent() const { return extent_; }
  /// Radius of the narrowest hollow at the points of the grid; infinite where there is none [m].
  double least_hollow() const { return hollow_; }
  /// Whether all slopes are numbers.
  bool is_finite() const;

 private:
  std::vector<double> x_, y_;
  std::vector<std::array<double, 4>> node_;  // height, slopes along x and y, mixed derivative
  double low_ = 0, high_ = 0, extent_ = 0, spacing_ = 0, piece_ = 0, steep_ = 1, hollow_ = HUGE_VAL;
};

}  // namespace hilo
