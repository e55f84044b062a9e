// SPDX-License-Identifier: GPL-3.0-or-later
// What takes part in a run: flexible cells, rigid bodies, joints, springs, loads, motions, measures, each a Contribution in one file, and
// one of each of the roles below that it plays.  The system and the recorder loop over roles and know no contribution by name; a new kind
// is one file, and a line in Builder::add_contributions.  A contribution holds many things of its kind (all cells, all joints), so that a
// call costs nothing beside its work.
//
// All ranks have the same contributions in the same order, also where a rank has nothing of one: functions may be collective.
#pragma once
#include <algorithm>
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "base/archive.hpp"
#include "base/joined.hpp"
#include "base/json.hpp"
#include "system/constraint.hpp"
#include "system/pass.hpp"

namespace hilo {

/// What integrators and solvers ask of what they solve.
struct Traits {
  bool deforms = false;       // flexible cells
  bool constrains = false;    // rows with multipliers
  bool has_rates = false;     // forces that follow rates
  bool is_pressed = false;    // forces that depend on multipliers beyond their rows
  bool is_driven = false;     // moves by a law
  bool remembers = false;     // state that a step moves on: plastic strain
  bool searches = false;      // its rows or cliques change from step to step
  bool is_thin = false;       // shells: they turn far in a correction, and swing before they settle
  bool lumps_masses = false;  // masses on the diagonal, outside of cliques
  bool slides = false;        // contacts that may have friction
  bool reaches = false;       // joins nodes of which the rank that evaluates it has no cell
  Traits& operator|=(const Traits& o) {
    deforms |= o.deforms, constrains |= o.constrains, has_rates |= o.has_rates;
    is_pressed |= o.is_pressed, is_driven |= o.is_driven, remembers |= o.remembers, searches |= o.searches;
    is_thin |= o.is_thin, lumps_masses |= o.lumps_masses, slides |= o.slides, reaches |= o.reaches;
    return *this;
  }
};

struct Energy {
  double kinetic = 0, elastic = 0, gravity = 0;          // [J]
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();  // [kg m/s], about the origin [kg m^2/s]
};

/// Over the step of a stage: work of loads, of motors and of prescribed motions, and dissipation of rate terms; at its end, what the
/// dissipation of the integrator stores of what it took [J].
struct Work {
  double external = 0, dissipated = 0, stored = 0;
  /// Of a stage's Dissipation; `form(from, to, last, before)`: (D - last D1 - before D2).C D, D the change from `from` to `to`, D1 and D2
  /// those of the steps before `from`.
  template <class Form>
  void add(const Stage& s, const Form& form) {
    if (!s.dissipation) return;
    const Dissipation& d = *s.dissipation;
    constexpr double g = 0.57735026918962576, whole = 2. / 3 - g / 2, mixed = g - 1. / 3, past = 1. / 3 - g / 2;  // of Psi
    const double D1 = form(*d.one, *s.e0, 0, 0), D2 = form(*d.two, *d.one, 0, 0);
    // D1.D2 from the square of their sum
    const double mixed_before = (form(*d.two, *s.e0, 0, 0) - D1 - D2) / 2;
    const double at_end = d.kappa * (whole * form(*s.e0, *s.e1, -mixed / whole * d.share1, 0) + past * d.share1 * d.share1 * D1);
    const double at_start = d.kappa * (whole * D1 + mixed * d.share_before * mixed_before + past * d.share_before * d.share_before * D2);
    stored += at_end;
    dissipated += d.kappa * form(*s.e0, *s.e1, d.last(), d.before()) - (at_end - at_start);
  }
};

/// Largest |g| of the constraint rows that are kept and of those dropped as redundant [m, 1], with the multiplier blocks (from the first
/// one on) that they belong to, or -1.
struct Violation {
  double kept = 0, dropped = 0;
  int kept_block = -1, dropped_block = -1;
  double worst() const { return std::max(kept, dropped); }
};

/// The largest turn of a body or a cell: cos^2(angle/2), and who.
struct Turned {
  double cos2 = 1;
  int part = -1, item = -1;
  void look(double c2, int of_part, int of_item) {
    if (!(c2 >= -1)) c2 = -1;  // not finite
    if (c2 < cos2) cos2 = c2, part = of_part, item = of_item;
  }
};

/// How bodies hang together: mechanisms, for clocks of their own (dynamics/clock).
class Ties {
 public:
  explicit Ties(size_t n_bodies) : joined_(n_bodies), freedoms_(n_bodies, 0), excluded_(n_bodies, 0) {}
  /// Bodies are connected.
  void connect(int a, int b) { joined_.join(a, b); }
  /// So many freedoms less of the mechanism of body b.
  void hold(int b, int rows) { freedoms_[b] -= rows; }
  /// The mechanism of body b is flexible, or moved from outside.
  void exclude(int b) { excluded_[b] = 1; }
  int root(int b) { return joined_.root(b); }
  int freedoms(int b) const { return freedoms_[b]; }
  bool is_excluded(int b) const { return excluded_[b] > 0; }
  std::vector<double>& excluded() { return excluded_; }

