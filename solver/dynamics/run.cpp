// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/run.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "dynamics/choose_solver.hpp"
#include "dynamics/contradiction.hpp"
#include "dynamics/integrator_kinds.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start.hpp"
#include "system/modal_damping.hpp"

namespace hilo {
namespace {

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

Analysis analysis_of(const Scene& scene) {
  const std::string& word = scene.table("time").text("analysis");
  return word == "static" ? Analysis::statics : word == "path" ? Analysis::path : word == "modes" ? Analysis::modes : Analysis::dynamic;
}

class Run {
 public:
  Run(const Scene& scene, System& system, const RunOptions& options)
      : options_(options),
        began_(wall_clock()),
        processor_began_(processor_clock()),
        run_{.scene = scene,
             .system = system,
             .options = options,
             .analysis = analysis_of(scene),
             .talk = !options.quiet && system.comm->rank == 0} {
    phases() = {};
  }

  RunReport go() {
    read();
    const Pause pause = [this] {
      if (!options_.between_steps) return std::string();
      const std::string why = options_.between_steps({run_.report.steps, run_.state.t}, [this] { return keep(); });
      run_.report.stopped = !why.empty();
      return why;
    };
    shares_.emplace(run_.system.shares());
    steps_ = run_.analysis == Analysis::statics ? static_steps(run_, pause)
             : run_.analysis == Analysis::path  ? path_steps(run_, pause)
             : run_.analysis == Analysis::modes ? mode_steps(run_, pause)
                                                : dynamic_steps(run_, pause);
    Archive from(options_.from, &*shares_);
    if (options_.from.empty())
      prepare();
    else
      archive_start(from);
    run_.audit.emplace(run_.system, run_.energy_unchecked, run_.newton.tolerance);
    open_recorder();
    try {
      if (!options_.from.empty()) go_on(from);
      steps_->take();
      {
        const Timed timed(phases().output);
        run_.recorder->finish(run_.report.complete);
      }
      const Comm& comm = *run_.system.comm;
      const Profile profile(comm, *run_.solver, began_, processor_began_, options_.output);
      run_.report.profile = profile.text();
      const double peak = comm.max(peak_memory());
      comm.on_first([&] { write_run_json(run_, profile, peak); });
    } catch (...) {
      run_.recorder->give_up();
      throw;
    }
    return run_.report;
  }

 private:
  bool is_static() const { return run_.analysis == Analysis::statics || run_.analysis == Analysis::path; }

  /// What the scene asks for.
  void read() {
    System& system = run_.system;
    const Entry &time = run_.scene.table("time"), &newton = run_.scene.table("solver");
    run_.newton.tolerance = newton.number("tolerance");
    run_.newton.max_iterations = static_cast<int>(newton.number("iterations"));
    run_.max_cuts = static_cast<int>(newton.number("cuts"));
    const bool is_dynamic = run_.analysis == Analysis::dynamic, is_static = this->is_static();
    if (is_dynamic) {
      if (!time.has("end")) throw Error(time.place.text(), "[time] has no end", "a dynamic run needs end, and step or tolerance");
      if (!time.has("step") && !time.has("tolerance"))
        throw Error(time.place.text(), "[time] has no step", "give a step, or a tolerance that chooses it");
    }
    if (system.comm->rank == 0) warn_of_idle_keys(time);
    const IntegratorKind& method = integrator_kind(time);
    run_.integrator = method.make(time),
    run_.energy_unchecked = is_static             ? "a static analysis takes the work of a step with the loads at its end"
                            : !is_dynamic         ? "an analysis of modes takes no steps"
                            : method.keeps_energy ? ""
                                                  : "the method does not keep it";
    if (is_dynamic) {
      if (const std::string why = method.weakness(time, system); !why.empty() && system.comm->rank == 0)
        warn(time.where("integrator"), run_.integrator->name() + ": " + why);
      if (system.traits().remembers && !method.carries_state) {
        std::vector<std::string_view> able;
        for (const IntegratorKind& other : integrator_kinds())
          if (other.carries_state) able.push_back(other.name);
        throw Error(time.where("integrator"), run_.integrator->name() + " does not carry what a material remembers (plastic strain)",
                    fmt::format("{} do", fmt::join(able, ", ")));
      }
      const double end = time.number("end"), step = time.has("step") ? time.number("step") : end / 20;
      run_.events = events(system, end, step), system.same_time = 1e-9 * step;
      run_.events.push_back({end, false});
    }
    run_.state.q = system.start;
    run_.state.v = system.start_velocity;
    system.prescribe(run_.state.q, 0, is_static && !time.has("end") ? 0 : 1);
    run_.solver = choose_solver(run_.scene, system, run_.talk);
  }

  /// Positions that close the joints, and rows that are independent there.
  void prepare() {
    System& system = run_.system;
    State& state = run_.state;
    if (const auto carry = system.search(state.q, is_static() ? nullptr : &state.v, 0)) run_.follow(*carry);
    if (!is_static() && system.violation(state.q, 0).worst() > 1e-11 * std::max(1.0, system.length)) {
      run_.figures.assembled = assemble_positions(system, *run_.solver, state.q);
      if (run_.talk) fmt::print(stderr, "start positions changed by up to {:.3g} m to put the joints together\n", run_.figures.assembled);
    }
    const Redundancy& redundancy = run_.redundancy = drop_redundant_rows(system, state.q, 0);
    if (run_.analysis == Analysis::dynamic) refuse_contradictions(run_.scene, system, redundancy, run_.scene.table("time").number("end"));
    if (run_.talk && !redundancy.dropped.empty()) {
      fmt::print(stderr, "{} of {} joint rows are redundant; reactions are the minimum-norm share:\n", redundancy.rows - redundancy.rank,
                 redundancy.rows);
      for (const auto& d : redundancy.dropped) fmt::print(stderr, "  {}\n", d);
    }
    if (run_.talk && redundancy.singular())
      fmt::print(stderr, "a singular position: {} more joint rows depend on others at the start alone\n",
                 redundancy.rank - redundancy.rank_at_pose);
    state.lambda.assign(3 * system.n_joint_blocks(), 0.0);
    if (!is_static()) find_modal_damping(system, state.q);
  }

