// SPDX-License-Identifier: GPL-3.0-or-later
// Linear cells become quadratic: a node in the middle of every edge.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>

#include "base/error.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

using Edges = std::vector<std::array<int, 2>>;
/// Edges in the order of the mid-side nodes (VTK).
const Edges& edges_of(Shape s) {
  static const Edges none, tet{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}},
      wedge{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
      hex{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  switch (s) {
    case Shape::tet4:
    case Shape::tet10:
      return tet;
    case Shape::wedge6:
    case Shape::wedge15:
      return wedge;
    case Shape::hex8:
    case Shape::hex20:
    case Shape::hex20r:
      return hex;
    default:
      return none;
  }
}

Shape quadratic(Shape s) {
  return s == Shape::tet4 ? Shape::tet10 : s == Shape::wedge6 ? Shape::wedge15 : s == Shape::hex8 ? Shape::hex20r : s;
}

struct EdgeHash {
  size_t operator()(const std::pair<std::int64_t, std::int64_t>& e) const {
    return static_cast<size_t>(e.first) * 0x9e3779b97f4a7c15ull ^ (static_cast<size_t>(e.second) + 0x7f4a7c15u) * 0xbf58476d1ce4e5b9ull;
  }
};

}  // namespace

void raise_order(Imported& in, double metres) {
  Mesh& m = in.mesh;
  std::unordered_map<std::pair<std::int64_t, std::int64_t>, std::int64_t, EdgeHash> middle;
  const auto ends = [](std::int64_t a, std::int64_t b) { return std::pair(std::min(a, b), std::max(a, b)); };
  const auto n_linear = m.n_nodes();
  // where quadratic cells are beside linear ones, their nodes serve both
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto s = static_cast<Shape>(m.shape[c]);
    const auto& edges = edges_of(s);
    if (quadratic(s) == s)
      for (size_t i = 0; i < edges.size(); ++i)
        middle[ends(m.cell(c)[edges[i][0]], m.cell(c)[edges[i][1]])] = m.cell(c)[info(s).n_corners + static_cast<int>(i)];
  }
  std::int64_t next_id = m.node_id.empty() ? 1 : *std::max_element(m.node_id.begin(), m.node_id.end()) + 1;
  std::vector<std::array<std::int64_t, 2>> ends_of;  // of the new nodes
  Mesh cells;
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto s = static_cast<Shape>(m.shape[c]);
    const auto old = m.cell(c);
    std::vector<std::int64_t> nodes(old.begin(), old.end());
    if (quadratic(s) == s && info(s).dimension == 3 && info(s).n_nodes == info(s).n_corners)
      throw Error("", fmt::format("--order 2: {} has no quadratic form here", info(s).name), "", Exit::usage);
    for (const auto& [i, j] : quadratic(s) != s ? edges_of(s) : Edges{}) {
      const auto [it, fresh] = middle.try_emplace(ends(old[i], old[j]), m.n_nodes());
      if (fresh) {
        m.X.push_back((m.X[old[i]] + m.X[old[j]]) / 2);
        m.node_id.push_back(next_id++);
        ends_of.push_back({old[i], old[j]});
      }
      nodes.push_back(it->second);
    }
    cells.add_cell(quadratic(s), nodes, m.region[c], m.cell_id[c]);
  }
  replace_cells(m, std::move(cells));
  // a set that holds both ends of an edge holds its middle
  std::vector<char> inside(n_linear);
  for (auto& [name, set] : m.node_sets) {
    if (in.as_listed.count(name)) continue;
    std::fill(inside.begin(), inside.end(), 0);
    for (const auto a : set) inside[a] = 1;
    for (size_t i = 0; i < ends_of.size(); ++i)
      if (inside[ends_of[i][0]] && inside[ends_of[i][1]]) set.push_back(n_linear + static_cast<std::int64_t>(i));
  }
  hold_middles(in, ends_of, metres);
  if (m.n_nodes() > n_linear)
    in.notes.push_back(fmt::format("order 2: {} nodes in the middle of edges; node sets that hold both ends of an edge hold it too",
                                   m.n_nodes() - n_linear));
}

std::int64_t straighten(Mesh& m) {
  std::vector<char> done(m.shape.size(), 0);
  std::int64_t count = 0;
  for (bool again = true; again;) {
    again = false;
    for (std::int64_t c = 0; c < m.n_cells(); ++c) {
      const auto s = static_cast<Shape>(m.shape[c]);
      if (done[c] || info(s).n_nodes == info(s).n_corners) continue;
      if (const auto q = quality(m, c); q.volume > 0 && q.scaled_jacobian > 0) continue;
      const auto& edges = edges_of(s);
      for (size_t i = 0; i < edges.size(); ++i)
        m.X[m.cell(c)[info(s).n_corners + static_cast<int>(i)]] = (m.X[m.cell(c)[edges[i][0]]] + m.X[m.cell(c)[edges[i][1]]]) / 2;
      done[c] = again = true;
      ++count;
    }
  }
  return count;
}

}  // namespace hilo
