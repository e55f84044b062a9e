// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/surface/skin_builder.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

namespace hilo {
namespace {

constexpr double sharp = 0.766;  // cosine of 40 degrees: a wheel of twelve sides is still round

/// Shape functions of a facet with mid-side nodes after its corners.
std::vector<double> tri6(double r, double s) {
  const double t = 1 - r - s;
  return {t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t};
}
std::vector<double> quad8(double r, double s) {  // r, s in [-1, 1]
  return {(1 - r) * (1 - s) * (-r - s - 1) / 4,
          (1 + r) * (1 - s) * (r - s - 1) / 4,
          (1 + r) * (1 + s) * (r + s - 1) / 4,
          (1 - r) * (1 + s) * (-r + s - 1) / 4,
          (1 - r * r) * (1 - s) / 2,
          (1 + r) * (1 - s * s) / 2,
          (1 - r * r) * (1 + s) / 2,
          (1 - r) * (1 - s * s) / 2};
}

/// Sort items that name a point first: into buckets of that point by counting, then within these few.
template <class Item, class Point, class Less>
void sort_by_point(std::vector<Item>& items, size_t n_points, Point&& point, Less&& less) {
  std::vector<std::int64_t> start(n_points + 1, 0);
  for (const Item& i : items) ++start[static_cast<size_t>(point(i)) + 1];
  for (size_t p = 1; p < start.size(); ++p) start[p] += start[p - 1];
  std::vector<Item> sorted(items.size());
  auto next = start;
  for (const Item& i : items) sorted[static_cast<size_t>(next[static_cast<size_t>(point(i))]++)] = i;
  for (size_t p = 0; p < n_points; ++p)
    if (start[p + 1] - start[p] > 1) std::sort(sorted.begin() + start[p], sorted.begin() + start[p + 1], less);
  items = std::move(sorted);
}

}  // namespace

SkinBuilder::SkinBuilder(const Mesh& mesh, std::span<const Facet> facets, std::span<const std::int64_t> bars, const Plane* cut,
                         std::span<const std::int64_t> cells)
    : mesh_(mesh), node_point_(static_cast<size_t>(mesh.n_nodes()), -1), cut_(cut) {
  if (cut_) {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vec3& x : mesh.X) low = low.cwiseMin(x), high = high.cwiseMax(x);
    near_ = 1e-9 * (high - low).norm();
  }
  for (const Facet& f : facets) {
    const auto& local = info(mesh.shape[static_cast<size_t>(f.cell)]).facets[static_cast<size_t>(f.facet)];
    std::array<std::int64_t, 8> nodes{};
    for (size_t k = 0; k < local.size(); ++k) nodes[k] = mesh.cell(f.cell)[static_cast<size_t>(local[k])];
    const std::span<const std::int64_t> used(nodes.data(), local.size());
    if (local.size() <= 4)
      add_linear(used, f.cell);
    else
      add_quadratic(used, local.size() == 6 ? 3 : 4, f.cell);
  }
  bar_cell.assign(bars.begin(), bars.end());
  for (const std::int64_t c : bars) bar_ends.push_back({point_of_node(mesh.cell(c)[0]), point_of_node(mesh.cell(c)[1])});
  if (cut_) {
    clip_edges(facet_edges), clip_edges(bar_ends, &bar_cell);
    add_section(cells);
  }
  for (auto& e : facet_edges)
    if (e[0] > e[1]) std::swap(e[0], e[1]);
  sort_by_point(
      facet_edges, position_.size(), [](const auto& e) { return e[0]; }, std::less<>());
  facet_edges.erase(std::unique(facet_edges.begin(), facet_edges.end()), facet_edges.end());
  find_feature_edges();
  split_at_sharp_edges();
}

std::int64_t SkinBuilder::new_point(std::span<const std::int64_t> nodes, std::span<const double> weights) {
  Vec3 x = Vec3::Zero();
  for (size_t k = 0; k < nodes.size(); ++k) {
    if (weights[k] == 0) continue;
    node.push_back(nodes[k]), weight.push_back(weights[k]);
    x += weights[k] * mesh_.X[static_cast<size_t>(nodes[k])];
  }
  first.push_back(static_cast<std::int64_t>(node.size()));
  position_.push_back(x);
  return static_cast<std::int64_t>(position_.size()) - 1;
}

