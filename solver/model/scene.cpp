// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>

#include "base/comm.hpp"
#include "model/inputs.hpp"
#include "model/scene_read.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

/// The value, which now counts as read, or null.
const Value* look(const Entry& e, std::string_view key) {
  const auto v = e.values.find(key);
  if (v == e.values.end()) return nullptr;
  *v->second.read = true;
  return &v->second;
}

const Value& value_of(const Entry& e, std::string_view key) {
  if (const Value* v = look(e, key)) return *v;
  throw Error(e.where(""), fmt::format("{}: \"{}\" is missing", e.label(), key));
}

/// Standard input on every rank; mpirun gives it to the first alone.
std::string standard_input(const Comm& comm) {
  std::vector<char> text;
  comm.on_first([&] {
    char block[4096];
    while ((std::cin.read(block, sizeof block), std::cin.gcount() > 0)) {
      text.insert(text.end(), block, block + std::cin.gcount());
      if (text.size() > most_text) throw Error("<stdin>", fmt::format("more than {} MB of text", most_text >> 20));
    }
  });
  if (comm.size > 1) text = comm.exchange(std::vector<std::vector<char>>(comm.size, text))[0];
  return {text.begin(), text.end()};
}

}  // namespace

std::string Place::text() const { return line == 0 ? file : fmt::format("{}:{}:{}", file, line, column); }

bool Entry::has(std::string_view key) const { return values.find(key) != values.end(); }
bool Entry::given(std::string_view key) const {
  const auto v = values.find(key);
  return v != values.end() && v->second.given;
}
double Entry::number(std::string_view key) const { return value_of(*this, key).numbers.at(0); }
Vec3 Entry::vector3(std::string_view key) const { return Vec3(value_of(*this, key).numbers.data()); }
const std::vector<double>& Entry::numbers(std::string_view key) const { return value_of(*this, key).numbers; }
const std::string& Entry::text(std::string_view key) const { return value_of(*this, key).texts.at(0); }
const std::vector<std::string>& Entry::texts(std::string_view key) const { return value_of(*this, key).texts; }
bool Entry::boolean(std::string_view key) const { return value_of(*this, key).boolean.value(); }
const History& Entry::history(std::string_view key) const {
  static const History one{{0}, {1}};
  const Value* v = look(*this, key);
  return v && v->history ? *v->history : one;
}
std::string Entry::where(std::string_view key) const {
  const auto v = values.find(key);
  return (v != values.end() && v->second.given ? v->second.place : place).text();
}
std::string Entry::label() const { return name.empty() ? section : fmt::format("{} \"{}\"", section, name); }

Scene Scene::load(const std::string& path, std::span<const std::string> overrides) { return load(path, overrides, Comm::alone()); }

Scene Scene::load(const std::string& path, std::span<const std::string> overrides, const Comm& comm) {
  const std::string text = path == "-" ? standard_input(comm) : read_text_file(path);
  return parse(text, path, overrides);
}

Scene Scene::parse(const std::string& text, const std::string& path, std::span<const std::string> overrides) {
  Scene scene;
  Surroundings around;
  const auto parent = std::filesystem::path(path).parent_path().string();
  scene.path = path;
  scene.text = text;
  scene.folder = path == "-" || parent.empty() ? std::string(".") : parent;
  around.file = path == "-" ? std::string("<stdin>") : path;
  around.folder = scene.folder;
  toml::table root = parse_toml(scene.text, around.file);
  for (const auto& option : overrides) apply_override(root, option);
  if (!overrides.empty()) scene.text = toml_text(root);
  scene.entries_ = read_sections(root, around);
  check_entries(scene.entries_);
  scene.units = around.units;
  scene.warnings = find_implausible(scene.entries_);
  for (auto& [section, entries] : scene.entries_)  // what was looked at here has had no effect yet
    for (Entry& e : entries)
      for (auto& [key, value] : e.values) *value.read = false;
  return scene;
}

std::vector<std::string> Scene::unread() const {
  std::vector<std::string> out;
  for (const auto& [section, entries] : entries_) {
    // [time] has keys of other analyses, a material those of other fidelities; quantities are asked for when the run is over, and what
    // import left out is no part of the model
    if (!is_list_section(section) || section == "quantity" || section == "left_out") continue;
    for (const Entry& e : entries) {
      const auto is_read = [](const auto& v) { return *v.second.read; };
      if (std::none_of(e.values.begin(), e.values.end(), is_read)) continue;
      for (const auto& [key, value] : e.values)
        if (value.given && !*value.read && key != "kind" && key != "name")
          out.push_back(fmt::format("{}: {}: {} has no effect here", value.place.text(), e.label(), key));
    }
  }
  return out;
}

std::span<const Entry> Scene::entries(std::string_view section) const {
  const auto e = entries_.find(section);
  return e == entries_.end() ? std::span<const Entry>{} : std::span<const Entry>(e->second);
}

const Entry& Scene::table(std::string_view section) const { return entries_.find(section)->second.front(); }

std::string Scene::mesh_path() const {
  const Entry& top = table("scene");
  if (!top.given("mesh")) return "";
  const std::filesystem::path p(top.text("mesh"));
  const std::string path = p.is_absolute() ? p.string() : (std::filesystem::path(folder) / p).string();
  if (std::error_code error; !std::filesystem::exists(path, error) && !error)
    throw Error(top.where("mesh"), fmt::format("no file {}", path), "make it with hilo-import, hilo-tag or hilo-part");
  return path;
}

}  // namespace hilo
