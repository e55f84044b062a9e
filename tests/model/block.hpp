// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes made by hand for tests: reference cells, and blocks of hexahedra.
#pragma once
#include <functional>

#include "model/mesh.hpp"

namespace hilo::test {

/// Corners of the reference cell of a shape, then the middles of its edges: volume 1/6, 1/2 or 1 (length 1 for the bar).
inline std::vector<Vec3> reference_nodes(Shape shape) {
  switch (shape) {
    case Shape::bar2:
      return {{0, 0, 0}, {1, 0, 0}};
    case Shape::tet4:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case Shape::tet10:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}};
    case Shape::wedge6:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    case Shape::wedge15:
      return {{0, 0, 0},  {1, 0, 0},  {0, 1, 0},   {0, 0, 1},  {1, 0, 1},  {0, 1, 1},  {.5, 0, 0}, {.5, .5, 0},
              {0, .5, 0}, {.5, 0, 1}, {.5, .5, 1}, {0, .5, 1}, {0, 0, .5}, {1, 0, .5}, {0, 1, .5}};
    case Shape::hex8:
      return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    case Shape::hex20:
    case Shape::hex20r:
      return {{0, 0, 0},  {1, 0, 0},  {1, 1, 0},  {0, 1, 0},  {0, 0, 1},  {1, 0, 1},  {1, 1, 1},  {0, 1, 1},  {.5, 0, 0}, {1, .5, 0},
              {.5, 1, 0}, {0, .5, 0}, {.5, 0, 1}, {1, .5, 1}, {.5, 1, 1}, {0, .5, 1}, {0, 0, .5}, {1, 0, .5}, {1, 1, .5}, {0, 1, .5}};
  }
  return {};
}

inline Mesh one_cell(
    Shape shape, const std::function<Vec3(const Vec3&)>& map = [](const Vec3& x) { return x; }) {
  Mesh m;
  std::vector<std::int64_t> nodes;
  for (const Vec3& x : reference_nodes(shape)) {
    nodes.push_back(m.n_nodes());
    m.X.push_back(map(x));
    m.node_id.push_back(m.n_nodes());
  }
  m.region_name = {"all"};
  m.region_data.resize(1);
  m.add_cell(shape, nodes, 0, 1);
  return m;
}

/// nx x ny x nz cubes of edge 1; cells with the same region_of(i) along x make a region.
inline Mesh block(
    int nx, int ny, int nz, const std::vector<std::string>& regions = {"all"},
    const std::function<int(int)>& region_of = [](int) { return 0; }) {
  Mesh m;
  const auto node = [&](int i, int j, int k) { return std::int64_t{i} + (nx + 1) * (j + std::int64_t{ny + 1} * k); };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) m.X.emplace_back(i, j, k), m.node_id.push_back(m.n_nodes());
  m.region_name = regions;
  m.region_data.resize(regions.size());
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::int64_t n[] = {node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
                                  node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
        m.add_cell(Shape::hex8, n, region_of(i), m.n_cells() + 1);
      }
  for (std::int64_t a = 0; a < m.n_nodes(); ++a)
    if (m.X[a].x() == 0) m.node_sets["left"].push_back(a);
  for (std::int64_t c = 0; c < m.n_cells(); c += nx) m.facet_sets["left face"].push_back({c, 0});
  m.cell_sets["first"] = {0, 1};
  return m;
}

}  // namespace hilo::test