std::int64_t SkinBuilder::point_of_node(std::int64_t n) {
  auto& point = node_point_[static_cast<size_t>(n)];
  if (point < 0) point = new_point(std::array{n}, std::array{1.0});
  return point;
}

void SkinBuilder::add_polygon(std::span<const std::int64_t> points, std::int64_t cell) {
  cut_ ? add_clipped(points, cell) : keep_polygon(points, cell);
}

void SkinBuilder::keep_polygon(std::span<const std::int64_t> points, std::int64_t cell) {
  corner.insert(corner.end(), points.begin(), points.end());
  polygon.push_back(static_cast<std::int64_t>(corner.size()));
  face_cell.push_back(cell);
}

void SkinBuilder::add_linear(std::span<const std::int64_t> nodes, std::int64_t cell) {
  std::array<std::int64_t, 4> p{};
  for (size_t k = 0; k < nodes.size(); ++k) p[k] = point_of_node(nodes[k]);
  for (size_t k = 0; k < nodes.size(); ++k) facet_edges.push_back({p[k], p[(k + 1) % nodes.size()]});
  add_polygon({p.data(), nodes.size()}, cell);
}

std::int64_t SkinBuilder::edge_point(std::span<const std::int64_t> nodes, std::span<const double> weights, std::int64_t a, std::int64_t b,
                                     int quarter) {
  const std::array<std::int64_t, 3> key =
      a < b ? std::array<std::int64_t, 3>{a, b, quarter} : std::array<std::int64_t, 3>{b, a, 4 - quarter};
  const auto found = on_edge_.find(key);
  if (found != on_edge_.end()) return found->second;
  return on_edge_[key] = new_point(nodes, weights);
}

void SkinBuilder::add_quadratic(std::span<const std::int64_t> nodes, int n_corners, std::int64_t cell) {
  // Grid of points, (i, j) in quarters: the square 0..4 x 0..4, or its half i + j <= 4.
  std::array<std::array<std::int64_t, 5>, 5> grid{};
  const bool triangle = n_corners == 3;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= (triangle ? 4 - j : 4); ++i) {
      auto& p = grid[static_cast<size_t>(i)][static_cast<size_t>(j)];
      auto w = triangle ? tri6(i / 4.0, j / 4.0) : quad8(i / 2.0 - 1, j / 2.0 - 1);
      for (double& x : w)
        if (std::abs(x) < 1e-14) x = 0;
      const auto along = [&](size_t a, size_t b, int quarter) {
        if (quarter == 0)
          p = point_of_node(nodes[a]);
        else if (quarter == 4)
          p = point_of_node(nodes[b]);
        else
          p = edge_point(nodes, w, nodes[a], nodes[b], quarter);
      };
      if (j == 0)
        along(0, 1, i);
      else if (triangle && i + j == 4)
        along(1, 2, j);
      else if (!triangle && i == 4)
        along(1, 2, j);
      else if (!triangle && j == 4)
        along(3, 2, i);
      else if (i == 0)
        along(0, triangle ? 2 : 3, j);
      else
        p = new_point(nodes, w);
    }
  const auto at = [&](int i, int j) { return grid[static_cast<size_t>(i)][static_cast<size_t>(j)]; };
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < (triangle ? 4 - j : 4); ++i) {
      if (!triangle)
        add_polygon(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, cell);
      else
        add_polygon(std::array{at(i, j), at(i + 1, j), at(i, j + 1)}, cell);
      if (triangle && i + j < 3) add_polygon(std::array{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, cell);
    }
  for (int k = 0; k < 4; ++k) {
    facet_edges.push_back({at(k, 0), at(k + 1, 0)});
    facet_edges.push_back({at(0, k), at(0, k + 1)});
    if (triangle) {
      facet_edges.push_back({at(4 - k, k), at(3 - k, k + 1)});
    } else {
      facet_edges.push_back({at(4, k), at(4, k + 1)});
      facet_edges.push_back({at(k, 4), at(k + 1, 4)});
    }
  }
}

