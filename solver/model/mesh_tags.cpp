// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mesh_tags.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.hpp"
#include "base/joined.hpp"
#include "model/scene_toml.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

const std::vector<std::string> keys{"rigid", "linear", "nonlinear", "rest"};

std::string place_text(const toml::node& node) { return place_of_node(node).text(); }

Vec3 read_point(const toml::node& node) {
  const auto* list = node.as_array();
  if (!list || list->size() != 3) throw Error(place_text(node), "a corner of a box is three numbers", "box = [[x, y, z], [x, y, z]]");
  Vec3 x;
  for (int i = 0; i < 3; ++i) {
    const auto number = (*list)[i].value<double>();
    if (!number) throw Error(place_text((*list)[i]), fmt::format("wanted a number, not {}", type_word((*list)[i])));
    if (!std::isfinite(*number)) throw Error(place_text((*list)[i]), "a corner of a box is three finite numbers");
    x[i] = *number;
  }
  return x;
}

void order_box(TagRule& rule) {
  const Vec3 a = rule.low, b = rule.high;
  rule.low = a.cwiseMin(b), rule.high = a.cwiseMax(b);
}

TagRule read_rule(Fidelity fidelity, const toml::node& node) {
  TagRule rule{fidelity, TagRule::By::name, "", {}, {}, place_text(node)};
  if (const auto text = node.value<std::string>()) {
    rule.pattern = *text;
    return rule;
  }
  const auto* table = node.as_table();
  if (!table) throw Error(rule.where, fmt::format("wanted a name, {{box = ...}} or {{set = ...}}, not {}", type_word(node)));
  if (table->size() != 1) throw Error(rule.where, "wanted one of {box = ...} and {set = ...}");
  const Item item = in_file_order(*table).front();
  if (item.key == "box") {
    const auto* corners = item.node->as_array();
    if (!corners || corners->size() != 2) throw Error(place_text(*item.node), "a box is two corners", "box = [[x, y, z], [x, y, z]]");
    rule.by = TagRule::By::box;
    rule.low = read_point((*corners)[0]), rule.high = read_point((*corners)[1]);
    order_box(rule);
  } else if (item.key == "set") {
    rule.by = TagRule::By::set;
    const auto name = item.node->value<std::string>();
    if (!name) throw Error(place_text(*item.node), fmt::format("wanted the name of a set, not {}", type_word(*item.node)));
    rule.pattern = *name;
  } else {
    throw Error(item.place.text(), fmt::format("unknown key \"{}\"", item.key), suggest(item.key, std::vector<std::string>{"box", "set"}));
  }
  return rule;
}

std::string described(const TagRule& rule) {
  if (rule.by == TagRule::By::box)
    return fmt::format("no region lies wholly inside the box [{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}]", rule.low[0], rule.low[1],
                       rule.low[2], rule.high[0], rule.high[1], rule.high[2]);
  if (rule.by == TagRule::By::set) return fmt::format("no region lies wholly inside the set \"{}\"", rule.pattern);
  return fmt::format("no region \"{}\"", rule.pattern);
}

std::vector<int> all_where(const std::vector<char>& inside) {
  std::vector<int> regions;
  for (size_t r = 0; r < inside.size(); ++r)
    if (inside[r]) regions.push_back(static_cast<int>(r));
  return regions;
}

/// Regions whose cells all pass.
template <class Passes>
std::vector<int> regions_of_cells(const Mesh& mesh, const Passes& passes) {
  std::vector<char> inside(mesh.region_name.size(), 1), seen(inside.size(), 0);
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    seen[mesh.region[c]] = 1;
    if (!passes(c)) inside[mesh.region[c]] = 0;
  }
  for (size_t r = 0; r < inside.size(); ++r) inside[r] = inside[r] && seen[r];
  return all_where(inside);
}

std::vector<int> in_box(const Mesh& mesh, const TagRule& rule) {
  const Vec3 slack = Vec3::Constant(1e-9 * (rule.high - rule.low).norm());  // a region that fills the box is inside
  const Vec3 low = rule.low - slack, high = rule.high + slack;
  return regions_of_cells(mesh, [&](std::int64_t c) {
    return std::ranges::all_of(
        mesh.cell(c), [&](auto n) { return (mesh.X[n].array() >= low.array()).all() && (mesh.X[n].array() <= high.array()).all(); });
  });
}

std::vector<int> in_set(const Mesh& mesh, const TagRule& rule) {
  if (const auto set = mesh.cell_sets.find(rule.pattern); set != mesh.cell_sets.end()) {
    std::vector<char> in(mesh.shape.size(), 0);
    for (const auto c : set->second) in[c] = 1;
    return regions_of_cells(mesh, [&](std::int64_t c) { return in[c] != 0; });
  }
  std::vector<char> in(mesh.X.size(), 0);
  for (const auto n : mesh.nodes_of(rule.pattern, rule.where)) in[n] = 1;
  return regions_of_cells(mesh, [&](std::int64_t c) { return std::ranges::all_of(mesh.cell(c), [&](auto n) { return in[n] != 0; }); });
}

