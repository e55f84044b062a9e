// SPDX-License-Identifier: GPL-3.0-or-later
// A corridor that pulses shall stay in, as a test's specification gives it: lowest and highest change of acceleration over time, per axis.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "post/injury/measures.hpp"

namespace hilo {

struct Corridor {
  struct Side {
    std::vector<double> t, low, high;  // [s], [g]
    bool covers(double time) const {
      const double slack = 1e-9 * (t.back() - t.front());
      return time >= t.front() - slack && time <= t.back() + slack;
    }
  };
  std::array<std::optional<Side>, 3> axis;  // x, y, z
  std::string path;
};

/// CSV with the columns t and, for one axis at least, x_low and x_high (y_, z_), and no others.  Straight between its rows, silent before
/// and after them.
Corridor read_corridor(const std::string& path);

/// Largest distance of a signal from the corridor, 0 inside; not a number where the corridor has none of its times.
double outside(const Corridor::Side& side, const std::vector<double>& t, const std::vector<double>& x);

/// Adds measures "outside_x" ... for the axes that the corridor has.  Warns where a largest change lies before or after the corridor.
void add_corridor(std::vector<Crew>& crew, const Corridor& corridor);

}  // namespace hilo
