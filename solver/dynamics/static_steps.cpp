// SPDX-License-Identifier: GPL-3.0-or-later
// Load steps of a static analysis: equal ones, halved where one fails, that end where a history breaks.
//
// A step that ends where equilibrium is not stable has jumped over the branch that bends away, or stands behind a point where branches
// part: it is halved too, then left along the motion that grows.  So is one that jumps to another branch (dynamics/jump), which is told.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/jump.hpp"
#include "dynamics/linear_step.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start/from_rest.hpp"
#include "dynamics/start/held.hpp"
#include "dynamics/start/soft_contacts.hpp"
#include "dynamics/start/stability.hpp"
#include "dynamics/start/start.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

class StaticSteps final : public Steps {
 public:
  StaticSteps(RunParts& run, Pause pause) : Steps(run, std::move(pause)) {
    const Entry& time = run_.scene.table("time");
    n_ = static_cast<int>(time.number("steps"));
    end_ = time.has("end") ? time.number("end") : 1;
    at_.step = 1.0 / n_;
    for (const UsedHistory& used : run_.system.histories)
      for (const History::Break& b : used.history.breaks()) breaks_.push_back(b.t / end_);
  }

  void archive(Archive& a) override { a("static steps", at_, soft_.begins_soft); }

  void take() override {
    System& system = run_.system;
    State& state = run_.state;
    if (at_.done == 0) {
      if (!touching(system)) require_held(system, state.q, end_ / n_, 1.0 / n_, run_.scene.table("time").where("analysis"));
      run_.audit->start(state);
      record_rest(state, 0);
    }
    system.commit(state.q), system.settle(false);  // where the first step begins, also of a run that goes on
    Progress progress(run_.options.quiet || system.comm->rank != 0, 0, 1);
    no_acceleration_.resize_like(state.q);  // zeros without a sign
    State reached = state;
    std::string why;  // of the first failure since the last good state, or that a cell would be inside out
    while (at_.done < 1 - 1e-12) {
      double next = step_end();
      NewtonReport r;
      std::string failure = try_step(next, reached, r);
      const bool shorter = at_.step > std::ldexp(1.0 / n_, -std::min(5, run_.max_cuts));
      if (failure.empty() && unstable_ && !at_.unstable && shorter) {
        at_.ahead = {reached, next, 0};
        failure = "the equilibrium is not stable: " + unstable_->text;
      } else if (failure.empty() && jump_ > 0 && shorter) {
        at_.ahead = {reached, next, jump_};
        failure = jumped(next);
      } else if (!failure.empty() && at_.ahead && !system.traits().remembers) {  // too near to where the branch ends
        next = at_.ahead->next, r = {};
        failure = go_ahead(reached);
      } else if (failure.empty()) {
        failure = leave(next, reached);
      }
      if (!failure.empty()) {
        if (before_rest_) run_.recall(*before_rest_);
        system.commit(state.q), system.settle(false);
        if (why.empty() || r.least_det.det <= 0) why = failure;
        const bool free = at_.done == 0 && touching(system) && !unheld(system, system.start).empty();  // it comes to rest soon, or hardly
        if (ends_ || at_.step <= std::ldexp(1.0 / n_, -(free ? 2 : run_.max_cuts))) {
          if (at_.least.det < 0.01 && r.least_det.det > 0) why += "; " + system.inside_out(at_.least);
          if (r.least_det.det > 0 && !r.is_round_off)
            why += !touching(system) && at_.done == 0 && !rests_unloaded()
                       ? "; springs or motors push without the loads where the scene is drawn: analysis = \"dynamic\" or \"modes\" with "
                         "time.start = \"equilibrium\" finds its rest"
                   : touching(system)
                       ? "; a part may slide where friction holds no more, or part from what holds it: a run in time shows where it goes"
                       : "; where a structure bears no more, analysis = \"path\" finds the limit and goes past it";
          return run_.stop(why + unheld(system, system.start));
        }
        ++run_.report.cuts;
        do at_.step /= 2;
        while (step_end() >= next);
        continue;
      }
      why.clear(), at_.least.take(r.least_det);
      run_.audit->accept(reached.t);
      run_.recorder->step(reached, run_.audit->ledger(), taken_, no_acceleration_, r.iterations);
      system.settle(true);
      std::swap(state, reached);
      if (at_.ahead && (next >= at_.ahead->next || system.traits().remembers)) at_.ahead.reset();
      at_.unstable_states += at_.unstable;
      if (!unforeseen_) at_.ways.last = 0;
      if (jump_ > 0) tell_jump(next);
      ++run_.report.steps;
      at_.done = next, at_.step = std::min(1.0 / n_, 2 * at_.step);
      progress.show(at_.done, run_.report.steps, r.iterations);
      if (const std::string stop = pause_(); !stop.empty() && at_.done < 1 - 1e-12) {
        progress.done();
        return run_.stop(stop);
      }
    }
    progress.done();
    run_.report.t = state.t;
    if (examined_) run_.figures.unstable = at_.unstable_states;
    if (!at_.jumps.empty())
      run_.lists.emplace_back("jumps", Json::list_of(
                                           at_.jumps,
                                           [](const Jumped& j) -> Json {
                                             return {{"from", {j.from, 12}}, {"to", {j.to, 12}}, {"way", {j.way, 6}}};
                                           },
                                           Json::In::lines));
    if (run_.talk && is_large())
      fmt::print(stderr, "stability was not examined: beyond {} unknowns it would cost more than the load steps\n", 3 * most_blocks);
    else if (run_.talk && !examined_)
      Stability::tell_unknown(run_.solver->name());
    run_.report.complete = true;
  }

