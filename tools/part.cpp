// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-part: which rank works on which cell.
#include <fmt/format.h>

#include <optional>

#include "about.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "model/inputs.hpp"
#include "model/scene_sets.hpp"
#include "model/store.hpp"
#include "part/partition.hpp"
#include "part/table.hpp"

int main(int argc, char** argv) {
  using namespace hilo;
  return guarded("hilo-part", [&] {
    const auto app = make_app(
        {"hilo-part",
         "Divide a tagged mesh among ranks, with the work of nonlinear cells balanced, and separately that of rigid and linear cells.",
         "hilo-part tags.h5 -n 2 -o parts-2.h5", about({metis()})});
    std::string mesh_path, scene_path, output, weights = "weighted";
    int n_parts = 0;
    bool json = false, table = false;
    app->add_option("mesh", mesh_path, "tags.h5 or mesh.h5")->required();
    app->add_option("scene", scene_path, "scene.toml: the work of its joints and springs is weighed in");
    app->add_option("-n,--parts", n_parts, "number of parts (ranks)")->type_name("N")->check(CLI::Range(1, 1 << 20));
    app->add_option("-o,--output", output, "the parts file to write [parts-N.h5]; with --table a CSV file [none]")->type_name("FILE");
    app->add_option("--weights", weights, "weighted: work of nonlinear cells, and of others; uniform: number of cells")
        ->type_name("WORD")
        ->capture_default_str()
        ->check(CLI::IsMember({"weighted", "uniform"}));
    app->add_flag("--table", table, "compare uniform and weighted partitions into 2, 4, 8 ... N parts [128]; no parts file is written");
    app->add_flag("--json", json, "the table as JSON");
    if (!parse(*app, argc, argv)) return;
    if (n_parts == 0 && !table) throw Error("", "--parts is required", "see hilo-part --help", Exit::usage);
    if (output.empty() && !table) output = fmt::format("parts-{}.h5", n_parts);

    MeshFile file = read_mesh_file(mesh_path);
    std::optional<Scene> scene;
    if (!scene_path.empty()) scene = Scene::load(scene_path), add_scene_sets(*scene, file.mesh);
    if (!output.empty()) check_output(output);
    if (!file.tagged && !is_quiet()) fmt::print(stderr, "hilo-part: {} has no tags, so every region is nonlinear\n", mesh_path);
    const CellGraph graph = cell_graph(file.mesh, file.fidelity, scene ? &*scene : nullptr);
    if (table) {
      const Table t = comparison(graph, file.mesh, n_parts ? n_parts : 128);
      if (!output.empty()) write_text_file(output, csv(t));
      if (json || output.empty() || !is_quiet()) fmt::print("{}", json ? t.json().text() + "\n" : t.text());
      return;
    }
    Division division{weights, {}, {}, {}};
    try {
      division.part = partition(graph, file.mesh, n_parts, weights == "weighted");
    } catch (const Error& e) {
      throw Error(mesh_path, e.message, e.hint, e.exit);
    }
    division.report = report(graph, division.part, n_parts);
    if (const auto nonlinear = std::ranges::count(graph.is_nonlinear, 1);
        nonlinear > 0 && nonlinear < graph.n() && n_parts > 1 && n_parts <= nonlinear)
      division.other = report(graph, partition(graph, file.mesh, n_parts, weights != "weighted"), n_parts);

    auto provenance = file.provenance;
    provenance.push_back(command_line(argc, argv));
    write_parts(output, mesh_path, n_parts, division.part, provenance);
    if (json || !is_quiet()) fmt::print("{}", json ? division_json(division, graph, output) : division_text(division, graph));
    for (const auto& line : doubts(division)) warn(mesh_path, line);
  });
}
