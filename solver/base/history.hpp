// SPDX-License-Identifier: GPL-3.0-or-later
// Histories: factors over time as piecewise linear, smooth or cubic functions, with exact means and one-sided derivatives.
#pragma once
#include <vector>

namespace hilo {

/// How a history goes from point to point: linear; smooth, w = (1 - cos(pi s))/2 (C1); smoother, w = 35 s^4 - 84 s^5 + 70 s^6 - 20 s^7
/// (C3), both at rest at every point; cubic, with the slopes of a spline at the points (base/spline).
enum class Ramp { linear, smooth, smoother, cubic };

/// Values at rising times with ramps between them.
/// Before the first point the first value, after the last the last, unless it repeats.  Two equal times make a jump, which a cubic one has
/// not.
struct History {
  std::vector<double> t;      // [s]
  std::vector<double> value;  // dimension of what it scales
  Ramp ramp = Ramp::linear;
  std::vector<double> slopes{};          // at the points, of cubic ramps
  bool repeats = false;                  // its points are one period
  double operator()(double time) const;  // from the right at a jump
  double slope(double time) const;       // from the right where it jumps, as the next one
  double curvature(double time) const;   // second derivative
  /// Value, slope and curvature at `time` in the segment that holds `near`: the limits from one side where they jump.
  struct Jet {
    double value, slope, curvature;
  };
  Jet at(double time, double near) const;
  double mean(double t0, double t1) const;  // exact average over [t0, t1]
  /// Points at which a derivative jumps, and the order of the lowest that does: 0 a jump, 1 a kink, 2 a jump of the curvature.
  struct Break {
    double t;
    int order;
  };
  std::vector<Break> breaks() const;
};

}  // namespace hilo
