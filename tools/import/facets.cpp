// SPDX-License-Identifier: GPL-3.0-or-later
// Faces given by nodes, found among the facets of the cells.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>

#include "base/error.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

/// The corner nodes of a facet, sorted: what two facets that touch have in common.
using Key = std::array<std::int64_t, 4>;
struct KeyHash {
  size_t operator()(const Key& k) const {
    std::uint64_t h = 1469598103934665603ull;
    for (const auto x : k) h = (h ^ static_cast<std::uint64_t>(x)) * 1099511628211ull, h ^= h >> 29;
    return h;
  }
};

Key key_of(const std::int64_t* nodes, size_t n) {
  Key k{-1, -1, -1, -1};  // a triangle keeps one -1
  for (size_t i = 0; i < n && i < k.size(); ++i) k[i] = nodes[i];
  std::sort(k.begin(), k.end());
  return k;
}

/// Corner nodes of a facet in its outward order; a facet has 3 or 4 corners, with as many mid-side nodes behind them or none.
size_t corners(const Mesh& m, std::int64_t c, size_t f, std::int64_t* out) {
  const ShapeInfo& s = info(m.shape[c]);
  size_t n = 0;
  for (const int a : s.facets[f])
    if (a < s.n_corners && n < 4) out[n++] = m.cell(c)[a];
  return n;
}

/// Whether two cyclic lists of the same nodes turn the same way.
bool same_turn(const std::vector<std::int64_t>& face, const std::int64_t* facet, size_t n) {
  const auto at = std::find(facet, facet + n, face[0]) - facet;
  return facet[(at + 1) % static_cast<std::ptrdiff_t>(n)] == face[1];
}

}  // namespace

std::vector<int> facet_corners(const ShapeInfo& s, size_t facet) {
  std::vector<int> corners = s.facets[facet];
  std::erase_if(corners, [&](int a) { return a >= s.n_corners; });
  return corners;
}

std::vector<Facet> match_facets(const Mesh& mesh, const std::vector<std::vector<std::int64_t>>& faces) {
  std::vector<Facet> found(faces.size(), {-1, -1});
  std::unordered_map<Key, std::vector<size_t>, KeyHash> index;
  for (size_t i = 0; i < faces.size(); ++i) index[key_of(faces[i].data(), faces[i].size())].push_back(i);
  if (index.empty()) return found;
  std::int64_t nodes[4];
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    for (size_t f = 0; f < info(mesh.shape[c]).facets.size(); ++f) {
      const size_t n = corners(mesh, c, f, nodes);
      if (n < 3) continue;
      const auto hit = index.find(key_of(nodes, n));
      if (hit == index.end()) continue;
      for (const size_t i : hit->second)
        if (found[i].cell < 0 || same_turn(faces[i], nodes, n) != is_mirrored(mesh, c)) found[i] = {c, static_cast<std::int64_t>(f)};
    }
  return found;
}

std::vector<Facet> free_facets(const Mesh& mesh, const std::vector<std::int64_t>& cells) {
  std::unordered_map<Key, int, KeyHash> count;
  std::int64_t nodes[4];
  for (const auto c : cells)
    for (size_t f = 0; f < info(mesh.shape[c]).facets.size(); ++f)
      if (const size_t n = corners(mesh, c, f, nodes); n >= 3) count[key_of(nodes, n)] = 0;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    for (size_t f = 0; f < info(mesh.shape[c]).facets.size(); ++f)
      if (const size_t n = corners(mesh, c, f, nodes); n >= 3)
        if (const auto it = count.find(key_of(nodes, n)); it != count.end()) ++it->second;
  std::vector<Facet> free;
  for (const auto c : cells)
    for (size_t f = 0; f < info(mesh.shape[c]).facets.size(); ++f)
      if (const size_t n = corners(mesh, c, f, nodes); n >= 3 && count[key_of(nodes, n)] == 1)
        free.push_back({c, static_cast<std::int64_t>(f)});
  return free;
}

std::vector<Facet> facets_within(const Mesh& mesh, const std::vector<std::int64_t>& nodes) {
  std::vector<char> in(mesh.X.size(), 0);
  for (const auto i : nodes) in[i] = 1;
  std::vector<std::int64_t> cells;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    if (std::ranges::any_of(mesh.cell(c), [&](std::int64_t i) { return in[i]; })) cells.push_back(c);
  std::vector<Facet> out = free_facets(mesh, cells);
  std::erase_if(out, [&](const Facet& f) { return !std::ranges::all_of(mesh.facet_nodes(f), [&](std::int64_t i) { return in[i]; }); });
  return out;
}

void refuse_flat(const std::string& file, std::int64_t flat, std::int64_t solids) {
  if (flat > 0 && solids == 0)
    throw Error(file, fmt::format("{} flat cells (triangles, quadrangles) and no volume", flat),
                "a surface alone, as in an STL, has no volume: mesh its inside; lines beside flat cells are their edges, not bars");
}

LineEnds lines_on_solids(const Mesh& m, const std::vector<std::pair<std::int64_t, std::int64_t>>& lines) {
  std::vector<char> end(m.X.size(), 0);
  for (const auto& [a, b] : lines) end[a] = end[b] = 1;
  const LineEnds wanted(lines.begin(), lines.end());
  LineEnds found;
  std::vector<std::int64_t> ends;
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    if (info(m.shape[c]).dimension != 3) continue;
    ends.clear();
    for (int i = 0; i < info(m.shape[c]).n_corners; ++i)
      if (end[m.cell(c)[i]]) ends.push_back(m.cell(c)[i]);
    for (const auto a : ends)
      for (const auto b : ends)
        if (wanted.count({a, b})) found.insert({a, b});
  }
  return found;
}

}  // namespace hilo
