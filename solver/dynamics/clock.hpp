// Clock of a mechanism of one degree of freedom that goes by itself.
//
// Such a mechanism runs along a fixed curve, and a method that keeps its energy has the right speed at every place of it: what is left of
// the error is the time of arrival.  A step of length tau goes q1 - q0 = tau (v0 + v1)/2, and the motion takes the time T for it,
//   q1 - q0 = T/2 (v0 + v1) + T^2/12 (a0 - a1) + O(T^5),
// so that in the metric of the mass, along the velocity,
//   tau = T - T^3/12 (v.M j)/(v.M v),   j = da/dt.
// A step of that length ends T later to fourth order, and energy and momentum are kept as ever.
#pragma once
#include <deque>

#include "dynamics/redundancy.hpp"
#include "dynamics/state.hpp"

namespace hilo {

/// Whether the system is rigid, has one degree of freedom, and nothing acts but constant forces and springs without dampers.
bool goes_by_itself(const System& system, const Redundancy& rows);

class Clock {
 public:
  explicit Clock(const System& system) : system_(system) {}
  /// Length of the step from velocities v that shall take the time T [s].
  double length(const Config& v, double T);
  /// The step planned last is taken: v at its end, a in its middle.
  void accept(const Config& v, const Config& a);
  void restart() { nodes_.clear(), a_ = {}; }

 private:
  struct Node {
    double vMv = 0, vMj = 0;  // [J, W/s]
  };
  double inner(const Config& v, const Config& w) const;
  double excess(const Node& from, const Node& to) const;
  const System& system_;
  std::deque<Node> nodes_;  // instants between steps, the last first; of that one the jerk is not known yet
  Config v_, a_;            // at the last instant; in the middle of the step before it, or empty
  double T_ = 0, tau_ = 0;  // of the step planned last [s]
  double owed_ = 0;         // tau - T still to come for steps whose ends' jerks are known [s]
};

}  // namespace hilo
