// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/scene_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>

#include "base/utf8.hpp"

namespace hilo {
namespace {

constexpr std::string_view set_prefix = "--set ";

Place place(const toml::source_region& region) {
  const std::string file = region.path ? *region.path : "";
  if (file.starts_with(set_prefix)) return {file, 0, 0};
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

/// Split a.b."c.d" at the dots outside quotes.
std::vector<std::string> split_path(std::string_view path, const std::string& where) {
  std::vector<std::string> parts{""};
  char quote = 0;
  for (const char c : path) {
    if (quote) {
      if (c == quote)
        quote = 0;
      else
        parts.back() += c;
    } else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (const auto& p : parts)
    if (p.empty() || quote)
      throw Error(where, fmt::format("cannot read the path \"{}\"", path), "write SECTION.NAME.KEY=VALUE", Exit::usage);
  return parts;
}

std::string_view trim(std::string_view s) {
  const auto first = s.find_first_not_of(" \t"), last = s.find_last_not_of(" \t");
  return first == s.npos ? "" : s.substr(first, last - first + 1);
}

/// Numbers as people type them, as TOML wants them: .5 becomes 0.5, and 1. becomes 1.0.
std::string with_all_digits(std::string_view value) {
  const auto is_digit = [&](size_t i) { return i < value.size() && value[i] >= '0' && value[i] <= '9'; };
  std::string out;
  char quote = 0;
  for (size_t i = 0; i < value.size(); ++i) {
    const char c = value[i];
    if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? 0 : c;
    const bool point = c == '.' && !quote, before = i > 0 && is_digit(i - 1), after = is_digit(i + 1);
    if (point && !before && after) out += '0';
    out += c;
    if (point && before && !after) out += '0';
  }
  return out;
}

/// The right side of an override as a one-key table; a bare word becomes a text.
toml::table parse_right_side(std::string_view value, const std::string& where) {
  if (std::any_of(value.begin(), value.end(), [](unsigned char c) { return c < 32 || c == 127; }))
    throw Error(where, "the value holds a control character", "", Exit::usage);
  try {
    auto t = toml::parse(fmt::format("x = {}", with_all_digits(value)), where);
    if (t.size() == 1) return t;
  } catch (const toml::parse_error& e) {
    if (value.empty() || std::string_view("[{\"'").find(value[0]) != std::string_view::npos)
      throw Error(where, fmt::format("cannot read the value: {}", e.description()), "", Exit::usage);
  }
  std::string quoted;
  for (const char c : value) quoted += c == '"' || c == '\\' ? fmt::format("\\{}", c) : std::string(1, c);
  return toml::parse(fmt::format("x = \"{}\"", quoted), where);
}

[[noreturn]] void no_such(const std::string& where, std::string_view what, const std::string& name,
                          const std::vector<std::string>& candidates) {
  std::string hint = suggest(name, candidates);
  if (hint.empty())
    hint = candidates.empty() ? fmt::format("the scene has no {}", what) : fmt::format("there are: {}", fmt::join(candidates, ", "));
  throw Error(where, fmt::format("no {} \"{}\"", what, name), hint);
}

std::vector<std::string> keys_of(const toml::table& t) {
  std::vector<std::string> keys;
  for (const auto& [k, v] : t) keys.emplace_back(k.str());
  return keys;
}

toml::table& list_entry(toml::table& root, const std::string& section, const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  if (auto* list = root[section].as_array()) {
    size_t number = 0;
    std::from_chars(name.data(), name.data() + name.size(), number);
    for (size_t i = 0; i < list->size(); ++i) {
      auto* t = list->get(i)->as_table();
      if (!t) continue;
      const auto found = (*t)["name"].value<std::string>();
      names.push_back(found ? *found : std::to_string(i + 1));
      if (found ? *found == name : i + 1 == number) return *t;
    }
  }
  no_such(where, section, name, names);
}

/// An empty table whose place is `where`.
toml::table empty_table(const std::string& where) { return std::move(*toml::parse("x = {}", where).get_as<toml::table>("x")); }

/// A region that the scene has no section of may get one: the mesh decides whether there is such a region.
toml::table& named_entry(toml::table& root, const std::string& section, const std::string& name, const std::string& where) {
  if (section == "region") {
    if (!root.contains(section)) root.insert(section, empty_table(where));
    if (auto* regions = root[section].as_table(); regions && !regions->contains(name)) regions->insert(name, empty_table(where));
  }
  auto* group = root[section].as_table();
  if (!group) no_such(where, section, name, {});
  if (auto* t = (*group)[name].as_table()) return *t;
  no_such(where, section, name, keys_of(*group));
}

toml::table& single_entry(toml::table& root, const std::string& section, const std::string& where) {
  if (section == "scene") return root;
  if (!root.contains(section)) root.insert(section, empty_table(where));
  if (auto* t = root[section].as_table()) return *t;
  throw Error(where, fmt::format("{} is not a table", section), fmt::format("write [{}]", section));
}

}  // namespace

namespace {

/// A key of dotted parts is as many tables within each other, which the parser makes and takes apart one within the other: more than a
/// stack holds are refused before.
void refuse_deep_keys(std::string_view text, const std::string& file) {
  constexpr int most = 16;  // a scene has four
  int line = 1, levels = 1;
  size_t line_begin = 0;
  const auto new_line = [&](size_t i) { ++line, line_begin = i + 1; };
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      new_line(i), levels = 1;
    } else if (c == '#') {
      while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
    } else if (c == '"' || c == '\'') {  // a text, or a part of a key
      const bool block = text.substr(i, 3) == std::string(3, c);
      const std::string end(block ? 3 : 1, c);
      for (i += end.size(); i < text.size() && text.substr(i, end.size()) != end; ++i) {
        if (text[i] == '\\' && c == '"') ++i;
        if (i >= text.size() || text[i] != '\n') continue;
        if (!block) break;  // not closed: the parser says so
        new_line(i);
      }
      if (i < text.size() && text[i] == '\n')
        --i;
      else
        i += end.size() - 1;
    } else if (c == '.') {
      if (++levels > most)
        throw Error(Place{file, line, static_cast<int>(i - line_begin) + 1}.text(), fmt::format("a key of more than {} levels", most));
    } else if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-' && c != ' ' && c != '\t') {
      levels = 1;
    }
  }
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
  refuse_deep_keys(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& e) {
    throw Error(Place{file, static_cast<int>(e.source().begin.line), static_cast<int>(e.source().begin.column)}.text(),
                std::string(e.description()), e.description().find("utf-8") == std::string_view::npos ? "" : "save the file as UTF-8");
  }
}

void apply_override(toml::table& root, const std::string& given) {
  const std::string option = as_utf8(given);
  const std::string where = std::string(set_prefix) + option;
  char quote = 0;
  size_t equals = 0;
  for (; equals < option.size() && (quote || option[equals] != '='); ++equals) {
    const char c = option[equals];
    if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? 0 : c;
  }
  if (equals == option.size()) throw Error(where, "no \"=\"", "write SECTION.NAME.KEY=VALUE", Exit::usage);
  const auto path = split_path(trim(std::string_view(option).substr(0, equals)), where);
  auto value = parse_right_side(trim(std::string_view(option).substr(equals + 1)), where);

  toml::table* table = &root;
  size_t next = 0;
  if (path.size() > 1) {
    const std::string& section = path[0];
    const bool single = is_single_section(section);
    std::vector<std::string> sections;
    for (const auto& s : scene_schema())
      if (sections.empty() || sections.back() != s.section) sections.emplace_back(s.section);
    if (std::find(sections.begin(), sections.end(), section) == sections.end()) no_such(where, "section", section, sections);
    if (!single && path.size() == 2)
      throw Error(where, fmt::format("{}.{} is a table, not a value", section, path[1]),
                  fmt::format("write {}.{}.KEY=VALUE", section, path[1]));
    table = single                     ? &single_entry(root, section, where)
            : is_list_section(section) ? &list_entry(root, section, path[1], where)
                                       : &named_entry(root, section, path[1], where);
    next = single ? 1 : 2;
  }
  for (; next + 1 < path.size(); ++next) {
    auto* inner = (*table)[path[next]].as_table();
    if (!inner) no_such(where, "table", path[next], keys_of(*table));
    table = inner;
  }
  table->insert_or_assign(path.back(), std::move(*value.get("x")));
}

std::string toml_text(const toml::table& root) {
  std::ostringstream out, regions;
  if (const auto* group = root["region"].as_table()) {
    for (const auto& item : in_file_order(*group)) {
      toml::table one, outer;
      one.insert(item.key, *item.node);
      if (auto* keys = one.begin()->second.as_table()) keys->is_inline(false);  // else each would open the table [region] again
      outer.insert("region", one);
      regions << "\n\n" << outer;
    }
    toml::table rest = root;
    rest.erase("region");
    out << rest << regions.str() << "\n";
  } else {
    out << root << "\n";
  }
  return out.str();
}

std::vector<Item> in_file_order(const toml::table& table) {
  std::vector<Item> items;
  for (const auto& [key, node] : table) {
    const Place value = place(node.source());
    items.push_back({std::string(key.str()), value.line == 0 ? value : place(key.source()), &node});
  }
  const auto order = [](const Item& item) {  // what an option gave comes behind the file
    return std::tuple(item.place.file.starts_with(set_prefix), item.place.line, item.place.column);
  };
  std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) { return order(a) < order(b); });
  return items;
}

Place place_of_node(const toml::node& node) { return place(node.source()); }

std::string_view type_word(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

}  // namespace hilo
