// SPDX-License-Identifier: GPL-3.0-or-later
// The table of cell shapes, and volume and quality of a cell from its facets and corners.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <initializer_list>
#include <memory>

#include "base/error.hpp"
#include "model/facet_rule.hpp"
#include "model/mesh.hpp"
#include "model/partition.hpp"
#include "model/shape_row.hpp"

namespace hilo {
namespace {

using Lists = std::vector<std::vector<int>>;

struct Kind {
  ShapeInfo info;
  Lists corners;                               // per corner the three neighbours that make a right-handed system
  std::array<std::array<int, 20>, 20> middle;  // mid-side node between two corners, -1 where there is none
  int work;
};

Kind make_shape(const ShapeRow& row) {
  const int n = row.corners + static_cast<int>(row.edges.size());
  Kind k{{row.name, n, row.corners, row.dimension, row.vtk, row.xdmf, row.facets,
          row.neighbours.empty() ? std::vector<int>{1} : row.neighbours[0]},
         row.neighbours,
         {},
         row.work};
  for (auto& list : k.middle) list.fill(-1);
  for (size_t e = 0; e < row.edges.size(); ++e) {
    const int from = row.edges[e][0], to = row.edges[e][1];
    k.middle[from][to] = k.middle[to][from] = row.corners + static_cast<int>(e);
  }
  if (!row.edges.empty())
    for (auto& facet : k.info.facets) {
      const size_t m = facet.size();
      for (size_t a = 0; a < m; ++a) facet.push_back(k.middle[facet[a]][facet[(a + 1) % m]]);
    }
  return k;
}

/// By number, in the order of Shape.
std::array<std::unique_ptr<const Kind>, most_shapes>& kinds() {
  static auto table = [] {
    const Lists tet{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}, tet_corners{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {2, 1, 0}};
    const Lists wedge{{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    const Lists wedge_corners{{1, 2, 3}, {2, 0, 4}, {0, 1, 5}, {5, 4, 0}, {3, 5, 1}, {4, 3, 2}};
    const Lists hex{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
    const Lists hex_corners{{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
    const Lists tet_edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    const Lists wedge_edges{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
    const Lists hex_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    const Lists tri_edges{{0, 1}, {1, 2}, {2, 0}}, quad_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    std::array<std::unique_ptr<const Kind>, most_shapes> t;
    size_t number = 0;
    for (const ShapeRow& row : std::initializer_list<ShapeRow>{{"bar2", 2, 1, 3, 2, 4, {{0}, {1}}, {}, {}},
                                                               {"tet4", 4, 3, 10, 6, 13, tet, tet_corners, {}},
                                                               {"tet10", 4, 3, 24, 38, 134, tet, tet_corners, tet_edges},
                                                               {"wedge6", 6, 3, 13, 8, 47, wedge, wedge_corners, {}},
                                                               {"wedge15", 6, 3, 26, 40, 370, wedge, wedge_corners, wedge_edges},
                                                               {"hex8", 8, 3, 12, 9, 100, hex, hex_corners, {}},
                                                               {"hex20", 8, 3, 25, 48, 540, hex, hex_corners, hex_edges},
                                                               {"hex20r", 8, 3, 25, 48, 460, hex, hex_corners, hex_edges},
                                                               {"tri3", 3, 2, 5, 4, 1, {{0, 1, 2}}, {}, {}},
                                                               {"tri6", 3, 2, 22, 36, 1, {{0, 1, 2}}, {}, tri_edges},
                                                               {"quad4", 4, 2, 9, 5, 1, {{0, 1, 2, 3}}, {}, {}},
                                                               {"quad8", 4, 2, 23, 37, 1, {{0, 1, 2, 3}}, {}, quad_edges},
                                                               {"shell8", 8, 3, 12, 9, 190, hex, hex_corners, {}}})
      t[number++] = std::make_unique<const Kind>(make_shape(row));
    return t;
  }();
  return table;
}

const Kind& kind(Shape shape) { return *kinds()[static_cast<size_t>(shape)]; }

/// Shape functions of a facet and their derivatives at (r, s): 3, 4, 6 or 8 nodes.
struct FacetPoint {
  std::array<double, 8> N, Nr, Ns;
  double weight;
};

FacetPoint triangle_point(int n, double r, double s, double weight) {
  FacetPoint p{{1 - r - s, r, s}, {-1, 1, 0}, {-1, 0, 1}, weight};
  if (n == 3) return p;
  const std::array<double, 3> L{p.N[0], r, s}, Lr{-1, 1, 0}, Ls{-1, 0, 1};
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    p.N[a] = L[a] * (2 * L[a] - 1), p.Nr[a] = (4 * L[a] - 1) * Lr[a], p.Ns[a] = (4 * L[a] - 1) * Ls[a];
    p.N[3 + a] = 4 * L[a] * L[b], p.Nr[3 + a] = 4 * (Lr[a] * L[b] + L[a] * Lr[b]), p.Ns[3 + a] = 4 * (Ls[a] * L[b] + L[a] * Ls[b]);
  }
  return p;
}

FacetPoint square_point(int n, double r, double s, double weight) {
  constexpr std::array<double, 8> R{-1, 1, 1, -1, 0, 1, 0, -1}, S{-1, -1, 1, 1, -1, 0, 1, 0};
  FacetPoint p{{}, {}, {}, weight};
  for (int a = 0; a < n; ++a) {
    const double u = 1 + r * R[a], v = 1 + s * S[a];
    if (a < 4 && n == 4)
      p.N[a] = u * v / 4, p.Nr[a] = R[a] * v / 4, p.Ns[a] = S[a] * u / 4;
    else if (a < 4) {
      const double w = r * R[a] + s * S[a] - 1;
      p.N[a] = u * v * w / 4, p.Nr[a] = R[a] * v * (w + u) / 4, p.Ns[a] = S[a] * u * (w + v) / 4;
    } else if (R[a] == 0)
      p.N[a] = (1 - r * r) * v / 2, p.Nr[a] = -r * v, p.Ns[a] = (1 - r * r) * S[a] / 2;
    else
      p.N[a] = (1 - s * s) * u / 2, p.Ns[a] = -s * u, p.Nr[a] = (1 - s * s) * R[a] / 2;
  }
  return p;
}

/// Rules that integrate x . (x_r cross x_s) exactly: degree 4 on the triangle (Dunavant's six points), 3 x 3 Gauss on the square.
std::vector<FacetPoint> rule(int n) {
  std::vector<FacetPoint> points;
  if (n % 3 == 0) {
    const double a = 0.445948490915965, b = 0.091576213509771, wa = 0.223381589678011 / 2, wb = 0.109951743655322 / 2;
    for (const auto& [c, w] : {std::pair{a, wa}, std::pair{b, wb}})
      for (const auto& [r, s] : {std::pair{c, c}, std::pair{1 - 2 * c, c}, std::pair{c, 1 - 2 * c}})
        points.push_back(triangle_point(n, r, s, w));
  } else {
    const std::array<double, 3> x{-std::sqrt(0.6), 0, std::sqrt(0.6)}, w{5. / 9, 8. / 9, 5. / 9};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) points.push_back(square_point(n, x[i], x[j], w[i] * w[j]));
  }
  return points;
}

const std::vector<FacetPoint>& rule_of(size_t n) {
  static const std::array<std::vector<FacetPoint>, 4> rules{rule(3), rule(4), rule(6), rule(8)};
  return rules[n == 3 ? 0 : n == 4 ? 1 : n == 6 ? 2 : 3];
}

}  // namespace

const ShapeInfo& info(Shape shape) { return kind(shape).info; }

bool is_shape(std::uint8_t shape) { return kinds()[shape] != nullptr; }

void add_shape_row(Shape shape, const ShapeRow& row) {
  const int number = static_cast<int>(shape);
  if (number < first_outside)
    throw Error("", fmt::format("shape \"{}\" has number {}", row.name, number), fmt::format("{} or more", first_outside), Exit::fault);
  for (const auto& k : kinds())
    if (k && (k->info.name == row.name || &k == &kinds()[number]))
      throw Error("", fmt::format("shape \"{}\", number {}: there is one", row.name, number), "", Exit::fault);
  kinds()[number] = std::make_unique<const Kind>(make_shape(row));
}

int work_of_cell(Shape shape) { return kind(shape).work; }

Vec3 facet_area(const Mesh& mesh, const Facet& f) {
  const auto cell = mesh.cell(f.cell);
  const auto& local = info(mesh.shape[f.cell]).facets[f.facet];
  Vec3 area = Vec3::Zero();
  if (local.size() < 3) return area;
  for (const auto& p : rule_of(local.size())) {
    Vec3 xr = Vec3::Zero(), xs = Vec3::Zero();
    for (size_t a = 0; a < local.size(); ++a) xr += p.Nr[a] * mesh.X[cell[local[a]]], xs += p.Ns[a] * mesh.X[cell[local[a]]];
    area += p.weight * xr.cross(xs);
  }
  return area;
}

void over_facet(const Mesh& mesh, const Facet& f, const std::function<void(const Vec3&, const Vec3&)>& visit) {
  const auto cell = mesh.cell(f.cell);
  const auto& local = info(mesh.shape[f.cell]).facets[f.facet];
  for (const auto& p : rule_of(local.size())) {
    Vec3 x = Vec3::Zero(), xr = x, xs = x;
    for (size_t a = 0; a < local.size(); ++a) {
      const Vec3& X = mesh.X[cell[local[a]]];
      x += p.N[a] * X, xr += p.Nr[a] * X, xs += p.Ns[a] * X;
    }
    visit(x, p.weight * xr.cross(xs));
  }
}

CellQuality quality(const Mesh& mesh, std::int64_t c) {
  const Kind& k = kind(static_cast<Shape>(mesh.shape[c]));
  const auto cell = mesh.cell(c);
  const Vec3 origin = mesh.X[cell[0]];
  if (k.info.dimension == 1) {
    const double length = (mesh.X[cell[1]] - origin).norm();
    return {length, length > 0 ? 1. : 0.};
  }
  if (k.info.dimension == 2) {
    double area = 0;
    for (const auto& p : rule_of(cell.size())) {
      Vec3 xr = Vec3::Zero(), xs = Vec3::Zero();
      for (size_t a = 0; a < cell.size(); ++a) xr += p.Nr[a] * mesh.X[cell[a]], xs += p.Ns[a] * mesh.X[cell[a]];
      area += p.weight * xr.cross(xs).norm();
    }
    return {area, area > 0 ? 1. : 0.};
  }
  // Volume by the divergence theorem, 3 V = sum over the facets of the integral of x . n dA: one rule for all shapes, curved ones too.
  double volume = 0;
  for (const auto& local : k.info.facets)
    for (const auto& p : rule_of(local.size())) {
      Vec3 x = Vec3::Zero(), xr = x, xs = x;
      for (size_t a = 0; a < local.size(); ++a) {
        const Vec3 X = mesh.X[cell[local[a]]] - origin;
        x += p.N[a] * X, xr += p.Nr[a] * X, xs += p.Ns[a] * X;
      }
      volume += p.weight * x.dot(xr.cross(xs)) / 3;
    }
  // At a corner the map's derivatives lie along the three edges: x_b - x_a, or -3 x_a + 4 x_m - x_b with a mid-side node.
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (int a = 0; a < k.info.n_corners; ++a) {
    Mat3 J;
    for (int i = 0; i < 3; ++i) {
      const int b = k.corners[a][i], m = k.middle[a][b];
      const Vec3 xa = mesh.X[cell[a]], xb = mesh.X[cell[b]];
      J.col(i) = m < 0 ? Vec3(xb - xa) : Vec3(-3 * xa + 4 * mesh.X[cell[m]] - xb);
    }
    const double det = J.determinant(), flat = 1e-9 * J.col(0).norm() * J.col(1).norm() * J.col(2).norm();
    least = std::min(least, det);
    most = std::max({most, std::abs(det), flat});  // a flat cell counts as degenerate, whatever the sign of its round-off
  }
  return {volume, most > 0 ? least / most : 0.};
}

}  // namespace hilo
