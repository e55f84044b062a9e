#include "dynamics/run.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "dynamics/predictor.hpp"
#include "dynamics/progress.hpp"
#include "dynamics/recorder.hpp"

namespace hilo {
namespace {

/// The linear solver for the scene, its pattern set: the light one while factors stay small, MUMPS above, GMRES for what no direct solver
/// holds.
std::unique_ptr<KktSolver> choose_solver(const Scene& scene, const System& system, bool talk) {
  const Entry& e = scene.table("solver");
  std::string kind = e.text("kind");
  const auto unknowns = 3 * system.map.n_global;
  std::string why = "asked for";
  if (kind == "auto") {
    kind = system.comm->size > 1 ? "direct" : unknowns <= 20000 ? "light" : "direct";
    if (unknowns > 600000) kind = "iterative";
    why = fmt::format("{} unknowns on {} rank{}", unknowns, system.comm->size, system.comm->size == 1 ? "" : "s");
  }
  if (kind == "light" && system.comm->size > 1)
    throw Error(e.where("kind"), "the light solver is serial", "use direct or iterative under mpirun");
  auto solver = kind == "light" ? make_light_solver() : make_petsc_solver(kind, e.number("linear_tolerance"));
  solver->structure(system.cliques, system.map);
  if (talk) fmt::print(stderr, "solver {}: {}\n", solver->name(), why);
  return solver;
}

std::string json_text(const std::string& s) {
  std::string out = "\"";
  for (char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else if (static_cast<unsigned char>(c) >= 32)
      out += c;
  }
  return out + "\"";
}

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

class Run {
 public:
  Run(const Scene& scene, System& system, const RunOptions& options)
      : scene_(scene), system_(system), options_(options), began_(wall_clock()), talk_(!options.quiet && system.comm->rank == 0) {}

  RunReport go() {
    const Entry &time = scene_.table("time"), &newton_table = scene_.table("solver");
    newton_.tolerance = newton_table.number("tolerance");
    newton_.max_iterations = static_cast<int>(newton_table.number("iterations"));
    max_cuts_ = static_cast<int>(newton_table.number("cuts"));
    is_static_ = time.text("analysis") == "static";
    if (!is_static_) {
      for (const char* key : {"end", "step"})
        if (!time.has(key)) throw Error(time.place.text(), fmt::format("[time] has no {}", key), "a dynamic run needs end and step");
    }
    const auto& integrator_name = time.text("integrator");
    if (integrator_name == "energy-momentum")
      integrator_ = make_energy_momentum(time.number("dissipation"));
    else
      integrator_ = make_generalized_alpha(time.number("rho"));

    state_.q = system_.start;
    state_.v = system_.start_velocity;
    system_.prescribe(state_.q, 0, is_static_ && !time.has("end") ? 0 : 1);
    assembled_ = system_.constraint_violation(state_.q);
    if (assembled_ > 1e-6 * system_.length && !has_moving_motion())
      throw Error(scene_.path, fmt::format("the joints are apart by {:.2g} at the start", assembled_));
    redundancy_ = drop_redundant_rows(system_, state_.q);
    if (talk_ && !redundancy_.dropped.empty()) {
      fmt::print(stderr, "{} of {} joint rows are redundant; reactions are the minimum-norm share:\n", redundancy_.rows - redundancy_.rank,
                 redundancy_.rows);
      for (const auto& d : redundancy_.dropped) fmt::print(stderr, "  {}\n", d);
    }
    solver_ = choose_solver(scene_, system_, talk_);
    state_.lambda.assign(3 * system_.n_joint_blocks(), 0.0);
    open_recorder();
    try {
      if (is_static_)
        static_steps();
      else
        dynamic_steps();
      recorder_->finish(report_.complete);
      peak_ = system_.comm->max(peak_memory());
      system_.comm->together([&] { write_json(); });
    } catch (...) {  // nothing half-written stays
      recorder_->discard();
      throw;
    }
    return report_;
  }

 private:
  bool has_moving_motion() const {
    return std::any_of(system_.motions.begin(), system_.motions.end(), [](const Motion& m) { return m.moving; });
  }
  void open_recorder() {
    const Entry &time = scene_.table("time"), &output = scene_.table("output");
    Recorder::Setup setup;
    setup.path = options_.output;
    setup.interval = output.given("interval") ? output.number("interval") : is_static_ ? 0 : time.number("end") / 50;
    setup.fields = output.texts("fields");
    setup.single_precision = output.text("precision") == "single";
    for (const Load& l : system_.loads)
      for (double t : l.history.jumps()) setup.jumps.push_back(t);
    setup.provenance = options_.provenance;
    setup.redundant = redundancy_.rank < redundancy_.rows;
    setup.own_time = integrator_->own_time();
    setup.is_static = is_static_;
    recorder_ = std::make_unique<Recorder>(system_, scene_, std::move(setup));
  }

