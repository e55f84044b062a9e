// SPDX-License-Identifier: GPL-3.0-or-later
// What a run knows of the error of its positions.
#pragma once
#include <string>
#include <vector>

namespace hilo {

struct Config;
class System;

/// The largest distance of a node, or of a point of a body as far from its centre as its size says, in two configurations [m].  Collective.
double apart(const System& system, const Config& a, const Config& b);

/// From the distance between two solutions, one of them at twice the step of the other.
///
/// Where the leading terms rule, of order p, the distance is 2^p - 1 times the error of the finer one, whatever the motion has made of
/// early errors on their way [hairner-norsett-wanner, II.4].  A distance that is no small part of the motion is taken for the error itself.
/// Where it grew exponentially until then the motion is called chaotic, and the error of the finer one goes on growing at that rate.
class ErrorEstimate {
 public:
  /// At time t the solutions are `apart` [m], and the finer one has moved by `moved` since the start [m]; its method is of this order.
  /// `added`: a measure of what its steps have added to the error until then, without what the motion made of it.
  void look(double t, double apart, double moved, int order, double added);
  /// Without a second solution: what the steps until t have added, `sum` [m], without what the motion made of it.
  void add_up(double t, double sum, double moved);
  bool is_sum() const { return is_sum_; }
  /// The coarser one could not take its step and took those of the finer one: there the distance says nothing.
  void split() { ++splits_; }
  int splits() const { return splits_; }
  /// There is none from here on, for this reason.
  void give_up(const std::string& why) { why_ = why; }
  /// The same, since the coarser one cannot go on: so coarse are the steps.
  void lose(const std::string& why) { why_ = why, is_lost_ = true; }
  bool is_given_up() const { return !why_.empty(); }
  bool is_lost() const { return is_lost_ || (!is_given_up() && is_halved()); }
  /// Why there is none, or "".
  std::string why() const { return why_.empty() && is_halved() ? "steps twice as long fail" : why_; }
  bool is_there() const { return why().empty() && t_ > 0; }

  double end() const { return error(apart_, t_); }  // at the time looked at last [m]
  double largest() const { return error(most_, most_t_); }
  double largest_t() const { return most_t_; }
  double motion() const { return motion_; }  // the longest way of a point from its start [m]
  /// What moves less than this is at rest [m]: rounding of positions.
  void at_rest_below(double way) { rest_ = way; }
  /// Of the motion, where anything moves.
  double share(double error) const { return motion_ > rest_ ? error / motion_ : 0; }
  /// Whether the motion made distances, small beside it, grow exponentially.
  bool is_chaotic() const { return growth() > 0; }
  /// What the motion makes of the rounding of the start until t, where it is chaotic, else 0 [m].
  double rounding(double t) const;
  /// Time after which positions mean nothing, the error being a fifth of the motion; infinite where there is none.
  double meaningless_from() const;
  void archive(class Archive& a);

 private:
  struct Sample {
    double t, most, added;  // largest distance until then
  };
  /// More than a tenth of its steps were those of the finer one.
  bool is_halved() const { return 10 * splits_ > looks_; }
  double error(double apart, double t) const;
  double growth() const;   // e-foldings a second, or 0
  double trusted() const;  // until then distances are small beside the motion [s]
  double grown(double t) const;
  int order_ = 99, splits_ = 0, looks_ = 0;
  double t_ = 0, apart_ = 0, most_ = 0, most_t_ = 0, motion_ = 0, rest_ = 0, spacing_ = 0;
  std::vector<Sample> samples_;
  std::string why_ = "";
  bool is_lost_ = false, is_sum_ = false;
};

}  // namespace hilo
