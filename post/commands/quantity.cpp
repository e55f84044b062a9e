// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post quantity: the quantities that the scene of a run asks for.
#include "post/quantity/quantity.hpp"

#include <algorithm>
#include <memory>

#include "base/args.hpp"
#include "post/commands/commands.hpp"
#include "post/files/output.hpp"

namespace hilo {
namespace {

struct QuantityOptions {
  std::string run, scene;
  std::vector<std::string> names;
  bool json = false;
};

void run(const QuantityOptions& o) {
  RunFile file = judged_run(o.run);
  const Scene scene = o.scene.empty() ? scene_of(file) : Scene::load(o.scene);
  const auto all = quantities(scene, file);
  if (all.empty()) throw Error(scene.path, "the scene asks for no quantity", "write [[quantity]], and give it with --scene");
  std::vector<QuantityValue> shown;
  for (const QuantityValue& v : all) shown.push_back(v);
  if (!o.names.empty()) {
    shown.clear();
    std::vector<std::string> known;
    for (const QuantityValue& v : all) known.push_back(v.name);
    for (const std::string& name : o.names) {
      const size_t before = shown.size();
      for (const QuantityValue& v : all)
        if (matches(name, v.name)) shown.push_back(v);
      if (shown.size() == before) throw Error(scene.path, "no quantity \"" + name + "\"", suggest(name, known));
    }
  }
  for (const QuantityValue& v : shown)
    if (!v.why.empty()) warn("", v.why);
  const Table table = quantity_table(shown);
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

}  // namespace

Command quantity_command(CLI::App& app) {
  auto* sub = app.add_subcommand("quantity", "the quantities that the scene asks for, [[quantity]], with what they may be off");
  const auto o = std::make_shared<QuantityOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("names", o->names, "quantities by name or glob; all by default");
  sub->add_option("--scene", o->scene, "the quantities of this scene instead of the run's own");
  sub->add_flag("--json", o->json, "the table as JSON, in SI units and g");
  example(*sub, "  hilo-post quantity run.h5\n  hilo-post quantity run.h5 --json");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
