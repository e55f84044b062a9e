#include "dynamics/run.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "base/table.hpp"
#include "dynamics/audit.hpp"
#include "dynamics/choose_solver.hpp"
#include "dynamics/contradiction.hpp"
#include "dynamics/held.hpp"
#include "dynamics/impulse.hpp"
#include "dynamics/predictor.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/progress.hpp"
#include "dynamics/record/recorder.hpp"
#include "dynamics/redundancy.hpp"
#include "dynamics/singular_start.hpp"
#include "dynamics/start.hpp"
#include "dynamics/step_control.hpp"

namespace hilo {
namespace {

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

class Run {
 public:
  Run(const Scene& scene, System& system, const RunOptions& options)
      : scene_(scene),
        system_(system),
        options_(options),
        began_(wall_clock()),
        processor_began_(processor_clock()),
        talk_(!options.quiet && system.comm->rank == 0) {}

  RunReport go() {
    const Entry &time = scene_.table("time"), &newton_table = scene_.table("solver");
    newton_.tolerance = newton_table.number("tolerance");
    newton_.max_iterations = static_cast<int>(newton_table.number("iterations"));
    max_cuts_ = static_cast<int>(newton_table.number("cuts"));
    is_static_ = time.text("analysis") == "static";
    if (!is_static_) {
      if (!time.has("end")) throw Error(time.place.text(), "[time] has no end", "a dynamic run needs end, and step or tolerance");
      if (!time.has("step") && !time.has("tolerance"))
        throw Error(time.place.text(), "[time] has no step", "give a step, or a tolerance that chooses it");
    }
    integrator_ = make_integrator(time);
    if (const std::string why = is_static_ ? "" : known_weakness(time, system_); !why.empty() && system_.comm->rank == 0)
      warn(time.where("integrator"), integrator_->name() + ": " + why);

    if (!is_static_ && system_.traits().remembers && !integrator_->carries_state())
      throw Error(time.where("integrator"), integrator_->name() + " does not carry what a material remembers (plastic strain)",
                  "energy-momentum, newmark, hht, wbz, generalized-alpha and bdf2 do");
    if (!is_static_) {
      const double end = time.number("end"), step = time.has("step") ? time.number("step") : end / 20;
      events_ = events(system_, end, step), system_.same_time = 1e-9 * step;
      events_.push_back({end, false});
    }
    state_.q = system_.start;
    state_.v = system_.start_velocity;
    system_.prescribe(state_.q, 0, is_static_ && !time.has("end") ? 0 : 1);
    solver_ = choose_solver(scene_, system_, talk_);
    if (!is_static_ && system_.violation(state_.q, 0).worst() > 1e-11 * std::max(1.0, system_.length)) {
      assembled_ = assemble_positions(system_, *solver_, state_.q);
      if (talk_) fmt::print(stderr, "start positions changed by up to {:.3g} m to put the joints together\n", assembled_);
    }
    redundancy_ = drop_redundant_rows(system_, state_.q, 0);
    if (!is_static_) refuse_contradictions(scene_, system_, redundancy_, time.number("end"));
    if (talk_ && !redundancy_.dropped.empty()) {
      fmt::print(stderr, "{} of {} joint rows are redundant; reactions are the minimum-norm share:\n", redundancy_.rows - redundancy_.rank,
                 redundancy_.rows);
      for (const auto& d : redundancy_.dropped) fmt::print(stderr, "  {}\n", d);
    }
    if (talk_ && redundancy_.singular())
      fmt::print(stderr, "a singular position: {} more joint rows depend on others at the start alone\n",
                 redundancy_.rank - redundancy_.rank_at_pose);
    state_.lambda.assign(3 * system_.n_joint_blocks(), 0.0);
    audit_.emplace(system_, !is_static_ && integrator_->keeps_energy(), newton_.tolerance);
    open_recorder();
    try {
      if (is_static_)
        static_steps();
      else
        dynamic_steps();
      {
        const Timed timed(phases().output);
        recorder_->finish(report_.complete);
      }
      const Profile profile(*system_.comm, *solver_, began_, processor_began_, options_.output);
      report_.profile = profile.text();
      peak_ = system_.comm->max(peak_memory());
      system_.comm->together([&] { write_json(profile); });
    } catch (...) {  // nothing half-written stays
      recorder_->discard();
      throw;
    }
    return report_;
  }

