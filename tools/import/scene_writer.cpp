// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/scene_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "model/scene.hpp"

namespace hilo {
namespace {

[[noreturn]] void fault(const std::string& what) { throw Error("", "a deck's scene: " + what, "", Exit::fault); }

const KindSchema& schema_of(const SceneKind& kind) {
  for (const KindSchema& s : scene_schema())
    if (s.section == kind.section && s.kind == kind.kind) return s;
  fault(fmt::format("the schema has no {} of kind \"{}\"", kind.section, kind.kind));
}

bool takes(Type key, Type value) {
  return value == key || (value == Type::text && key == Type::history) || (value == Type::number && key == Type::numbers) ||
         (value == Type::numbers && key == Type::vector3);
}

}  // namespace

std::string toml_text(const std::string& s) {
  std::string q(1, '"');
  for (const char c : s) {
    if (c == '"' || c == '\\') q += '\\';
    q += static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
  q += '"';
  return q;
}

SceneValue::SceneValue(const std::string& text) : toml_(text.empty() ? "" : toml_text(text)), texts_{text} {}

SceneValue::SceneValue(double x) : type_(Type::number), toml_(fmt::format("{}", x == 0 ? 0.0 : x)) {
  if (toml_.find_first_of(".en") == toml_.npos) toml_ += ".0";
}

SceneTable::SceneTable(const SceneKind& kind, const std::string& name, const std::string& place, std::initializer_list<SceneKey> keys)
    : schema_(&schema_of(kind)) {
  const bool list = is_list_section(kind.section);
  const std::string behind = place.empty() ? "\n" : "   # " + place + '\n';
  if (list)
    text_ = fmt::format("\n[[{}]]{}", kind.section, behind);
  else if (kind.section != "scene")
    text_ = fmt::format("\n[{}{}]{}", kind.section, name.empty() ? "" : '.' + toml_text(name), behind);
  set("kind", std::string(kind.kind));
  if (list) set("name", name);
  for (const auto& [key, value] : keys) set(key, value);
}

SceneTable& SceneTable::set(std::string_view key, const SceneValue& value) {
  if (!value.given()) return *this;
  const auto of = std::ranges::find(schema_->params, key, &Param::key);
  if (of == schema_->params.end()) fault(fmt::format("{} {} has no key \"{}\"", schema_->section, schema_->kind, key));
  if (!takes(of->type, value.type_)) fault(fmt::format("{} {}: {} = {}", schema_->section, schema_->kind, key, value.toml_));
  text_ += fmt::format("{} = {}\n", key, value.toml_);
  if (key == "on" || key == "a" || key == "b") ends_.insert(ends_.end(), value.texts_.begin(), value.texts_.end());
  return *this;
}

SceneTable& SceneTable::comment(const std::string& line) {
  text_ += "# " + line + '\n';
  return *this;
}

size_t SceneTable::value_at(std::string_view key) const {
  const std::string begins = fmt::format("\n{} = ", key);
  const size_t at = text_.find(begins);
  return at == text_.npos ? at : at + begins.size();
}

double SceneTable::number(std::string_view key) const {
  const size_t at = value_at(key);
  return at == text_.npos ? 0 : std::strtod(&text_[at], nullptr);
}

SceneTable SceneTable::with(std::initializer_list<SceneKey> keys) const {
  SceneTable out = *this;
  for (const auto& [key, value] : keys) {
    const size_t from = out.value_at(key);
    if (from == text_.npos) fault(fmt::format("{} has no {}", schema_->section, key));
    out.text_.replace(from, out.text_.find('\n', from) - from, value.toml_);
    if (key == "on") out.ends_ = value.texts_;
  }
  return out;
}

bool SceneTable::is(std::string_view section) const { return schema_ && schema_->section == section; }

void SceneWriter::begin(const std::string& title, const SceneValue& gravity) {
  if (items_.empty() && !gravity.given()) return;
  items_.insert(items_.begin(), SceneTable("scene", "", "", {{"title", title}, {"units", "m-kg-s"}, {"gravity", gravity}}));
}

std::string SceneWriter::unique(std::string_view section, const std::string& wish) {
  std::string name = wish;
  for (int i = 2; !take(section, name); ++i) name = fmt::format("{}_{}", wish, i);
  return name;
}

void SceneWriter::repeat(const std::vector<std::pair<std::string, size_t>>& sets) {
  double all = 0;
  for (const auto& [set, n] : sets) all += static_cast<double>(n);
  const size_t before = items_.size();
  for (size_t i = 0; i < before; ++i) {
    const SceneTable table = items_[i];
    const bool mass = table.is("point_mass");
    if (std::ranges::count(table.ends(), sets.front().first) == 0 || (!mass && !table.is("load"))) continue;
    const auto share = [&](SceneTable of, size_t n) {
      return mass ? of.with({{"mass", table.number("mass") * static_cast<double>(n) / all}}) : of;
    };
    items_[i] = share(table, sets.front().second);
    for (size_t k = 1; k < sets.size(); ++k) {
      const auto& [set, n] = sets[k];
      items_.push_back(share(table.with({{"name", unique(mass ? "point_mass" : "load", set)}, {"on", set}}), n));
    }
  }
}

bool SceneWriter::take(std::string_view section, const std::string& name) {
  return given_.insert(fmt::format("{}/{}", section, name)).second;
}

std::int64_t SceneWriter::count(std::string_view section) const {
  return std::ranges::count_if(items_, [&](const SceneTable& item) { return item.is(section); });
}

std::set<std::string> SceneWriter::ends(std::initializer_list<std::string_view> sections) const {
  std::set<std::string> names;
  for (const SceneTable& item : items_)
    if (std::ranges::any_of(sections, [&](std::string_view section) { return item.is(section); }))
      names.insert(item.ends().begin(), item.ends().end());
  return names;
}

std::string SceneWriter::text() const {
  std::string all;
  for (const SceneTable& item : items_) all += item.text();
  return all;
}

}  // namespace hilo
