// SPDX-License-Identifier: GPL-3.0-or-later
// Clocks of mechanisms of one degree of freedom.
//
// Such a mechanism runs along a fixed curve, and a method that keeps its energy has the right speed at every place of it: what is left of
// the error is the time of arrival.  A step of length tau goes q1 - q0 = tau (v0 + v1)/2, and the motion takes the time T for it,
//   q1 - q0 = T/2 (v0 + v1) + T^2/12 (a0 - a1) + O(T^5),
// so that in the metric of the mass, along the velocity,
//   tau = T - T^3/12 (v.M j)/(v.M v),   j = da/dt.
// A step of that length ends T later to fourth order, and energy and momentum are kept as ever.
//
// Every mechanism has a clock of its own: what no joint and no spring connects does not feel how long the step of another is.  The
// correction fades out, so that what does little changes little,
// - where dampers, friction or motors make the speed itself wrong: the share falls to a half where what they take in a step is 0.02 of
//   v.Mv omega T, omega^2 = |v.M j|/v.Mv (of an oscillator: where it is damped by a hundredth of critical);
// - where forces change by the time and not by the place: their impulse is exact at equal steps alone;
// - where a step does not resolve the motion (an impact).
#pragma once
#include <deque>
#include <string>
#include <vector>

#include "dynamics/integrator.hpp"
#include "system/system.hpp"

namespace hilo {

/// Rigid mechanisms of one degree of freedom that nothing moves from outside: their bodies.
std::vector<std::vector<int>> mechanisms_of_one_freedom(const System& system);

class Clocks {
 public:
  explicit Clocks(const System& system);
  bool empty() const { return mechanisms_.empty(); }
  std::vector<std::string> names() const;
  /// Plan a step from velocities v at t that shall take the time T [s].
  void plan(const Config& v, double t, double T);
  /// T over the length of the step planned last, for each body.
  const std::vector<double>& tempo() const { return tempo_; }
  /// The step planned last is taken: v at its end, a in its middle.
  void accept(const Config& v, const Config& a, const Taken& taken);
  void restart();
  void archive(Archive& a) { a("clocks", mechanisms_, group_, tempo_, v_, a_, T_); }

 private:
  struct Node {
    double vMv = 0, vMj = 0;  // [J, W/s]
    double share = 1;         // of the correction that is taken
  };
  struct Mechanism {
    std::vector<int> bodies;
    std::deque<Node> nodes;  // instants between steps, the last first; of that one the jerk is not known yet
    double tau = 0;          // of the step planned last [s]
    double taken = 0;        // by dampers in the last step, or given by motors [J]
    double all = 0;          // change of M a between the last two steps: a.M a [N^2/kg]
    double changed = 0;      // by the time alone over the step planned last: f.M^-1 f [N^2/kg]
    double owed = 0;         // tau - T still to come for steps whose ends' jerks are known [s]
  };
  void inner(const Config& v, const Config& w, std::vector<double>& out) const;
  double excess(const Node& from, const Node& to) const;
  static double own_share(const Mechanism& m);
  const System& system_;
  std::vector<Mechanism> mechanisms_;
  std::vector<int> group_;  // mechanism of each body, or -1
  std::vector<double> tempo_;
  std::vector<double> vMv_, vMj_, jMj_, changed_, taken_;  // of the mechanisms
  Config v_, a_, jerk_;  // at the last instant; in the middle of the step before it, or empty; times T between two middles
  double T_ = 0;         // of the step planned last [s]
};

}  // namespace hilo