 private:
  void open_recorder() {
    const Entry &time = scene_.table("time"), &output = scene_.table("output");
    Recorder::Setup setup;
    setup.path = options_.output;
    setup.interval = output.given("interval") ? output.number("interval") : is_static_ ? 0 : time.number("end") / 50;
    setup.fields = output.texts("fields");
    setup.single_precision = output.text("precision") == "single";
    setup.skin = output.text("nodes") == "skin";
    for (const Event& e : events_)
      if (e.jump) setup.jumps.push_back(e.t);
    setup.provenance = options_.provenance;
    setup.redundant = redundancy_.rank < redundancy_.rows;
    setup.own_time = is_static_ ? 1 : integrator_->own_time(), setup.alternates = !is_static_ && integrator_->alternates();
    setup.is_static = is_static_;
    recorder_ = std::make_unique<Recorder>(system_, scene_, std::move(setup));
  }

  void static_steps() {
    const Entry& time = scene_.table("time");
    const int n = static_cast<int>(time.number("steps"));
    const double end = time.has("end") ? time.number("end") : 1;
    require_held(system_, state_.q, end / n, 1.0 / n, time.where("analysis"));
    audit_->start(state_);
    recorder_->first(state_, audit_->ledger());
    Progress progress(options_.quiet || system_.comm->rank != 0, 0, 1);
    const Config no_acceleration = [&] {
      Config zero;
      combine(zero, {{0, &state_.q}});
      return zero;
    }();
    double done = 0, dt = 1.0 / n;
    int cuts = 0;
    LeastDet least;
    State reached = state_;
    std::string why;             // of the first failure since the last good state, or that a cell would be inside out
    std::vector<double> breaks;  // of the histories: where a load turns back what remembers must have been
    for (const UsedHistory& used : system_.histories)
      for (const History::Break& b : used.history.breaks()) breaks.push_back(b.t / end);
    const auto step_end = [&] {  // the next multiple of dt, or the break before it
      double to = std::min(1.0, (std::floor(done / dt + 1e-9) + 1) * dt);
      for (const double b : breaks)
        if (b > done + 1e-9 && b < to - 1e-9) to = b;
      return to;
    };
    while (done < 1 - 1e-12) {
      const double next = step_end();
      reached.q = state_.q, reached.lambda = state_.lambda, reached.t = next * end;
      const NewtonReport r = equilibrium(system_, *solver_, reached.q, reached.lambda, reached.t, next, false, newton_);
      report_.iterations += r.iterations;
      Taken taken{stage_at(reached.q, reached.t), reached.lambda};
      taken.stage.elapsed = slow;
      if (r.converged) system_.advance(taken.stage);
      taken.stage.a = &no_acceleration, taken.stage.load_factor = next, taken.stage.work_from = &state_.q;
      failure_ = r.converged ? audit_->look(state_.q, reached, {&taken, 1}, r, next) : r.reason;
      if (!failure_.empty()) {
        system_.commit(state_.q), system_.settle(false);
        if (why.empty() || r.least_det.det <= 0) why = failure_;
        if (++cuts > max_cuts_) {
          if (least.det < 0.01 && r.least_det.det > 0) why += "; " + system_.inside_out(least);
          return stop(why + unheld(system_, system_.start));
        }
        ++report_.cuts;
        do dt /= 2;
        while (step_end() >= next);
        continue;
      }
      cuts = 0, why.clear(), least.take(r.least_det);
      audit_->accept(reached.t);
      recorder_->step(reached, audit_->ledger(), taken, no_acceleration, r.iterations);
      system_.settle(true);
      std::swap(state_, reached);
      done = next;
      ++report_.steps;
      progress.show(done, report_.steps, r.iterations);
      dt = std::min(1.0 / n, 2 * dt);
    }
    progress.done();
    report_.t = state_.t;
    report_.complete = true;
  }

