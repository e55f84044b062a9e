// SPDX-License-Identifier: GPL-3.0-or-later
// The audit of a run: what is known exactly is checked at every step, before the step is accepted.
//
//   energy      |dE - dW + dD - N|, where the method keeps it  <= bound x largest kinetic energy so far + rounding,
//                                                               of n steps sqrt(n) times that of one
//               N, what Newton left: the work of its residual, and of multipliers as rows open: the tolerance, and told
//               |N|                                          <= max(1e-4, bound) x all energies that came or went
//   joint rows  |g|, of the rows kept and of those dropped   <= bound x length of the scene
//   slip        of rows of velocities that were dropped      <= 1 % of the largest speed + 10 times that of the rows kept
//   turn        of every body and cell over the step         <= 2 rad: at half a turn (R0 + R1)/2 loses rank, and with it equations vanish
//   everything finite; det F of every cell above zero (Newton's report; between its points System::fault)
//
// with bound = max(1e-8, 10 solver.tolerance) of energy and max(1e-9, 20 solver.tolerance) of rows: Newton leaves up to ten of the latter.
#pragma once
#include <cmath>
#include <span>
#include <string>

#include "base/json.hpp"
#include "dynamics/integrator.hpp"

namespace hilo {

inline constexpr double turn_limit = 2;  // of a part in a step [rad]

/// Energies at an instant, the work and dissipation until then [J], and how far joints are open.
struct Ledger {
  Energy energy;
  double work = 0, dissipated = 0, balance = 0;  // balance: E - E0 - W + D
  double left = 0;                               // of it, what Newton left
  Violation rows;
};

class Audit {
 public:
  /// `energy_unchecked`: why the balance of energy is not checked, or "".
  Audit(const System& system, std::string energy_unchecked, double tolerance);
  /// The state before the first step.
  void start(const State& s);
  /// The step from q0 to `end`: why it cannot be accepted, or "".  `load_factor` is that of a static analysis;
  /// `besides`: energies besides those of `taken`; `before`: the forces at the start of a load step,
  /// whose work is that of the mean of both; `followed`: the way was gone in shorter moves, so it may turn any far.
  std::string look(const Config& q0, const State& end, std::span<const Taken> taken, const NewtonReport& newton, double load_factor = 1,
                   const Besides& besides = {}, const Taken* before = nullptr, bool followed = false);
  /// The step looked at last is accepted.
  void accept(double t);
  /// Work of an impulse between two steps [J].
  void push(double work) { sums_.work += work; }
  /// Whether the step looked at last opens a row that was dropped as redundant.
  bool opens_dropped_row() const { return opens_dropped_row_; }
  /// The account at the end of the step accepted last.
  const Ledger& ledger() const { return now_; }
  /// At the end of the run: why it must not be called complete, or "".
  std::string verdict() const;
  /// Largest |E - E0 - W + D| over the largest kinetic energy; NaN where nothing ever moved but by rounding.
  double balance() const;
  double violation() const { return worst_.rows.worst(); }
  double least_det() const { return worst_.det.det; }
  /// The verdict as a JSON object; `failure`: why the run stopped, or "".
  Json json(const std::string& failure) const;
  void archive(Archive& a) {
    a("audit", t_, E0_, start_, rounding_, moving_, n_steps_, largest_, unexplained_, gaps_, now_, sums_, worst_, opens_dropped_row_);
  }

 private:
  std::string slipping(const State& end);
  double opened(const std::vector<double>& gaps, std::span<const Taken> taken);
  /// Of all steps, where each rounds by `one`, either way.
  double rounded(double one) const { return one * std::sqrt(n_steps_ + 1); }
  struct Worst {                                      // of the accepted steps, each with its time
    double step = 0, step_t = 0, sum = 0, sum_t = 0;  // energy, over what it is judged by
    struct Left {
      double part = 0, t = 0;
    } left;
    Violation rows;
    double kept_t = 0, dropped_t = 0;
    System::Turn turn;
    double turn_t = 0, det_t = 0;
    LeastDet det;
  };
  const System& system_;
  std::string energy_unchecked_;
  double energy_bound_, left_bound_, row_bound_;
  bool opens_dropped_row_ = false;
  double t_ = 0, E0_ = 0, rounding_ = 0, moving_ = 0, n_steps_ = 0, largest_ = 0;  // largest kinetic energy; largest |E - E0 - W + D| [J]
  double unexplained_ = 0;                                                         // largest without what Newton left [J]
  Energy start_;
  std::vector<double> gaps_, gaps_next_;  // of the rows, laid out like lambda; those of velocities begin each step at 0
  Ledger now_, next_;
  struct Sums {
    double work = 0, dissipated = 0, left = 0;
  } sums_;
  double step_ = 0, sum_ = 0, left_ = 0, moving_next_ = 0, rounding_next_ = 0;  // of the step looked at last
  System::Turn turn_;
  LeastDet det_;
  Worst worst_;
};

}  // namespace hilo
