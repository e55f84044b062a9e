// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-solve: a scene, and the mesh it names, become motion.
#include <fmt/format.h>
#include <omp.h>

#include <filesystem>
#include <limits>
#include <optional>

#include "about.hpp"
#include "base/args.hpp"
#include "base/crowd.hpp"
#include "base/error.hpp"
#include "base/interrupt.hpp"
#include "base/on_ranks.hpp"
#include "dynamics/checkpoint.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/wanted.hpp"
#include "linear/blas_kernels.hpp"
#include "model/inputs.hpp"
#include "model/left_out.hpp"
#include "model/quantity_schema.hpp"
#include "model/scene_sets.hpp"
#include "model/store.hpp"
#include "post/quantity/quantity.hpp"
#include "system/contact/contact_entries.hpp"
#include "system/contact/untouched.hpp"

namespace hilo {
namespace {

struct Options {
  std::string scene, mesh, modes, output = "run.h5", restart, checkpoint, time_limit;
  std::vector<std::string> overrides;
  bool dry_run = false, explain = false, profile = false, accept = false, accept_left_out = false;
};

void print_plan(const System& s, bool talk) {
  std::string plan;
  for (const auto& part : s.parts())
    if (const std::string count = part->count(); !count.empty()) plan += count + ", ";
  if (talk) fmt::print(stderr, "{}{} unknowns\n", plan, 3 * s.layout.map.n_global);
}

CheckpointPolicy policy_of(const Options& o) {
  CheckpointPolicy p;
  if (!o.time_limit.empty()) p.time_limit = parse_duration(o.time_limit, "--time-limit");
  if (o.checkpoint.empty()) return p;
  p.seconds = std::numeric_limits<double>::infinity();
  if (o.checkpoint == "none") return p;
  p.at_end = true;
  char* end = nullptr;
  if (const long steps = std::strtol(o.checkpoint.c_str(), &end, 10); std::string_view(end) == "steps" && steps > 0)
    p.steps = steps;
  else
    p.seconds = parse_duration(o.checkpoint, "--checkpoint");
  return p;
}

/// A run to go on with is complete, and the same is asked of it.
bool is_done(const Options& o, Comm& comm) {
  const auto run = complete_without_checkpoint(o.restart);
  if (!run) return false;
  const Scene asked = o.scene.empty() ? Scene::parse(run->text, o.restart, o.overrides) : Scene::load(o.scene, o.overrides, comm);
  return asked.values() == run->values();
}

void solve(int argc, char** argv, Comm& comm) {
  const double began = wall_clock();
  Options o;
  auto app = make_app({"hilo-solve", "Solve a scene of rigid and flexible parts in time.",
                       "hilo-solve scene.toml tags.h5 -o run.h5\n  mpirun -n 2 hilo-solve scene.toml parts-2.h5\n  hilo-solve "
                       "scene.toml tags.h5 --set 'time.analysis=\"modes\"' -o modes.h5\n  hilo-solve --set time.step=1e-4 --explain "
                       "scene.toml",
                       about({"PETSc " HILO_PETSC_VERSION, metis()})});
  app->add_option("scene", o.scene, "scene file (TOML), - for standard input");
  app->add_option("mesh", o.mesh, "mesh.h5, tags.h5 or parts-N.h5; overrides the scene's `mesh`");
  app->add_option("--modes", o.modes,
                  "reduced.h5 of hilo-reduce: modes of linear regions, without it the run finds them; a folder keeps those of all runs");
  const auto* output =
      app->add_option("-o,--output", o.output, "results file; .xdmf and .json are written beside it")->capture_default_str();
  app->add_option("--set", o.overrides, "override a key of the scene, such as joint.trunnion.at=[0,0,1] (repeatable)")
      ->allow_extra_args(false)
      ->expected(1)
      ->take_all();
  app->add_option(
      "--restart", o.restart,
      "go on with these results from their last checkpoint; scene, mesh, overrides and --checkpoint are those of that run unless given");
  app->add_flag("--accept", o.accept, "go on from there also with a scene that differs");
  app->add_flag("--accept-left-out", o.accept_left_out, "run also where import left out a tie, or all loads of a static analysis");
  app->add_option(
      "--checkpoint", o.checkpoint,
      "time between checkpoints (10m), their number of steps (500steps), or none; one stays at the end (default: 15m, until the "
      "run is complete)");
  app->add_option(
      "--time-limit", o.time_limit,
      "stop in time with a checkpoint, such as 3h50m; so do SIGTERM, SIGINT, SIGHUP, SIGUSR1 and a file STOP beside the results");
  app->add_flag("--dry-run", o.dry_run, "read and check everything, print the memory and disk that the run will need, then stop");
  app->add_flag("--explain", o.explain, "print every value in force, defaults included, then stop");
  app->add_flag("--profile", o.profile, "print seconds, counts and messages by phase at the end");
  if (!parse(*app, argc, argv)) return;
  const bool talk = !is_quiet() && comm.rank == 0;
  if (const Crowd here = crowd(comm); talk && here.ranks > here.cores)
    fmt::print(stderr, "hilo-solve: note: {} ranks share {} cores, and wait for each other; as many ranks as cores are faster\n",
               here.ranks, here.cores);
  if (comm.rank != 0) quiet_warnings(true);

  std::optional<Checkpoint> from;
  if (!o.restart.empty()) {
    if (output->count() > 0 && o.output != o.restart)
      throw Error("", "--restart goes on in the results it names, so there is no -o",
                  fmt::format("copy {} and its checkpoints first", o.restart), Exit::usage);
    if (is_done(o, comm)) {
      if (talk) fmt::print(stderr, "{} is complete: nothing is left to do\n", o.restart);
      return;
    }
    from = read_checkpoint(o.restart, comm);
    o.output = o.restart;
    if (o.scene.empty()) {
      o.scene = from->command.scene;
      if (o.modes.empty()) o.modes = from->command.modes;
      o.overrides.insert(o.overrides.begin(), from->command.overrides.begin(), from->command.overrides.end());
    }
    if (o.mesh.empty()) o.mesh = from->command.mesh;
    if (o.checkpoint.empty()) o.checkpoint = from->command.checkpoint;
  } else if (o.scene.empty()) {
    throw Error("", "scene is required", "see hilo-solve --help", Exit::usage);
  }
  CheckpointPolicy policy = policy_of(o);
  policy.began = began;

  Scene scene = from && o.scene == "-" ? Scene::parse(from->scene, "-", o.overrides) : Scene::load(o.scene, o.overrides, comm);
  if (from) scene.put_in_order(from->values);
  for (const auto& w : scene.warnings) warn("", w);
  if (comm.rank == 0) tell_left_out(scene);
  if (o.explain) {
    if (comm.rank == 0) fmt::print("{}", scene.explain());
    if (meets_all(scene)) {
      const std::string path = o.mesh.empty() ? scene.mesh_path() : o.mesh;
      const auto mesh = path.empty() ? nullptr : std::make_unique<LocalMesh>(read_local_mesh(path, comm));
      if (mesh) add_scene_sets(scene, *mesh, comm);
      const std::string pairs = told_pairs(scene, mesh.get(), comm);
      if (comm.rank == 0) fmt::print("{}", pairs);
    }
    return;
  }
  if (!from && !o.accept_left_out) refuse_left_out(scene);
  if (!o.output.ends_with(".h5")) throw Error(o.output, "the results file must end in .h5", "-o run.h5", Exit::usage);
  const auto folder = std::filesystem::path(o.output).parent_path();
  if (std::error_code error; !folder.empty() && !std::filesystem::is_directory(folder, error))
    throw Error(o.output, "no such folder", fmt::format("mkdir -p {}", folder.string()), Exit::resources);

  for (const char* ending : {".h5", ".xdmf", ".json"}) check_output(o.output.substr(0, o.output.size() - 3) + ending);

  RunOptions options;
  options.output = o.output;
  options.quiet = is_quiet();
  options.mesh = o.mesh.empty() ? scene.mesh_path() : o.mesh;
  std::unique_ptr<LocalMesh> mesh;
  if (!options.mesh.empty()) {
    mesh = std::make_unique<LocalMesh>(read_local_mesh(options.mesh, comm));
    options.provenance = mesh->provenance;
    if (mesh->mesh.region_name.empty()) {  // of a deck of beams, which stand in the scene
      if (talk) fmt::print(stderr, "{} has no cells: the run goes without it\n", options.mesh);
      mesh.reset(), options.mesh.clear();
    }
    if (talk && mesh && !mesh->tagged) fmt::print(stderr, "{} is not tagged: all regions are nonlinear\n", options.mesh);
  }
  if (mesh) check_quantity_regions(scene, mesh->mesh.region_name);
  if (from) options.provenance = from->command.provenance;
  options.provenance.push_back(command_line(argc, argv));
  const auto system = build_system(scene, mesh.get(), comm, {.from = o.modes, .to = "", .provenance = {}});
  for (const std::string& key : scene.unread()) warn("", key);
  print_plan(*system, talk);
  if (scene.table("time").text("analysis") == "dynamic")  // the others say themselves what is free
    for (const std::string& part : untouched(*system)) warn("", part + ": nothing holds, moves, loads or touches it");
  if (from) require_same(*from, scene, options.mesh, o.accept), options.from = std::move(from->kept);
  if (o.dry_run) {
    const std::string plan = is_quiet() ? "" : text(wanted(scene, *system));  // on all ranks: sources of fields are collective
    if (talk) fmt::print(stderr, "{}\n", plan);
    return;
  }
  Checkpoints checkpoints(comm, scene, {o.scene, options.mesh, o.modes, o.overrides, o.checkpoint, options.provenance}, o.output, policy,
                          from ? from->path : "");
  options.between_steps = [&](const StepsSoFar& so_far, const auto& keep) { return checkpoints.between_steps(so_far, keep); };
  note_signals();
  std::vector<QuantityValue> asked;
  options.more = [&](Json& run) {
    if (scene.entries("quantity").empty()) return;
    RunFile file(o.output);
    asked = quantities(scene, file);
    run.add("quantities", quantity_table(asked).json());
  };
  const RunReport report = [&] {
    try {
      return run(scene, *system, options);
    } catch (const Error& e) {  // of the whole, not of a place in it
      throw Error(e.where.empty() ? scene.path : e.where, e.message, e.hint, e.exit);
    }
  }();
  if (o.profile && comm.rank == 0) fmt::print("{}", report.profile);
  if (!report.complete && report.stopped)
    throw Error(scene.path, fmt::format("{} at t = {:.6g} s", report.reason, report.t),
                fmt::format("go on with: hilo-solve --restart {}", o.output), Exit::stopped);
  if (!report.complete)
    throw Error(scene.path, fmt::format("stopped at t = {:.6g} s: {}", report.t, report.reason),
                fmt::format("the last good state is in {}", o.output), Exit::not_converged);
  checkpoints.finish();
  if (talk) fmt::print("{}", report.table);
  for (const QuantityValue& v : asked)
    if (!v.why.empty()) warn("", v.why);
  if (talk && !asked.empty()) fmt::print("{}", quantity_table(asked).text());
  if (talk && report.table.empty())
    fmt::print(stderr, "{}: {} steps, {} Newton iterations{}\n", o.output, report.steps, report.iterations,
               report.cuts ? fmt::format(", {} step cuts", report.cuts) : "");
}

}  // namespace
}  // namespace hilo

int main(int argc, char** argv) {
  hilo::use_kernels_of_this_processor(argv);
  omp_set_max_active_levels(0);  // a rank is a thread: those of CHOLMOD and others would fight for its core
  return hilo::on_ranks("hilo-solve", [&](hilo::Comm& comm) { hilo::solve(argc, argv, comm); });
}
