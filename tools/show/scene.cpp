// SPDX-License-Identifier: GPL-3.0-or-later
// A scene in a summary.
#include "model/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "show/summary.hpp"

namespace hilo {
namespace {

/// What an entry is about, in a few words: its ends, what it acts on, its material.
std::string about(const Entry& e) {
  if (e.has("a") && e.has("b")) return fmt::format("{} - {}", e.text("a"), e.text("b"));
  if (e.has("on")) return e.section == "initial" ? fmt::format("{}", fmt::join(e.texts("on"), ", ")) : e.text("on");
  if (e.section == "region" && e.has("material")) return e.text("material");
  if (e.section == "body") return fmt::format("{:g} kg", e.number("mass"));
  if (e.section == "material" && e.has("E") && e.has("nu") && e.has("density"))
    return fmt::format("E {:g} Pa, nu {:g}, {:g} kg/m^3", e.number("E"), e.number("nu"), e.number("density"));
  return "";
}

}  // namespace

Summary summary_of_scene(const std::string& path) {
  const Scene scene = Scene::load(path);
  Summary s;
  s.say("file", path);
  s.say("format", "hilo scene");
  for (const std::string key : {"title", "mesh"})
    if (const Entry& head = scene.table("scene"); head.has(key)) s.say(key, head.text(key));
  s.say("units", scene.units);
  const Entry& time = scene.table("time");
  for (const std::string key : {"end", "step"})
    if (time.has(key)) s.measure(fmt::format("time.{} [s]", key), time.number(key));
  Table t{{"section", "kind", "name", "about", "place"}, {}, 5};
  std::string last;
  for (const auto& schema : scene_schema()) {
    if (schema.section == last || is_single_section(schema.section)) continue;
    last = schema.section;
    for (const Entry& e : scene.entries(schema.section)) t.rows.push_back({e.section, e.kind, e.name, about(e), e.place.text()});
  }
  s.list("entries", std::move(t));
  for (const auto& line : scene.warnings) warn("", line);
  return s;
}

}  // namespace hilo
