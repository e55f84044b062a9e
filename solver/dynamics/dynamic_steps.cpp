// SPDX-License-Identifier: GPL-3.0-or-later
// Steps in time, from event to event: equal ones, halved where one fails, or those that the tolerance chooses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "dynamics/choose_solver.hpp"
#include "dynamics/error/companion.hpp"
#include "dynamics/error/phase_error.hpp"
#include "dynamics/error/step_errors.hpp"
#include "dynamics/integrator_kinds.hpp"
#include "dynamics/predictor.hpp"
#include "dynamics/redundancy/contradiction.hpp"
#include "dynamics/redundancy/singular_start.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start/start.hpp"

namespace hilo {
namespace {

/// Blocks of unknowns of a scene whose error is estimated without being asked.
constexpr std::int64_t largest_estimated = 300;

class DynamicSteps final : public Steps {
 public:
  DynamicSteps(RunParts& run, Pause pause)
      : Steps(run, std::move(pause)),
        time_(run.scene.table("time")),
        end_(time_.number("end")),
        step_(longest_step(time_)),
        progress_(run.options.quiet || run.system.comm->rank != 0, 0, end_) {
    const StepPlan& plan = run_.plan;
    if (plan.asked > 0) control_.emplace(run_.system, run_.integrator->order(), plan.now().demand, end_, step_);
    take_estimate();
  }

  void archive(Archive& a) override {
    std::vector<Event> events = run_.events;
    a("dynamic steps", at_, events);
    if (control_) control_->archive(a);
    if (companion_) companion_->archive(a);
    bool by_steps = step_errors_.has_value();  // start() may have found that they tell nothing
    a("error by steps", by_steps);
    if (!by_steps) step_errors_.reset();
    if (step_errors_) step_errors_->archive(a);
    const auto same = [](const Event& x, const Event& y) { return x.t == y.t && x.jump == y.jump; };
    if (a.restores() && !std::ranges::equal(events, run_.events, same)) find_place();
  }

  void take() override {
    if (run_.report.steps == 0 && !start()) return;
    for (const std::vector<Event>& events = run_.events; at_.event < events.size(); ++at_.event, at_.begun = false) {
      const size_t i = at_.event;
      const double to = events[i].t;
      if (!at_.begun) {
        if (i == 0 || events[i - 1].jump || run_.integrator->needs_acceleration()) restart();
        if (i == 0) run_.audit->start(run_.state), record_start();
        if (companion_ && !companion_->has_begun() && !run_.redundancy.singular()) companion_->begin(run_.state);
        at_.begun = true, at_.step = at_.done = 0, at_.from = i == 0 ? 0 : events[i - 1].t;
      }
      if (!(control_ ? controlled_steps(to) : equal_steps(at_.from, to))) {
        progress_.done();
        return run_.stop(failure_);
      }
      if (companion_) companion_->catch_up(run_.state, added(), run_.estimate);
    }
    run_.figures.local = control_ && run_.integrator->order() == 2 ? control_->sum() : -1;
    progress_.show(end_, run_.report.steps, iterations_, true);
    progress_.done();
    if (failure_ = run_.audit->verdict(); !failure_.empty()) return run_.stop(failure_);
    run_.report.t = end_;
    run_.report.complete = true;
  }

 private:
  /// By what the error is estimated, or why by nothing.
  void take_estimate() {
    ErrorEstimate& estimate = run_.estimate;
    estimate.at_rest_below(1e-13 * run_.system.length);
    const std::string& word = time_.text("error_estimate");
    const bool large = run_.system.layout.map.n_global > largest_estimated, searches = run_.system.traits().searches;
    if (word == "never") return estimate.give_up("time.error_estimate has none");
    if (!control_ && (word == "steps" || (word == "auto" && (large || searches)))) {
      const std::string& method = run_.plan.now().method;
      if (const std::optional<double> phase = phase_error(time_, method)) return void(step_errors_.emplace(*phase));
      return estimate.give_up(fmt::format("steps alone tell the error of methods of second order, not of {}{}", method,
                                          method == Newmark::name ? " where gamma is not 1/2" : ""));
    }
    if (searches) return estimate.give_up("the structure of the scene changes from step to step");
    companion_.emplace(run_.system, integrator_kinds().at(run_.plan.now().method, time_.where("integrator")).make(time_), make_solver_,
                       run_.newton);
  }