 private:
  Joined<> joined_;
  std::vector<int> freedoms_;
  std::vector<double> excluded_;  // some contributions know their part of the model alone: summed over the ranks
};

/// Positions, velocities and, where given, accelerations at an instant, with positions moved along them, over ways as long as the scene.
struct Rates {
  const Config &q, &v;
  const Config* a;
  double t;
  double tau, sigma;  // q + tau v, q - tau v [s]; q + sigma a, q - sigma a [s^2]
  Config forward, backward, up, down;
};

/// A velocity that a law makes jump at an instant.
struct Jump {
  double by = 0, scale = 0;  // and the largest rate that occurs [m/s, or as the law]
  std::string who;           // `motion "m"`
  double told = 0;           // by how much, in `unit`
  const char* unit = "";
};

using NodalForces = std::vector<std::pair<int, Vec3>>;  // node, force [N]

/// An array of the results that a contribution fills: /history/GROUP/NAME, of which unit and meaning are in model/schema.cpp.  Its numbers
/// are `n_end` that belong to the end of a step and `n_mid` that belong to its inside, which the recorder takes to the end.
struct Output {
  std::string group, name;
  int n_end = 0, n_mid = 0;
  /// The row from both; null: the one and then the other.
  std::function<void(const double* end, const double* mid, std::vector<double>& row)> row = nullptr;
  bool only_presses = false;  // mid: forces that begin and end at any instant, never below zero
};

class System;

/// A stage that is taken: with multipliers and accelerations, for outputs and work.
class Moment {
 public:
  Moment(const System& system, const Stage& s, std::span<const double> lambda, std::span<const double> shared, const Config* a)
      : s(s), lambda(lambda), shared(shared), a(a), system_(system) {}
  /// Another stage of the same system.
  Moment(const Moment& other, const Stage& s, std::span<const double> lambda) : Moment(other.system_, s, lambda, lambda, nullptr) {}
  const Stage& s;
  std::span<const double> lambda;  // multipliers
  std::span<const double> shared;  // the same, in minimum norm where rows are redundant
  const Config* a;                 // accelerations of the step
  /// Forces of everything, before reduction; found when first asked for.  Collective.
  const Forces& forces() const;