  void open_recorder() {
    const Entry &time = run_.scene.table("time"), &output = run_.scene.table("output");
    Recorder::Setup setup;
    const bool in_time = run_.analysis == Analysis::dynamic;
    setup.path = options_.output;
    setup.interval = output.given("interval") ? output.number("interval") : in_time ? time.number("end") / 50 : 0;
    setup.fields = output.texts("fields");
    setup.single_precision = output.text("precision") == "single";
    setup.skin = output.text("nodes") == "skin";
    setup.envelope = output.boolean("envelope");
    if (setup.envelope && !run_.system.mesh)
      throw Error(output.where("envelope"), "a scene of bodies alone has no nodes to take the largest values of");
    if (setup.envelope && run_.analysis == Analysis::modes)
      throw Error(output.where("envelope"), "an analysis of modes takes no steps", "leave output.envelope out");
    for (const Event& e : run_.events)
      if (e.jump) setup.jumps.push_back(e.t);
    setup.provenance = options_.provenance;
    setup.redundant = run_.redundancy.rank < run_.redundancy.rows;
    setup.own_time = in_time ? run_.integrator->own_time() : 1;
    setup.alternates = in_time && run_.integrator->alternates();
    setup.is_static = !in_time;
    run_.recorder = std::make_unique<Recorder>(run_.system, run_.scene, std::move(setup));
  }

  /// The walk through all that the run remembers, in two parts: what the recorder is made from, and the rest.
  void archive_start(Archive& a) {
    a("start", run_.redundancy, run_.state, run_.report, run_.figures, run_.impulses);
    run_.system.archive(a);
    if (a.restores() && run_.system.traits().searches) run_.follow(run_.system.number());
    double sum = 0;  // NaN: of a node that no rank had
    for (const Config* c : {&run_.state.q, &run_.state.v})
      for (const Vec3& x : c->x) sum += x.sum();
    if (a.restores() && !std::isfinite(run_.system.comm->max(std::abs(sum))))
      throw Error(run_.scene.path, "what was kept lacks nodes that these ranks need", "go on with as many ranks as before",
                  Exit::resources);
  }
  void archive_rest(Archive& a) {
    a("audit", *run_.audit);
    run_.integrator->archive(a, run_.system);
    steps_->archive(a);
    run_.recorder->archive(a);
    if (!a.restores()) a.agrees(*run_.system.comm);
    a("phases", phases());  // of rank 0 for all
  }

  Kept keep() {
    Phases::Earlier& earlier = phases().earlier;
    earlier.set_up += run_.solver->set_up_seconds(), earlier.undivided += run_.solver->undivided_seconds();
    run_.solver.reset();
    run_.solver = choose_solver(run_.scene, run_.system, false);
    const Phases::Earlier here = earlier;
    earlier.wall += wall_clock() - began_, earlier.processor += processor_clock() - processor_began_;
    const Traffic& sent = traffic();
    earlier.sent = {here.sent.messages + sent.messages, here.sent.collectives + sent.collectives, here.sent.bytes + sent.bytes};
    Archive a(&*shares_);
    archive_start(a);
    archive_rest(a);
    earlier = here;
    return a.kept();
  }

  void go_on(Archive& a) {
    archive_rest(a);
    if (!a.is_at_end()) throw Error("", "more was kept than is restored", "", Exit::fault);
    if (run_.talk) fmt::print(stderr, "goes on from t = {:.6g} s, {} steps behind the start\n", run_.state.t, run_.report.steps);
  }

  const RunOptions& options_;
  double began_, processor_began_;
  RunParts run_;
  std::unique_ptr<Steps> steps_;
  std::optional<Shares> shares_;
};

}  // namespace

void RunParts::follow(const Carry& carry) {
  solver->structure(system.layout.cliques, system.layout.map);
  state.lambda = carry(state.lambda);
  integrator->carry(carry);
}

void Steps::search(double h) {
  const bool moves = run_.analysis == Analysis::dynamic;
  if (const auto carry = run_.system.search(run_.state.q, moves ? &run_.state.v : nullptr, h)) run_.follow(*carry);
}

void RunParts::stop(const std::string& reason) {
  report.reason = reason.empty() ? "no convergence" : reason;
  if (redundancy.singular() && report.steps == 0)
    report.reason +=
        fmt::format("; nothing leads out of the singular position at the start, where rows of {} \"{}\" depend on others",
                    redundancy.singular_joints.size() > 1 ? "joints" : "joint", fmt::join(redundancy.singular_joints, "\", \""));
  if (audit->opens_dropped_row() && system.traits().is_driven) report.reason += "; what is driven or moved contradicts it";
  report.complete = false;
  report.t = state.t;
}

RunReport run(const Scene& scene, System& system, const RunOptions& options) { return Run(scene, system, options).go(); }

}  // namespace hilo
