// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the unknowns, here and over all ranks.
#include <algorithm>
#include <map>

#include "system/points.hpp"

namespace hilo {

Layout Points::layout_of_points() {
  Layout out;
  const auto [n_node_blocks, n_local] = number_points(out.cliques);
  out.first_row = n_local;
  out.map = number_globally(n_node_blocks, n_local);
  return out;
}

/// Local blocks; the number of those of nodes, and of all.
std::pair<int, int> Points::number_points(Cliques& cliques) {
  const int n = static_cast<int>(X.size());
  node_block.assign(n, -1), body_block.assign(bodies.size(), -1), body_clique.assign(bodies.size(), -1);
  UnknownField nodes, centres, turns, amplitudes;
  nodes.array = &Config::x, nodes.held = &fixed;
  centres.array = &Config::c, centres.stride = 2;
  turns.update = UnknownField::Update::turn, turns.stride = 2;
  int next = 0;
  for (int i = 0; i < n; ++i)
    if (follower[i] < 0) node_block[i] = next++, nodes.item.push_back(i);
  const int n_node_blocks = next;
  centres.first = next, turns.first = next + 1;
  std::vector<size_t> order;  // bodies that cells hold stand beside the nodes
  for (const bool with_cells : {true, false})
    for (size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].free() && bodies[b].has_cells == with_cells) order.push_back(b);
  for (const size_t b : order) {
    const int blocks[2] = {next, next + 1};
    body_block[b] = next, next += 2;
    body_clique[b] = cliques.add(blocks);
    centres.item.push_back(static_cast<int>(b)), turns.item.push_back(static_cast<int>(b)), turns.lever.push_back(bodies[b].size);
  }
  amplitudes.array = &Config::eta, amplitudes.first = next;
  for (Modes& m : modes) {
    m.block = next;
    const int body = body_block[m.body];
    std::vector<int> blocks{body, body < 0 ? -1 : body + 1};
    for (int k = 0; k < m.n_blocks; ++k) {
      blocks.push_back(next++);
      amplitudes.item.push_back(m.first + k), amplitudes.lever.push_back(m.lever[k]);
    }
    m.clique = cliques.add(blocks);
  }
  unknowns = {std::move(nodes), std::move(centres), std::move(turns), std::move(amplitudes)};
  return {n_node_blocks, next};
}

void Points::lowest_over_ranks(std::vector<std::int64_t>& value) const {
  if (comm->size == 1) return;
  std::vector<std::vector<std::int64_t>> tell(comm->size), ask(comm->size);
  for (size_t i = 0; i < X.size(); ++i) {
    const std::int64_t row = mesh->node_global[i];
    tell[row % comm->size].push_back(row), tell[row % comm->size].push_back(value[i]);
    ask[row % comm->size].push_back(row);
  }
  std::map<std::int64_t, std::int64_t> lowest;
  for (const auto& list : comm->exchange(tell))
    for (size_t k = 0; k + 1 < list.size(); k += 2) {
      const auto [it, fresh] = lowest.try_emplace(list[k], list[k + 1]);
      if (!fresh) it->second = std::min(it->second, list[k + 1]);
    }
  auto asked = comm->exchange(ask);
  for (auto& list : asked)
    for (auto& row : list) row = lowest.at(row);
  const auto answers = comm->exchange(asked);
  std::vector<size_t> cursor(comm->size, 0);
  for (size_t i = 0; i < X.size(); ++i) {
    const auto keeper = mesh->node_global[i] % comm->size;
    value[i] = answers[keeper][cursor[keeper]++];
  }
}

/// Local blocks, `n_node_blocks` of them of nodes, over all ranks.
BlockMap Points::number_globally(int n_node_blocks, int n_local) const {
  BlockMap map;
  map.X.assign(3 * static_cast<size_t>(n_local), 0.0);
  for (size_t i = 0; i < X.size(); ++i)
    if (node_block[i] >= 0)
      for (int k = 0; k < 3; ++k) map.X[3 * node_block[i] + k] = X[i][k];
  for (size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].has_cells && body_block[b] >= 0) {
      for (int k = 0; k < 6; ++k) map.X[3 * body_block[b] + k] = bodies[b].Xc[k % 3];
      map.n_with_cells += 2;
    }
  map.global.resize(n_local);
  if (comm->size == 1) {
    for (int i = 0; i < n_local; ++i) map.global[i] = i;
    map.n_owned = map.n_global = n_local;
    map.first_dense = n_node_blocks;
    return map;
  }
  // owned nodes are numbered rank after rank; bodies and multipliers come last and belong to the last rank
  std::int64_t owned = 0;
  for (size_t i = 0; i < X.size(); ++i) owned += node_block[i] >= 0 && node_owned[i];
  std::vector<double> counts(comm->size, 0.0);
  counts[comm->rank] = static_cast<double>(owned);
  comm->sum(counts);
  std::int64_t before = 0, total = 0;
  for (int r = 0; r < comm->size; ++r) {
    if (r < comm->rank) before += static_cast<std::int64_t>(counts[r]);
    total += static_cast<std::int64_t>(counts[r]);
  }
  // shared nodes ask for their number at the rank that keeps the row of the file (row modulo ranks)
  std::vector<std::vector<std::int64_t>> tell(comm->size), ask(comm->size);
  std::int64_t next = before;
  for (size_t i = 0; i < X.size(); ++i) {
    if (node_block[i] < 0) continue;
    const std::int64_t row = mesh->node_global[i];
    const int keeper = static_cast<int>(row % comm->size);
    if (node_owned[i]) {
      map.global[node_block[i]] = next;
      tell[keeper].push_back(row), tell[keeper].push_back(next);
      ++next;
    } else {
      ask[keeper].push_back(row);
    }
  }
  std::map<std::int64_t, std::int64_t> number_of_row;
  for (const auto& list : comm->exchange(tell))
    for (size_t k = 0; k + 1 < list.size(); k += 2) number_of_row[list[k]] = list[k + 1];
  auto asked = comm->exchange(ask);
  for (auto& list : asked)
    for (auto& row : list) row = number_of_row.at(row);
  const auto answers = comm->exchange(asked);
  std::vector<size_t> cursor(comm->size, 0);
  for (size_t i = 0; i < X.size(); ++i)
    if (node_block[i] >= 0 && !node_owned[i]) {
      const int keeper = static_cast<int>(mesh->node_global[i] % comm->size);
      map.global[node_block[i]] = answers[keeper][cursor[keeper]++];
    }
  for (int i = n_node_blocks; i < n_local; ++i) map.global[i] = total + (i - n_node_blocks);
  map.first = before;
  map.n_owned = owned;
  map.first_dense = total;
  map.n_global = total + (n_local - n_node_blocks);
  if (comm->rank == comm->size - 1) map.n_owned += n_local - n_node_blocks;
  return map;
}

}  // namespace hilo
