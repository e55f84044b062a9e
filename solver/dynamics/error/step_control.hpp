// SPDX-License-Identifier: GPL-3.0-or-later
// Times the steps must hit, and the length of the next step from an estimate of the position error.
#pragma once
#include <array>
#include <deque>
#include <vector>

#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

/// An instant at which forces, or by a law of motion velocities, jump or have a kink.
struct Event {
  double t;
  bool jump;
};
/// Events inside (0, end), rising, of all histories of the system.  Where velocities or the values of loads jump they all count; kinks, and
/// jumps of prescribed accelerations, do where they are at least `step` apart from each other: what lies closer is a measured table, whose
/// mean over a step is exact anyway.
std::vector<Event> events(const System& system, double end, double step);

/// Of all points, from four positions of theirs at four times: the third derivative of what does not move by a law [m/s^3].  Collective.
double largest_third_derivative(const System& system, const std::array<const Config*, 4>& q, const std::array<double, 4>& t);

/// Second order: keeps the sum of local position errors e = h^3/2 |q[n+1, n, n-1, n-2]| (third divided difference, largest over all points)
/// at the demand by sharing it out evenly over the run.  Higher orders: keeps e itself at the demand, as a measure of how far a step goes
/// along the motion, so that steps are a smooth function of the motion and errors have leading terms.  Where the third derivative starts at
/// zero, as from rest, it is no measure of the error in velocity: sqrt(|q''| |q''''|), its like in harmonic motion, stands in for it during
/// the first 1/omega = sqrt(|q''|/|q''''|).
class StepControl {
 public:
  /// demand: largest e/h [m/s], or of a method of higher order e [m]; end: length of the run [s].
  StepControl(const System& system, int order, double demand, double end, double largest_step);
  /// Start, or go on after a jump: earlier positions are taken from the state's own derivatives.  Sets the first length.
  void restart(const State& s);
  double step() const { return step_; }
  /// Whether a step of length h to q1 is good enough; if not, step() is shorter.
  bool accept(const Config& q1, double h);
  /// The step failed.
  void cut(double h);
  double sum() const { return sum_; }      // of e of accepted steps [m]
  double added() const { return added_; }  // in proportion to the sum of their local errors
  void archive(Archive& a) { a("step control", demand_, step_, sum_, added_, calm_, t_, started_, first_third_, fade_, past_); }

 private:
  double error(const Config& q1, double h) const;  // largest over all points [m]
  const System& system_;
  int order_;
  double demand_, end_, largest_, step_ = 0, sum_ = 0, added_ = 0;
  int calm_ = 0;                                             // accepted steps since the last cut
  double t_ = 0, started_ = 0, first_third_ = 0, fade_ = 0;  // stand-in for |q'''| at the start [m/s^3], its time constant [s]
  struct Past {
    double t;
    Config q;
  };
  std::deque<Past> past_;  // three, the last is q_n
};

}  // namespace hilo
