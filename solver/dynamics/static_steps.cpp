// SPDX-License-Identifier: GPL-3.0-or-later
// Load steps of a static analysis: equal ones, halved where one fails, that end where a history breaks.
#include <algorithm>
#include <cmath>

#include "dynamics/held.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start.hpp"

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

  void archive(Archive& a) override { a("static steps", at_); }

  void take() override {
    System& system = run_.system;
    State& state = run_.state;
    if (at_.done == 0) {
      require_held(system, state.q, end_ / n_, 1.0 / n_, run_.scene.table("time").where("analysis"));
      run_.audit->start(state);
      run_.recorder->first(state, run_.audit->ledger());
    }
    Progress progress(run_.options.quiet || system.comm->rank != 0, 0, 1);
    combine(no_acceleration_, {{0, &state.q}});
    State reached = state;
    std::string why;  // of the first failure since the last good state, or that a cell would be inside out
    while (at_.done < 1 - 1e-12) {
      const double next = step_end();
      NewtonReport r;
      if (const std::string failure = try_step(next, reached, r); !failure.empty()) {
        system.commit(state.q), system.settle(false);
        if (why.empty() || r.least_det.det <= 0) why = failure;
        if (at_.step <= std::ldexp(1.0 / n_, -run_.max_cuts)) {
          if (at_.least.det < 0.01 && r.least_det.det > 0) why += "; " + system.inside_out(at_.least);
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
    System& system = run_.system;
    const State& state = run_.state;
    reached.q = state.q, reached.lambda = state.lambda, reached.t = next * end_;
    NewtonOptions options = run_.newton;
    options.least_share = 0.03;  // a smaller step costs less
    r = equilibrium(system, *run_.solver, reached.q, reached.lambda, reached.t, next, false, options);
    run_.report.iterations += r.iterations;
    taken_ = {stage_at(reached.q, reached.t), reached.lambda};
    taken_.stage.elapsed = slow;
    if (r.converged) system.advance(taken_.stage);
    taken_.stage.a = &no_acceleration_, taken_.stage.load_factor = next, taken_.stage.work_from = &state.q;
    if (!r.converged) return r.reason;
    const std::string fault = system.fault(reached.q);
    return fault.empty() ? run_.audit->look(state.q, reached, {&taken_, 1}, r, next) : fault;
  }

  int n_ = 1;                   // load steps asked for
  double end_ = 1;              // time of the full load [s]
  std::vector<double> breaks_;  // of the histories, shares of end_
  struct Place {
    double done = 0, step = 1;  // shares of the loads
    LeastDet least;             // of the steps taken
  } at_;
  Taken taken_;  // of the step tried last
  Config no_acceleration_;
};

}  // namespace

std::unique_ptr<Steps> static_steps(RunParts& run, Pause pause) { return std::make_unique<StaticSteps>(run, std::move(pause)); }

}  // namespace hilo
