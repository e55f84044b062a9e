// SPDX-License-Identifier: GPL-3.0-or-later
// State of the system at an instant, and sums of configurations.
#pragma once
#include <initializer_list>
#include <utility>
#include <vector>

#include "physics/config.hpp"

namespace hilo {

struct State {
  double t = 0;  // [s]
  Config q, v;
  Config a, jerk, snap;        // consistent ones at the start and after a jump, for methods that keep such history; else empty
  Config across;               // beside them: what of the jerk is no velocity that the joints allow
  std::vector<double> lambda;  // multipliers of the last step, (3 x joint blocks)
};

/// out = sum of factor * config over the list, at most eight, all of one size; `out` may be one of them.
void combine(Config& out, std::initializer_list<std::pair<double, const Config*>> terms);

}  // namespace hilo