 private:
  /// The next multiple of the step, or the break before it: where a load turns back, what remembers must have been.
  double step_end() const {
    double to = std::min(1.0, (std::floor(at_.done / at_.step + 1e-9) + 1) * at_.step);
    for (const double b : breaks_)
      if (b > at_.done + 1e-9 && b < to - 1e-9) to = b;
    return to;
  }

  /// A step to the share `next` of the loads: why it cannot be accepted, or "".
  std::string try_step(double next, State& reached, NewtonReport& r) {
    search(0);
    ends_ = false, before_rest_.reset();
    System& system = run_.system;
    const State& state = run_.state;
    reached.t = next * end_;
    NewtonOptions options = run_.newton;
    options.least_share = 0.03;  // a smaller step costs less
    LoadStep step{state.t, at_.done};
    r = soft_.find(step, reached.t, next, options, reached.q, reached.lambda);
    const bool sharp = r.least_det.det > 0 && at_.step <= std::ldexp(1.0 / n_, -4);  // a sharp bend
    // steps from rest put what moves by a law in its place at once, so that friction drags nothing any more: shorter steps are tried first
    const bool shorter_first =
        at_.done > 0 && system.moves() && system.traits().slides && at_.step > std::ldexp(1.0 / n_, -std::min(3, run_.max_cuts));
    const bool from_rest = !r.converged && !shorter_first && (sharp || touching(system));
    if (from_rest) {
      system.commit(state.q), system.settle(false);
      before_rest_ = system.memory();
      State at = state;
      const RestReport rest = come_to_rest(run_, at, {reached.t, next});
      r = rest, ends_ = rest.ends;
      run_.report.iterations += r.iterations;
      reached.q = at.q, reached.lambda = at.lambda;
    }
    unstable_.reset(), jump_ = 0;
    bool factored = false;
    if (r.converged && !is_large()) {
      Stability stability(system, *run_.solver, reached.t, next);
      unstable_ = stability.look(reached.q, reached.lambda);
      examined_ = stability.known(), factored = stability.factored();
    }
    if (!r.converged) return r.reason;
    if (const std::string far = system.too_far(state.q, reached.q); !far.empty()) return far;
    if (!unstable_ && !(from_rest && at_.done == 0) && ((examined_ && !is_large()) || r.iterations > few_iterations))
      jump_ =
          BranchJump(system, *run_.solver, options)
              .between({state.q, state.lambda, state.t, at_.done}, {reached.q, reached.lambda, reached.t, next}, step.foreseen, factored);
    unforeseen_ = jump_ > 0 && touching(system) && at_.ways.shorten(at_.done, next, jump_);
    if (unforeseen_) jump_ = 0;
    take(reached, next);
    const std::string fault = system.fault(reached.q);
    return fault.empty() ? look(reached, r, next) : fault;
  }

  /// Whether the first state, without the loads, is at rest.
  bool rests_unloaded() {
    Stage s = stage_at(run_.state.q, 0);
    s.a = &no_acceleration_, s.load_factor = 0, s.elapsed = slow;
    Residual r;
    assemble(run_.system, *run_.solver, s, run_.state.lambda, r, false);
    return run_.system.comm->max(relative_residual(run_.system, r)) < 1e-3;
  }

  /// What memory makes of a state, and its stage for what looks at it.
  void take(const State& reached, double next) {
    taken_ = {stage_at(reached.q, reached.t), reached.lambda};
    taken_.stage.elapsed = slow;
    run_.system.advance(taken_.stage);
    taken_.stage.a = &no_acceleration_, taken_.stage.load_factor = next, taken_.stage.work_from = &run_.state.q;
  }

