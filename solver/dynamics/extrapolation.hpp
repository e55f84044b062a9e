// SPDX-License-Identifier: GPL-3.0-or-later
// What the first guess missed at the last steps, continued to the next one.
//
// The guess of dynamics/predictor is of low order; what it misses over equal steps is smooth, but for what alternates from step to step
// in methods without damping.  A combination of the last values that continues polynomials has the characteristic polynomial (x - 1)^m,
// one that continues an alternating part besides (x - 1)^m (x + 1).  The one that would have served the last step best is taken.
#pragma once
#include <array>
#include <deque>
#include <span>
#include <vector>

#include "system/system.hpp"

namespace hilo {

class Extrapolation {
 public:
  /// Increments to add to the guess of a step of length h (3 x n_blocks, multipliers' blocks zero), or nothing where there is no history.
  std::span<const double> increments(const System& system, double h);
  /// Multipliers to start from; `last` where nothing better is known.
  std::vector<double> multipliers(const std::vector<double>& last) const;
  /// A step of length h is accepted: what its guess missed, and its multipliers.
  void accept(const System& system, double h, std::vector<double> missed, std::vector<double> lambda);
  /// The multipliers are laid out anew.
  void carry(const Carry& carry) {
    for (Step& s : past_) s.lambda = carry(s.lambda);
  }
  void clear() { past_.clear(), rule_ = lambda_rule_ = 0; }
  void archive(Archive& a) { a("extrapolation", past_, h_, rule_, lambda_rule_); }

 private:
  static constexpr int n_rules = 9, most = 6;  // rules, and the steps they take
  struct Step {
    std::vector<double> missed, lambda;
    void archive(Archive& a) {
      a.increments(missed);
      a("step", lambda);
    }
  };
  std::deque<Step> past_;  // the last one first, of equal steps
  double h_ = 0;
  int rule_ = 0, lambda_rule_ = 0;
  std::vector<double> increments_;
};

}  // namespace hilo
