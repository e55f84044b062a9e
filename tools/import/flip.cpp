// SPDX-License-Identifier: GPL-3.0-or-later
// --flip: cells whose nodes are numbered as in a mirror, inside out, are turned.
#include <vector>

#include "import/imported.hpp"

namespace hilo {
namespace {

/// A numbering that turns a shape inside out: new[i] = old[node[i]]; and the facet that each facet becomes.
struct Turned {
  std::vector<int> node, facet;
};
const Turned& turned(int n_corners) {
  static const Turned tet{{1, 0, 2, 3, 4, 6, 5, 8, 7, 9}, {0, 2, 1, 3}};
  static const Turned wedge{{3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14}, {1, 0, 2, 3, 4}};
  static const Turned hex{{4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19}, {0, 1, 2, 3, 5, 4}};
  return n_corners == 4 ? tet : n_corners == 6 ? wedge : hex;
}

}  // namespace

bool is_mirrored(const Mesh& m, std::int64_t cell) { return info(m.shape[cell]).dimension == 3 && quality(m, cell).volume < 0; }

std::int64_t flip(Mesh& m) {
  std::vector<char> flipped(m.shape.size(), 0);
  std::int64_t count = 0;
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    if (!is_mirrored(m, c)) continue;
    const std::vector<std::int64_t> old(m.cell(c).begin(), m.cell(c).end());
    for (size_t i = 0; i < old.size(); ++i)
      m.nodes[static_cast<size_t>(m.offset[c]) + i] = old[static_cast<size_t>(turned(info(m.shape[c]).n_corners).node[i])];
    flipped[c] = 1, ++count;
  }
  for (auto& [name, set] : m.facet_sets)
    for (Facet& f : set)
      if (flipped[f.cell]) f.facet = turned(info(m.shape[f.cell]).n_corners).facet[static_cast<size_t>(f.facet)];
  return count;
}

}  // namespace hilo