  /// Its work is that of the mean of the forces at both ends of the step.
  std::string look(const State& reached, const NewtonReport& r, double next, bool followed = false) {
    const State& state = run_.state;
    Taken before{stage_at(state.q, state.t), state.lambda};
    before.stage.elapsed = slow, before.stage.a = &no_acceleration_, before.stage.load_factor = at_.done, before.stage.end = &reached.q;
    return run_.audit->look(state.q, reached, {&taken_, 1}, r, next, {}, &before, followed);
  }

  /// To the state that lies ahead: why it cannot be accepted, or "".
  std::string go_ahead(State& reached) {
    const auto& [to, next, jump] = *at_.ahead;
    reached = to, jump_ = jump, unstable_.reset();
    run_.system.commit(reached.q);
    if (jump == 0) unstable_ = Stability(run_.system, *run_.solver, reached.t, next).look(reached.q, reached.lambda);
    take(reached, next);
    const std::string fault = look(reached, {}, next);
    return fault.empty() ? leave(next, reached) : fault;
  }

  /// From a state that is not stable to one that is, and what has changed in words: why the step cannot be accepted, or "".
  std::string leave(double next, State& reached) {
    if (!unstable_) {
      if (at_.unstable) warn(place(), fmt::format("stable again at {:.4g} of the loads", next));
      return at_.unstable = false, "";
    }
    if (at_.unstable) return "";
    System& system = run_.system;
    const State unstable = reached;
    const std::string found = fmt::format("at {:.4g} of the loads the equilibrium is not stable: {}", next, unstable_->text);
    system.settle(false);
    const Kept memory = system.memory();
    if (Stability(system, *run_.solver, reached.t, next).leave(*unstable_, reached.q, reached.lambda, false, run_.newton)) {
      take(reached, next);
      if (system.fault(reached.q).empty() && look(reached, {}, next, true).empty()) {
        warn(place(),
             fmt::format("{}. The run goes on from a stable one, {:.3g} m away", found, system.largest_difference(unstable.q, reached.q)));
        return "";
      }
      system.recall(memory);
      reached = unstable;
    }
    warn(place(), found +
                      ". The run goes on along states that are not stable "
                      "(analysis = \"path\" shows where branches part)");
    system.commit(reached.q), take(reached, next);
    at_.unstable = true;
    return look(reached, {}, next);
  }
  std::string jumped(double next) const {
    return fmt::format("positions jump by {:.3g} m between {:.6g} and {:.6g} of the loads", jump_, at_.done, next);
  }
  void tell_jump(double next) {
    warn(place(), jumped(next) +
                      ", to another branch of equilibrium, as in a snap-through: analysis = \"path\" follows what lies between, "
                      "a run in time tells where it would come to rest");
    at_.jumps.push_back({at_.done, next, jump_});
  }
  bool is_large() const { return run_.system.layout.map.n_global > most_blocks; }
  std::string place() const { return run_.scene.table("time").where("analysis"); }

  int n_ = 1;                   // load steps asked for
  double end_ = 1;              // time of the full load [s]
  std::vector<double> breaks_;  // of the histories, shares of end_
  struct Ahead {
    State state;
    double next, jump;
  };
  struct Jumped {
    double from, to, way;  // of the loads; of positions [m]
  };
  struct Place {
    double done = 0, step = 1;  // shares of the loads
    LeastDet least;             // of the steps taken
    bool unstable = false;      // the last one
    long unstable_states = 0;
    UnforeseenWays ways;
    std::vector<Jumped> jumps;   // told
    std::optional<Ahead> ahead;  // the nearest state that is not stable, or on another branch
  } at_;
  SoftContacts soft_{run_};
  static constexpr int most_blocks = 30000;  // beyond, the count would cost more than the step
  std::optional<Unstable> unstable_;         // the step tried last
  bool examined_ = true;                     // whether it told
  bool ends_ = false;                        // it failed for what no shorter step mends
  double jump_ = 0;                          // of the step tried last [m], or 0
  bool unforeseen_ = false;                  // no jump, but a way that no tangent foresaw
  static constexpr int few_iterations = 5;   // a step that takes no more has not jumped, where telling would cost as much
  std::optional<Kept> before_rest_;          // what was remembered before steps from rest, of the step tried last
  Taken taken_;                              // of the step tried last
  Config no_acceleration_;
};

}  // namespace

std::unique_ptr<Steps> static_steps(RunParts& run, Pause pause) { return std::make_unique<StaticSteps>(run, std::move(pause)); }

}  // namespace hilo
