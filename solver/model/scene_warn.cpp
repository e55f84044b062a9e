// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a scene that are possible but not plausible: mostly units gone wrong, and steps too long for the load.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "model/scene_read.hpp"

namespace hilo {
namespace {

struct Warnings {
  std::vector<std::string> lines;
  void add(const Entry& e, std::string_view key, const std::string& what) {
    lines.push_back(fmt::format("{}: {}{}", e.where(key), e.section == "scene" ? "" : e.label() + ": ", what));
  }
};

constexpr const char* units_hint = "; do the numbers fit `units`?";

void check_material(const Entry& m, Warnings& w) {
  const bool has_E = m.has("E"), has_density = m.has("density");
  const double E = has_E ? m.number("E") : 0, density = has_density ? m.number("density") : 0;
  const size_t before = w.lines.size();
  if (has_density && (density < 10 || density > 3e4)) w.add(m, "density", fmt::format("a density of {:.4g} kg/m^3{}", density, units_hint));
  if (has_E && (E < 1e3 || E > 2e12)) w.add(m, "E", fmt::format("a Young's modulus of {:.4g} Pa{}", E, units_hint));
  if (has_E && has_density && w.lines.size() == before) {
    const double c = std::sqrt(E / density);
    if (c < 1 || c > 2e4) w.add(m, "E", fmt::format("waves of {:.4g} m/s in a bar{}", c, units_hint));
  }
}

/// No set of positive masses has these principal moments, unless each is at most the sum of the others.
void check_body(const Entry& b, Warnings& w) {
  const auto& J = b.numbers("inertia");
  if (J.size() > 3 && (J[3] != 0 || J[4] != 0 || J[5] != 0)) return;
  const double largest = std::max({J[0], J[1], J[2]});
  if (2 * largest > (J[0] + J[1] + J[2]) * (1 + 1e-9))
    w.add(b, "inertia", fmt::format("no body has these moments: {:.4g} is more than the other two together", largest));
}

/// Coordinates are doubles, of 16 digits: far from the origin little is left of them.
void check_places(const Entry& e, Warnings& w) {
  constexpr double digit = std::numeric_limits<double>::epsilon() / 2, seen = 1e-9;  // [m]
  for (const char* key : {"at", "at_a", "at_b", "com"}) {
    if (!e.given(key) || e.section == "set" || e.values.find(key)->second.numbers.size() != 3) continue;
    const double far = e.vector3(key).norm();
    if (far * digit > seen)
      w.add(e, key, fmt::format("a place {:.3g} m from the origin, where positions are known to {:.1g} m{}", far, far * digit, units_hint));
  }
}

/// Shortest time in which the history goes one way by a tenth of its range or more; infinite without such a piece.
double shortest_rise(const History& h) {
  const auto [low, high] = std::minmax_element(h.value.begin(), h.value.end());
  double shortest = std::numeric_limits<double>::infinity();
  for (size_t i = 1, begin = 0; i < h.t.size(); ++i) {
    const bool last = i + 1 == h.t.size();
    if (!last && h.t[i + 1] > h.t[i] && h.t[i] > h.t[i - 1] && (h.value[i + 1] - h.value[i]) * (h.value[i] - h.value[i - 1]) > 0) continue;
    if (h.t[i] > h.t[begin] && std::abs(h.value[i] - h.value[begin]) >= 0.1 * (*high - *low) && *high > *low)
      shortest = std::min(shortest, h.t[i] - h.t[begin]);
    begin = i;
  }
  return shortest;
}

/// A history of a file that ends before the run, at a value that is not zero: that it is held may not be meant.
void warn_of_ends(const Entries& entries, const Entry& time, Warnings& w) {
  if (!time.has("end") || time.text("analysis") != "dynamic") return;
  const auto named = entries.find("history");
  if (named == entries.end()) return;
  for (const Entry& h : named->second) {
    if (!h.has("file")) continue;
    for (const auto& [section, list] : entries)
      for (const Entry& e : list)
        for (const auto& [key, v] : e.values) {
          if (!v.history || v.texts.empty() || v.texts[0] != h.name) continue;
          const History& table = *v.history;
          if (table.repeats || table.value.back() == 0 || table.t.back() >= time.number("end") * (1 - 1e-9)) continue;
          w.add(h, "file",
                fmt::format("the table ends at {:.4g} s, before the run does at {:.4g} s: its last value, {:.4g}, holds from there on",
                            table.t.back(), time.number("end"), table.value.back()));
          goto next;
        }
  next:;
  }
}

void check_beam(const Entry& e, Warnings& w) {
  if (e.text("fidelity") == "linear") return;
  for (const char* key : {"modes", "up_to", "modal_damping"})
    if (e.given(key)) w.add(e, key, "says nothing but to fidelity = \"linear\"");
}

/// Friction of joints is a force of the speed.
void warn_of_friction(const Entries& entries, const Entry& time, Warnings& w) {
  const auto list = entries.find("friction");
  const std::string& analysis = time.text("analysis");
  const bool starts = analysis == "dynamic" || analysis == "modes";
  if (list == entries.end() || (starts && time.text("start") != "equilibrium")) return;
  for (const Entry& e : list->second)
    w.add(e, "",
          fmt::format("it has no force in {}: what it would hold gives way there (a fixed joint holds it)",
                      starts ? "start = \"equilibrium\"" : fmt::format("analysis = \"{}\"", analysis)));
}

void warn_of_time(const Entries& entries, const Entry& time, Warnings& w) {
  if (time.has("reach") && time.text("analysis") != "path") w.add(time, "reach", "says nothing but to analysis = \"path\"");
  if (!time.has("step")) return;
  const double step = time.number("step");
  if (time.has("end") && step > time.number("end"))
    w.add(time, "step", fmt::format("a step of {:.4g} s is longer than the run of {:.4g} s", step, time.number("end")));
  const Entry& output = entries.find("output")->second.front();
  if (output.has("interval") && output.number("interval") < step)
    w.add(output, "interval", "shorter than the time step: fields are written every step");
  if (time.text("analysis") != "dynamic") return;
  std::set<std::string> said;
  for (const char* section : {"load", "motion"}) {
    const auto list = entries.find(section);
    if (list == entries.end()) continue;
    for (const auto& e : list->second) {
      if (!e.given("history")) continue;
      const Value& v = e.values.find("history")->second;
      const double rise = shortest_rise(*v.history);
      if (step <= rise / 10 * (1 + 1e-9) || (!v.texts.empty() && !said.insert(v.texts[0]).second)) continue;
      w.add(time, "step",
            fmt::format("a step of {:.4g} s is long for {}, whose history rises or falls within {:.4g} s", step, e.label(), rise));
    }
  }
}

/// Materials, histories, sets and sections that nothing names.
void check_unused(const Entries& entries, Warnings& w) {
  std::set<std::string> materials, histories, words;
  for (const auto& [section, list] : entries)
    for (const auto& e : list) {
      if ((section == "region" || section == "beam") && e.has("material")) materials.insert(e.text("material"));
      for (const auto& [key, value] : e.values) words.insert(value.texts.begin(), value.texts.end());
      const auto h = e.values.find("history");
      if (h != e.values.end() && !h->second.texts.empty()) histories.insert(h->second.texts[0]);
    }
  for (const auto& [section, used] :
       {std::pair("material", &materials), std::pair("history", &histories), std::pair("set", &words), std::pair("section", &words)})
    if (const auto list = entries.find(section); list != entries.end())
      for (const auto& e : list->second)
        if (!used->contains(e.name)) w.add(e, "", "nothing uses it");
}

}  // namespace

std::vector<std::string> find_implausible(const Entries& entries) {
  Warnings w;
  const Entry& scene = entries.find("scene")->second.front();
  const double g = scene.vector3("gravity").norm();
  if (g != 0 && (g < 0.1 || g > 30)) w.add(scene, "gravity", fmt::format("a gravity of {:.4g} m/s^2{}", g, units_hint));
  for (const auto& [section, list] : entries)
    for (const auto& e : list) {
      if (section == "material") check_material(e, w);
      if (section == "body") check_body(e, w);
      if (section == "beam") check_beam(e, w);
      check_places(e, w);
      if (section == "region" && e.number("mass_damping") > 0) w.add(e, "mass_damping", "brakes rigid motion too; `damping` does not");
    }
  warn_of_ends(entries, entries.find("time")->second.front(), w);
  warn_of_time(entries, entries.find("time")->second.front(), w);
  warn_of_friction(entries, entries.find("time")->second.front(), w);
  check_unused(entries, w);
  return std::move(w.lines);
}

}  // namespace hilo
