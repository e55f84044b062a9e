// SPDX-License-Identifier: GPL-3.0-or-later
#include "show/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"

namespace hilo {

void Summary::say(const std::string& key, const std::string& value) { facts.push_back({key, value, false}); }
void Summary::count(const std::string& key, std::int64_t n) { facts.push_back({key, std::to_string(n), true}); }
void Summary::measure(const std::string& key, double value) { facts.push_back({key, fmt::format("{:.6g}", value), true}); }

std::string Summary::text() const {
  size_t wide = 0;
  for (const auto& f : facts) wide = std::max(wide, f.key.size());
  std::string out;
  for (const auto& f : facts) out += fmt::format("{:<{}}  {}\n", f.key, wide, f.value);
  for (const auto& [key, table] : tables) {
    if (table.rows.empty()) continue;
    if (!out.empty()) out += '\n';
    out += table.text();
  }
  return out;
}

std::string Summary::json() const {
  Json out = Json::object(Json::In::lines);
  for (const auto& f : facts) out.add(f.key, f.is_number ? Json::number(f.value) : f.value);
  for (const auto& [key, table] : tables) out.add(key, table.json());
  return out.text() + "\n";
}

Summary summary_of_file(const std::string& path) {
  const Store store = Store::open(path);
  const auto format = store.text_attribute("/", "format");
  if (!format || !format->starts_with("hilo ")) throw Error(path, "not a hilo file: it has no attribute format = \"hilo ...\"");
  Summary s;
  s.say("file", path);
  s.say("format", *format);
  s.count("version", static_cast<std::int64_t>(store.number_attribute("/", "version").value_or(0)));
  s.say("complete", store.number_attribute("/", "complete").value_or(0) == 1 ? "yes" : "no");
  for (const std::string what : {"mesh", "tags"})
    if (const auto link = store.linked(fmt::format("/{}", what))) s.say(fmt::format("{} from", what), link->first);
  if (store.has("/mesh") || store.linked("/mesh")) {
    if (*format != "hilo run" || store.has("/mesh"))
      add_mesh(s, read_mesh_file(path), path);
    else
      warn(path, fmt::format("the mesh is in {}, which is missing", resolved_from(path, store.linked("/mesh")->first)));
  }
  if (*format == "hilo run") add_run(s, store);
  if (*format == "hilo reduced") add_reduced(s, store);
  Table commands{{"provenance"}, {}};
  if (store.has("/provenance"))
    for (const auto& line : store.read_strings("/provenance")) commands.rows.push_back({line});
  s.list("provenance", std::move(commands));
  return s;
}

}  // namespace hilo