std::vector<int> matched(const Mesh& mesh, const TagRule& rule) {
  if (rule.by == TagRule::By::box) return in_box(mesh, rule);
  if (rule.by == TagRule::By::set) return in_set(mesh, rule);
  if (const int r = mesh.find_region(rule.pattern); r >= 0) return {r};
  std::vector<char> match;
  for (const auto& name : mesh.region_name) match.push_back(::fnmatch(rule.pattern.c_str(), name.c_str(), 0) == 0);
  return all_where(match);
}

}  // namespace

TagRules read_tag_rules(const std::string& path) {
  TagRules rules;
  const toml::table root = parse_toml(read_text_file(path), path);
  for (const Item& item : in_file_order(root)) {
    const std::string where = item.place.text();
    if (std::find(keys.begin(), keys.end(), item.key) == keys.end()) {
      const auto hint = suggest(item.key, keys);
      throw Error(where, fmt::format("unknown key \"{}\"", item.key), hint.empty() ? "rigid, linear, nonlinear or rest" : hint);
    }
    if (item.key == "rest") {
      const auto text = item.node->value<std::string>();
      if (!text) throw Error(place_text(*item.node), fmt::format("wanted rigid, linear or nonlinear, not {}", type_word(*item.node)));
      rules.rest = fidelity_of(*text, place_text(*item.node));
      continue;
    }
    const auto* list = item.node->as_array();
    if (!list)
      throw Error(place_text(*item.node), fmt::format("wanted a list of regions, not {}", type_word(*item.node)),
                  fmt::format("{} = [\"name\"]", item.key));
    for (const auto& node : *list) rules.rules.push_back(read_rule(fidelity_of(item.key, where), node));
  }
  return rules;
}

TagRule tag_rule_of_option(Fidelity fidelity, const std::string& option, const std::string& word) {
  TagRule rule{fidelity, TagRule::By::name, word, {}, {}, fmt::format("{} {}", option, word)};
  if (word.starts_with("set:")) rule.by = TagRule::By::set, rule.pattern = word.substr(4);
  if (!word.starts_with("box:")) return rule;
  rule.by = TagRule::By::box;
  const char* at = word.data() + 4;
  for (int i = 0; i < 6; ++i) {
    double& x = i < 3 ? rule.low[i] : rule.high[i - 3];
    const auto [end, error] = std::from_chars(at, word.data() + word.size(), x);
    const bool last = end == word.data() + word.size();
    if (error != std::errc() || !std::isfinite(x) || last != (i == 5) || (!last && *end != ','))
      throw Error(rule.where, "wanted box:x,y,z,x,y,z", "", Exit::usage);
    at = end + 1;
  }
  order_box(rule);
  return rule;
}

std::vector<std::optional<Fidelity>> apply_tag_rules(const Mesh& mesh, const TagRules& rules) {
  const size_t n = mesh.region_name.size();
  std::vector<std::optional<Fidelity>> fidelity(n);
  std::vector<const TagRule*> by(n, nullptr);
  for (const auto& rule : rules.rules) {
    const auto regions = matched(mesh, rule);
    if (regions.empty()) {
      std::string hint = suggest(rule.pattern, mesh.region_name);
      if (rule.pattern.ends_with(".h5") || rule.pattern.ends_with(".toml")) hint = "files come before the options";
      throw Error(rule.where, described(rule), rule.by == TagRule::By::name ? hint : "");
    }
    for (const int r : regions) {
      if (by[r] && by[r]->fidelity != rule.fidelity)
        throw Error(rule.where, fmt::format("region \"{}\" is tagged twice: {} here, {} at {}", mesh.region_name[r], word(rule.fidelity),
                                            word(by[r]->fidelity), by[r]->where));
      by[r] = &rule;
      fidelity[r] = rule.fidelity;
    }
  }
  if (rules.rest)
    for (auto& f : fidelity)
      if (!f) f = rules.rest;
  return fidelity;
}

std::vector<int> body_of_region(const Mesh& mesh, std::span<const Fidelity> fidelity) {
  Joined regions(fidelity.size());
  std::vector<int> owner(mesh.X.size(), -1);  // a rigid region that has the node
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const int r = mesh.region[c];
    if (fidelity[r] != Fidelity::rigid) continue;
    for (const auto n : mesh.cell(c)) {
      if (owner[n] < 0) owner[n] = r;
      regions.join(owner[n], r);
    }
  }
  std::vector<int> body(fidelity.size(), -1);
  int count = 0;
  for (int r = 0; r < static_cast<int>(body.size()); ++r)
    if (fidelity[r] == Fidelity::rigid) body[r] = regions.root(r) == r ? count++ : body[regions.root(r)];
  return body;
}

}  // namespace hilo
