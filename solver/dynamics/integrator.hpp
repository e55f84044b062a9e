// One-step integrators of the rigid-flexible system.  Each turns the unknown end configuration into a Stage of the system's residual.
#pragma once
#include <memory>
#include <string>

#include "system/system.hpp"

namespace hilo {

/// State at an instant.  `a` is history of the integrator's own (generalized-alpha's auxiliary acceleration), empty where none is kept.
struct State {
  double t = 0;
  Config q, v, a;
  std::vector<double> lambda;  // multipliers of the last step, (3 x joint blocks)
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string name() const = 0;
  /// Start a step of length h from s.
  virtual void begin(const State& s, double h) = 0;
  /// The stage for an end configuration q1; it refers to arrays of the integrator and to q1.
  virtual Stage stage(const Config& q1) = 0;
  /// Accept q1: velocities and history of the end of the step.
  virtual void finish(State& s, const Config& q1) = 0;
  /// Accelerations of the accepted step, and where in the step they and its multipliers belong: 1/2 mid, 1 end.
  virtual const Config& acceleration() const = 0;
  virtual double own_time() const = 0;
  /// Whether a start acceleration consistent with forces and constraints is needed in State::a.
  virtual bool needs_acceleration() const { return false; }
};

/// Energy-momentum: mid-point inertia and constraint gradients, discrete-gradient stress [simo-tarnow-1992, betsch-steinmann-2001].
/// chi adds dissipation chi/2 C (E1 - E0) to the stress of flexible parts.
std::unique_ptr<Integrator> make_energy_momentum(double chi);
/// Generalized-alpha for index 3 in the form of Arnold and Bruls, spectral radius rho [arnold-bruls-2007].
std::unique_ptr<Integrator> make_generalized_alpha(double rho);

/// out = sum of factor * config over the list; all of one size.
void combine(Config& out, std::initializer_list<std::pair<double, const Config*>> terms);

}  // namespace hilo