 private:
  const System& system_;
  mutable std::optional<Forces> forces_;
};

/// An accepted step as observers see it, or the state before the first one.
struct Sight {
  double t;                       // of its end [s], or its number
  const Config &q, &v;            // at its end
  const Moment* step;             // null: before the first step
  std::vector<double>&end, &mid;  // numbers of the outputs, put behind: of the end, and where there is a step of its inside
};

/// What every contribution says.
class Contribution {
 public:
  virtual ~Contribution() = default;
  virtual Traits traits() const { return {}; }
  /// "12 joints", for the line that tells what a scene has; "": not told.  Collective.
  virtual std::string count() const { return {}; }
  /// Once, before anything is numbered; may be collective.
  virtual void prepare() {}
  /// All that it remembers from accepted steps.
  virtual void archive(Archive& /*a*/) {}
};

/// Terms of the equations of motion.
class Equations {
 public:
  /// Its blocks of multipliers and its cliques, again whenever the structure changes: what it is called with is all that it depends on.
  virtual void number(Layout& /*layout*/) {}
  /// What can meet in the step of length h [s] that begins at q with velocities v (null in statics); true where its rows or cliques become
  /// others.  Between steps, and at the start.  May be collective; the answer need not be the same on all ranks, rows must be.
  virtual bool search(const Config& /*q*/, const Config* /*v*/, double /*h*/) { return false; }
  virtual void evaluate(Pass& p) const = 0;
  /// The share, in (0, 1], of the way from one configuration to another that a correction of Newton's may go: cells stay whole, gaps are
  /// not run through.  This rank's answer.
  virtual double longest_share(const Config& /*from*/, const Config& /*to*/) const { return 1; }
  /// This rank's share; of work, over the step from s.from() to s.end.
  virtual void add_energy(const Config& /*q*/, const Config& /*v*/, Energy& /*sum*/) const {}
  virtual void add_work(const Moment& /*m*/, Work& /*sum*/) const {}
  /// What the unknowns of a local block belong to (`region "r", at node 7`), or "".
  virtual std::string owner(int /*block*/) const { return {}; }
  /// How it connects, holds or moves bodies.  There is no default: what is forgotten here would make clocks wrong without a word.
  virtual void tie(Ties& ties) const = 0;
};

/// Rows with multipliers.
class Constraining {
 public:
  /// Those that may depend on others, by the thing that has them; blocks are numbered.
  virtual void add_constraints(std::vector<std::unique_ptr<Constraint>>& /*out*/) {}
  /// Marks those that are always kept and are no Constraint, laid out like lambda.
  virtual void mark_rows(std::vector<char>& /*on*/) const {}
  virtual void look_at_rows(const Config& /*q*/, double /*t*/, double /*factor*/, Violation& /*worst*/) const {}
  /// First and, where given, second derivatives by time of its rows less their courses, laid out like lambda.
  virtual void add_row_rates(const Rates& /*at*/, std::vector<double>& /*rate*/, std::vector<double>* /*acceleration*/) const {}
};

/// Nodes and bodies that move by a law.
class Prescribing {
 public:
  /// Whether there are any.
  virtual bool moves() const = 0;
  virtual void prescribe(Config& q, double t, double ramp) const = 0;
  virtual void prescribe_rates(double t, Side side, Config* v, Config* a) const = 0;
  virtual void copy_prescribed(const Config& from, Config& to) const = 0;
  /// Why a step from t0 to t1 is too long, or "".
  virtual std::string too_far(double t0, double t1) const = 0;
};

/// Laws whose velocities jump.
class Jumping {
 public:
  /// Velocities that jump at t from `before` to `after`; `slack`: rates of the rows with those before, laid out like lambda.  Collective.
  virtual void add_jumps(double t, const Config& before, const Config& after, std::span<const double> slack,
                         std::vector<Jump>& jumps) const = 0;
};

/// Loads that are known before the run.
class Loading {
 public:
  /// Forces on nodes at their reference positions, one list for each direction that they may take as a region turns below them.
  virtual void add_reference_forces(std::vector<NodalForces>& list) const = 0;
};

/// State that goes on from step to step; Contribution::archive keeps it.
class Stateful {
 public:
  /// Why q cannot be, or "" ("joint \"j\" ran off the end of its curve"); the same on all ranks.
  virtual std::string fault(const Config& /*q*/) const { return {}; }
  /// Why a step from rest at q0 to rest at q1 is too long, or ""; the same on all ranks.
  virtual std::string too_far(const Config& /*q0*/, const Config& /*q1*/) const { return {}; }
  /// The state at the end of a step of this stage, beside the accepted one, which evaluations go on from until settle().
  virtual void advance(const Stage& /*stage*/) {}
  /// What advance() found becomes the accepted state, or is forgotten.
  virtual void settle(bool /*accepted*/) {}
  /// Accept q, with velocities v where they are known, as the state to go on from.
  virtual void commit(const Config& /*q*/, const Config* /*v*/) {}
};

/// What is chosen within a step and not solved for: which facet a point meets; Newton's method asks for it.
class Revising {
 public:
  /// Chooses again by an answer that Newton's method has converged to; true where the equations became others by it.  May be collective;
  /// the answer need not be the same on all ranks.
  virtual bool revise(const Stage& stage) = 0;
  /// Whether it has anything to choose; the same on all ranks.
  virtual bool chooses() const { return true; }
};

/// What turns as a whole: bodies, cells.
class Turning {
 public:
  virtual void look_at_turn(const Config& q0, const Config& q1, int part, Turned& most) const = 0;
  virtual std::string name(int item) const = 0;
  /// Free nodes that move about as one body, for the first guess of a step.
  virtual void add_groups(std::vector<std::vector<int>>& /*groups*/) const {}
};

/// What results are told beside fields: measures, reactions, modes.
class Observer {
 public:
  virtual std::vector<Output> outputs() const = 0;
  /// Called once for the start of a run and for every accepted step: its numbers, and what it keeps of the whole run.  Collective.
  virtual void observe(const Sight& at) = 0;
  /// What it has to say of the whole run, to run.json; warnings besides.  On rank 0.
  virtual void add_to_report(Json& /*run*/) const {}
};

/// What clocks of mechanisms ask; `group`: of each body, or -1.
class Clocked {
 public:
  /// v.M w of the bodies of each group.
  virtual void add_inertia(std::span<const int> /*group*/, const Config& /*v*/, const Config& /*w*/, std::span<double> /*sum*/) const {}
  /// What forces do differently in [t, t + T] than in [t - T, t] by the time alone: f.M^-1 f of each group [N^2/kg].
  virtual void add_timed(std::span<const int> /*group*/, double /*t*/, double /*T*/, std::span<double> /*sum*/) const {}
  /// Energy that rate forces take from, or give to, each group in a step [J].
  virtual void add_taken(std::span<const int> /*group*/, const Stage& /*s*/, std::span<const double> /*lambda*/,
                         std::span<double> /*sum*/) const {}
};

/// The contributions by the roles that they play, in their order.
class Cast {
 public:
  template <std::derived_from<Contribution> T>
  void add(T& part) {
    const auto enter = [&]<class Role>(std::vector<Role*>& list) {
      if constexpr (std::derived_from<T, Role>) list.push_back(&part);
    };
    std::apply([&](auto&... list) { (enter(list), ...); }, lists_);
  }
  template <class Role>
  const std::vector<Role*>& all() const {
    return std::get<std::vector<Role*>>(lists_);
  }

 private:
  template <class... Roles>
  using Lists = std::tuple<std::vector<Roles*>...>;
  Lists<Equations, Constraining, Prescribing, Jumping, Loading, Stateful, Revising, Turning, Observer, Clocked> lists_;
};

}  // namespace hilo
