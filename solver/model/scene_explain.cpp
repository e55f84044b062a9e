// SPDX-License-Identifier: GPL-3.0-or-later
// Every value in force, for --explain.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/digest.hpp"
#include "model/scene.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

std::string text_of(const Value& v) {
  if (v.history && v.texts.empty() && v.history->t.size() == 1) return fmt::format("{}", v.history->value[0]);
  if (v.history) {
    const auto& h = *v.history;
    return fmt::format("{}({} point{}, {:g} to {:g} s)", v.texts.empty() ? "" : v.texts[0] + " ", h.t.size(), h.t.size() == 1 ? "" : "s",
                       h.t.front(), h.t.back());
  }
  if (v.boolean) return *v.boolean ? "true" : "false";
  return "";
}

std::string text_of(const Value& v, Type type) {
  switch (type) {
    case Type::number:
      return fmt::format("{}", v.numbers[0]);
    case Type::vector3:
    case Type::numbers:
      return fmt::format("[{}]", fmt::join(v.numbers, ", "));
    case Type::text:
      return fmt::format("\"{}\"", v.texts[0]);
    case Type::texts:
      return fmt::format("[\"{}\"]", fmt::join(v.texts, "\", \""));
    default:
      return text_of(v);
  }
}

std::string path_of(const Entry& e, size_t number) {
  if (e.section == "scene") return "";
  if (is_single_section(e.section)) return e.section + ".";
  const std::string name = e.name.empty() ? std::to_string(number) : e.name.find('.') == std::string::npos ? e.name : "\"" + e.name + "\"";
  return e.section + "." + name + ".";
}

}  // namespace

std::string Entry::all_values() const {
  std::string out = section + " " + kind;
  for (const auto& [key, v] : values) {
    out += fmt::format(" {} = {} {} {}", key, v.numbers, v.texts, v.boolean.value_or(false));
    if (v.history) out += fmt::format(" {} {}", v.history->t, v.history->value);
  }
  return out;
}

namespace {

/// visit(path of the key, its parameter, its value) of every value in force.
template <class Visit>
void each_value(const Scene& scene, const Visit& visit) {
  std::vector<std::string_view> done;
  for (const auto& schema : scene_schema()) {
    if (std::find(done.begin(), done.end(), schema.section) != done.end()) continue;
    done.push_back(schema.section);
    size_t number = 0;
    for (const auto& e : scene.entries(schema.section)) {
      ++number;
      const auto kind = std::find_if(scene_schema().begin(), scene_schema().end(),
                                     [&](const KindSchema& k) { return k.section == e.section && k.kind == e.kind; });
      for (const auto& p : kind->params) {
        const auto v = e.values.find(p.key);
        if (v != e.values.end()) visit(fmt::format("{}{}", path_of(e, number), p.key), p, v->second);
      }
    }
  }
}

}  // namespace

std::vector<std::string> Scene::values() const {
  std::vector<std::string> out;
  each_value(*this, [&](const std::string& key, const Param& p, const Value& v) {
    std::string text = text_of(v, p.type);
    if (v.history) {
      Digest digest;
      for (const double t : v.history->t) digest.add(t);
      for (const double value : v.history->value) digest.add(value);
      text += fmt::format(" {}", digest.text());
    }
    std::error_code ignored;
    if (p.key == "file" || p.key == "shapes")
      if (const auto file = std::filesystem::path(folder) / v.texts.front(); std::filesystem::is_regular_file(file, ignored))
        text += fmt::format(" {}", digest(file.string()));
    out.push_back(fmt::format("{} = {}", key, text));
  });
  return out;
}

void Scene::put_in_order(std::span<const std::string> values) {
  std::map<std::string, size_t, std::less<>> place;  // of the first line of an entry
  for (size_t i = 0; i < values.size(); ++i) {
    const std::string_view key = std::string_view(values[i]).substr(0, values[i].find(" = "));
    place.emplace(key.substr(0, key.rfind('.') + 1), i);
  }
  for (auto& [section, list] : entries_) {
    std::vector<std::pair<size_t, size_t>> order;
    for (size_t i = 0; i < list.size(); ++i) {
      const auto at = place.find(path_of(list[i], i + 1));
      order.emplace_back(at == place.end() ? values.size() : at->second, i);
    }
    std::sort(order.begin(), order.end());
    std::vector<Entry> sorted;
    for (const auto& [at, i] : order) sorted.push_back(std::move(list[i]));
    list = std::move(sorted);
  }
}

std::string Scene::explain() const {
  std::vector<std::array<std::string, 3>> rows;
  each_value(*this, [&](const std::string& key, const Param& p, const Value& v) {
    const std::string unit = p.unit.empty() || p.unit == "1" ? "" : fmt::format(" [{}]", p.unit);
    rows.push_back({key, text_of(v, p.type) + unit, v.given ? "given, " + v.place.text() : "default"});
  });
  size_t key = 0, value = 0;
  for (const auto& r : rows) key = std::max(key, r[0].size()), value = std::max(value, std::min<size_t>(r[1].size(), 40));
  std::string out;
  for (const auto& r : rows) out += fmt::format("{:<{}} = {:<{}}  # {}\n", r[0], key, r[1], value, r[2]);
  return out;
}

}  // namespace hilo