  void dynamic_steps() {
    const Entry& time = scene_.table("time");
    const double end = time.number("end"), step = time.has("step") ? time.number("step") : end / 20;
    const std::vector<Active> rows = active_rows(system_);
    set_rows(system_, redundancy_.at_pose);
    if (time.text("start") == "equilibrium") {
      require_rest(system_, state_.q, time.where("start"));
      const NewtonReport r = equilibrium(system_, *solver_, state_.q, state_.lambda, 0, 1, true, newton_);
      if (!r.converged) {
        audit_->start(state_);
        recorder_->first(state_, audit_->ledger());
        return stop("no static equilibrium at the start: " + r.reason + unheld(system_, system_.start));
      }
      Stage rest = stage_at(state_.q, 0);
      rest.elapsed = slow, system_.advance(rest), system_.settle(true);
      if (talk_) fmt::print(stderr, "equilibrium after {} iterations\n", r.iterations);
    }
    projected_ = impulses_.strike(system_, *solver_, state_, talk_).change;
    if (const std::string name = contradicted_joint(system_, state_.q, state_.v, 0); !name.empty())
      throw Error(scene_.path, fmt::format("joint \"{}\" cannot move as the driven joints would have it", name),
                  "two drives, or a drive and a joint, hold the same motion");
    if (redundancy_.singular()) leave_singular_position(rows, step);
    if (talk_ && projected_ > 1e-9)
      fmt::print(stderr, "initial velocities changed by up to {:.3g} m/s to satisfy the joints\n", projected_);
    system_.commit(state_.q, &state_.v);
    Progress progress(options_.quiet || system_.comm->rank != 0, 0, end);
    std::optional<StepControl> control;
    if (time.has("tolerance")) control.emplace(system_, time.number("tolerance") * system_.length, end, step);
    if (!control) {
      const std::vector<Active> now = active_rows(system_);
      set_rows(system_, rows);  // the freedoms of mechanisms are those beside a singular pose
      integrator_->keep_time(system_);
      set_rows(system_, now);
    }
    const size_t clocks = integrator_->timed().size();
    if (talk_)
      fmt::print(stderr, "integrator: {}{}\n", integrator_->name(),
                 clocks ? fmt::format(", {} mechanism{} of one degree of freedom on a clock of {} own", clocks, clocks > 1 ? "s" : "",
                                      clocks > 1 ? "their" : "its")
                        : "");
    double from = 0;
    for (size_t i = 0; i < events_.size(); ++i) {
      if (i == 0 || events_[i - 1].jump || integrator_->needs_acceleration()) restart(control, step);
      if (i == 0) audit_->start(state_), recorder_->first(state_, audit_->ledger());
      if (!(control ? controlled_steps(*control, events_[i].t, progress) : equal_steps(from, events_[i].t, step, progress))) {
        progress.done();
        return stop(failure_);
      }
      from = events_[i].t;
    }
    estimated_ = control ? control->sum() : -1;
    progress.show(end, report_.steps, iterations_, true);
    progress.done();
    if (failure_ = audit_->verdict(); !failure_.empty()) return stop(failure_);
    report_.t = end;
    report_.complete = true;
  }

  /// At a singular position mechanisms branch: the accelerations there tell which way, and velocities follow the joints a little ahead.
  void leave_singular_position(const std::vector<Active>& rows, double step) {
    consistent_acceleration(system_, *solver_, state_, 0.05 * step);
    projected_ = std::max(projected_, follow_branch(system_, *solver_, state_, redundancy_, rows));
  }

  /// At the start and after a jump of the loads: history that belongs to the new forces.
  void restart(std::optional<StepControl>& control, double step) {
    if (state_.t > 0 && system_.traits().is_driven) audit_->push(impulses_.strike(system_, *solver_, state_, talk_).work);
    const std::vector<Active> rows = active_rows(system_);
    if (report_.steps == 0) set_rows(system_, redundancy_.at_pose);
    if (integrator_->needs_acceleration() || control) consistent_acceleration(system_, *solver_, state_, 0.05 * step);
    set_rows(system_, rows);
    integrator_->restart();
    if (control) control->restart(state_);
  }