  /// Positions and velocities to start from; false where there are none.
  bool start() {
    System& system = run_.system;
    State& state = run_.state;
    const Redundancy& redundancy = run_.redundancy;
    const std::vector<Active> rows = active_rows(system);
    set_rows(system, redundancy.at_pose);
    if (time_.text("start") == "equilibrium" && !settle_down(run_)) return false;
    run_.figures.projected = run_.impulses.strike(system, *run_.solver, state, run_.talk).change;
    if (const std::string name = contradicted_joint(system, state.q, state.v, 0); !name.empty())
      throw Error(run_.scene.path, fmt::format("joint \"{}\" cannot follow the driven joints", name),
                  "two drives, or a drive and a joint, hold the same motion: remove one");
    if (redundancy.singular()) leave_singular_position(rows);
    if (run_.talk && run_.figures.projected > 1e-9)
      fmt::print(stderr, "initial velocities changed by up to {:.3g} m/s to satisfy the joints\n", run_.figures.projected);
    system.commit(state.q, &state.v);
    if (!control_) {
      const std::vector<Active> now = active_rows(system);
      set_rows(system, rows);  // the freedoms of mechanisms are those beside a singular pose
      run_.integrator->keep_time(system);
      if (companion_) companion_->integrator().keep_time(system);
      set_rows(system, now);
    }
    const size_t clocks = run_.integrator->timed().size();
    if (clocks > 0 && step_errors_)
      step_errors_.reset(), run_.estimate.give_up("mechanisms go by clocks of their own, which no step tells of");
    if (step_errors_) step_errors_->begin(state);
    if (run_.talk)
      fmt::print(stderr, "integrator: {}{}\n", run_.integrator->name(),
                 clocks ? fmt::format(", {} mechanism{} of one degree of freedom on a clock of {} own", clocks, clocks > 1 ? "s" : "",
                                      clocks > 1 ? "their" : "its")
                        : "");
    return true;
  }

  /// The run goes on with other events, such as another end: which comes next.
  void find_place() {
    const double t = run_.state.t, same = run_.system.same_time;
    at_.event = 0;
    while (at_.event < run_.events.size() && run_.events[at_.event].t <= t + same) ++at_.event;
    at_.begun = at_.event == 0 || run_.events[at_.event - 1].t < t - same;
    at_.from = t, at_.step = at_.done = 0;
  }

  /// At a singular position mechanisms branch: the accelerations there tell which way, and velocities follow the joints a little ahead.
  void leave_singular_position(const std::vector<Active>& rows) {
    consistent_acceleration(run_.system, *run_.solver, run_.state, 0.05 * step_);
    run_.figures.projected = std::max(run_.figures.projected, follow_branch(run_.system, *run_.solver, run_.state, run_.redundancy, rows));
  }

  /// At the start and after a jump of the loads: history that belongs to the new forces.
  void restart() {
    System& system = run_.system;
    State& state = run_.state;
    if (state.t > 0 && system.traits().is_driven)
      run_.audit->push(run_.impulses.strike(system, *run_.solver, state, run_.talk).work);
    else if (state.t > 0 && run_.integrator->needs_acceleration() && system.traits().constrains)
      nearest_velocities(system, *run_.solver, state.q, state.v, state.t);  // they were off as before the jump
    const std::vector<Active> rows = active_rows(system);
    if (run_.report.steps == 0) set_rows(system, run_.redundancy.at_pose);
    if (run_.integrator->needs_acceleration() || control_) consistent_acceleration(system, *run_.solver, state, 0.05 * step_);
    set_rows(system, rows);
    run_.integrator->restart();
    if (control_) control_->restart(state);
    if (companion_ && companion_->has_begun()) companion_->restart(state, system.traits().is_driven, 0.05 * step_);
  }

