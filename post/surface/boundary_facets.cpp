// SPDX-License-Identifier: GPL-3.0-or-later
// The outside of what is shown of a mesh.
#include <array>

#include "model/facet_key.hpp"
#include "post/surface/skin.hpp"

namespace hilo {

std::vector<Facet> boundary_facets(const Mesh& mesh, const std::vector<bool>& shown) {
  // Facets meet in a bucket of their smallest corner node, and are the same when the next two corners are too; one seen twice is inside.
  struct Seen {
    std::array<std::int64_t, 2> next;
    std::int64_t facet;  // 8 cell + local facet, -1 once seen twice
  };
  const auto key_of = [&](const Facet& f, std::int64_t& smallest) {
    const auto corner = facet_key(mesh, f, [](std::int64_t n) { return n; });
    smallest = corner[0];
    return std::array{corner[1], corner[2]};
  };
  const auto each = [&](auto&& visit) {
    for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
      const auto& shape = info(mesh.shape[static_cast<size_t>(c)]);
      if (shape.dimension < 3 || !shown[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])]) continue;
      for (std::int64_t f = 0; f < static_cast<std::int64_t>(shape.facets.size()); ++f) visit(Facet{c, f});
    }
  };
  std::vector<std::int64_t> first(static_cast<size_t>(mesh.n_nodes()) + 1, 0);
  std::int64_t smallest = 0;
  each([&](const Facet& f) { key_of(f, smallest), ++first[static_cast<size_t>(smallest) + 1]; });
  for (size_t n = 1; n < first.size(); ++n) first[n] += first[n - 1];
  std::vector<Seen> seen(static_cast<size_t>(first.back()));
  std::vector<std::int64_t> end(first.begin(), first.end() - 1);
  each([&](const Facet& f) {
    const auto next = key_of(f, smallest);
    const auto b = static_cast<size_t>(smallest);
    for (std::int64_t k = first[b]; k < end[b]; ++k)
      if (seen[static_cast<size_t>(k)].next == next) {
        seen[static_cast<size_t>(k)].facet = -1;
        return;
      }
    seen[static_cast<size_t>(end[b]++)] = {next, 8 * f.cell + f.facet};
  });
  std::vector<std::uint8_t> once(static_cast<size_t>(mesh.n_cells()), 0);  // facets of each cell, one bit each
  for (size_t n = 0; n + 1 < first.size(); ++n)
    for (std::int64_t k = first[n]; k < end[n]; ++k)
      if (const auto f = seen[static_cast<size_t>(k)].facet; f >= 0)
        once[static_cast<size_t>(f / 8)] |= static_cast<std::uint8_t>(1 << (f % 8));
  std::vector<Facet> outside;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    for (std::int64_t f = 0; once[static_cast<size_t>(c)] >> f; ++f)
      if (once[static_cast<size_t>(c)] >> f & 1) outside.push_back({c, f});
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)  // shells have no inside
    if (info(mesh.shape[static_cast<size_t>(c)]).dimension == 2 && shown[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])])
      outside.push_back({c, 0});
  return outside;
}

}  // namespace hilo
