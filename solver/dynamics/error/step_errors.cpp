// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/error/step_errors.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/error/step_control.hpp"

namespace hilo {

void StepErrors::begin(const State& s) {
  start_ = s.q, steps_ = 0;
  for (Level& level : levels_) level = {level.stride, 0, 0, {{s.t, s.q}}};
}

void StepErrors::follow(const System& system, const State& s, ErrorEstimate& estimate) {
  ++steps_;
  double least = 1e300, left_out = 0;
  for (Level& level : levels_) {
    if (steps_ % level.stride == 0) {
      auto& past = level.past;
      past.push_back({s.t, s.q});
      if (past.size() == 4) {
        const double third = largest_third_derivative(system, {&past[0].q, &past[1].q, &past[2].q, &past[3].q},
                                                      {past[0].t, past[1].t, past[2].t, past[3].t});
        const double since = s.t - past[steps_ == 3 * level.stride ? 0 : 2].t, h = (s.t - past[2].t) / level.stride;
        level.sum += since * phase_error_ * h * h * third;
        level.left_out = std::max(level.left_out, third * std::pow((s.t - past[0].t) / 3, 3) / 8);
        past.pop_front();
      }
    }
    left_out = std::max(left_out, level.left_out);
    if (steps_ >= 3 * level.stride) least = std::min(least, level.sum + left_out);
  }
  if (steps_ % 4 == 0 && least < 1e300) estimate.add_up(s.t, least, apart(system, s.q, start_));
}

}  // namespace hilo