  /// Rigid parts have their forces at the start as they are there; of what may vibrate between steps they come from the steps behind.
  void record_start() {
    Config a;
    std::vector<double> lambda;
    const bool known =
        run_.is_rigid && !run_.redundancy.singular() && find_acceleration(run_.system, *run_.solver, run_.state, a, lambda).empty();
    const Instant there(run_.state, std::move(a));
    run_.recorder->first(run_.state, run_.audit->ledger(), known ? &there.stage : nullptr, lambda);
  }

  /// Steps of equal length from `from` to `to`, up to a thousandth of one longer than asked for: the times of a table are rounded, and one
  /// more step would change them all.  Step k goes from k h to (k+1) h; a failed one is halved, level by level, and grows back at
  /// aligned instants.
  bool equal_steps(double from, double to) {
    const long n_steps = std::max(1l, std::lround(std::ceil((to - from) / step_ - 1e-3)));
    const long whole = 1l << run_.max_cuts;
    while (at_.step < n_steps) {
      const double t0 = from + (to - from) * static_cast<double>(at_.step) / static_cast<double>(n_steps),
                   t1 = from + (to - from) * static_cast<double>(at_.step + 1) / static_cast<double>(n_steps);
      const long piece = whole >> at_.level;
      const double a = t0 + (t1 - t0) * static_cast<double>(at_.done) / static_cast<double>(whole);
      const double b = at_.done + piece == whole ? t1 : t0 + (t1 - t0) * static_cast<double>(at_.done + piece) / static_cast<double>(whole);
      run_.state.t = a;
      if (try_step(b - a)) {
        at_.done += piece;
        accept(b);
        if (++at_.good >= 8 && at_.level > 0 && at_.done % (2 * piece) == 0) --at_.level, at_.good = 0;
        if (at_.done == whole) ++at_.step, at_.done = 0;
        if (is_stopped()) return false;
      } else if (at_.level < run_.max_cuts) {
        ++at_.level, cut();
      } else {
        return false;
      }
    }
    return true;
  }

  /// Steps chosen by the error they make, the last of them ending at `to`.  The last thirty are fitted in: one short step at the end would
  /// cost accelerations and multipliers their order there.  They are as many as make pairs for the second solution: a last one that both
  /// take says nothing of its error.
  bool controlled_steps(double to) {
    int failures = 0;
    StepControl& control = *control_;
    while (run_.state.t < to) {
      const double t = run_.state.t, left = to - t;
      double pieces = std::ceil(left / control.step() - 1e-6);
      if (pieces < 30 && companion_ && companion_->has_begun() && (std::lround(pieces) + companion_->waiting()) % 2 != 0)
        pieces += pieces > 8 && left / (pieces - 1) <= step_ ? -1 : 1;
      const double h = pieces < 30 ? left / pieces : control.step();
      if (!(t + h > t)) return failure_ = fmt::format("time.tolerance asks for steps of {:.2g} s", h), false;
      if (!try_step(h)) {
        if (++failures > run_.max_cuts) return false;
        control.cut(h), cut();
      } else if (!control.accept(reached_.q, h)) {
        ++run_.figures.rejected, run_.system.settle(false);
      } else {
        failures = 0;
        accept(pieces == 1 ? to : t + h);
        if (is_stopped()) return false;
      }
    }
    return true;
  }

  /// Between two steps: whether something from outside ends the run here.
  bool is_stopped() {
    const std::string why = pause_();
    if (why.empty() || run_.state.t >= run_.events.back().t) return false;
    failure_ = why;
    return true;
  }

  void cut() {
    ++run_.report.cuts, at_.good = 0;
    run_.system.settle(false);
    if (run_.redundancy.rank < run_.redundancy.rows && recheck_redundant_rows(run_.system, run_.state.q, run_.state.t, run_.redundancy) &&
        run_.talk)
      fmt::print(stderr, "t = {:.6g} s: another choice of independent joint rows\n", run_.state.t);
  }

