// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mesh_pieces.hpp"

#include "base/joined.hpp"

namespace hilo {

std::vector<std::int64_t> pieces_of(const Mesh& m) {
  Joined<std::int64_t> nodes(m.X.size());
  for (std::int64_t c = 0; c < m.n_cells(); ++c)
    for (const auto a : m.cell(c)) nodes.join(m.cell(c)[0], a);
  std::vector<std::int64_t> of_block(m.block_name.size(), -1);
  for (size_t a = 0; a < m.block.size(); ++a)
    if (const auto b = m.block[a]; b >= 0) {
      auto& one = of_block[static_cast<size_t>(b)];
      if (one < 0) one = static_cast<std::int64_t>(a);
      nodes.join(one, static_cast<std::int64_t>(a));
    }
  std::vector<std::int64_t> out;
  for (size_t a = 0; a < nodes.size(); ++a) out.push_back(nodes.root(static_cast<std::int64_t>(a)));
  return out;
}

}  // namespace hilo