  void static_steps() {
    const Entry& time = scene_.table("time");
    const int n = static_cast<int>(time.number("steps"));
    const double end = time.has("end") ? time.number("end") : 1;
    recorder_->first(state_);
    Progress progress(options_.quiet || system_.comm->rank != 0, 0, 1);
    const Config no_acceleration = [&] {
      Config zero;
      combine(zero, {{0, &state_.q}});
      return zero;
    }();
    double done = 0, dt = 1.0 / n;
    int cuts = 0;
    while (done < 1 - 1e-12) {
      const double next = std::min(1.0, done + dt);
      Config q = state_.q;
      std::vector<double> lambda = state_.lambda;
      const NewtonReport r = equilibrium(system_, *solver_, q, lambda, next * end, next, false, newton_);
      report_.iterations += r.iterations;
      if (!r.converged) {
        if (++cuts > max_cuts_) return stop(r.reason);
        ++report_.cuts, dt /= 2;
        continue;
      }
      cuts = 0;
      least_det_ = std::min(least_det_, r.least_det);
      Config before = state_.q;
      state_.q = q, state_.lambda = lambda, state_.t = next * end;
      Stage s{};
      s.q0 = s.w0 = &before, s.q1 = s.w1 = s.left = &state_.q;
      s.a = &no_acceleration, s.slope = 1, s.t0 = s.t1 = next * end, s.load_factor = next;
      Stage at_end = s;
      at_end.q0 = at_end.w0 = &state_.q;
      recorder_->step(state_, at_end, state_.lambda, no_acceleration, r.iterations);
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
    const double end = time.number("end"), step = time.number("step");
    if (time.text("start") == "equilibrium") {
      const NewtonReport r = equilibrium(system_, *solver_, state_.q, state_.lambda, 0, 1, true, newton_);
      if (!r.converged) {
        recorder_->first(state_);
        return stop("no static equilibrium at the start: " + r.reason);
      }
      if (talk_) fmt::print(stderr, "equilibrium after {} iterations\n", r.iterations);
    }
    projected_ = project_velocities(system_, *solver_, state_.q, state_.v);
    if (talk_ && projected_ > 1e-9)
      fmt::print(stderr, "initial velocities changed by up to {:.3g} m/s to satisfy the joints\n", projected_);
    if (integrator_->needs_acceleration()) consistent_acceleration(system_, *solver_, state_, state_.a, state_.lambda);
    system_.commit(state_.q);
    recorder_->first(state_);
    Progress progress(options_.quiet || system_.comm->rank != 0, 0, end);
    const long n_steps = std::max(1l, std::lround(std::ceil(end / step - 1e-9)));
    // nominal step k goes from k h to (k+1) h; a failed one is halved, level by level, and grows back at aligned instants
    for (long k = 0; k < n_steps; ++k) {
      const double t0 = end * static_cast<double>(k) / static_cast<double>(n_steps),
                   t1 = end * static_cast<double>(k + 1) / static_cast<double>(n_steps);
      long done = 0;  // in units of the finest level, 2^-max_cuts
      const long whole = 1l << max_cuts_;
      int level = level_;
      while (done < whole) {
        const long piece = whole >> level;
        const double a = t0 + (t1 - t0) * static_cast<double>(done) / static_cast<double>(whole);
        const double b = done + piece == whole ? t1 : t0 + (t1 - t0) * static_cast<double>(done + piece) / static_cast<double>(whole);
        state_.t = a;
        if (try_step(b - a)) {
          state_.t = b;
          done += piece;
          recorder_->step(state_, stage_, state_.lambda, integrator_->acceleration(), iterations_);
          ++report_.steps;
          progress.show(b, report_.steps, iterations_);
          if (++good_ >= 8 && level > 0 && done % (2 * piece) == 0) --level, good_ = 0;
        } else if (level < max_cuts_) {
          ++level, ++report_.cuts, good_ = 0;
        } else {
          report_.t = a;
          progress.done();
          return stop(failure_);
        }
      }
      level_ = level;
    }
    progress.show(end, report_.steps, iterations_, true);
    progress.done();
    report_.t = end;
    report_.complete = true;
  }

  /// One step of length h from state_, trying predictors in turn; the state is left alone when it fails.
  bool try_step(double h) {
    integrator_->begin(state_, h);
    for (const Predictor p : {Predictor::rigid_rotation, Predictor::velocity, Predictor::hold}) {
      Config q1 = predict(system_, state_, h, p);
      system_.prescribe(q1, state_.t + h);
      std::vector<double> lambda = state_.lambda;
      const NewtonReport r = newton(
          system_, *solver_, [&](const Config& q) { return integrator_->stage(q); }, q1, lambda, newton_);
      report_.iterations += r.iterations;
      iterations_ = r.iterations;
      if (!r.converged) {
        failure_ = r.reason;
        continue;
      }
      if (r.least_det <= 0) {
        failure_ = fmt::format("a cell is turned inside out (det F = {:.2g})", r.least_det);
        continue;
      }
      least_det_ = std::min(least_det_, r.least_det);
      restore_rotations(q1);
      before_ = state_.q;
      accepted_ = std::move(q1);
      integrator_->stage(accepted_);
      integrator_->finish(state_, accepted_);
      state_.lambda = std::move(lambda);
      state_.q = accepted_;
      // the stage for the recorder refers to copies that outlive the state's own change
      combine(mid_, {{0.5, &before_}, {0.5, &accepted_}});
      make_recorder_stage(h);
      system_.commit(state_.q);
      return true;
    }
    return false;
  }

  void make_recorder_stage(double h) {
    State before{state_.t - h, before_, {}, {}, {}};
    stage_ = Stage{};
    const bool end_point = integrator_->own_time() == 1;
    stage_.q0 = end_point ? &accepted_ : &before_, stage_.q1 = &accepted_;
    stage_.left = end_point ? &accepted_ : &mid_;
    stage_.h = h;
    if (end_point) {
      combine(rate0_, {{1, &accepted_}, {-h / 2, &state_.v}});
      combine(rate1_, {{1, &accepted_}, {h / 2, &state_.v}});
      stage_.w0 = &rate0_, stage_.w1 = &rate1_;
    } else {
      stage_.w0 = &before_, stage_.w1 = &accepted_;
    }
    stage_.a = &integrator_->acceleration();
    combine(v_mid_, {{1 / h, &accepted_}, {-1 / h, &before_}});
    stage_.v = end_point ? &state_.v : &v_mid_;
    stage_.chi = scene_.table("time").number("dissipation");
    if (end_point) stage_.chi = 0;
    stage_.t0 = end_point ? state_.t : state_.t - h, stage_.t1 = state_.t;
    stage_.work_from = &before_;
  }

  /// Directors back to orthonormal to round-off, so that lengths do not drift over millions of steps.
  void restore_rotations(Config& q) const {
    for (Mat3& R : q.R) R = R * (1.5 * Mat3::Identity() - 0.5 * R.transpose() * R);
    system_.follow(q);
  }

  void stop(const std::string& reason) {
    report_.reason = reason.empty() ? "no convergence" : reason;
    report_.complete = false;
    report_.t = state_.t;
  }

  void write_json() const {
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
    add("unknowns", fmt::format("{}", 3 * system_.map.n_global));
    add("bodies", fmt::format("{}", system_.bodies.size() - 1));
    add("joint_rows", fmt::format("{}", redundancy_.rows));
    add("redundant_rows", fmt::format("{}", redundancy_.rows - redundancy_.rank));
    add("ranks", fmt::format("{}", system_.comm->size));
    add("solver", json_text(solver_->name()));
    add("integrator", json_text(is_static_ ? "static" : integrator_->name()));
    add("energy_balance", fmt::format("{:.6g}", recorder_->balance()));
    add("constraint_violation", fmt::format("{:.6g}", recorder_->violation()));
    add("least_det_F", least_det_ < 1e299 ? fmt::format("{:.6g}", least_det_) : "null");
    add("velocity_change", fmt::format("{:.6g}", projected_));
    add("seconds", fmt::format("{{\"all\": {:.6g}, \"assembly\": {:.6g}, \"solve\": {:.6g}, \"output\": {:.6g}}}", wall_clock() - began_,
                               p.assembly, p.solve, p.output));
    add("counts", fmt::format("{{\"evaluations\": {}, \"tangents\": {}, \"solves\": {}, \"linear_iterations\": {}}}", p.evaluations,
                              p.tangents, p.solves, p.linear_iterations));
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
  State state_;
  Stage stage_{};
  Config before_, accepted_, mid_, v_mid_, rate0_, rate1_;
  std::string failure_;
  double began_, peak_ = 0, assembled_ = 0, projected_ = 0, least_det_ = 1e300;
  int max_cuts_ = 8, level_ = 0, good_ = 0, iterations_ = 0;
  bool is_static_ = false, talk_;
};

}  // namespace

RunReport run(const Scene& scene, System& system, const RunOptions& options) { return Run(scene, system, options).go(); }

}  // namespace hilo
