// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "base/error.hpp"

namespace hilo {

void Mesh::add_cell(Shape s, std::span<const std::int64_t> cell_nodes, std::int32_t cell_region, std::int64_t id) {
  if (static_cast<int>(cell_nodes.size()) != info(s).n_nodes)
    throw Error("", fmt::format("cell {}: {} has {} nodes, not {}", id, info(s).name, info(s).n_nodes, cell_nodes.size()), "", Exit::fault);
  shape.push_back(static_cast<std::uint8_t>(s));
  nodes.insert(nodes.end(), cell_nodes.begin(), cell_nodes.end());
  offset.push_back(static_cast<std::int64_t>(nodes.size()));
  region.push_back(cell_region);
  cell_id.push_back(id);
}

std::vector<std::int64_t> Mesh::facet_nodes(const Facet& f) const {
  const auto c = cell(f.cell);
  std::vector<std::int64_t> out;
  for (const int a : info(shape[f.cell]).facets[f.facet]) out.push_back(c[a]);
  return out;
}

std::vector<std::int64_t> Mesh::nodes_of(const std::string& name, const std::string& where) const {
  std::vector<std::int64_t> out;
  const auto take = [&](std::span<const std::int64_t> list) { out.insert(out.end(), list.begin(), list.end()); };
  if (const int r = find_region(name); r >= 0) {
    for (std::int64_t c = 0; c < n_cells(); ++c)
      if (region[c] == r) take(cell(c));
  } else if (const auto n = node_sets.find(name); n != node_sets.end()) {
    take(n->second);
  } else if (const auto f = facet_sets.find(name); f != facet_sets.end()) {
    for (const auto& facet : f->second) take(facet_nodes(facet));
  } else if (const auto s = cell_sets.find(name); s != cell_sets.end()) {
    for (const auto c : s->second) take(cell(c));
  } else {
    throw Error(where, fmt::format("no region or set \"{}\" in the mesh", name), suggest(name, all_names()));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

int Mesh::find_region(std::string_view name) const {
  constexpr size_t many = 100;
  if (region_name.size() < many) {
    const auto at = std::find(region_name.begin(), region_name.end(), name);
    return at == region_name.end() ? -1 : static_cast<int>(at - region_name.begin());
  }
  // the numbers of the list asked for last: it is the same one for thousands of names
  thread_local std::unordered_map<std::string, int> number;
  thread_local const std::string* list = nullptr;
  const auto has = [&](size_t r) {
    const auto at = number.find(region_name[r]);
    return at != number.end() && at->second == static_cast<int>(r);
  };
  const size_t last = region_name.size() - 1;
  if (list != region_name.data() || number.size() != region_name.size() || !has(0) || !has(last / 2) || !has(last)) {  // another list
    number.clear(), list = region_name.data();
    for (size_t r = 0; r < region_name.size(); ++r) number.emplace(region_name[r], static_cast<int>(r));
  }
  const auto at = number.find(std::string(name));
  return at == number.end() ? -1 : at->second;
}

std::vector<std::string> Mesh::all_names() const {
  std::vector<std::string> names = region_name;
  for (const auto& [name, list] : node_sets) names.push_back(name);
  for (const auto& [name, list] : facet_sets) names.push_back(name);
  for (const auto& [name, list] : cell_sets) names.push_back(name);
  return names;
}

namespace {
const std::vector<std::string> words{"nonlinear", "rigid", "linear"};
}

std::string_view word(Fidelity f) { return words[static_cast<size_t>(f)]; }

Fidelity fidelity_of(std::string_view text, const std::string& where) {
  const auto at = std::find(words.begin(), words.end(), text);
  if (at != words.end()) return static_cast<Fidelity>(at - words.begin());
  const auto hint = suggest(text, words);
  throw Error(where, fmt::format("unknown fidelity \"{}\"", text), hint.empty() ? "rigid, linear or nonlinear" : hint);
}

}  // namespace hilo
