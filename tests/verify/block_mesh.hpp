// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of cells of any shape, made by the test itself: regions along x, faces as facet sets, straight edges.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "model/mesh.hpp"

namespace hilo::test {

/// What block_mesh makes: a box of nx x ny x nz bricks, each one hexahedron, two wedges or six tetrahedra.
struct BlockOptions {
  Shape shape = Shape::hex8;
  int n[3] = {1, 1, 1};
  Vec3 low = Vec3::Zero(), high = Vec3::Ones();
  std::function<Vec3(const Vec3&)> map = nullptr;  // of the corners; edges stay straight
  std::vector<std::string> regions = {"block"};
  std::function<int(const Vec3&)> region_of = nullptr;  // by the centre of a brick, before the map
};

/// A number in [-1, 1] that looks random and is the same everywhere.
inline double scatter(int seed) {
  const double x = std::sin(12.9898 * (seed + 1)) * 43758.5453;
  return 2 * (x - std::floor(x)) - 1;
}

/// Facet sets xmin xmax ymin ymax zmin zmax and `surface` (all of them).
inline Mesh block_mesh(const BlockOptions& o) {
  Mesh m;
  m.region_name = o.regions;
  m.region_data.resize(o.regions.size());
  const int nx = o.n[0], ny = o.n[1], nz = o.n[2];
  std::vector<Vec3> plain;  // positions before the map
  const auto add_node = [&](const Vec3& at, const Vec3& x) {
    plain.push_back(at);
    m.X.push_back(x);
    m.node_id.push_back(m.n_nodes());
    return m.n_nodes() - 1;
  };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        const Vec3 s(double(i) / nx, double(j) / ny, double(k) / nz), at = o.low + s.cwiseProduct(o.high - o.low);
        add_node(at, o.map ? o.map(at) : at);
      }
  const auto grid = [&](int i, int j, int k) { return std::int64_t{i} + (nx + 1) * (j + std::int64_t{ny + 1} * k); };
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> middle;
  const auto between = [&](std::int64_t a, std::int64_t b) {
    const auto key = std::minmax(a, b);
    const auto [it, fresh] = middle.try_emplace({key.first, key.second}, -1);
    if (fresh) it->second = add_node((plain[a] + plain[b]) / 2, (m.X[a] + m.X[b]) / 2);
    return it->second;
  };
  using Edges = std::vector<std::pair<int, int>>;
  const Edges tet{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
      wedge{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
      hex{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  const auto add_cell = [&](std::vector<std::int64_t> nodes, int region) {
    const Edges* edges = o.shape == Shape::tet10 ? &tet : o.shape == Shape::wedge15 ? &wedge : info(o.shape).n_nodes == 20 ? &hex : nullptr;
    if (edges)
      for (const auto& [a, b] : *edges) nodes.push_back(between(nodes[a], nodes[b]));
    m.add_cell(o.shape, nodes, region, m.n_cells() + 1);
  };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::int64_t c[8] = {grid(i, j, k),     grid(i + 1, j, k),     grid(i + 1, j + 1, k),     grid(i, j + 1, k),
                                   grid(i, j, k + 1), grid(i + 1, j, k + 1), grid(i + 1, j + 1, k + 1), grid(i, j + 1, k + 1)};
        const int region = o.region_of ? o.region_of((plain[c[0]] + plain[c[6]]) / 2) : 0;
        if (info(o.shape).n_corners == 8) {
          add_cell({c, c + 8}, region);
        } else if (o.shape == Shape::wedge6 || o.shape == Shape::wedge15) {
          add_cell({c[0], c[1], c[2], c[4], c[5], c[6]}, region);
          add_cell({c[0], c[2], c[3], c[4], c[6], c[7]}, region);
        } else {  // the six tetrahedra about the diagonal 0-6
          static constexpr int path[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
          for (const auto& [a, b] : path) add_cell({c[0], c[a], c[b], c[6]}, region);
        }
      }
  const char* face[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const int n_facets = static_cast<int>(info(o.shape).facets.size());
    for (int f = 0; f < n_facets; ++f)
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
          const double at = side ? o.high[axis] : o.low[axis], tiny = 1e-9 * (o.high - o.low).norm();
          const auto nodes = m.facet_nodes({c, f});
          if (std::all_of(nodes.begin(), nodes.end(), [&](std::int64_t a) { return std::abs(plain[a][axis] - at) < tiny; })) {
            m.facet_sets[face[axis][side]].push_back({c, f});
            m.facet_sets["surface"].push_back({c, f});
          }
        }
  }
  return m;
}

/// Nodes that satisfy a condition on their reference position, as a node set.
inline void add_node_set(Mesh& m, const std::string& name, const std::function<bool(const Vec3&)>& in) {
  for (std::int64_t a = 0; a < m.n_nodes(); ++a)
    if (in(m.X[a])) m.node_sets[name].push_back(a);
}

}  // namespace hilo::test