  /// Steps of equal length from `from` to `to`, up to a thousandth of one longer than asked for: the times of a table are rounded, and one
  /// more step would change them all.  Step k goes from k h to (k+1) h; a failed one is halved, level by level, and grows back at
  /// aligned instants.
  bool equal_steps(double from, double to, double step, Progress& progress) {
    const long n_steps = std::max(1l, std::lround(std::ceil((to - from) / step - 1e-3)));
    for (long k = 0; k < n_steps; ++k) {
      const double t0 = from + (to - from) * static_cast<double>(k) / static_cast<double>(n_steps),
                   t1 = from + (to - from) * static_cast<double>(k + 1) / static_cast<double>(n_steps);
      long done = 0;  // in units of the finest level, 2^-max_cuts
      const long whole = 1l << max_cuts_;
      while (done < whole) {
        const long piece = whole >> level_;
        const double a = t0 + (t1 - t0) * static_cast<double>(done) / static_cast<double>(whole);
        const double b = done + piece == whole ? t1 : t0 + (t1 - t0) * static_cast<double>(done + piece) / static_cast<double>(whole);
        state_.t = a;
        if (try_step(b - a)) {
          done += piece;
          accept(b, progress);
          if (++good_ >= 8 && level_ > 0 && done % (2 * piece) == 0) --level_, good_ = 0;
        } else if (level_ < max_cuts_) {
          ++level_, cut();
        } else {
          return false;
        }
      }
    }
    return true;
  }

  /// Steps chosen by the error they make, the last of them ending at `to`.  The last thirty are fitted in: one short step at the end would
  /// cost accelerations and multipliers their order there.
  bool controlled_steps(StepControl& control, double to, Progress& progress) {
    int failures = 0;
    while (state_.t < to) {
      const double left = to - state_.t, pieces = std::ceil(left / control.step() - 1e-6), h = pieces < 30 ? left / pieces : control.step();
      if (!(state_.t + h > state_.t)) return failure_ = fmt::format("time.tolerance asks for steps of {:.2g} s", h), false;
      if (!try_step(h)) {
        if (++failures > max_cuts_) return false;
        control.cut(h), cut();
      } else if (!control.accept(*integrator_->taken().back().stage.end, h)) {
        ++rejected_, system_.settle(false);
      } else {
        failures = 0;
        accept(pieces == 1 ? to : state_.t + h, progress);
      }
    }
    return true;
  }

  void cut() {
    ++report_.cuts, good_ = 0;
    system_.settle(false);
    if (redundancy_.rank < redundancy_.rows && recheck_redundant_rows(system_, state_.q, state_.t, redundancy_) && talk_)
      fmt::print(stderr, "t = {:.6g} s: another choice of independent joint rows\n", state_.t);
  }

  /// One step of length h from state_, trying predictors in turn; the state is left alone.
  bool try_step(double h) {
    StepTools tools{system_, *solver_, newton_};
    const bool leaving = redundancy_.singular() && report_.steps == 0;
    for (const Predictor p : {Predictor::accelerated, Predictor::rigid_rotation, Predictor::velocity, Predictor::hold}) {
      if (p == Predictor::accelerated && !leaving) continue;
      tools.newton.reach = p == Predictor::rigid_rotation ? 1 : newton_.reach;
      const NewtonReport r = integrator_->solve(tools, state_, h, p);
      report_.iterations += r.iterations;
      iterations_ = r.iterations;
      if (!r.converged) {
        failure_ = r.reason;
        continue;
      }
      integrator_->end(end_), end_.t = state_.t + h;
      system_.advance(integrator_->taken().back().stage);
      failure_ = system_.fault(end_.q);
      if (failure_.empty()) failure_ = audit_->look(state_.q, end_, integrator_->taken(), r);
      if (failure_.empty()) return true;
    }
    return false;
  }

  /// The step tried last becomes the state, at time t.
  void accept(double t, Progress& progress) {
    integrator_->accept(state_);
    state_.t = t;
    system_.commit(state_.q, &state_.v);
    audit_->accept(t);
    recorder_->step(state_, audit_->ledger(), integrator_->taken().back(), integrator_->acceleration(), iterations_);
    system_.settle(true);
    ++report_.steps;
    progress.show(t, report_.steps, iterations_);
  }

  void stop(const std::string& reason) {
    report_.reason = reason.empty() ? "no convergence" : reason;
    if (redundancy_.singular() && report_.steps == 0)
      report_.reason +=
          fmt::format("; nothing leads out of the singular position at the start, where rows of {} \"{}\" depend on others",
                      redundancy_.singular_joints.size() > 1 ? "joints" : "joint", fmt::join(redundancy_.singular_joints, "\", \""));
    if (audit_->opens_dropped_row() && system_.traits().is_driven) report_.reason += "; what is driven or moved contradicts it";
    report_.complete = false;
    report_.t = state_.t;
  }

