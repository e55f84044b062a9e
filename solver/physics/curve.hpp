// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth curve through points: C2 cubic spline over the chord lengths, closed, or open with not-a-knot ends [de-boor-1978].
#pragma once
#include <span>
#include <vector>

#include "base/math.hpp"

namespace hilo {

class Curve {
 public:
  /// At least two different points, three when closed; a closed curve returns from the last point to the first.
  Curve(std::vector<Vec3> points, bool closed);
  /// Position and its first two derivatives by the parameter s [m]; an open curve goes on straight beyond its ends.
  struct Point {
    Vec3 x, dx, ddx;
  };
  Point at(double s) const;
  /// Parameter of the point nearest to x.
  double nearest(const Vec3& x) const;
  double length() const { return s_.back(); }  // of its chords [m]
  bool closed() const { return closed_; }

 private:
  bool closed_;
  std::vector<double> s_;    // of the points, the first again at the end of a closed curve
  std::vector<Vec3> x_, m_;  // points and second derivatives
};

}  // namespace hilo