  /// First guesses in the order in which they are tried: what led to a step where the first one did not comes first for a while.
  std::vector<Predictor> guesses() const {
    std::vector<Predictor> out;
    if (run_.redundancy.singular() && run_.report.steps == 0) out.push_back(Predictor::accelerated);
    if (at_.stay > 0) out.push_back(at_.guess);
    for (const Predictor p : {Predictor::rigid_rotation, Predictor::velocity, Predictor::hold})
      if (at_.stay == 0 || p != at_.guess) out.push_back(p);
    return out;
  }

  /// One step of length h from the state, trying first guesses in turn, the last one with patience; the state is left alone.
  bool try_step(double h) {
    search(h);
    StepTools tools{run_.system, *run_.solver, run_.newton, make_solver_};
    const State& state = run_.state;
    const std::vector<Predictor> order = guesses();
    for (const Predictor p : order) {
      tools.newton.reach = p == Predictor::rigid_rotation ? 1 : run_.newton.reach;
      tools.newton.least_share = p == order.back() ? run_.newton.least_share : 0.1;
      const NewtonReport r = run_.integrator->solve(tools, state, h, p);
      run_.report.iterations += r.iterations;
      iterations_ = r.iterations;
      if (!r.converged) {
        if (!r.reason.empty()) failure_ = r.reason;
        continue;
      }
      run_.integrator->end(reached_), reached_.t = state.t + h;
      run_.system.advance(run_.integrator->taken().back().stage);
      failure_ = run_.system.fault(reached_.q);
      if (failure_.empty()) failure_ = run_.audit->look(state.q, reached_, run_.integrator->taken(), r, 1, run_.integrator->besides());
      if (!failure_.empty()) continue;
      if (at_.stay > 0)
        --at_.stay;
      else if (p == Predictor::velocity || p == Predictor::hold)
        at_.guess = p, at_.stay = 8;
      return true;
    }
    return false;
  }

  /// To the error, by steps so far: equal ones add as much as any other.
  double added() const { return control_ ? control_->added() : run_.state.t; }

  /// The step tried last becomes the state, at time t.
  void accept(double t) {
    State& state = run_.state;
    run_.integrator->accept(state);
    state.t = t;
    run_.system.commit(state.q, &state.v);
    run_.audit->accept(t);
    run_.recorder->step(state, run_.audit->ledger(), run_.integrator->taken().back(), run_.integrator->acceleration(), iterations_,
                        run_.integrator->velocity());
    run_.system.settle(true);
    ++run_.report.steps;
    if (step_errors_) step_errors_->follow(run_.system, state, run_.estimate);
    if (companion_ && companion_->has_begun())
      companion_->follow(state, added(), run_.estimate);
    else if (companion_)  // two steps at once may leave a singular position by another branch
      companion_->begin(state);
    progress_.show(t, run_.report.steps, iterations_);
  }

  const Entry& time_;
  double end_, step_;                   // of the run, of a step at most [s]
  std::optional<StepControl> control_;  // where the tolerance chooses the steps
  std::function<std::unique_ptr<KktSolver>()> make_solver_ = [this] { return choose_solver(run_.scene, run_.system, false); };
  std::optional<Companion> companion_;     // where the error is estimated by a second solution,
  std::optional<StepErrors> step_errors_;  // and where by its steps alone
  struct Place {
    size_t event = 0;                   // the one that steps go to
    bool begun = false;                 // from the one before,
    double from = 0;                    // at this time [s]
    long step = 0, done = 0;            // equal steps since then; parts of this one, of 2^max_cuts
    int level = 0, good = 0;            // how often steps are halved; steps since the last cut
    Predictor guess = Predictor::hold;  // of the next steps first,
    int stay = 0;                       // this many
  } at_;
  State reached_;        // of the step tried last,
  std::string failure_;  // and why it cannot be accepted
  int iterations_ = 0;   // of Newton
  Progress progress_;
};

}  // namespace

std::unique_ptr<Steps> dynamic_steps(RunParts& run, Pause pause) { return std::make_unique<DynamicSteps>(run, std::move(pause)); }

}  // namespace hilo
