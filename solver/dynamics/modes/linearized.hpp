// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of small motions about a state, by what their matrices do to vectors.
#pragma once
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "dynamics/modes/about_state.hpp"
#include "dynamics/start/start.hpp"

namespace hilo {

/// Products with K, M and C about a state, and with the inverse of K + s M on the motions that joints and supports allow.
class Linearized : AboutState {
 public:
  using Vector = Eigen::VectorXd;
  /// `load_factor`: of the loads that act at the state.
  Linearized(const System& system, KktSolver& solver, const State& rest, double load_factor = 1)
      : AboutState(system, solver, rest), load_factor_(load_factor), none_(rest.lambda.size(), 0.0), base_mass_(mass_residual(zero_)) {}
  Eigen::Index n() const { return n_; }
  const System& system() const { return system_; }

  /// Forces of inertia.  Accelerations are taken so large that the rounding of stiff cells, which is in the residual too, is small beside.
  Vector mass_of(const Config& acceleration) const {
    const double factor = typical_acceleration_ / std::max(1e-300, system_.largest_rate(acceleration));
    Config a;
    combine(a, {{factor, &acceleration}});
    return (mass_residual(a) - base_mass_) / factor;
  }
  Vector mass(const Vector& x) const { return mass_of(rates(state_.q, x)); }
  /// The mean of the squared frequencies, most of them of single cells.
  double mean_omega2() {
    std::mt19937_64 random{7};
    std::normal_distribution<double> normal;
    Vector x(n_);
    double mean = 0;
    for (double& value : x) value = normal(random);
    for (int twice = 0; twice < 2; ++twice) {
      mean = std::abs(x.dot(stiffness(x)) / x.dot(mass(x)));
      if (!std::isfinite(mean) || mean == 0) mean = 1;
      typical_acceleration_ = std::max(mean, 1.0) * system_.length;
    }
    return mean;
  }

  /// About K x, by differences of the residual between a little motion to either side.
  Vector stiffness(const Vector& x) const {
    const double step = 1e-5 * system_.length / std::max(1e-300, system_.largest_rate(rates(state_.q, x)));
    Vector out[2];
    for (const int side : {0, 1}) {
      const double by = side == 0 ? -step : step;
      Config q = state_.q;
      const std::vector<double> z = padded(x * by);
      system_.move(q, z);
      Residual r;
      system_.evaluate(stage(q), state_.lambda, r, nullptr);
      out[side] = free_part(r.r);
    }
    return (out[1] - out[0]) / (2 * step);
  }

  /// What pushes at the state, of the loads their share.
  Vector forces() const {
    Residual r;
    system_.evaluate(stage(state_.q), state_.lambda, r, nullptr);
    return -free_part(r.r);
  }
  Config rates_of(const Vector& x) const { return rates(state_.q, x); }

  /// What loads and gravity push with at the state.
  Vector loads() const {
    Vector out[2];
    for (const int on : {0, 1}) {
      Stage s = stage(state_.q);
      s.load_factor = on;
      Residual r;
      system_.evaluate(s, state_.lambda, r, nullptr);
      out[on] = free_part(r.r);
    }
    return out[0] - out[1];
  }

  /// C v, by rates too small for friction to slip, over ways that rounding does not see; with `dampers`, or of mass alone.
  Vector damping_of(const Config& rate, bool dampers = true) const {
    const double speed = 1e-6 * system_.length / std::max(1e-300, system_.largest_rate(rate)), h = 10;
    Vector out[2];
    for (const int moving : {0, 1}) {
      Config v, before, after;
      combine(v, {{moving * speed, &rate}});
      combine(before, {{1, &state_.q}, {-h / 2, &v}});
      combine(after, {{1, &state_.q}, {h / 2, &v}});
      Stage s = stage(state_.q);
      s.v = &v, s.no_impacts = true;
      if (dampers) s.w0 = &before, s.w1 = &after, s.h = h;
      Residual r;
      system_.evaluate(s, state_.lambda, r, nullptr);
      out[moving] = free_part(r.r);
    }
    return (out[1] - out[0]) / speed;
  }
  Vector damping(const Vector& x) const { return damping_of(rates(state_.q, x)); }

  /// K + s M becomes the matrix of the solver.
  void factor(double shift) {
    Stage s = stage(state_.q);
    s.mass_slope = shift;
    Residual r;
    system_.evaluate(s, state_.lambda, r, &solver_);
    sigma_ = r.sigma;
  }
  /// Motion and multipliers under the forces b; what is left of the equations, over |b|.
  double solve(const Vector& b, Vector& x, std::vector<double>* mu = nullptr) const {
    std::vector<double> rhs = padded(b), z(rhs.size(), 0.0);
    const SolveReport report = solver_.solve(rhs, z);
    if (!report.ok) throw Error("", "no modes: " + report.message, "a part may have neither mass nor support");
    x = Eigen::Map<const Vector>(z.data(), n_);
    if (mu) mu->assign(z.begin() + n_, z.end());
    for (size_t i = 0; mu && i < mu->size(); ++i) (*mu)[i] *= sigma_;
    return report.residual;
  }

 private:
  Stage stage(const Config& q) const {
    Stage s = stage_at(q, state_.t);
    s.a = &zero_, s.load_factor = load_factor_;
    return s;
  }
  Vector mass_residual(const Config& acceleration) const {
    Stage s = stage_at(system_.start, state_.t);
    s.left = s.end = &state_.q;
    s.slope = 0, s.chain = 1e-30;  // without stiffness
    s.a = &acceleration, s.mass_slope = 1;
    s.rates_alone = true, s.load_factor = 0;
    Residual r;
    system_.evaluate(s, none_, r, nullptr);
    return free_part(r.r);
  }
  double load_factor_;
  std::vector<double> none_;
  Vector base_mass_;
  double sigma_ = 1, typical_acceleration_ = 1;
};

}  // namespace hilo
