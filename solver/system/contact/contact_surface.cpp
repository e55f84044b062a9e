// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/contact/contact_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace hilo {
namespace {

/// Plain facets as they are, those of four nodes about their middle; quadratic ones by a grid of `facet_pieces` along each edge.
FacetCut cut(size_t n) {
  FacetCut out;
  for (size_t a = 0; a < n; ++a) out.corner.push_back({}), out.corner.back()[a] = 1;  // its nodes come first
  const auto corner = [&](double r, double s) {
    const FacetShape shape = facet_shape(n, r, s);
    const auto node = std::find_if(shape.N, shape.N + n, [](double N) { return N > 1 - 1e-9; });
    if (node != shape.N + n) return static_cast<int>(node - shape.N);
    std::array<double, 8> share{};
    std::copy_n(shape.N, n, share.begin());
    out.corner.push_back(share);
    return static_cast<int>(out.corner.size()) - 1;
  };
  if (n == 4) {
    corner(0, 0);
    for (int e = 0; e < 4; ++e) out.triangle.push_back({e, (e + 1) % 4, 4}), out.on_edge.push_back({e, -1, -1});
    return out;
  }
  const bool three = n == 3 || n == 6;
  const int k = n == 3 ? 1 : facet_pieces;
  std::array<std::array<int, facet_pieces + 1>, facet_pieces + 1> at{};
  for (int j = 0; j <= k; ++j)
    for (int i = 0; i <= (three ? k - j : k); ++i) {
      const double r = static_cast<double>(i) / k, s = static_cast<double>(j) / k;
      at[i][j] = three ? corner(r, s) : corner(2 * r - 1, 2 * s - 1);
    }
  const auto edge_of = [&](std::array<int, 2> a, std::array<int, 2> b) {
    if (a[1] == 0 && b[1] == 0) return 0;
    if (three) return a[0] + a[1] == k && b[0] + b[1] == k ? 1 : a[0] == 0 && b[0] == 0 ? 2 : -1;
    return a[0] == k && b[0] == k ? 1 : a[1] == k && b[1] == k ? 2 : a[0] == 0 && b[0] == 0 ? 3 : -1;
  };
  const auto add = [&](std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
    out.triangle.push_back({at[a[0]][a[1]], at[b[0]][b[1]], at[c[0]][c[1]]});
    out.on_edge.push_back({edge_of(a, b), edge_of(b, c), edge_of(c, a)});
  };
  for (int j = 0; j < k; ++j)
    for (int i = 0; i < (three ? k - j : k); ++i) {
      if (!three && (2 * i < k) == (2 * j < k)) {  // diagonals about the middle, the same seen from each corner
        add({i, j}, {i + 1, j}, {i + 1, j + 1}), add({i, j}, {i + 1, j + 1}, {i, j + 1});
        continue;
      }
      add({i, j}, {i + 1, j}, {i, j + 1});
      if (!three || i + j + 2 <= k) add({i + 1, j}, {i + 1, j + 1}, {i, j + 1});
    }
  return out;
}

}  // namespace

const FacetCut& cut_of(size_t n) {
  static const FacetCut cuts[4] = {cut(3), cut(4), cut(6), cut(8)};
  return cuts[n == 3 ? 0 : n == 4 ? 1 : n == 6 ? 2 : 3];
}

FacetPoints facet_points(std::span<const Vec3> X, int n) {
  struct Gauss {
    std::array<double, 4> at, weight;
  };
  static constexpr Gauss rules[3] = {
      {{-0.577350269189625764509, 0.577350269189625764509}, {1, 1}},
      {{-0.774596669241483377036, 0, 0.774596669241483377036}, {5. / 9, 8. / 9, 5. / 9}},
      {{-0.861136311594052575224, -0.339981043584856264803, 0.339981043584856264803, 0.861136311594052575224},
       {0.347854845137453857373, 0.652145154862546142627, 0.652145154862546142627, 0.347854845137453857373}}};
  const size_t nodes = X.size();
  std::vector<std::array<double, 3>> at;  // place and weight
  if ((nodes == 3 || nodes == 6) && n == 2) {
    for (const auto& [r, s] : {std::pair{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}}) at.push_back({r, s, 1. / 6});
  } else if (nodes == 3 || nodes == 6) {  // exact for polynomials of degree four
    for (const auto& [a, w] : {std::pair{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}})
      for (int k = 0; k < 3; ++k) at.push_back({k == 1 ? 1 - 2 * a : a, k == 2 ? 1 - 2 * a : a, w / 2});
  } else {
    const Gauss& rule = rules[n - 2];
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) at.push_back({rule.at[i], rule.at[j], rule.weight[i] * rule.weight[j]});
  }
  FacetPoints out;
  for (const auto& [r, s, weight] : at) {
    const FacetShape shape = facet_shape(nodes, r, s);
    Vec3 tr = Vec3::Zero(), ts = Vec3::Zero();
    for (size_t a = 0; a < nodes; ++a) tr += shape.dr[a] * X[a], ts += shape.ds[a] * X[a];
    out.share.emplace_back(shape.N, shape.N + nodes);
    out.area.push_back(tr.cross(ts).norm() * weight);
  }
  return out;
}

void ContactSurface::find_borders() {
  std::map<std::pair<int, int>, std::vector<int>> seen;
  const auto each = [&](auto&& visit) {
    for (Face& face : faces) {
      const int corners = face.n == 3 || face.n == 6 ? 3 : 4;
      for (int e = 0; e < corners; ++e) visit(face, e, std::minmax(int{face.node[e]}, int{face.node[(e + 1) % corners]}));
    }
  };
  const auto number = [&](const Face& face) { return static_cast<int>(&face - faces.data()); };
  each([&](Face& face, int, std::pair<int, int> edge) { seen[edge].push_back(number(face)); });
  each([&](Face& face, int e, std::pair<int, int> edge) {
    const std::vector<int>& have = seen[edge];
    face.border[e] = have.size() == 1;
    const auto other = std::ranges::find_if(have, [&](int f) { return f != number(face); });
    face.across[e] = other == have.end() ? -1 : *other;
  });
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
