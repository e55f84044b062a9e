// hilo-reduce: the modes of the linear regions of a scene, once for all runs that have them.
#include <fmt/format.h>
#include <malloc.h>

#include <filesystem>

#include "base/args.hpp"
#include "dynamics/region_shapes.hpp"
#include "model/inputs.hpp"
#include "model/store.hpp"
#include "system/system.hpp"

int main(int argc, char** argv) {
  using namespace hilo;
  mallopt(M_MMAP_THRESHOLD, 1 << 30), mallopt(M_TRIM_THRESHOLD, 1 << 30);  // matrices of many columns come and go: keep their memory
  return guarded("hilo-reduce", [&] {
    const auto app = make_app(
        {"hilo-reduce", "Find the modes of the linear regions of a scene, for all runs with this mesh, material, interfaces and loads.",
         "hilo-tag mesh.h5 --linear arm --rest rigid -o linear.h5\nhilo-reduce scene.toml linear.h5 -o reduced.h5\n"
         "hilo-solve scene.toml linear.h5 --modes reduced.h5"});
    std::string scene_path, mesh_path, output = "reduced.h5", shapes;
    std::vector<std::string> overrides;
    app->add_option("scene", scene_path, "scene file (TOML), - for standard input")->required();
    app->add_option("mesh", mesh_path, "tags.h5; overrides the scene's `mesh`");
    app->add_option("-o,--output", output, "file of modes; regions in it that nothing has changed of are kept")->capture_default_str();
    app->add_option("--shapes", shapes, "also a run.h5 whose instants are the modes, for hilo-post render and movie")->type_name("FILE");
    app->add_option("--set", overrides, "override a key of the scene (repeatable), as hilo-solve is told to")
        ->allow_extra_args(false)
        ->expected(1)
        ->take_all();
    if (!parse(*app, argc, argv)) return;
    const Scene scene = Scene::load(scene_path, overrides);
    if (mesh_path.empty()) mesh_path = scene.mesh_path();
    if (mesh_path.empty()) throw Error("", "a mesh is required", "hilo-reduce scene.toml tags.h5", Exit::usage);
    Comm& comm = Comm::world();
    if (comm.size > 1) throw Error("", "modes are found on one rank", "hilo-reduce without mpirun", Exit::usage);
    LocalMesh mesh = read_local_mesh(mesh_path, comm);
    check_output(output);
    if (!shapes.empty()) check_output(shapes);
    ReducedFiles files{.from = std::filesystem::exists(output) ? output : "", .to = output, .provenance = mesh.provenance};
    files.provenance.push_back(command_line(argc, argv));
    const auto system = build_system(scene, &mesh, comm, files);
    if (system->modes.empty()) throw Error(mesh_path, "no region is linear", "hilo-tag mesh.h5 --linear NAME -o tags.h5");
    if (shapes.empty()) return;
    const auto lines = write_region_shapes(*system, scene, shapes, files.provenance);
    if (!is_quiet()) fmt::print("{}:\n", shapes);
    for (const auto& line : lines)
      if (!is_quiet()) fmt::print("{}\n", line);
  });
}
