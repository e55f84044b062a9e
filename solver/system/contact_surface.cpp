// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/contact_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace hilo {
namespace {

FacetCut cut(size_t n) {
  FacetCut out;
  const auto node = [](int i) {
    std::array<double, 8> share{};
    share[i] = 1;
    return share;
  };
  const int corners = n == 3 || n == 6 ? 3 : 4, m = static_cast<int>(n);
  for (int i = 0; i < m; ++i) out.corner.push_back(node(i));
  if (n == 3) {
    out.triangle = {{0, 1, 2}}, out.on_edge = {{0, 1, 2}};
  } else if (n == 6) {
    out.triangle = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}, out.on_edge = {{0, -1, 2}, {0, 1, -1}, {-1, 1, 2}, {-1, -1, -1}};
  } else {  // about the middle
    std::array<double, 8> middle{};
    const FacetShape shape = facet_shape(n, 0, 0);
    std::copy_n(shape.N, n, middle.begin());
    out.corner.push_back(middle);
    for (int e = 0; e < corners; ++e) {
      const int next = (e + 1) % corners;
      if (n == 4) {
        out.triangle.push_back({e, next, m}), out.on_edge.push_back({e, -1, -1});
      } else {
        out.triangle.push_back({e, 4 + e, m}), out.on_edge.push_back({e, -1, -1});
        out.triangle.push_back({4 + e, next, m}), out.on_edge.push_back({e, -1, -1});
      }
    }
  }
  return out;
}

}  // namespace

const FacetCut& cut_of(size_t n) {
  static const FacetCut cuts[4] = {cut(3), cut(4), cut(6), cut(8)};
  return cuts[n == 3 ? 0 : n == 4 ? 1 : n == 6 ? 2 : 3];
}

FacetPoints facet_points(std::span<const Vec3> X) {
  const size_t n = X.size();
  const bool triangle = n == 3 || n == 6;
  FacetPoints out;
  const double g = 1 / std::sqrt(3.0);
  const std::vector<std::array<double, 2>> at =
      triangle ? std::vector<std::array<double, 2>>{{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}}
               : std::vector<std::array<double, 2>>{{-g, -g}, {g, -g}, {g, g}, {-g, g}};
  for (const auto& [r, s] : at) {
    const FacetShape shape = facet_shape(n, r, s);
    Vec3 tr = Vec3::Zero(), ts = Vec3::Zero();
    for (size_t a = 0; a < n; ++a) tr += shape.dr[a] * X[a], ts += shape.ds[a] * X[a];
    out.share.emplace_back(shape.N, shape.N + n);
    out.area.push_back(tr.cross(ts).norm() * (triangle ? 1. / 6 : 1));
  }
  return out;
}

void ContactSurface::find_borders() {
  std::map<std::pair<int, int>, int> seen;
  const auto each = [&](auto&& visit) {
    for (Face& face : faces) {
      const int corners = face.n == 3 || face.n == 6 ? 3 : 4;
      for (int e = 0; e < corners; ++e) visit(face, e, std::minmax(int{face.node[e]}, int{face.node[(e + 1) % corners]}));
    }
  };
  each([&](Face&, int, std::pair<int, int> edge) { ++seen[edge]; });
  each([&](Face& face, int e, std::pair<int, int> edge) { face.border[e] = seen[edge] == 1; });
}

Vec3 ContactSurface::at(const SurfacePoint& point, std::span<const Vec3> x) const {
  const Face& face = faces[point.face];
  Vec3 out = Vec3::Zero();
  for (int a = 0; a < face.n; ++a) out += point.share[a] * x[face.node[a]];
  return out;
}

std::array<Vec3, 3> ContactSurface::triangle(int number, int triangle, std::span<const Vec3> x) const {
  const Face& face = faces[number];
  const FacetCut& cut = cut_of(face.n);
  std::array<Vec3, 3> out;
  for (int k = 0; k < 3; ++k) {
    const int c = cut.triangle[triangle][k];
    if (c < face.n) {
      out[k] = x[face.node[c]];
      continue;
    }
    out[k] = Vec3::Zero();
    for (int a = 0; a < face.n; ++a) out[k] += cut.corner[c][a] * x[face.node[a]];
  }
  return out;
}

}  // namespace hilo
