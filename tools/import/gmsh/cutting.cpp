// SPDX-License-Identifier: GPL-3.0-or-later
// Where the surface mesh of a geometry cuts itself: why gmsh cannot fill it, which it says without a place.
#include <fmt/format.h>
#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "import/gmsh/cad.hpp"

namespace hilo {
namespace {

struct SurfaceTriangle {
  int face;
  std::array<std::size_t, 3> node;
  std::array<Vec3, 3> x;
  Vec3 low, high;
  SurfaceTriangle(int f, const std::array<std::size_t, 3>& n, const std::array<Vec3, 3>& at)
      : face(f), node(n), x(at), low(at[0].cwiseMin(at[1]).cwiseMin(at[2])), high(at[0].cwiseMax(at[1]).cwiseMax(at[2])) {}
};

/// Where the line from p to q goes through a triangle, strictly between its ends.
std::optional<Vec3> through(const Vec3& p, const Vec3& q, const SurfaceTriangle& t) {
  const Vec3 u = t.x[1] - t.x[0], v = t.x[2] - t.x[0], d = q - p, n = d.cross(v);
  const double det = u.dot(n);
  if (std::abs(det) < 1e-12 * u.norm() * v.norm() * d.norm()) return std::nullopt;
  const Vec3 s = p - t.x[0], m = s.cross(u);
  const double a = s.dot(n) / det, b = d.dot(m) / det, c = v.dot(m) / det;
  constexpr double in = 1e-9;
  if (a < -in || b < -in || a + b > 1 + in || c < in || c > 1 - in) return std::nullopt;
  return p + c * d;
}

std::optional<Vec3> where_cut(const SurfaceTriangle& a, const SurfaceTriangle& b) {
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (size_t k = 0; k < 3; ++k)
      if (const auto x = through(one->x[k], one->x[(k + 1) % 3], *other)) return x;
  return std::nullopt;
}

std::vector<SurfaceTriangle> surface_triangles() {
  std::vector<std::size_t> tags;
  std::vector<double> at, u;
  gmsh::model::mesh::getNodes(tags, at, u);
  std::map<std::size_t, Vec3> X;
  for (size_t i = 0; i < tags.size(); ++i) X[tags[i]] = Vec3(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
  gmsh::vectorpair faces;
  gmsh::model::getEntities(faces, 2);
  std::vector<SurfaceTriangle> all;
  for (const auto& [dim, tag] : faces) {
    std::vector<std::size_t> element, nodes;
    constexpr int of_three = 2;
    gmsh::model::mesh::getElementsByType(of_three, element, nodes, tag);
    for (size_t i = 0; i + 2 < nodes.size(); i += 3)
      all.emplace_back(tag, std::array{nodes[i], nodes[i + 1], nodes[i + 2]}, std::array{X[nodes[i]], X[nodes[i + 1]], X[nodes[i + 2]]});
  }
  std::ranges::sort(all, {}, [](const SurfaceTriangle& t) { return t.low.x(); });
  return all;
}

}  // namespace

std::string name_of_volume(int tag) {
  std::string name;
  gmsh::model::getEntityName(3, tag, name);
  std::vector<int> groups;
  if (name.empty()) gmsh::model::getPhysicalGroupsForEntity(3, tag, groups);
  if (!groups.empty()) gmsh::model::getPhysicalName(3, groups[0], name);
  return name.empty() ? fmt::format("volume {}", tag) : fmt::format("\"{}\"", name);
}

std::string where_facets_cut(double unit) {
  const auto all = surface_triangles();
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = i + 1; j < all.size() && all[j].low.x() <= all[i].high.x(); ++j) {
      const SurfaceTriangle &a = all[i], &b = all[j];
      if ((b.low.array() > a.high.array()).any() || (a.low.array() > b.high.array()).any()) continue;
      if (std::ranges::find_first_of(a.node, b.node) != a.node.end()) continue;  // neighbours
      const auto x = where_cut(a, b);
      if (!x) continue;
      std::set<std::string> names;
      for (const int face : {a.face, b.face}) {
        std::vector<int> up, down;
        gmsh::model::getAdjacencies(2, face, up, down);
        for (const int v : up) names.insert(name_of_volume(v));
      }
      std::string of;
      for (const auto& name : names) of += (of.empty() ? "" : " and ") + name;
      return fmt::format("facets of {} cut each other at ({:.6g}, {:.6g}, {:.6g})", of, (*x)[0] / unit, (*x)[1] / unit, (*x)[2] / unit);
    }
  return "";
}

}  // namespace hilo
