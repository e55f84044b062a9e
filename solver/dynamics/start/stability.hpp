// SPDX-License-Identifier: GPL-3.0-or-later
// Stability of equilibrium: motions that the tangent does not resist, and the way from there to a state that is stable.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/newton.hpp"

namespace hilo {

/// An equilibrium that would leave by itself.
struct Unstable {
  int motions = 0;        // eigenvalues of the tangent below zero
  std::vector<double> z;  // the motion that grows fastest, its largest part a
                          // metre long; empty where mass does not tell it
  double rate2 = 0;       // square of the rate at which it grows [1/s^2]
  std::string text;       // what it would do
};

/// Looks at states under the loads at time t times `ramp`.  Direct solvers count eigenvalues; those that iterate leave it unknown.
/// Collective.
class Stability {
 public:
  Stability(System& system, KktSolver& solver, double t, double ramp) : system_(system), solver_(solver), t_(t), ramp_(ramp) {}

  /// What it would do, or nothing where it is stable, or where that is not known.
  std::optional<Unstable> look(const Config& q, const std::vector<double>& lambda);
  /// Whether look() could tell.
  bool known() const { return known_; }
  /// Whether the solver has the factors of the tangent looked at last: not where masses were added to it.
  bool factored() const { return factored_; }
  /// Says so in a line where it could not.
  static void tell_unknown(const std::string& solver);
  /// From an unstable state along its motion, to either side, down to the deeper stable equilibrium; false, and all as it was, where there
  /// is none. `mechanism`: as of equilibrium().
  bool leave(const Unstable& from, Config& q, std::vector<double>& lambda, bool mechanism, const NewtonOptions& options);

 private:
  struct Way {
    Config q;
    std::vector<double> lambda;
    double work = 0;  // done against the forces [J]
    Kept memory;      // of the contributions at its end
  };
  std::optional<int> below(const Config& q, const std::vector<double>& lambda, double mass);
  double curvature(const Config& q, const std::vector<double>& lambda, const std::vector<double>& z, double* noise);
  double dot(std::span<const double> a, std::span<const double> b) const;
  std::string told(const Unstable& u) const;
  std::optional<Way> descend(const Unstable& from, double side, const Config& q, const std::vector<double>& lambda, bool mechanism,
                             const NewtonOptions& options);
  Stage stage(const Config& q, double mass);

  System& system_;
  KktSolver& solver_;
  double t_, ramp_;
  bool known_ = false, factored_ = false;
  Config zero_;
  Residual r_;
};

}  // namespace hilo
