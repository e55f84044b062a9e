// SPDX-License-Identifier: GPL-3.0-or-later
// Velocities along rows that follow laws: drives of joints, and rows of which an end moves.  At the ends of steps they are those of the
// laws.
//
// By v1 = 2 dq/h - v0 the mean (v0 + v1)/2 is the chord of the law, which misses its rate by c = O(h^2): (wh)^2/12 of the speed on a
// circle. A start that is as fast as the law would be 0, 2c, 0, 2c beside it for ever, and reactions would alternate by 2 m c/h, of first
// order in h.  So a step begins with impulses of the rows that add c, and ends with impulses that take away what is beside the law.  Both
// are part of the reactions; their sum is of order h^3.  c is known from the step before: half of what that one began and ended with.  A
// first step is solved twice.
#pragma once
#include <optional>
#include <vector>

#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

class LawRates {
 public:
  /// A step of length h begins: what velocities gain at its start; null: nothing.
  const Config* begin(double h);
  /// The step from s ends at positions q, with velocities v.  Whether it stands; else it is to be solved once more, with `again` at its
  /// start.
  bool end(const System& system, KktSolver& solver, const State& s, double h, const Config& q, const Config& v);
  const Config* again() const { return &begun_->v; }
  /// What velocities gain at the end; null: nothing.
  const Config* at_end() const { return ended_ ? &ended_->v : nullptr; }
  /// Of both ends: work [J], and what the rows add to multipliers and their bodies to mean accelerations over the step.
  double work() const { return (begun_ ? begun_->work() : 0) + (ended_ ? ended_->work() : 0); }
  void add_to(std::vector<double>& lambda, Config& acceleration, double h) const;
  void accept() { next_ = std::move(after_); }
  void forget() { next_.reset(), begun_.reset(); }
  void carry(const Carry& carry);
  void archive(Archive& a) { a("rates of laws", next_); }

 private:
  struct Kick {
    double h = 0;                 // of the step that it was found with
    std::vector<double> rates;    // of rows change by this,
    Config v;                     // velocities,
    std::vector<double> impulse;  // by this, laid out like multipliers
    double along = 0, own = 0;    // its work at the velocities before, and on what it adds [J]
    double work() const { return along + own; }
    void scale(double f);
    void archive(Archive& a) { a("kick", h, rates, v, impulse, along, own); }
  };
  using Kicked = std::optional<Kick>;
  static Kicked kick(const System& system, KktSolver& solver, const Config& q, const Config& v, double t, double kinetic,
                     std::vector<double> by, double h, double* sigma);

  Kicked begun_, ended_;  // of the step solved last,
  Kicked after_;          // of the start of the one after it,
  Kicked next_;           // of the one after the step accepted last
};

}  // namespace hilo
