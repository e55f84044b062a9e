// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a scene: every key known, given once, in range, or completed with its default.
#include "model/scene_read.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/printable.hpp"

namespace hilo {
namespace {

std::vector<const KindSchema*> kinds_of(std::string_view section) {
  std::vector<const KindSchema*> kinds;
  for (const auto& s : scene_schema())
    if (s.section == section) kinds.push_back(&s);
  return kinds;
}

std::string one_of(const std::string& name, const std::vector<std::string>& candidates, std::string_view plural) {
  const std::string near = suggest(name, candidates);
  return near.empty() ? fmt::format("{}: {}", plural, fmt::join(candidates, ", ")) : near;
}

/// How a scene begins an entry of a section.
std::string begins(std::string_view section) {
  if (is_single_section(section)) return fmt::format("[{}]", section);
  return is_list_section(section) ? fmt::format("[[{}]]", section) : fmt::format("[{}.NAME]", section);
}

/// What is said of a key that a table, one of `section`, does not have: the nearest of its keys or all of them, and the few other
/// tables that have it.
std::string not_among(const std::string& key, const std::vector<std::string>& keys, std::string_view section, std::string_view plural) {
  std::vector<std::string> owners;
  for (const auto& s : scene_schema()) {
    if (s.section == "scene" || std::none_of(s.params.begin(), s.params.end(), [&](const Param& p) { return p.key == key; })) continue;
    std::string owner = begins(s.section);
    if (s.section == section && !s.kind.empty()) owner += fmt::format(" of kind \"{}\"", s.kind);
    if (owners.empty() || owners.back() != owner) owners.push_back(owner);
  }
  const std::string usual = one_of(key, keys, plural);
  constexpr size_t few = 4;
  if (owners.empty() || owners.size() > few) return usual;
  const std::string last = owners.back();
  owners.pop_back();
  const std::string has = fmt::format("is a key of {}{}{}", fmt::join(owners, ", "), owners.empty() ? "" : " and ", last);
  return suggest(key, keys).empty() ? fmt::format("it {}; {}", has, usual) : fmt::format("{} \"{}\" {}", usual, key, has);
}

/// The kind a table says it is, among those its section has.
const KindSchema& kind_of(std::string_view section, const toml::table& table, const std::string& label, const Place& place) {
  const auto& all = scene_schema();
  const auto given = table["kind"].value<std::string_view>();
  for (bool first = true; const auto& s : all) {
    if (s.section != section) continue;
    if ((first && s.kind.empty()) || (given && s.kind == *given)) return s;
    first = false;
  }
  const auto kinds = kinds_of(section);
  std::vector<std::string> names;
  for (const auto* k : kinds) names.emplace_back(k->kind);
  const auto items = in_file_order(table);
  const auto item = std::find_if(items.begin(), items.end(), [](const Item& i) { return i.key == "kind"; });
  if (item == items.end()) {
    const auto& first = kinds.front()->params.front();
    if (first.key == "kind" && first.fallback != "!") return *kinds.front();
    throw Error(place.text(), label + ": \"kind\" is missing", fmt::format("one of: {}", fmt::join(names, ", ")));
  }
  const auto kind = item->node->value<std::string>();
  if (!kind || !item->node->is_string())
    throw Error(item->place.text(), fmt::format("{}: kind is {}, not text", label, type_word(*item->node)),
                fmt::format("one of: {}", fmt::join(names, ", ")));
  for (const auto* k : kinds)
    if (k->kind == *kind) return *k;
  throw Error(item->place.text(), fmt::format("{}: unknown kind \"{}\"", label, *kind), one_of(*kind, names, "kinds"));
}

/// Names become paths in result files and in --set.
void check_name(std::string_view section, const std::string& name, const Place& place) {
  if (name.empty()) throw Error(place.text(), fmt::format("{}: empty name", section));
  if (section == "region") return;  // may be a glob or whatever the mesh calls it
  if (name.find('/') != name.npos || name == "." || name == "..")
    throw Error(place.text(), fmt::format("{} \"{}\": a name may not hold \"/\" nor be a dot", section, name));
  if (const std::string shown = printable(name); shown != name || name.find_first_of("\n\t") != name.npos)
    throw Error(place.text(), fmt::format("{} \"{}\": a name may not hold characters that cannot be seen", section, shown));
}

void check_new(std::map<std::string, Place>& seen, std::string_view section, const std::string& name, const Place& place) {
  const auto [first, fresh] = seen.try_emplace(name, place);
  if (!fresh) throw Error(place.text(), fmt::format("{} \"{}\" is given twice", section, name), "first at " + first->second.text());
}

void read_list(std::string_view section, const Item& item, const Surroundings& around, std::vector<Entry>& out) {
  const auto* list = item.node->as_array();
  if (!list)
    throw Error(item.place.text(), fmt::format("{} is {}, not a list of tables", section, type_word(*item.node)),
                fmt::format("write [[{}]]", section));
  std::map<std::string, Place> seen;
  for (const auto& node : *list) {
    const auto* table = node.as_table();
    if (!table)
      throw Error(place_of_node(node).text(), fmt::format("{} holds {}, not a table", section, type_word(node)),
                  fmt::format("write [[{}]]", section));
    const auto name = (*table)["name"].value<std::string>().value_or("");
    out.push_back(read_entry(section, *table, name, place_of_node(node), around));
    if (!out.back().given("name")) continue;
    const Place& place = out.back().values.find("name")->second.place;
    check_name(section, name, place);
    check_new(seen, section, name, place);
  }
}

void read_named(std::string_view section, const Item& item, const Surroundings& around, std::vector<Entry>& out) {
  const auto* group = item.node->as_table();
  const std::string form = fmt::format("write [{}.NAME]", section);
  if (!group) throw Error(item.place.text(), fmt::format("{} is {}, not a table of tables", section, type_word(*item.node)), form);
  for (const auto& named : in_file_order(*group)) {
    const auto* table = named.node->as_table();
    if (!table) throw Error(named.place.text(), fmt::format("{}: {} is {}, not a table", section, named.key, type_word(*named.node)), form);
    check_name(section, named.key, named.place);
    out.push_back(read_entry(section, *table, named.key, named.place, around));
  }
}

/// A [time] table, or the keys at the top of the file as section "scene".
Entry read_single(std::string_view section, const Item& item, const Surroundings& around) {
  const auto* table = item.node->as_table();
  if (!table)
    throw Error(item.place.text(), fmt::format("{} is {}, not a table", section, type_word(*item.node)),
                fmt::format("write [{}]", section));
  return read_entry(section, *table, "", item.place, around);
}

std::vector<std::string> section_names() {
  std::vector<std::string> names;
  for (const auto& s : scene_schema())
    if (s.section != "scene" && (names.empty() || names.back() != s.section)) names.emplace_back(s.section);
  return names;
}

}  // namespace

Entry read_entry(std::string_view section, const toml::table& table, const std::string& name, const Place& place,
                 const Surroundings& around, const std::string& owner) {
  Entry entry(section, name, place);
  const std::string label = owner.empty() ? entry.label() : owner;
  const KindSchema& schema = kind_of(section, table, label, place);
  entry.kind = schema.kind;
  for (const auto& item : in_file_order(table)) {
    const auto param = std::find_if(schema.params.begin(), schema.params.end(), [&](const Param& p) { return p.key == item.key; });
    if (param == schema.params.end()) {
      std::vector<std::string> keys;
      for (const auto& p : schema.params) keys.emplace_back(p.key);
      throw Error(item.place.text(), fmt::format("{}: unknown key \"{}\"", label, item.key), not_among(item.key, keys, section, "keys"));
    }
    entry.values.emplace(item.key, read_value(section, *param, item, label, around));
  }
  for (const auto& param : schema.params) {
    if (entry.values.contains(param.key) || param.fallback.empty()) continue;
    if (param.fallback == "!")
      throw Error(place.text(), fmt::format("{}: \"{}\" is missing", label, param.key), std::string(param.meaning));
    std::optional<Value>& known = around.known[&param].fallback;
    if (!known) known = default_value(param);
    Value v = *known;
    v.place = place;
    entry.values.emplace(param.key, std::move(v));
  }
  check_history_unit(entry, around);
  return entry;
}

Entries read_sections(const toml::table& root, Surroundings& around) {
  Entries entries;
  const auto items = in_file_order(root);
  const auto names = section_names();
  toml::table top;
  // The units first, since all else depends on them; then the histories, which others name.
  for (const auto& item : items) {
    if (std::find(names.begin(), names.end(), item.key) != names.end()) continue;
    const auto& scene = kinds_of("scene").front()->params;
    const bool known = std::any_of(scene.begin(), scene.end(), [&](const Param& p) { return p.key == item.key; });
    if (!known && (item.node->is_table() || item.node->is_array_of_tables())) {
      throw Error(item.place.text(), fmt::format("unknown section \"{}\"", item.key), one_of(item.key, names, "sections"));
    } else if (!known) {
      std::vector<std::string> keys;
      for (const auto& p : scene) keys.emplace_back(p.key);
      throw Error(item.place.text(), fmt::format("unknown key \"{}\"", item.key),
                  not_among(item.key, keys, "scene", "keys at the top of a scene"));
    }
    const auto& units = *std::find_if(scene.begin(), scene.end(), [](const Param& p) { return p.key == "units"; });
    if (item.key == "units") around.units = read_value("scene", units, item, "", around).texts.front();
  }
  Entry scene("scene", "", {around.file, 0, 0});
  for (const auto& p : kinds_of("scene").front()->params) {
    const auto item = std::find_if(items.begin(), items.end(), [&](const Item& i) { return i.key == p.key; });
    if (item != items.end())
      scene.values.emplace(p.key, read_value("scene", p, *item, "", around));
    else if (!p.fallback.empty())
      scene.values.emplace(p.key, default_value(p));
  }
  entries["scene"] = {scene};
  for (const auto& item : items)
    if (item.key == "history") {
      read_named("history", item, around, entries["history"]);
      for (const auto& e : entries["history"]) around.histories.emplace(e.name, history_of(e, e.label(), around));
    }
  for (const auto& item : items) {
    if (item.key == "history" || std::find(names.begin(), names.end(), item.key) == names.end()) continue;
    if (is_list_section(item.key))
      read_list(item.key, item, around, entries[item.key]);
    else if (is_single_section(item.key))
      entries[item.key] = {read_single(item.key, item, around)};
    else
      read_named(item.key, item, around, entries[item.key]);
  }
  for (const auto& name : names)
    if (is_single_section(name) && entries[name].empty()) entries[name] = {read_entry(name, {}, "", {around.file, 0, 0}, around)};
  return entries;
}

}  // namespace hilo