Vec3 SkinBuilder::normal(size_t face) const {
  const auto* c = corner.data() + polygon[face];
  const auto x = [&](int k) -> const Vec3& { return position_[static_cast<size_t>(c[k])]; };
  const auto sides = static_cast<int>(polygon[face + 1] - polygon[face]);
  Vec3 n = sides == 3 ? (x(1) - x(0)).cross(x(2) - x(0)) : (x(2) - x(0)).cross(x(3) - x(1));
  for (int k = 4; k < sides; ++k) n += (x(k - 1) - x(0)).cross(x(k) - x(0));  // the rest of a cut polygon
  return n.normalized();
}

void SkinBuilder::find_feature_edges() {
  struct Side {
    std::int64_t a, b;
    size_t face;
  };
  std::vector<Side> sides;
  sides.reserve(corner.size());
  for (size_t f = 0; f < face_cell.size(); ++f) {
    const auto n = polygon[f + 1] - polygon[f];
    for (std::int64_t k = 0; k < n; ++k) {
      const auto a = corner[static_cast<size_t>(polygon[f] + k)], b = corner[static_cast<size_t>(polygon[f] + (k + 1) % n)];
      sides.push_back({std::min(a, b), std::max(a, b), f});
    }
  }
  sort_by_point(
      sides, position_.size(), [](const Side& s) { return s.a; },
      [](const Side& s, const Side& t) { return std::tie(s.b, s.face) < std::tie(t.b, t.face); });
  for (size_t i = 0; i < sides.size();) {
    size_t j = i;
    while (j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b) ++j;
    bool feature = j - i != 2;
    if (!feature) {
      const size_t f = sides[i].face, g = sides[i + 1].face;
      const auto region = [&](size_t face) { return mesh_.region[static_cast<size_t>(face_cell[face])]; };
      feature = region(f) != region(g) || normal(f).dot(normal(g)) < sharp;
    }
    if (feature) feature_edges.push_back({sides[i].a, sides[i].b});
    i = j;
  }
}

void SkinBuilder::split_at_sharp_edges() {
  // Corners of the polygons around each point, gathered by counting.
  std::vector<std::int64_t> start(position_.size() + 1, 0);
  for (const auto p : corner) ++start[static_cast<size_t>(p) + 1];
  for (size_t p = 1; p < start.size(); ++p) start[p] += start[p - 1];
  struct Around {
    std::int64_t place;  // in `corner`
    size_t face;
  };
  std::vector<Around> around(corner.size());
  auto next = start;
  for (size_t f = 0; f < face_cell.size(); ++f)
    for (std::int64_t k = polygon[f]; k < polygon[f + 1]; ++k)
      around[static_cast<size_t>(next[static_cast<size_t>(corner[static_cast<size_t>(k)])]++)] = {k, f};

  std::vector<Vec3> normals(face_cell.size());
  for (size_t f = 0; f < normals.size(); ++f) normals[f] = normal(f);
  std::vector<size_t> patch;
  for (size_t p = 0; p < position_.size(); ++p) {
    const auto n = static_cast<size_t>(start[p + 1] - start[p]);
    const Around* here = around.data() + start[p];
    patch.assign(n, n);
    for (size_t i = 0; i < n; ++i) {  // grow a patch from every face that has none yet
      if (patch[i] != n) continue;
      const auto vertex = static_cast<std::int64_t>(vertex_point.size());
      vertex_point.push_back(static_cast<std::int64_t>(p));
      std::vector<size_t> open{i};
      patch[i] = i;
      while (!open.empty()) {
        const size_t a = open.back();
        open.pop_back();
        corner[static_cast<size_t>(here[a].place)] = vertex;
        const auto region = [&](size_t k) { return mesh_.region[static_cast<size_t>(face_cell[here[k].face])]; };
        for (size_t b = 0; b < n; ++b)
          if (patch[b] == n && region(b) == region(a) && normals[here[a].face].dot(normals[here[b].face]) > sharp)
            patch[b] = i, open.push_back(b);
      }
    }
  }
}

}  // namespace hilo
