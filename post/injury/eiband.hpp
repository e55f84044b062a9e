// SPDX-License-Identifier: GPL-3.0-or-later
// Tolerance to a plateau of acceleration against its duration, as Eiband collected it [eiband-1959].  The corner points are approximate
// readings: an overlay to see where a run lies, never a limit.
#pragma once
#include <string>
#include <vector>

#include "post/injury/measures.hpp"

namespace hilo {

struct Tolerance {
  std::string name;  // "towards the head (+z)"
  size_t axis;       // 0 x, 1 y, 2 z
  int sign;
  std::vector<double> duration, level;  // [s], [g]; uninjured volunteers
};
const std::vector<Tolerance>& eiband_tolerances();

/// Durations [s] and the highest level [g] that the change of acceleration along sign * axis holds for each without a break.
struct HeldLevel {
  std::vector<double> duration, level;
};
HeldLevel levels_of(const Crew& crew, size_t axis, int sign);

/// Four panels on logarithmic axes, one for each direction: the tolerance, and what each sensor felt.
void write_eiband(const std::vector<Crew>& crew, double cfc, const std::string& title, const std::string& path);

}  // namespace hilo
