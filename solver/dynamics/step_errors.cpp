// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/step_errors.hpp"

#include "dynamics/step_control.hpp"

namespace hilo {

void StepErrors::begin(const State& s) { start_ = s.q, past_ = {{s.t, s.q}}, steps_ = 0, sum_ = 0; }

void StepErrors::follow(const System& system, const State& s, ErrorEstimate& estimate) {
  if (++steps_ % stride != 0) return;
  past_.push_back({s.t, s.q});
  if (past_.size() < 4) return;
  const double third = largest_third_derivative(system, {&past_[0].q, &past_[1].q, &past_[2].q, &past_[3].q},
                                                {past_[0].t, past_[1].t, past_[2].t, past_[3].t});
  const double since = s.t - past_[steps_ == 3 * stride ? 0 : 2].t, h = (s.t - past_[2].t) / stride;
  sum_ += since * h * h / 12 * third;
  past_.pop_front();
  estimate.add_up(s.t, sum_, apart(system, s.q, start_));
}

}  // namespace hilo
