// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-tag: which region is rigid and which is flexible.
#include <fmt/format.h>

#include "about.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "model/inputs.hpp"
#include "model/mesh_tags.hpp"
#include "model/store.hpp"
#include "tag/pieces.hpp"
#include "tag/savings.hpp"

int main(int argc, char** argv) {
  using namespace hilo;
  return guarded("hilo-tag", [&] {
    const auto app = make_app({"hilo-tag", "Say for every region of a mesh whether it is rigid, linear or nonlinear, and what that saves.",
                               "hilo-tag mesh.h5 --rigid 'wheel_*' hull --rest nonlinear -o tags.h5", about()});
    std::string mesh_path, rules_path, output = "tags.h5", rest;
    std::vector<std::string> words[3];
    bool json = false, dry = false;
    app->add_option("mesh", mesh_path, "mesh.h5, or a tags.h5 whose mesh is tagged again")->required();
    app->add_option("tags", rules_path,
                    "tags.toml: rigid, nonlinear, linear = [\"name\", \"glob*\", {box = [[..], [..]]}, {set = \"..\"}], rest = \"rigid\"");
    app->add_option("-o,--output", output, "the tags file to write")->capture_default_str()->type_name("FILE");
    const auto add = [&](Fidelity f, const std::string& help) {
      app->add_option(fmt::format("--{}", word(f)), words[static_cast<int>(f)], help)->type_name("REGION");
    };
    add(Fidelity::rigid, "rigid regions: name, glob, box:x,y,z,x,y,z (wholly inside) or set:NAME");
    add(Fidelity::nonlinear, "regions of finite strain, the same");
    add(Fidelity::linear, "regions of small strain on any motion, by modes");
    app->add_option("--rest", rest, "fidelity of all other regions: \"--nonlinear barrel --rest rigid\" makes all but the barrel rigid")
        ->type_name("WORD");
    app->add_flag("--json", json, "the table as JSON");
    app->add_flag("--dry-run", dry, "the table only, no file");
    if (!parse(*app, argc, argv)) return;

    TagRules rules = rules_path.empty() ? TagRules{} : read_tag_rules(rules_path);
    for (const auto f : {Fidelity::rigid, Fidelity::nonlinear, Fidelity::linear})
      for (const auto& w : words[static_cast<int>(f)]) rules.rules.push_back(tag_rule_of_option(f, fmt::format("--{}", word(f)), w));
    if (!rest.empty()) rules.rest = fidelity_of(rest, "--rest");
    const MeshFile file = read_mesh_file(mesh_path);
    if (!dry) check_output(output);
    const auto fidelity = all_tagged(file.mesh, read_thin_regions(mesh_path), apply_tag_rules(file.mesh, rules));
    for (const std::string& line : loose_pieces(file.mesh, fidelity)) warn("", line);
    if (!dry) {
      auto provenance = file.provenance;
      provenance.push_back(command_line(argc, argv));
      write_tags(output, mesh_path, fidelity, provenance);
    }
    if (is_quiet() && !json && !dry) return;
    const Savings s = savings(file.mesh, fidelity);
    fmt::print("{}", json ? savings_json(s, dry ? "" : output) : savings_text(s));
  });
}
