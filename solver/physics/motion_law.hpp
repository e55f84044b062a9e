// SPDX-License-Identifier: GPL-3.0-or-later
// The law of a prescribed motion: one coordinate as a function of time, the same for [[motion]] and for what drives a joint.
#pragma once
#include "base/history.hpp"

namespace hilo {

/// A prescribed coordinate at an instant, with its derivatives by time.
struct Course {
  double value, rate, acceleration;
};

/// x(t) = scale h(t), or x(t) = scale int_0^t h where the history is that of a rate.  Without a history of its own a coordinate follows
/// the load steps of a static analysis.
class MotionLaw {
 public:
  MotionLaw() = default;  // rests at 0
  MotionLaw(double scale, bool is_rate, History history, bool ramped);
  /// At t, the derivatives those of the side on which `near` lies; `factor` is that of the load step.
  Course at(double t, double near, double factor = 1) const;
  Course at(double t) const { return at(t, t); }
  /// By how much its rate jumps at t; instants `near` and closer are one.
  double jump(double t, double near) const;
  /// The largest rate of its ramps were they straight, to compare jumps with.
  double top_rate() const;

 private:
  double scale_ = 0;
  bool is_rate_ = false, ramped_ = false;
  History history_{{0}, {1}};
};

/// A row that is held to a law: g = law(t).
struct Drive {
  int row = -1;
  MotionLaw law;
  const char* unit = "";  // of its rate
};

}  // namespace hilo
