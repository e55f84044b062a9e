// SPDX-License-Identifier: GPL-3.0-or-later
// Time integrators of the rigid-flexible system.  Each turns the unknown end of a step into stages of the system's residual.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "dynamics/extrapolation.hpp"
#include "dynamics/integrator/law_rates.hpp"
#include "dynamics/newton.hpp"
#include "dynamics/predictor.hpp"
#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

/// Loads at the instant a step ends belong to the step: the value from the left where a table jumps there.
inline Stage from_left(Stage s, double h) {
  if (s.t0 == s.t1) s.t0 -= 1e-9 * h;
  return s;
}

/// Directors back to orthonormal to round-off, so that lengths do not drift over millions of steps.
void restore_rotations(const System& system, Config& q);

/// Velocities and accelerations of what moves by a law at an instant that ends a step or stage: they come from the law, not from the
/// update formulas, which would make a jump of them ring for ever (v1 = 2 dq/h - v0).
class GivenRates {
 public:
  void at(const System& system, double t, const Config& like);
  /// Accelerations become the mean ones of the step from v0 to here.
  void mean_from(const Config& v0, double h);
  void put(Config* v, Config* a) const;

 private:
  const System* system_ = nullptr;  // null: nothing moves
  Config v_, a_;
};

/// What a step is solved with.
struct StepTools {
  const System& system;
  KktSolver& solver;
  NewtonOptions newton;
  std::function<std::unique_ptr<KktSolver>()> another_solver = {};  // like it, for matrices beside those of the step
};

/// A stage of an accepted step with its multipliers: for work, and the last one for reactions.
struct Taken {
  Stage stage;
  std::vector<double> lambda;
};

/// Energies of a step besides what its stages do [J].
struct Besides {
  double work = 0;        // of what moves by a law
  double dissipated = 0;  // by the method
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string name() const = 0;
  /// Of the error of positions, where steps resolve the motion.
  virtual int order() const { return 2; }
  /// Solve a step of length h from s, first guess by `predictor`; s is left alone.  No convergence and no reason: the guess is the one that
  /// was tried last.
  virtual NewtonReport solve(const StepTools& tools, const State& s, double h, Predictor predictor) = 0;
  /// Positions, velocities and multipliers at the end of the step solved last; nothing is remembered yet.
  virtual void end(State& s) = 0;
  /// s becomes the end of the step solved last.
  virtual void accept(State& s) = 0;
  /// Stages of the step solved last; they refer to arrays of the integrator.
  virtual std::span<const Taken> taken() const = 0;
  /// Accelerations of the step solved last, and where in the step they and the multipliers belong: 1/2 the middle, 1 the end.
  virtual const Config& acceleration() const = 0;
  virtual double own_time() const = 0;
  /// Of the step solved last.
  virtual Besides besides() const { return {}; }
  /// Velocities at the end of the step accepted last, as results show them; null: those of its state.
  virtual const Config* velocity() const { return nullptr; }
  /// Whether State::a and State::jerk must be consistent with forces and constraints at the start and after a jump of the loads.
  virtual bool needs_acceleration() const { return false; }
  /// Steps are equal: correct the time of mechanisms of one degree of freedom (clock.hpp), where the method keeps energy.
  virtual void keep_time(const System&) {}
  /// The mechanisms whose time is corrected, by the names of their bodies.
  virtual std::vector<std::string> timed() const { return {}; }
  /// Forget history kept from earlier steps: the loads have jumped.
  virtual void restart() {}
  /// Between two steps: the structure of the system is another one; multipliers kept from earlier steps are laid out anew.
  virtual void carry(const Carry& carry) = 0;
  /// All that it remembers between two steps.  A matrix and its factors are given up, kept or restored: they are made anew on either side.
  virtual void archive(Archive& a, const System& system) = 0;
  /// Whether accelerations and multipliers alternate about the true ones from step to step, so that neighbours must be averaged.
  virtual bool alternates() const { return false; }
};

/// Methods whose stages are solved one after another, each for one unknown configuration.
class StageIntegrator : public Integrator {
 public:
  NewtonReport solve(const StepTools& tools, const State& s, double h, Predictor predictor) final;
  void end(State& s) final;
  void accept(State& s) final;
  std::span<const Taken> taken() const final { return taken_; }
  Besides besides() const final { return {.work = laws_.work()}; }
  void restart() final { past_.clear(), laws_.forget(), forget(); }
  void carry(const Carry& carry) final {
    for (Extrapolation& p : past_) p.carry(carry);
    laws_.carry(carry), tried_h_ = 0;
  }
  void archive(Archive& a, const System& system) final {
    a(name(), past_, laws_);
    archive_history(a, system);
  }

  /// Start a step of length h from s, which outlives the step.
  virtual void begin(const System& system, const State& s, double h) = 0;
  /// Stage k for its unknown; the last call for k before that for k + 1 had the accepted one.
  virtual Stage stage(int k, const Unknown& u) = 0;

 protected:
  virtual int n_stages() const { return 1; }
  virtual double instant(int) const { return 1; }  // of stage k's unknown, in units of the step
  /// Velocities at the end of the step solved last.
  virtual void end_velocity(Config& v) = 0;
  /// Accelerations where they are the mean ones of a step, (v1 - v0)/h, as v1 = 2 dq/h - v0 implies: rows that follow laws then need
  /// LawRates.  Null: other formulas.
  virtual Config* mean_acceleration() { return nullptr; }
  /// The step is accepted with end velocities v: history.
  virtual void finish(const Config& v) = 0;
  /// Its own history, at a restart.
  virtual void forget() {}
  /// The same, kept or restored; between two steps.
  virtual void archive_history(Archive& a, const System& system) = 0;

 private:
  NewtonReport stages(const StepTools& tools, const State& s, double h, Predictor predictor);
  bool is_tried(const System& system, double h);

  double h_ = 0;
  Predictor predictor_ = Predictor::hold;  // of the step solved last
  const System* system_ = nullptr;
  std::vector<Unknown> solved_;              // per stage
  std::vector<Extrapolation> past_;          // per stage
  std::vector<std::vector<double>> missed_;  // what the first guess of each stage missed
  std::vector<double> tried_;                // the first guess of the step tried last, as increments,
  double tried_h_ = 0;                       // and its length; 0: the step was accepted
  std::vector<Taken> taken_;
  std::vector<double> lambda_;
  LawRates laws_;
  State begun_;  // the start of the step with what laws add to it
};

}  // namespace hilo
