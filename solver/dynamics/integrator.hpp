// Time integrators of the rigid-flexible system.  Each turns the unknown end of a step into stages of the system's residual.
#pragma once
#include <memory>
#include <span>
#include <string>

#include "dynamics/extrapolation.hpp"
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
};

/// A stage of an accepted step with its multipliers: for work, and the last one for reactions.
struct Taken {
  Stage stage;
  std::vector<double> lambda;
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string name() const = 0;
  /// Solve a step of length h from s, first guess by `predictor`; s is left alone.
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
  /// Whether State::a and State::jerk must be consistent with forces and constraints at the start and after a jump of the loads.
  virtual bool needs_acceleration() const { return false; }
  /// Steps are equal: correct the time of mechanisms of one degree of freedom (clock.hpp), where the method keeps energy.
  virtual void keep_time(const System&) {}
  /// The mechanisms whose time is corrected, by the names of their bodies.
  virtual std::vector<std::string> timed() const { return {}; }
  /// Forget history kept from earlier steps: the loads have jumped.
  virtual void restart() {}
  /// Whether accelerations and multipliers alternate about the true ones from step to step, so that neighbours must be averaged.
  virtual bool alternates() const { return false; }
  /// Whether its stages take materials that remember from the accepted state to the end of the step.
  virtual bool carries_state() const { return false; }
  /// Whether the balance of energy closes over every step, up to what Newton leaves.
  virtual bool keeps_energy() const { return false; }
};

/// Methods whose stages are solved one after another, each for one unknown configuration.
class StageIntegrator : public Integrator {
 public:
  NewtonReport solve(const StepTools& tools, const State& s, double h, Predictor predictor) final;
  void end(State& s) final;
  void accept(State& s) final;
  std::span<const Taken> taken() const final { return taken_; }
  void restart() final { past_.clear(), forget(); }

  /// Start a step of length h from s, which outlives the step.
  virtual void begin(const System& system, const State& s, double h) = 0;
  /// Stage k for its unknown; the last call for k before that for k + 1 had the accepted one.
  virtual Stage stage(int k, const Unknown& u) = 0;

 protected:
  virtual int n_stages() const { return 1; }
  virtual double instant(int) const { return 1; }  // of stage k's unknown, in units of the step
  /// Velocities at the end of the step solved last.
  virtual void end_velocity(Config& v) = 0;
  /// The step is accepted with end velocities v: history.
  virtual void finish(const Config& v) = 0;
  /// Its own history, at a restart.
  virtual void forget() {}

 private:
  double h_ = 0;
  Predictor predictor_ = Predictor::hold;  // of the step solved last
  const System* system_ = nullptr;
  std::vector<Unknown> solved_;              // per stage
  std::vector<Extrapolation> past_;          // per stage
  std::vector<std::vector<double>> missed_;  // what the first guess of each stage missed
  std::vector<Taken> taken_;
  std::vector<double> lambda_;
};

/// Energy-momentum: mid-point inertia and constraint gradients, discrete-gradient stress [simo-tarnow-1992, betsch-steinmann-2001].
/// chi adds dissipation chi/2 C (E1 - E0) to the stress of flexible parts.
std::unique_ptr<StageIntegrator> make_energy_momentum(double chi);
/// Mid-point rule: everything at (q0 + q1)/2, stress included.
std::unique_ptr<StageIntegrator> make_mid_point();
/// Generalized-alpha for index 3 in the form of Arnold and Bruls [arnold-bruls-2007]; Newmark, HHT and WBZ are members of it.
struct AlphaParameters {
  double alpha_m, alpha_f, beta, gamma;
};
AlphaParameters generalized_alpha(double rho);
AlphaParameters hht(double rho);  // rho at infinite frequency, 1/2 to 1
AlphaParameters wbz(double rho);
std::unique_ptr<StageIntegrator> make_generalized_alpha(const AlphaParameters& p, const std::string& name = "generalized-alpha");
/// Generalized single-step single-solve family of Zhou and Tamma, U0 (zero-order overshoot in displacement) or V0 (in velocity)
/// [zhou-tamma-2004]; averaged: stress at the averaged strain, B((1-w) q0 + w q1)^T C [(1-w) E0 + w E1].
std::unique_ptr<StageIntegrator> make_zhou_tamma(bool velocity_family, const double rho[3], bool averaged);
/// Composite of trapezoidal rule and three-point backward difference [bathe-2007].
std::unique_ptr<StageIntegrator> make_bathe();
/// Two-step backward difference formula at changing steps, started by one step of backward Euler.
std::unique_ptr<StageIntegrator> make_bdf2();
/// Three-stage Radau IIA for index 3, all stages solved together; for references, serial [hairer-wanner-1996].
std::unique_ptr<Integrator> make_radau(std::unique_ptr<SerialKktSolver> solver = make_light_solver());
/// The integrator that [time] asks for.
std::unique_ptr<Integrator> make_integrator(const Entry& time);
/// Why the method chosen is known to fail, or "" where it is not [docs/stability.md].
std::string known_weakness(const Entry& time, const System& system);

}  // namespace hilo
