// SPDX-License-Identifier: GPL-3.0-or-later
// Where in a step an integrator takes which term.
#pragma once
#include "physics/config.hpp"

namespace hilo {

/// From which side an instant is reached: the end of a step from the left, its start from the right.
enum class Side { left = -1, right = 1 };

struct Collocation;

/// The stress that dissipates: kappa C (D - 2/3 share1 D1 - 1/3 share2 D2), D, D1, D2 the changes of strain over the step and the two
/// before. As D grows like h, it is of order h^2.  Its work over the step is the change of a store Psi >= 0 and what is lost,
///
///   Psi = kappa ((2/3 - g/2) |D|^2 + (g - 1/3) share1 D.D1 + (1/3 - g/2) |share1 D1|^2),   g = 1/sqrt(3), norms by C,
///   lost = kappa/2 |p D + (r - p) share1 D1 - r share2 D2|^2 >= 0,   p^2 = 2/3 + g,  r^2 = 2/3 - g   (shares 1)
///
/// so Psi with the energy never grows.  Shares fall where steps become shorter: less than the store of the steps before is then given back.
/// Of all such stresses of D, D1 and D2 it is the one that meets what alternates as much as it softens what is slow, which takes most of
/// what rings behind a front (docs/design-time.md).
struct Dissipation {
  double kappa = 0;
  const Config *one = nullptr, *two = nullptr;  // the starts of the step before, and of the one before that
  double share1 = 0, share2 = 0;
  double share_before = 0;  // share1 of the step before
  /// The stress is kappa C (D - last() D1 - before() D2).
  double last() const { return 2 * share1 / 3; }
  double before() const { return share2 / 3; }
};

/// How the unknown came to be what it is, for the stresses that a tangent foresees (physics/solid, `foresee`).
struct Correction {
  Config before, along;  // where it began, and the way from there to first order
};

/// Everything an evaluation needs besides the unknowns.
struct Stage {
  const Config* end;                         // q1, the unknown: increments and constraint rows live here
  const Config* left;                        // configuration of the left null space and of the constraint gradients
  double slope = 0.5;                        // d left / d end
  const Config *e0, *e1;                     // elastic pair: the ends of the step, or one configuration twice
  double weight = 0.5;                       // share of e1 in averages; 1/2 of two different ends means discrete gradients over the step
  double chain = 1;                          // d e1 / d end
  const Config *w0, *w1;                     // pair of the rate terms, rate = (e(w1) - e(w0))/h: v h/2 on either side of `left`
  double h = 0;                              // time between w0 and w1 [s]; 0: no rate terms
  double span = 0;                           // time that the stage stands for in the work of the rate terms [s]; 0: h
  const Config* a;                           // accelerations [m/s^2]
  const Config* v = nullptr;                 // velocities, for mass-proportional damping
  double mass_slope = 0;                     // d a / d end [1/s^2]
  const double* tempo = nullptr;             // step over the one by its own clock, of each body; null: 1
  double alpha_slope = 0;                    // d v / d end [1/s]
  const Dissipation* dissipation = nullptr;  // in flexible parts; null: none
  double t0 = 0, t1 = 0;                     // loads: mean over [t0, t1], or value at t0 = t1
  double t_end = 0;                          // time of `end`: driven joints
  const Config* work_from = nullptr;         // start of the step for System::work; null: e0
  const Config* v0 = nullptr;                // start velocities, where v1 = v0 + h a: there inertia works through h (v0 + v1)/2
  bool rates_alone = false;                  // how accelerations, rates and rows of velocities act on the equations of another stage
  double elapsed = 0;                        // of materials since their accepted state [s]; 0: nothing flows, infinite: too slow for rates
  const Correction* last = nullptr;          // Newton's, that led to e1; null: none
  double load_factor = 1;                    // of gravity and of the loads that are ramped
  const Collocation* step = nullptr;         // of a stage that shares its step with others: rows hold increments, forces keep energy
  int member = 0;                            // which of them this is
  bool slopes_of_end = false;                // of strains that are not of the second degree, where `weight` takes a mean: for buckling
  bool no_impacts = false;                   // restitution takes nothing: for motions so small that nothing meets
  bool fixed_friction = false;               // tangents without what the pressure adds to friction: for eigenvalues
  /// Derivatives of w0 and w1 by `end`.
  double slope0() const {
    const double x = slope - h * alpha_slope / 2;
    return x > 1e-12 || x < -1e-12 ? x : 0;  // w0 is the start of the step
  }
  double slope1() const { return slope + h * alpha_slope / 2; }
  /// Of the rate terms' work over h, what belongs to the stage.
  double share() const { return span > 0 ? span / h : 1; }
  bool conserving() const { return weight == 0.5 && e0 != e1; }
  const Config& from() const { return work_from ? *work_from : *e0; }
};

/// A stage that takes everything at one configuration: statics, and methods that enforce the equations of motion at an instant.
inline Stage stage_at(const Config& q, double t) {
  Stage s{};
  s.end = s.left = s.e0 = s.e1 = s.w0 = s.w1 = &q;
  s.slope = s.weight = s.chain = 1;
  s.t0 = s.t1 = s.t_end = t;
  return s;
}

}  // namespace hilo
