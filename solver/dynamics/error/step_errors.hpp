// SPDX-License-Identifier: GPL-3.0-or-later
// What the steps of a run add to the error of positions, from its positions alone.
#pragma once
#include <array>
#include <cmath>
#include <deque>

#include "dynamics/error/error_estimate.hpp"
#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

/// Of a method of second order with the phase error C: the sum of C h^3 |q'''| over the steps, of the point where it is largest. Vibrations
/// that steps do not resolve would add up in that sum for ever, and yet are off by about their amplitude.  So third differences are taken
/// over strides of 1, 2, 8 and 32 steps.  The longer the stride, the fewer vibrations are in its sum, and the larger the amplitude is, an
/// eighth of the largest difference, that it leaves out.  The least sum of both counts.  A stride of a period sees no vibration at all: so
/// what a stride leaves out is no less than what shorter ones do.  What the motion makes of early errors later is not in it.
class StepErrors {
 public:
  explicit StepErrors(double phase_error) : phase_error_(std::abs(phase_error)) {}
  /// From the state that the run starts from.
  void begin(const State& s);
  /// A step was taken, to s.  Collective.
  void follow(const System& system, const State& s, ErrorEstimate& estimate);
  void archive(Archive& a) { a("step errors", steps_, start_, levels_); }

 private:
  struct Past {
    double t;
    Config q;
  };
  struct Level {
    int stride = 1;
    double sum = 0, left_out = 0;  // of what steps add; amplitude of what is not in it [m]
    std::deque<Past> past = {};    // at most four
  };
  double phase_error_;  // C
  long steps_ = 0;
  Config start_;
  std::array<Level, 4> levels_{Level{1}, Level{2}, Level{8}, Level{32}};
};

}  // namespace hilo
