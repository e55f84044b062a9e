// SPDX-License-Identifier: GPL-3.0-or-later
// The scene that a run keeps.
#include <functional>

#include "model/scene_toml.hpp"
#include "post/run/run_file.hpp"

namespace hilo {

Scene scene_of(const RunFile& run) {
  toml::table root = parse_toml(run.store().read_text("/scene"), run.path);
  const std::function<void(toml::table&)> strip = [&](toml::table& table) {
    table.erase("history");
    if (!table.contains("kind")) table.erase("file");  // of a history: what has a kind reads its file when it is built
    for (auto&& [key, node] : table) {
      if (auto* inner = node.as_table()) strip(*inner);
      if (auto* list = node.as_array())
        for (auto& item : *list)
          if (auto* inner = item.as_table()) strip(*inner);
    }
  };
  strip(root);
  return Scene::parse(toml_text(root), run.path);
}

}  // namespace hilo
