// SPDX-License-Identifier: GPL-3.0-or-later
// Pyramids of five nodes, of which hilo has no cell.
#include <fmt/format.h>

#include <algorithm>

#include "import/imported.hpp"

namespace hilo {

std::array<std::vector<std::int64_t>, 2> halves_of_pyramid(std::span<const std::int64_t> n) {
  const auto lowest = std::min_element(n.begin(), n.begin() + 4) - n.begin();
  if (lowest % 2 == 0) return {{{n[0], n[1], n[2], n[4]}, {n[0], n[2], n[3], n[4]}}};
  return {{{n[0], n[1], n[3], n[4]}, {n[1], n[2], n[3], n[4]}}};
}

std::vector<std::vector<Facet>> facets_of(const Mesh& mesh, const std::vector<std::vector<std::int64_t>>& faces) {
  std::vector<std::vector<Facet>> out(faces.size());
  std::vector<std::vector<std::int64_t>> halves;
  std::vector<size_t> of;
  const auto found = match_facets(mesh, faces);
  for (size_t i = 0; i < faces.size(); ++i) {
    if (found[i].cell >= 0) out[i].push_back(found[i]);
    if (found[i].cell >= 0 || faces[i].size() != 4) continue;
    const auto& f = faces[i];
    const auto k = static_cast<size_t>(std::ranges::min_element(f) - f.begin());  // as halves_of_pyramid() cuts it
    halves.push_back({f[k], f[(k + 1) % 4], f[(k + 2) % 4]});
    halves.push_back({f[k], f[(k + 2) % 4], f[(k + 3) % 4]});
    of.push_back(i);
  }
  const auto two = match_facets(mesh, halves);
  for (size_t j = 0; j < of.size(); ++j)
    if (two[2 * j].cell >= 0 && two[2 * j + 1].cell >= 0) out[of[j]] = {two[2 * j], two[2 * j + 1]};
  return out;
}

void tell_pyramids(Imported& in, std::int64_t n) {
  if (n == 0) return;
  in.notes.push_back(fmt::format("{} pyramids are two tetrahedra each", n));
  std::set<std::vector<std::int64_t>> quadrangles;  // of other cells, by their nodes
  std::int64_t beside = 0;
  const Mesh& m = in.mesh;
  const auto key = [](std::vector<std::int64_t> nodes) {
    std::ranges::sort(nodes);
    return nodes;
  };
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const ShapeInfo& s = info(m.shape[c]);
    if (s.dimension != 3) continue;
    for (size_t f = 0; f < s.facets.size(); ++f) {
      std::vector<std::int64_t> corners;
      for (const int a : facet_corners(s, f)) corners.push_back(m.cell(c)[a]);
      if (corners.size() == 4) quadrangles.insert(key(corners));
    }
  }
  for (std::int64_t c = 0; c + 1 < m.n_cells(); ++c) {  // two halves stand side by side, and share the apex, which is their last node
    const auto a = m.cell(c), b = m.cell(c + 1);
    if (m.shape[c] != static_cast<std::uint8_t>(Shape::tet4) || m.shape[c + 1] != m.shape[c] || a[3] != b[3]) continue;
    std::vector<std::int64_t> base{a[0], a[1], a[2], b[0], b[1], b[2]};
    sort_unique(base);
    if (base.size() == 4) beside += quadrangles.contains(base);
  }
  if (beside > 0)
    in.notes.push_back(
        fmt::format("warning: {} pyramids stand on a quadrangle of a hexahedron or prism: fields agree at its corners alone, and it counts "
                    "as outer surface",
                    beside));
}

}  // namespace hilo
