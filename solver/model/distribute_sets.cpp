// SPDX-License-Identifier: GPL-3.0-or-later
// Sets and names to the ranks that have their nodes and cells.
#include <fmt/format.h>

#include "model/distribution.hpp"

namespace hilo::division {

void Distribution::share_sets() {
  std::vector<Rows> entries(comm_.size);
  comm_.together([&] {
    for (size_t s = 0; s < sets_.size(); ++s) {
      const Slices slices{sets_[s].rows, comm_.size};
      const auto first = slices.first(comm_.rank), n = slices.first(comm_.rank + 1) - first;
      const auto values = mesh_file().read_rows<std::int64_t>(sets_[s].array, first, n);
      const int width = sets_[s].kind == facet ? 2 : 1;
      if (static_cast<std::int64_t>(values.size()) != width * n) throw damaged(sets_[s].array + " has a wrong number of columns");
      for (std::int64_t i = 0; i < n; ++i) {
        const auto row = values[i * width];
        const Slices& of = sets_[s].kind == node ? nodes_ : cells_;
        if (row < 0 || row >= of.n) throw damaged(fmt::format("{} holds {}, allowed is 0 to {}", sets_[s].array, row, of.n - 1));
        entries[of.holder(row)].insert(entries[of.holder(row)].end(),
                                       {static_cast<std::int64_t>(s), row, width == 2 ? values[2 * i + 1] : 0});
      }
    }
  });
  std::vector<Rows> forward(comm_.size);
  for (const auto& list : comm_.exchange(entries))
    for (size_t k = 0; k < list.size(); k += 3) {
      const auto pass = [&](int r) { forward[r].insert(forward[r].end(), list.begin() + k, list.begin() + k + 3); };
      if (sets_[list[k]].kind == node)
        for (const int r : holders_[list[k + 1] - nodes_.first(comm_.rank)]) pass(r);
      else
        pass(rank_of_cell_[list[k + 1] - cells_.first(comm_.rank)]);
    }
  Mesh& m = out_.mesh;
  const auto received = comm_.exchange(forward);
  comm_.together([&] {
    for (const auto& list : received)
      for (size_t k = 0; k < list.size(); k += 3) {
        const Set& set = sets_[list[k]];
        if (set.kind == node) {
          m.node_sets[set.name].push_back(local_node(list[k + 1]));
          continue;
        }
        const auto c = local_cell(list[k + 1]);
        if (set.kind == cell) {
          m.cell_sets[set.name].push_back(c);
          continue;
        }
        if (list[k + 2] < 0 || list[k + 2] >= static_cast<std::int64_t>(info(m.shape[c]).facets.size()))
          throw damaged(fmt::format("{} names facet {} of a {}", set.array, list[k + 2], info(m.shape[c]).name));
        m.facet_sets[set.name].push_back({c, list[k + 2]});
      }
  });
  for (auto& [name, set] : m.node_sets) std::sort(set.begin(), set.end());
  for (auto& [name, set] : m.cell_sets) std::sort(set.begin(), set.end());
  for (auto& [name, set] : m.facet_sets)
    std::sort(set.begin(), set.end(),
              [](const Facet& a, const Facet& b) { return std::pair(a.cell, a.facet) < std::pair(b.cell, b.facet); });
}

void Distribution::complete_names() {
  const Mesh& m = out_.mesh;
  std::vector<std::string> names = m.region_name;
  std::vector<std::pair<std::int64_t, std::int64_t>> mine;  // row of a shared node, name
  const auto belongs = [&](std::span<const std::int64_t> nodes, size_t name) {
    for (const auto i : nodes)
      if (shared_[i]) mine.emplace_back(out_.node_global[i], name);
  };
  for (std::int64_t c = 0; c < m.n_cells(); ++c) belongs(m.cell(c), m.region[c]);
  // where kinds of sets share a name, Mesh::nodes_of takes the first of region, node set, facet set and cell set
  const auto is_taken = [&](const std::string& name) { return m.find_region(name) >= 0 || m.node_sets.contains(name); };
  for (const auto& [name, set] : m.facet_sets) {
    if (is_taken(name)) continue;
    for (const auto& f : set) belongs(m.facet_nodes(f), names.size());
    names.push_back(name);
  }
  for (const auto& [name, set] : m.cell_sets) {
    if (is_taken(name) || m.facet_sets.contains(name)) continue;
    for (const auto c : set) belongs(m.cell(c), names.size());
    names.push_back(name);
  }
  std::sort(mine.begin(), mine.end());
  mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
  std::vector<Rows> tell(comm_.size), forward(comm_.size);
  for (const auto& [row, name] : mine) tell[nodes_.holder(row)].insert(tell[nodes_.holder(row)].end(), {row, name});
  const auto told = comm_.exchange(tell);
  for (int from = 0; from < comm_.size; ++from)
    for (size_t k = 0; k < told[from].size(); k += 2)
      for (const int r : holders_[told[from][k] - nodes_.first(comm_.rank)])
        if (r != from) forward[r].insert(forward[r].end(), {told[from][k], told[from][k + 1]});
  for (const auto& list : comm_.exchange(forward))
    for (size_t k = 0; k < list.size(); k += 2)
      if (!std::binary_search(mine.begin(), mine.end(), std::pair(list[k], list[k + 1])))
        out_.elsewhere[names[list[k + 1]]].push_back(local_node(list[k]));
  for (auto& [name, nodes] : out_.elsewhere) sort_unique(nodes);
}

}  // namespace hilo::division
