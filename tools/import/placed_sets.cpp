// SPDX-License-Identifier: GPL-3.0-or-later
// --set bore=cylinder:at=[0,0,15],axis=[0,0,1],radius=8: the sets that [set.NAME] makes in a scene, made while importing.
#include <fmt/format.h>

#include "base/error.hpp"
#include "import/deck_material.hpp"
#include "import/imported.hpp"
#include "model/scene.hpp"
#include "model/scene_sets.hpp"

namespace hilo {

void add_placed_sets(Imported& in, const std::vector<std::string>& sets) {
  for (const std::string& set : sets) {
    const std::string option = "--set " + set;
    const size_t eq = set.find('='), colon = set.find(':', eq == set.npos ? 0 : eq);
    if (eq == set.npos || eq == 0 || colon == set.npos)
      throw Error("", option + ": expected NAME=KIND:KEY=VALUE,...", "as in 'bore=cylinder:at=[0,0,0],axis=[0,0,1],radius=8'", Exit::usage);
    const std::string name = set.substr(0, eq), kind = set.substr(eq + 1, colon - eq - 1);
    std::string keys = set.substr(colon + 1);
    if (kind == "near" && keys.find('=') == keys.npos) keys = "at=[" + keys + "]";  // pin=near:1,2,3
    try {
      add_scene_sets(
          Scene::parse(fmt::format("[set]\n{} = {{kind = {}{}{}}}\n", toml_text(name), toml_text(kind), keys.empty() ? "" : ", ", keys),
                       "--set"),
          in.mesh);
    } catch (const Error& e) {
      throw Error("", option + ": " + e.message, e.hint, Exit::usage);
    }
    in.notes.push_back(fmt::format("set \"{}\": {} nodes, {} facets", name, in.mesh.node_sets.at(name).size(),
                                   in.mesh.facet_sets.contains(name) ? in.mesh.facet_sets.at(name).size() : 0));
  }
}

}  // namespace hilo
