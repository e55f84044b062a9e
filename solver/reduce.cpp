// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-reduce: the modes of the linear regions of a scene, once for all runs that have them.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "about.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "base/on_ranks.hpp"
#include "dynamics/modes/region_shapes.hpp"
#include "linear/blas_kernels.hpp"
#include "model/inputs.hpp"
#include "model/store.hpp"
#include "system/build/factor_room.hpp"

namespace hilo {
namespace {

void reduce(int argc, char** argv, const Comm& comm) {
  const auto app = make_app(
      {"hilo-reduce", "Find the modes of the linear regions of a scene, for all runs with this mesh, material, interfaces and loads.",
       "hilo-tag mesh.h5 --linear arm --rest rigid -o linear.h5\nhilo-reduce scene.toml linear.h5 -o reduced.h5\n"
       "hilo-solve scene.toml linear.h5 --modes reduced.h5",
       about({"PETSc " HILO_PETSC_VERSION, metis()})});
  std::string scene_path, mesh_path, output = "reduced.h5", shapes, scratch;
  std::vector<std::string> overrides;
  double memory = -1;
  app->add_option("scene", scene_path, "scene file (TOML), - for standard input")->required();
  app->add_option("mesh", mesh_path, "tags.h5 or parts-N.h5; overrides the scene's `mesh`");
  app->add_option("-o,--output", output, "file of modes; regions in it that nothing has changed of are kept")->capture_default_str();
  app->add_option("--shapes", shapes, "also a run.h5 whose instants are the modes, for hilo-post render and movie")->type_name("FILE");
  app->add_option("--memory", memory, "gigabytes for the factor of a region; without it, what is free besides its modes")
      ->check(CLI::NonNegativeNumber);
  app->add_option("--scratch", scratch, "folder where a factor that is too large for memory is kept in a file, while it is needed")
      ->type_name("FOLDER")
      ->check(CLI::ExistingDirectory);
  app->add_option("--set", overrides, "override a key of the scene (repeatable), as in hilo-solve")
      ->allow_extra_args(false)
      ->expected(1)
      ->take_all();
  if (!parse(*app, argc, argv)) return;
  const bool talk = !is_quiet() && comm.rank == 0;
  if (comm.rank != 0) quiet_warnings(true);
  const Scene scene = Scene::load(scene_path, overrides, comm);
  if (mesh_path.empty()) mesh_path = scene.mesh_path();
  const bool has_beams = std::ranges::any_of(scene.entries("beam"), [](const Entry& e) { return e.text("fidelity") == "linear"; });
  if (mesh_path.empty() && !has_beams) throw Error("", "a mesh is required", "hilo-reduce scene.toml tags.h5", Exit::usage);
  if (mesh_path.empty() && !shapes.empty())
    throw Error("", "--shapes shows regions of a mesh, and there is none", "hilo-solve --set 'time.analysis=\"modes\"'", Exit::usage);
  std::optional<LocalMesh> mesh;
  if (!mesh_path.empty()) mesh.emplace(read_local_mesh(mesh_path, comm));
  check_output(output);
  if (!shapes.empty()) check_output(shapes);
  ReducedFiles files{.from = std::filesystem::exists(output) ? output : "", .to = output, .provenance = {}};
  if (mesh) files.provenance = mesh->provenance;
  files.provenance.push_back(command_line(argc, argv));
  const FactorRoom room{.memory = memory < 0 ? -1 : 1e9 * memory, .scratch = scratch};
  const auto system = build_system(scene, mesh ? &*mesh : nullptr, comm, files, room);
  if (system->modes.empty()) throw Error(mesh_path, "no region is linear", "hilo-tag mesh.h5 --linear NAME -o tags.h5");
  if (shapes.empty()) return;
  const auto lines = write_region_shapes(*system, scene, shapes, files.provenance);
  if (talk) fmt::print("{}:\n", shapes);
  for (const auto& line : lines)
    if (talk) fmt::print("{}\n", line);
}

}  // namespace
}  // namespace hilo

int main(int argc, char** argv) {
  hilo::use_kernels_of_this_processor(argv);
  mallopt(M_MMAP_THRESHOLD, 1 << 30), mallopt(M_TRIM_THRESHOLD, 1 << 30);  // matrices of many columns come and go: keep their memory
  return hilo::on_ranks("hilo-reduce", [&](hilo::Comm& comm) { hilo::reduce(argc, argv, comm); });
}
