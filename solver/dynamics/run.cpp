// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/run.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "dynamics/choose_solver.hpp"
#include "dynamics/integrator_kinds.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/redundancy/contradiction.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start/start.hpp"
#include "system/linear_regions.hpp"
#include "system/modal_damping.hpp"
#include "system/moved_start.hpp"
#include "system/revising.hpp"
#include "system/springs.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

Analysis analysis_of(const Scene& scene) {
  const std::string& word = scene.table("time").text("analysis");
  return word == "static"     ? Analysis::statics
         : word == "path"     ? Analysis::path
         : word == "modes"    ? Analysis::modes
         : word == "buckling" ? Analysis::buckling
                              : Analysis::dynamic;
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
    Archive fresh;
    run_.system.archive(fresh);
    const std::vector<Active> rows = active_rows(run_.system);
    Archive from(options_.from, &*shares_);
    if (!options_.from.empty()) archive_start(from);
    for (bool goes_on = !options_.from.empty();; goes_on = false) {
      take_method();
      steps_ = run_.analysis == Analysis::statics    ? static_steps(run_, pause)
               : run_.analysis == Analysis::path     ? path_steps(run_, pause)
               : run_.analysis == Analysis::modes    ? mode_steps(run_, pause)
               : run_.analysis == Analysis::buckling ? buckling_steps(run_, pause)
                                                     : dynamic_steps(run_, pause);
      if (!goes_on) prepare();
      run_.audit.emplace(run_.system, run_.energy_unchecked, run_.newton.tolerance);
      open_recorder();
      if (pass(goes_on ? &from : nullptr)) break;
      Archive again(fresh.kept());
      run_.system.archive(again);
      set_rows(run_.system, rows);
      run_.report = {}, run_.figures = {}, run_.impulses = {}, run_.estimate = {}, run_.redundancy = {}, run_.state = {};
      start_state();
      run_.talk = false;  // the rest was told
    }
    return run_.report;
  }

 private:
  /// From the start, or on from where it was kept, to the end of a pass; false where another one follows.
  bool pass(Archive* from) {
    try {
      if (from) go_on(*from);
      steps_->take();
      if (run_.analysis == Analysis::dynamic && plan_another(run_.plan, run_.report, run_.state.q, run_.estimate, run_.integrator->order(),
                                                             run_.system, run_.scene.table("time").number("end"))) {
        const auto& passes = run_.plan.passes;
        const StepPlan::Pass &was = passes[passes.size() - 2], &next = passes.back();
        if (!options_.quiet && run_.system.comm->rank == 0)
          fmt::print(stderr, "{} steps{}: once more{}\n", was.steps,
                     run_.report.complete
                         ? fmt::format(" end with an error of about {:.2g} m, where {:.2g} m are asked", was.error, run_.plan.asked)
                         : " and no further: " + run_.report.reason,
                     was.method == next.method ? "" : ", by " + next.method);
        run_.recorder->give_up();
        return false;
      }
      tell_error();
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
    return true;
  }

  /// What positions are worth, where that is little, or less than was asked.
  void tell_error() const {
    const ErrorEstimate& e = run_.estimate;
    if (run_.system.comm->rank != 0 || run_.analysis != Analysis::dynamic || run_.report.steps == 0) return;
    const auto tell = [&](const std::string& what) { warn(run_.scene.path, what); };
    if (run_.plan.asked > 0 && !e.why().empty() && run_.scene.table("time").text("error_estimate") != "never")
      return tell("the error at the end of the run is not known, only the errors of single steps: " + e.why());
    if (e.is_lost() && run_.plan.asked == 0)
      tell("the error of positions is not known: " + e.why() + ": choose a shorter time.step, or time.tolerance");
    if (!e.is_there()) return;
    if (const std::string why = run_.why_better(); !why.empty() && !options_.quiet)
      fmt::print(stderr, "the error at the end is about {:.2g} m, where {:.2g} m are asked: {}\n", e.end(), run_.plan.asked, why);
    if (!run_.plan.unmet.empty()) tell("time.tolerance is not met: " + run_.plan.unmet);
    if (const double t = e.meaningless_from(); t < run_.report.t && e.is_chaotic())
      tell(fmt::format(
          "the motion is chaotic: errors of positions grow exponentially, and from t = {:.3g} s on they are as large as the motion", t));
    else if (run_.plan.asked == 0 && e.share(e.largest()) > 0.05)
      tell(
          fmt::format("positions are off by about {:.2g} % of the motion at t = {:.3g} s, by {}: choose a shorter time.step, or "
                      "time.tolerance",
                      100 * e.share(e.largest()), e.largest_t(),
                      e.is_sum() ? "the sum of what single steps add" : "a second solution at twice the step"));
  }

  bool is_static() const { return run_.analysis == Analysis::statics || run_.analysis == Analysis::path; }

  /// What the scene asks for.
  void read() {
    System& system = run_.system;
    const Entry &time = run_.scene.table("time"), &newton = run_.scene.table("solver");
    run_.newton.tolerance = newton.number("tolerance");
    run_.newton.max_iterations = static_cast<int>(newton.number("iterations"));
    run_.max_cuts = static_cast<int>(newton.number("cuts"));
    const bool is_dynamic = run_.analysis == Analysis::dynamic;
    if (is_dynamic) {
      if (!time.has("end")) throw Error(time.place.text(), "[time] has no end", "a dynamic run needs end, and step or tolerance");
      if (!time.has("step") && !time.has("tolerance"))
        throw Error(time.place.text(), "[time] has no step", "give a step, or a tolerance that chooses it");
    }
    if (system.comm->rank == 0) warn_of_idle_keys(time);
    run_.plan = first_plan(run_.scene, system);
    if (is_dynamic) {
      const IntegratorKind& method = take_method();
      if (const std::string why = method.weakness(time, system); !why.empty() && system.comm->rank == 0)
        warn(time.where("integrator"), run_.integrator->name() + ": " + why);
      if (system.traits().remembers && !method.carries_state) {
        std::vector<std::string_view> able;
        for (const IntegratorKind& other : integrator_kinds())
          if (other.carries_state) able.push_back(other.name);
        throw Error(time.where("integrator"),
                    run_.integrator->name() +
                        " cannot keep the plastic strain of a material, or the modes of shells whose law is not linear, from step to step",
                    fmt::format("{} do", fmt::join(able, ", ")));
      }
      if (revises(system) && (method.name == Radau::name || method.name == Gauss::name))  // the others solve each stage by `newton`
        throw Error(time.where("integrator"), run_.integrator->name() + " does not choose again what meets when a step is solved",
                    "energy-momentum does, and all methods that solve their stages one after another");
      const double end = time.number("end"), step = longest_step(time);
      run_.events = events(system, end, step), system.same_time = 1e-9 * step;
      run_.events.push_back({end, false});
    }
    start_state();
    run_.solver = choose_solver(run_.scene, system, run_.talk);
  }

  void start_state() {
    run_.state.q = run_.system.start;
    run_.state.v = run_.system.start_velocity;
    run_.system.prescribe(run_.state.q, 0, start_factor());
  }
  double start_factor() const { return is_static() && !run_.scene.table("time").has("end") ? 0 : 1; }

  void tell_torn(const std::vector<std::string>& motions) const {
    const Entry& time = run_.scene.table("time");
    if (motions.empty() || is_static() || (time.has("start") && time.text("start") == "equilibrium") || run_.system.comm->rank != 0) return;
    for (const Entry& e : run_.scene.entries("motion"))
      if (e.name == motions.front())
        warn(e.where("on"),
             fmt::format("{}{} begins away from the drawing, and what else holds its region does not move with it: cells between begin "
                         "strained (time.start = \"equilibrium\", or histories that begin at 0)",
                         e.label(), motions.size() > 1 ? fmt::format(", with {} more,", motions.size() - 1) : ""));
  }

  /// The integrator of the pass at work.
  const IntegratorKind& take_method() {
    const Entry& time = run_.scene.table("time");
    const IntegratorKind& method = integrator_kinds().at(run_.plan.now().method, time.where("integrator"));
    run_.integrator = method.make(time);
    run_.energy_unchecked = is_static() ? "a static analysis counts the work of a step by the mean of the forces at both ends"
                            : run_.analysis != Analysis::dynamic ? "an analysis of modes or buckling has no steps"
                            : method.keeps_energy                ? ""
                                                                 : "the method does not keep it";
    return method;
  }

  /// Positions that close the joints, and rows that are independent there.
  void prepare() {
    System& system = run_.system;
    State& state = run_.state;
    const MovedStart moved = begin_moved(system, state.q, start_factor());
    tell_torn(moved.torn);
    if (run_.talk && moved.way > 0)
      fmt::print(stderr, "what motions hold away from the drawing begins moved with them, by up to {:.3g} m\n", moved.way);
    if (const auto carry = system.search(state.q, is_static() ? nullptr : &state.v, 0)) run_.follow(*carry);
    if (!is_static() && system.violation(state.q, 0).worst() > 1e-11 * std::max(1.0, system.length)) {
      const std::vector<Active> rows = active_rows(system);
      drop_redundant_rows(system, state.q, 0);  // or no correction is determined; the others close with them, or are told
      run_.figures.assembled = assemble_positions(system, *run_.solver, state.q);
      set_rows(system, rows);
      if (run_.talk) fmt::print(stderr, "start positions changed by up to {:.3g} m to put the joints together\n", run_.figures.assembled);
    }
    const Redundancy& redundancy = run_.redundancy = drop_redundant_rows(system, state.q, 0);
    if (run_.analysis == Analysis::dynamic) refuse_contradictions(run_.scene, system, redundancy, run_.scene.table("time").number("end"));
    if (run_.talk && !redundancy.dropped.empty()) {
      fmt::print(stderr, "{} of {} joint rows are redundant; reactions are the minimum-norm share:\n", redundancy.rows - redundancy.rank,
                 redundancy.rows);
      for (const std::string& row : redundancy.dropped) fmt::print(stderr, "  {}\n", row);
      if (const size_t all = redundancy.rows - redundancy.rank, more = all - redundancy.dropped.size(); more > 0)
        fmt::print(stderr, "  and {} more\n", more);
    }
    if (!is_static()) warn_of_shared_friction();
    if (run_.talk && redundancy.singular())
      fmt::print(stderr, "a singular position: {} more joint rows depend on others at the start alone\n",
                 redundancy.rank - redundancy.rank_at_pose);
    state.lambda.assign(3 * system.n_joint_blocks(), 0.0);
    if (!is_static()) find_modal_damping(system, state.q);
  }

  /// Where the rows that press friction are redundant, the motion depends on which of them were kept.
  void warn_of_shared_friction() const {
    if (!run_.talk) return;
    const std::vector<std::string> pressed = pressed_by(run_.system, run_.redundancy.undetermined);
    for (const Entry& e : run_.scene.entries("friction"))
      if (std::ranges::find(pressed, e.text("joint")) != pressed.end())
        warn(e.where("joint"),
             fmt::format("{}: how much of the force joint \"{}\" takes is not determined, as its rows are redundant: friction has that of "
                         "the rows that were kept, which may be nothing or all (other joints; or reaction = false and a preload)",
                         e.label(), e.text("joint")));
  }

  void open_recorder() {
    const Entry &time = run_.scene.table("time"), &output = run_.scene.table("output");
    Recorder::Setup setup;
    const bool in_time = run_.analysis == Analysis::dynamic;
    setup.path = options_.output;
    setup.interval = output.given("interval") ? output.number("interval") : in_time ? time.number("end") / 50 : 0;
    if (in_time) setup.end = time.number("end");
    setup.fields = output.texts("fields");
    setup.single_precision = output.text("precision") == "single";
    setup.skin = output.text("nodes") == "skin";
    setup.envelope = output.boolean("envelope");
    if (setup.envelope && !run_.system.mesh)
      throw Error(output.where("envelope"), "a scene of bodies alone has no nodes to take the largest values of");
    if (setup.envelope && (run_.analysis == Analysis::modes || run_.analysis == Analysis::buckling))
      throw Error(output.where("envelope"), "an analysis of modes or buckling has no steps", "leave output.envelope out");
    for (const Event& e : run_.events)
      if (e.jump || &e == &run_.events.back()) setup.jumps.push_back(e.t);  // a run that goes on may find a jump at the end
    setup.provenance = options_.provenance;
    setup.redundant = run_.redundancy.rank < run_.redundancy.rows;
    setup.own_time = in_time ? run_.integrator->own_time() : 1;
    setup.alternates = in_time && run_.integrator->alternates();
    const System& system = run_.system;
    run_.is_rigid = in_time && !system.traits().deforms && system.modes.empty() && !touching(system);
    setup.is_smooth = run_.is_rigid && springs_are_smooth(system), setup.is_static = !in_time;
    run_.recorder = std::make_unique<Recorder>(run_.system, run_.scene, std::move(setup));
  }

  /// The walk through all that the run remembers, in two parts: what the recorder is made from, and the rest.
  void archive_start(Archive& a) {
    std::vector<std::string> bodies;  // sections of beams too
    std::vector<double> modes;        // what they move: of another reduction these are others
    for (const Body& body : run_.system.bodies) bodies.push_back(body.name);
    double largest = 0;
    for (const LinearRegion& of : run_.system.part<LinearRegions>().regions) {
      modes.insert(modes.end(), of.sites.data(), of.sites.data() + of.sites.size());
      if (of.sites.size() > 0) largest = std::max(largest, of.sites.cwiseAbs().maxCoeff());
    }
    auto kept_bodies = bodies;
    auto kept_modes = modes;
    a("bodies", kept_bodies, kept_modes);
    const auto alike = [&](double x, double y) { return std::abs(x - y) <= 1e-4 * largest; };
    if (kept_bodies != bodies || !std::ranges::equal(kept_modes, modes, alike))
      throw Error(run_.scene.path, "the run that was kept has other bodies, sections of beams or modes of regions",
                  "run the scene from its start");
    a("start", run_.redundancy, run_.state, run_.report, run_.figures, run_.impulses, run_.plan, run_.estimate);
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
    if (run_.talk) fmt::print(stderr, "goes on from t = {:.6g} s, {} steps after the start\n", run_.state.t, run_.report.steps);
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
  if (integrator) integrator->carry(carry);
}

void RunParts::recall(const Kept& memory) {
  system.recall(memory);
  if (system.traits().searches) follow(system.number());
}

void Steps::search(double h) {
  const bool moves = run_.analysis == Analysis::dynamic;
  if (const auto carry = run_.system.search(run_.state.q, moves ? &run_.state.v : nullptr, h)) run_.follow(*carry);
}

void Steps::record_rest(const State& rest, double load_factor) {
  Config none;
  combine(none, {{0, &rest.q}});
  Stage s = stage_at(rest.q, rest.t);
  s.a = &none, s.load_factor = load_factor, s.elapsed = slow;
  run_.recorder->first(rest, run_.audit->ledger(), &s, rest.lambda);
}

std::string RunParts::why_better() const {
  return hilo::why_better(plan, report, estimate, integrator->order(), system.length, scene.table("time"));
}

void RunParts::stop(const std::string& reason) {
  report.reason = reason.empty() ? "no convergence" : reason;
  if (redundancy.singular() && report.steps == 0)
    report.reason +=
        fmt::format("; nothing leads out of the singular position at the start, where rows of {} \"{}\" depend on others",
                    redundancy.singular_joints.size() > 1 ? "joints" : "joint", fmt::join(redundancy.singular_joints, "\", \""));
  if (audit->opens_dropped_row() && system.traits().is_driven) report.reason += "; what is driven or moved contradicts it";
  double far = 0;
  for (const std::vector<Vec3>* points : {&state.q.c, &state.q.x})
    for (const Vec3& p : *points) far = std::max(far, p.norm());
  if (far = system.comm->max(far); far > 1e5 * system.length)
    report.reason +=
        fmt::format("; the scene lies {:.2g} m from its origin, {:.1g} times its size, where positions are rounded to {:.1g} m", far,
                    far / system.length, 1e-16 * far);
  report.complete = false;
  report.t = state.t;
}

RunReport run(const Scene& scene, System& system, const RunOptions& options) { return Run(scene, system, options).go(); }

}  // namespace hilo
