// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/split.hpp"

#include <metis.h>

#include <algorithm>

namespace hilo::petsc {
namespace {

bool hang_together(idx_t n, const idx_t* first, const idx_t* next) {
  std::vector<char> seen(n, 0);
  std::vector<idx_t> stack(1, 0);
  seen[0] = 1;
  idx_t count = 0;
  while (!stack.empty()) {
    const idx_t i = stack.back();
    stack.pop_back();
    ++count;
    for (idx_t k = first[i]; k < first[i + 1]; ++k)
      if (!seen[next[k]]) seen[next[k]] = 1, stack.push_back(next[k]);
  }
  return count == n;
}

}  // namespace

std::vector<int> split_cliques(const Cliques& cliques, const BlockMap& map, int n) {
  std::vector<int> part(cliques.size(), 0);
  std::vector<idx_t> start{0}, blocks;
  std::vector<int> cell;  // cliques with a volume: those that can share a facet
  const auto is_flexible = [&](int i) { return i >= 0 && map.global[i] < map.first_dense; };
  for (int e = 0; e < cliques.size(); ++e) {
    const auto list = cliques[e];
    if (std::count_if(list.begin(), list.end(), is_flexible) < 3) continue;
    for (const int i : list)
      if (is_flexible(i)) blocks.push_back(i);
    start.push_back(static_cast<idx_t>(blocks.size()));
    cell.push_back(e);
  }
  if (n == 1 || static_cast<int>(cell.size()) < 2 * n) return part;
  idx_t cells = static_cast<idx_t>(cell.size()), nodes = static_cast<idx_t>(map.global.size()), common = 3, from_zero = 0, constraints = 1,
        parts = n, cut = 0;
  idx_t *first = nullptr, *next = nullptr;
  if (METIS_MeshToDual(&cells, &nodes, start.data(), blocks.data(), &common, &from_zero, &first, &next) != METIS_OK) throw std::bad_alloc();
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;  // the same for the same input
  std::vector<idx_t> of_cell(cell.size(), 0);
  const auto run = [&](auto metis) {
    return metis(&cells, &constraints, first, next, nullptr, nullptr, nullptr, &parts, nullptr, nullptr, options, &cut, of_cell.data());
  };
  options[METIS_OPTION_CONTIG] = hang_together(cells, first, next);
  if (run(METIS_PartGraphKway) != METIS_OK) std::fill(of_cell.begin(), of_cell.end(), 0);
  METIS_Free(first);
  METIS_Free(next);
  // bars, springs and joints go where their first block is
  std::vector<int> of_block(map.global.size(), -1);
  for (size_t c = cell.size(); c-- > 0;) {
    part[cell[c]] = static_cast<int>(of_cell[c]);
    for (const int i : cliques[cell[c]])
      if (is_flexible(i)) of_block[i] = part[cell[c]];
  }
  for (int e = 0; e < cliques.size(); ++e) {
    const auto list = cliques[e];
    const auto at = std::find_if(list.begin(), list.end(), is_flexible);
    if (at == list.end() || std::count_if(list.begin(), list.end(), is_flexible) > 2) continue;
    part[e] = std::max(0, of_block[*at]);
    for (const int i : list)
      if (is_flexible(i) && of_block[i] < 0) of_block[i] = part[e];
  }
  return part;
}

}  // namespace hilo::petsc
