// SPDX-License-Identifier: GPL-3.0-or-later
// What the steps of a run add to the error of positions, from the positions of every fourth one.
#pragma once
#include <deque>

#include "dynamics/error_estimate.hpp"
#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

/// Of a method of second order with the phase error of the mid-point rule: the sum of h^3/12 |q'''| over the steps, of the point where it
/// is largest.  Vibrations so fast that steps do not resolve them count a 64th of what differences of neighbouring steps would make of
/// them: they stay as small as they are, however many steps follow.  What the motion makes of early errors later is not in it.
class StepErrors {
 public:
  /// From the state that the run starts from.
  void begin(const State& s);
  /// A step was taken, to s.  Collective.
  void follow(const System& system, const State& s, ErrorEstimate& estimate);
  void archive(Archive& a) { a("step errors", steps_, sum_, start_, past_); }

 private:
  static constexpr int stride = 4;
  struct Past {
    double t;
    Config q;
  };
  long steps_ = 0;
  double sum_ = 0;  // [m]
  Config start_;
  std::deque<Past> past_;  // at most four
};

}  // namespace hilo
