// hilo-solve: a scene, and the mesh it names, become motion.
#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <filesystem>

#include "base/args.hpp"
#include "dynamics/run.hpp"
#include "model/inputs.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

struct Options {
  std::string scene, mesh, modes, output = "run.h5";
  std::vector<std::string> overrides;
  bool dry_run = false, explain = false, profile = false;
};

void print_plan(const System& s, bool talk) {
  std::string plan;
  for (const auto& part : s.parts())
    if (const std::string count = part->count(); !count.empty()) plan += count + ", ";
  if (talk) fmt::print(stderr, "{}{} unknowns\n", plan, 3 * s.map.n_global);
}

int solve(int argc, char** argv, Comm& comm) {
  Options o;
  auto app = make_app({"hilo-solve", "Solve a scene of rigid and flexible parts in time.",
                       "hilo-solve scene.toml tags.h5 -o run.h5\n  mpirun -n 2 hilo-solve scene.toml parts-2.h5\n  hilo-solve "
                       "scene.toml tags.h5 --set 'time.analysis=\"modes\"' -o modes.h5\n  hilo-solve --set time.step=1e-4 --explain "
                       "scene.toml"});
  app->add_option("scene", o.scene, "scene file (TOML), - for standard input")->required();
  app->add_option("mesh", o.mesh, "mesh.h5, tags.h5 or parts-N.h5; overrides the scene's `mesh`");
  app->add_option("--modes", o.modes, "reduced.h5 of hilo-reduce: modes of linear regions, which else are found anew");
  app->add_option("-o,--output", o.output, "results file; .xdmf and .json are written beside it")->capture_default_str();
  app->add_option("--set", o.overrides, "override a key of the scene, such as joint.trunnion.at=[0,0,1] (repeatable)")
      ->allow_extra_args(false)
      ->expected(1)
      ->take_all();
  app->add_flag("--dry-run", o.dry_run, "read and check everything, then stop");
  app->add_flag("--explain", o.explain, "print every value in force, defaults included, then stop");
  app->add_flag("--profile", o.profile, "print seconds, counts and messages by phase at the end");
  if (!parse(*app, argc, argv)) return 0;
  const bool talk = !is_quiet() && comm.rank == 0;
  if (comm.rank != 0) quiet_warnings(true);

  const Scene scene = Scene::load(o.scene, o.overrides);
  for (const auto& w : scene.warnings) warn("", w);
  if (o.explain) {
    if (comm.rank == 0) fmt::print("{}", scene.explain());
    return 0;
  }
  RunOptions options;
  options.output = o.output;
  options.quiet = is_quiet();
  options.mesh = o.mesh.empty() ? scene.mesh_path() : o.mesh;
  std::unique_ptr<LocalMesh> mesh;
  if (!options.mesh.empty()) {
    mesh = std::make_unique<LocalMesh>(read_local_mesh(options.mesh, comm));
    options.provenance = mesh->provenance;
    if (talk && !mesh->tagged) fmt::print(stderr, "{} is not tagged: all regions are nonlinear\n", options.mesh);
  }
  options.provenance.push_back(command_line(argc, argv));
  const auto system = build_system(scene, mesh.get(), comm, {.from = o.modes, .to = "", .provenance = {}});
  print_plan(*system, talk);
  if (o.dry_run) return 0;
  if (!o.output.ends_with(".h5")) throw Error(o.output, "the results file must end in .h5", "-o run.h5", Exit::usage);
  const auto folder = std::filesystem::path(o.output).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder))
    throw Error(o.output, "no such folder", fmt::format("mkdir -p {}", folder.string()), Exit::resources);

  for (const char* ending : {".h5", ".xdmf", ".json"}) check_output(o.output.substr(0, o.output.size() - 3) + ending);
  const RunReport report = [&] {
    try {
      return run(scene, *system, options);
    } catch (const Error& e) {  // of the whole, not of a place in it
      throw Error(e.where.empty() ? scene.path : e.where, e.message, e.hint, e.exit);
    }
  }();
  if (o.profile && comm.rank == 0) fmt::print("{}", report.profile);
  if (!report.complete)
    throw Error(scene.path, fmt::format("stopped at t = {:.6g} s: {}", report.t, report.reason),
                fmt::format("the last good state is in {}", o.output), Exit::not_converged);
  if (talk) fmt::print("{}", report.table);
  if (talk && report.table.empty())
    fmt::print(stderr, "{}: {} steps, {} Newton iterations{}\n", o.output, report.steps, report.iterations,
               report.cuts ? fmt::format(", {} step cuts", report.cuts) : "");
  return 0;
}

}  // namespace
}  // namespace hilo

int main(int argc, char** argv) {
  omp_set_max_active_levels(0);  // a rank is a thread: those of CHOLMOD and others would fight for its core
  hilo::Comm* comm = nullptr;
  const int code = hilo::guarded("hilo-solve", [&] {
    comm = &hilo::Comm::world();
    if (comm->size == 1) {
      hilo::solve(argc, argv, *comm);
      return;
    }
    try {
      hilo::solve(argc, argv, *comm);
    } catch (...) {
      if (comm->rank != 0) sleep(2);  // an error all ranks share is told once, by rank 0, which ends the job
      throw;
    }
  });
  if (comm && comm->size > 1) {
    if (code != 0) comm->abort(code);
    comm->finish();
  }
  return code;
}
