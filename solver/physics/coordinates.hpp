// SPDX-License-Identifier: GPL-3.0-or-later
// Forces along coordinates x(e) of a connector rather than along its measures e: an angle, a distance, the row of a joint.
//
// With the discrete gradient d of a coordinate, d.(e1 - e0) = x1 - x0, a force f along it acts as s = f d and does the work f (x1 - x0)
// of the step exactly.  So a law written for x keeps its energy statement: a potential stays conserved, friction stays dissipative.
// At an instant d is the gradient there, and dx/dt = d.de/dt: methods of high order keep their order with dampers.
#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "physics/force_law.hpp"
#include "physics/row_law.hpp"

namespace hilo {

/// A law of coordinates seen by the measures.
class OnCoordinates final : public SpringLaw {
 public:
  OnCoordinates(std::unique_ptr<RowLaw> coordinates, std::unique_ptr<SpringLaw> law)
      : coordinates_(std::move(coordinates)), law_(std::move(law)) {}
  void elastic(const Values& e0, const Values& e1, Response& out) const override;
  void viscous(const Values& r0, const Values& r1, const Interval& step, Response& out) const override;
  void commit(const Values& e, const Values& rate) override;
  bool needs_rate() const override { return law_->needs_rate(); }
  bool only_presses() const override { return law_->only_presses(); }
  void archive(Archive& a) override { coordinates_->archive(a), law_->archive(a); }
  bool conserves() const override { return law_->conserves(); }
  bool is_smooth() const override { return law_->is_smooth(); }
  std::string beyond(const Values& e) const override { return coordinates_->beyond(e); }

 private:
  using Slopes = std::array<Values, max_rows>;  // of coordinates, or forces along them, by the measures
  void spread(const RowLaw::Gradient& g, const Response& along, const Slopes& change, Response& out) const;
  void spread_step(const Values& e0, const Values& e1, const Response& along, Response& out) const;
  void add_change(const std::array<Values, max_measures>& D, const Slopes& coordinates_by_measures, Slopes& change) const;
  std::unique_ptr<RowLaw> coordinates_;
  std::unique_ptr<SpringLaw> law_;
};

/// Distance from its square, measure 0.
class Length final : public RowLaw {
 public:
  int n_rows() const override { return 1; }
  void values(const Values& e, double* x) const override;
  void gradient(const Values& e0, const Values& e1, Gradient& out) const override;
};

/// Independent linear springs and dampers: W = k/2 (x - free)^2, f = c dx/dt.
std::unique_ptr<SpringLaw> make_linear(std::vector<double> k, std::vector<double> c, std::vector<double> free = {});

/// Stop of one coordinate: W = k/2 <x - upper>^2 + k/2 <lower - x>^2 and, while it is touched, the damper of Hunt and Crossley that leaves
/// the fraction `restitution` of the speed of approach [hunt-crossley-1975].
struct StopLaw {
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
  double stiffness = 0, restitution = 1;
  double rest_speed = 1e-3;  // speeds of approach below it are damped as this one, so that a part at rest comes to rest
};
std::unique_ptr<SpringLaw> make_stop(const StopLaw& stop);

/// Motor: force over rate, piecewise linear, continued by its end segments; times the step's factor.
struct MotorLaw {
  std::vector<double> rate, force;
};
std::unique_ptr<SpringLaw> make_motor(MotorLaw motor);

/// Coulomb friction, regularised: the slip velocity has components lever_i dx_i/dt and magnitude u, the friction force is
/// coefficient * (preload + the step's load) * tanh(u/slip_velocity) against it, and acts on coordinate i through lever_i.
struct FrictionLaw {
  double coefficient = 0, preload = 0, slip_velocity = 1e-3;
  std::vector<double> lever;
};
std::unique_ptr<SpringLaw> make_friction(const FrictionLaw& friction);

}  // namespace hilo
