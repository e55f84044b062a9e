// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/error/companion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "dynamics/audit.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/start/start.hpp"
#include "system/springs.hpp"

namespace hilo {
namespace {

constexpr int most_cuts = 3;

/// What is done while it lives belongs to none of the phases of the run, but to the rest.  It warns of nothing: the run itself does.
class Aside {
 public:
  explicit Aside(const System& system) : system_(system) { quiet_warnings(true); }
  ~Aside() { phases() = before_, quiet_warnings(is_quiet() || system_.comm->rank != 0); }
  Aside(const Aside&) = delete;

 private:
  const System& system_;
  Phases before_ = phases();
};

}  // namespace

void Companion::renew_solver() { solver_ = make_solver_(); }

void Companion::begin(const State& s) {
  state_ = s, start_ = s.q, waiting_ = 0, begun_ = true;
  memory_ = system_.memory();
}

/// The system's memory becomes that of the other solution.
void Companion::swap_memory() {
  Kept now = system_.memory();
  system_.recall(memory_);
  memory_ = std::move(now);
}

void Companion::follow(const State& s, double added, ErrorEstimate& estimate) {
  if (++waiting_ == 2) catch_up(s, added, estimate);
}

void Companion::catch_up(const State& s, double added, ErrorEstimate& estimate) {
  if (waiting_ == 0 || estimate.is_given_up()) return;
  waiting_ = 0;
  const Aside aside(system_);
  swap_memory();
  const bool there = step(s.t, 0, estimate);
  swap_memory();
  if (!there)
    return estimate.lose(fmt::format("a step twice as long {} at t = {:.4g} s",
                                     turns_far_ ? fmt::format("turns a part by more than {:g} rad", turn_limit) : "fails", state_.t));
  const int order = springs_are_smooth(system_) ? integrator_->order() : std::min(integrator_->order(), 2);  // kinks leave no more
  estimate.look(s.t, apart(system_, s.q, state_.q), apart(system_, s.q, start_), order, added);
}

void Companion::restart(const State& of_run, bool strikes, double jerk_step) {
  const Aside aside(system_);
  state_.t = of_run.t;
  swap_memory();
  if (strikes) untold_.strike(system_, *solver_, state_, false);
  if (integrator_->needs_acceleration()) consistent_acceleration(system_, *solver_, state_, jerk_step);
  integrator_->restart();
  swap_memory();
}

bool Companion::step(double to, int cuts, ErrorEstimate& estimate) {
  if (try_step(to)) return true;
  system_.settle(false);
  if (turns_far_) return false;  // halved steps would be those of the run, and their distance nothing
  estimate.split();
  const double middle = (state_.t + to) / 2;
  return cuts < most_cuts && step(middle, cuts + 1, estimate) && step(to, cuts + 1, estimate);
}

bool Companion::try_step(double to) {
  StepTools tools{system_, *solver_, newton_, make_solver_};
  turns_far_ = false;
  for (const Predictor p : {Predictor::rigid_rotation, Predictor::velocity, Predictor::hold}) {
    tools.newton.reach = p == Predictor::rigid_rotation ? 1 : newton_.reach;
    tools.newton.least_share = p == Predictor::hold ? newton_.least_share : 0.1;
    if (!integrator_->solve(tools, state_, to - state_.t, p).converged) continue;
    integrator_->end(reached_);
    system_.advance(integrator_->taken().back().stage);
    turns_far_ = system_.largest_turn(state_.q, reached_.q).angle > turn_limit;
    if (turns_far_ || !system_.fault(reached_.q).empty()) continue;
    integrator_->accept(state_);
    state_.t = to;
    system_.commit(state_.q, &state_.v);
    system_.settle(true);
    return true;
  }
  return false;
}

void Companion::archive(Archive& a) {
  a("companion", begun_, waiting_, state_, start_, untold_);
  if (!begun_) return;
  if (a.restores()) memory_ = system_.memory();
  swap_memory();
  system_.archive(a);
  integrator_->archive(a, system_);
  swap_memory();
  if (!a.restores()) renew_solver();
}

}  // namespace hilo
