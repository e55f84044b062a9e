// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mesh_pieces.hpp"

#include <algorithm>
#include <numeric>

namespace hilo {

std::vector<std::int64_t> pieces_of(const Mesh& m) {
  std::vector<std::int64_t> parent(m.X.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int64_t a) {
    while (parent[a] != a) a = parent[a] = parent[parent[a]];
    return a;
  };
  const auto unite = [&](std::int64_t a, std::int64_t b) {
    const auto x = root(a), y = root(b);
    parent[std::max(x, y)] = std::min(x, y);
  };
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    for (const auto a : m.cell(c)) unite(m.cell(c)[0], a);
  std::vector<std::int64_t> of_block(m.block_name.size(), -1);
  for (size_t a = 0; a < m.block.size(); ++a)
    if (const auto b = m.block[a]; b >= 0) {
      auto& one = of_block[static_cast<size_t>(b)];
      if (one < 0) one = static_cast<std::int64_t>(a);
      unite(one, static_cast<std::int64_t>(a));
    }
  for (size_t a = 0; a < parent.size(); ++a) parent[a] = root(static_cast<std::int64_t>(a));
  return parent;
}

}  // namespace hilo
