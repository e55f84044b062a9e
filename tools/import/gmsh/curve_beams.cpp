// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/curve_beams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "model/scene.hpp"
#include "physics/beam_section.hpp"

namespace hilo {
namespace {

using Way = std::vector<std::int64_t>;  // nodes along a beam
constexpr const char* example = "as in 'rail=tube:diameter=60,thickness=3'";

/// [section.NAME] in SI: lengths are in the unit of the file.
void write_section(SceneWriter& out, const std::string& group, const std::string& words, double metre) {
  const std::string option = fmt::format("--beams {}={}", group, words);
  const size_t colon = std::min(words.find(':'), words.size());
  const std::string kind = words.substr(0, colon), keys = colon < words.size() ? words.substr(colon + 1) : "";
  try {
    const Scene scene = Scene::parse(
        fmt::format("[section]\n{} = {{kind = {}{}{}}}\n", toml_text(group), toml_text(kind), keys.empty() ? "" : ", ", keys), "--beams");
    const Entry& e = scene.entries("section").front();
    const SectionKind& of = section_kinds().at(e.kind, option);
    if (!of.area) throw Error("", fmt::format("a section of kind {} is written into the scene", e.kind), "any kind with sizes here");
    SceneTable& section = out.add({"section", e.kind}, group, "");
    std::vector<Param> keys_of = of.keys;
    keys_of.push_back({"shear", Type::numbers, "", "", ""});
    for (const Param& key : keys_of) {
      if (!e.given(key.key)) continue;
      if (key.type != Type::number) throw Error("", fmt::format("{} is written into the scene", key.key), "leave it out here");
      const double power = key.unit == "m" ? 1 : key.unit == "m^2" ? 2 : key.unit == "m^4" ? 4 : 0;
      section.set(key.key, e.number(key.key) * std::pow(metre, power));
    }
  } catch (const Error& e) {
    throw Error("", option + ": " + e.message, e.hint.empty() ? example : e.hint, Exit::usage);
  }
}

/// The ways of a group: from stop to stop, then those that are closed without one.
std::vector<Way> ways_of(const std::vector<std::array<std::int64_t, 2>>& lines, const std::set<std::int64_t>& stops) {
  std::map<std::int64_t, std::vector<size_t>> at;
  for (size_t l = 0; l < lines.size(); ++l)
    for (const auto node : lines[l]) at[node].push_back(l);
  std::vector<char> used(lines.size());
  std::vector<Way> out;
  const auto go = [&](std::int64_t from, size_t line) {
    Way way{from};
    while (true) {
      used[line] = 1;
      way.push_back(lines[line][0] == way.back() ? lines[line][1] : lines[line][0]);
      if (way.back() == from || stops.contains(way.back())) break;
      const auto& next = at.at(way.back());
      line = next[0] == line ? next[1] : next[0];
    }
    if (way.back() == from && stops.contains(from)) {  // a loop on a fork: two beams, as one would be closed
      const auto middle = way.begin() + static_cast<std::ptrdiff_t>(way.size() / 2);
      out.emplace_back(way.begin(), middle + 1), out.emplace_back(middle, way.end());
    } else {
      out.push_back(std::move(way));
    }
  };
  for (const bool closed : {false, true})
    for (const auto& [node, of] : at)
      for (const size_t l : of)
        if (!used[l] && (closed || stops.contains(node))) go(node, l);
  return out;
}

}  // namespace

CurveBeams::CurveBeams(const ImportOptions& options) : options_(options) {
  for (const std::string& words : options.beams) {
    const size_t eq = words.find('=');
    if (eq == words.npos || eq == 0)
      throw Error("", fmt::format("--beams {}: expected GROUP=KIND:KEY=VALUE,...", words), example, Exit::usage);
    if (!sections_.emplace(words.substr(0, eq), words.substr(eq + 1)).second)
      throw Error("", fmt::format("--beams {}: stated twice", words.substr(0, eq)), "", Exit::usage);
  }
}

size_t CurveBeams::n_lines() const {
  size_t sum = 0;
  for (const auto& [group, lines] : lines_) sum += lines.size();
  return sum;
}

SceneWriter CurveBeams::scene(Imported& in, const std::map<std::int64_t, std::vector<std::string>>& points) const {
  const double metre = options_.scale * in.metre.value_or(to_si("m", options_.units));
  std::map<std::int64_t, std::vector<const std::string*>> groups_at;  // of each line end
  std::set<std::array<std::int64_t, 2>> known;
  SceneWriter out, beams;
  out.comment("# the material of the beams: [material.beams] with E, nu and density");
  for (const auto& [group, words] : sections_) {
    const auto lines = lines_.find(group);
    if (lines == lines_.end()) throw Error("", fmt::format("--beams {}: no curve group of this name has lines", group), "", Exit::usage);
    for (const auto& [a, b] : lines->second) {
      if (!known.insert({std::min(a, b), std::max(a, b)}).second)
        throw Error("", fmt::format("--beams {}: a line of this group is in the file twice, or in another group of beams too", group));
      groups_at[a].push_back(&group), groups_at[b].push_back(&group);
    }
    write_section(out, group, words, metre);
  }
  const std::set<std::int64_t> of_cells(in.mesh.nodes.begin(), in.mesh.nodes.end());
  if (const auto n = std::ranges::count_if(groups_at, [&](const auto& node) { return of_cells.contains(node.first); }))
    in.notes.push_back(fmt::format("{} nodes of beams belong to cells too: nothing joins them there, but `a` and `b` of a beam can", n));
  std::set<std::int64_t> stops;
  for (const auto& [node, groups] : groups_at)
    if (groups.size() != 2 || *groups[0] != *groups[1]) stops.insert(node);
  std::set<std::string> taken;
  std::map<std::int64_t, std::string> stands_on;  // the section of each node
  for (const auto& [group, lines] : lines_) {
    const std::vector<Way> ways = ways_of(lines, stops);
    for (size_t w = 0; w < ways.size(); ++w) {
      const Way& way = ways[w];
      std::string name = ways.size() == 1 ? group : fmt::format("{}_{}", group, w + 1);
      while (!taken.insert(name).second) name += "_";
      std::vector<Vec3> X;
      for (const auto node : way) X.push_back(in.mesh.X[static_cast<size_t>(node)] * metre);
      const bool closed = way.front() == way.back();
      std::string a, b;
      for (size_t k = 0; k < way.size(); ++k) {
        const bool last = k + 1 == way.size();
        const auto [on, fresh] = stands_on.try_emplace(way[k], last ? name + ".end" : fmt::format("{}.{}", name, k));
        if (!fresh && !closed) (last ? b : a) = on->second;
      }
      beams.add("beam", name, "curve group " + group,
                {{"points", X}, {"cells", std::vector{1}}, {"section", group}, {"material", "beams"}, {"a", a}, {"b", b}});
    }
  }
  for (const auto& [node, names] : points)
    if (const auto on = stands_on.find(node); on != stands_on.end())
      for (const std::string& name : names) out.comment(fmt::format("# point {} is {}", name, on->second));
  out.append(beams);
  return out;
}

}  // namespace hilo