  void write_json(const Profile& profile) const {
    if (system_.comm->rank != 0) return;
    const Phases& p = phases();
    std::string j = "{\n";
    const auto add = [&](const char* key, const std::string& value) { j += fmt::format("  \"{}\": {},\n", key, value); };
    add("complete", report_.complete ? "true" : "false");
    if (!report_.complete) add("reason", json_text(report_.reason));
    add("t", fmt::format("{:.12g}", report_.t));
    add("steps", fmt::format("{}", report_.steps));
    add("newton_iterations", fmt::format("{}", report_.iterations));
    add("cuts", fmt::format("{}", report_.cuts));
    add("length", fmt::format("{:.12g}", system_.length));
    add("unknowns", fmt::format("{}", 3 * system_.map.n_global));
    add("bodies", fmt::format("{}", system_.bodies.size() - 1));
    add("joint_rows", fmt::format("{}", redundancy_.rows));
    add("redundant_rows", fmt::format("{}", redundancy_.rows - redundancy_.rank));
    add("ranks", fmt::format("{}", system_.comm->size));
    add("solver", json_text(solver_->name()));
    add("integrator", json_text(is_static_ ? "static" : integrator_->name()));
    std::string clocks;
    for (const auto& mechanism : integrator_->timed()) clocks += (clocks.empty() ? "" : ", ") + json_text(mechanism);
    add("clocks", "[" + clocks + "]");
    if (estimated_ >= 0) {
      add("estimated_position_error", fmt::format("{:.6g}", estimated_));
      add("rejected_steps", fmt::format("{}", rejected_));
    }
    const double balance = audit_->balance(), det = audit_->least_det();
    add("energy_balance", std::isnan(balance) ? "null" : fmt::format("{:.6g}", balance));
    add("constraint_violation", fmt::format("{:.6g}", audit_->violation()));
    add("least_det_F", det < 1e299 ? fmt::format("{:.6g}", det) : "null");
    add("audit", audit_->json(report_.complete ? "" : report_.reason));
    add("position_change", fmt::format("{:.6g}", assembled_));
    add("velocity_change", fmt::format("{:.6g}", projected_));
    add("impulses", impulses_.json());
    add("seconds", fmt::format("{{\"all\": {:.6g}, \"assembly\": {:.6g}, \"solve\": {:.6g}, \"output\": {:.6g}}}", wall_clock() - began_,
                               p.assembly.seconds, p.solve.seconds, p.output.seconds));
    add("counts", fmt::format("{{\"evaluations\": {}, \"tangents\": {}, \"solves\": {}, \"linear_iterations\": {}}}", p.evaluations,
                              p.tangents, p.solves, p.linear_iterations));
    j += profile.json();
    add("peak_memory_bytes", fmt::format("{:.0f}", peak_));
    add("mesh", json_text(options_.mesh));
    add("scene", json_text(scene_.path));
    std::string list;
    for (const auto& line : options_.provenance) list += (list.empty() ? "" : ", ") + json_text(line);
    j += fmt::format("  \"provenance\": [{}]\n}}\n", list);
    write_text_file(stem(options_.output) + ".json", j);
  }

  const Scene& scene_;
  System& system_;
  const RunOptions& options_;
  RunReport report_;
  NewtonOptions newton_;
  Redundancy redundancy_;
  std::unique_ptr<KktSolver> solver_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<Recorder> recorder_;
  std::optional<Audit> audit_;
  State state_, end_;          // accepted; of the step tried last
  std::vector<Event> events_;  // the last is the end
  Impulses impulses_;
  std::string failure_;
  double began_, processor_began_, peak_ = 0, assembled_ = 0, projected_ = 0, estimated_ = -1;
  int max_cuts_ = 8, level_ = 0, good_ = 0, iterations_ = 0;
  long rejected_ = 0;
  bool is_static_ = false, talk_;
};

}  // namespace

RunReport run(const Scene& scene, System& system, const RunOptions& options) { return Run(scene, system, options).go(); }

}  // namespace hilo
