// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/section_mesh.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Cell = std::array<int, 9>;

/// Shape functions of a cell and their derivatives by its own coordinates, at a point.
struct Shapes {
  Eigen::Matrix<double, 9, 1> N = Eigen::Matrix<double, 9, 1>::Zero();
  Eigen::Matrix<double, 9, 2> d = Eigen::Matrix<double, 9, 2>::Zero();
};

Shapes triangle(double r, double s) {
  const double t = 1 - r - s;
  Shapes out;
  out.N.head<6>() << t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t;
  out.d.topRows<6>() << 1 - 4 * t, 1 - 4 * t, 4 * r - 1, 0, 0, 4 * s - 1, 4 * (t - r), -4 * r, 4 * s, 4 * r, -4 * s, 4 * (t - s);
  return out;
}

Shapes quadrangle(double r, double s) {
  const auto one = [](double x) { return Vec3(x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2); };
  const auto slope = [](double x) { return Vec3(x - 0.5, -2 * x, x + 0.5); };
  constexpr int at[9][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}};
  const Vec3 a = one(r), b = one(s), da = slope(r), db = slope(s);
  Shapes out;
  for (int i = 0; i < 9; ++i) {
    const auto [k, l] = at[i];
    out.N[i] = a[k] * b[l], out.d.row(i) << da[k] * b[l], a[k] * db[l];
  }
  return out;
}

struct Sample {
  Shapes shapes;
  double weight;
};

/// Points that integrate degree 5.
const std::vector<Sample>& samples(bool is_triangle) {
  static const std::vector<Sample> of_triangle = [] {  // Radon's seven
    std::vector<Sample> out{{triangle(1.0 / 3, 1.0 / 3), 9.0 / 80}};
    const double root = std::sqrt(15.0);
    for (const double side : {-1.0, 1.0}) {
      const double a = (6 + side * root) / 21, w = (155 + side * root) / 2400;
      for (const auto& [r, s] : {std::pair{a, a}, {1 - 2 * a, a}, {a, 1 - 2 * a}}) out.push_back({triangle(r, s), w});
    }
    return out;
  }();
  static const std::vector<Sample> of_quadrangle = [] {
    std::vector<Sample> out;
    const double x = std::sqrt(0.6);
    for (const auto& [r, u] : {std::pair{-x, 5.0 / 9}, {0.0, 8.0 / 9}, {x, 5.0 / 9}})
      for (const auto& [s, v] : {std::pair{-x, 5.0 / 9}, {0.0, 8.0 / 9}, {x, 5.0 / 9}}) out.push_back({quadrangle(r, s), u * v});
    return out;
  }();
  return is_triangle ? of_triangle : of_quadrangle;
}

/// At the nodes.
const std::vector<Shapes>& nodal(bool is_triangle) {
  static const std::vector<Shapes> of_triangle{triangle(0, 0),   triangle(1, 0),     triangle(0, 1),
                                               triangle(0.5, 0), triangle(0.5, 0.5), triangle(0, 0.5)};
  static const std::vector<Shapes> of_quadrangle{quadrangle(-1, -1), quadrangle(1, -1), quadrangle(1, 1),
                                                 quadrangle(-1, 1),  quadrangle(0, -1), quadrangle(1, 0),
                                                 quadrangle(0, 1),   quadrangle(-1, 0), quadrangle(0, 0)};
  return is_triangle ? of_triangle : of_quadrangle;
}

int n_nodes(const Cell& cell) { return SectionMesh::is_triangle(cell) ? 6 : 9; }

Eigen::Matrix<double, 9, 2> places(const std::vector<Vector2d>& X, const Cell& cell) {
  Eigen::Matrix<double, 9, 2> out = Eigen::Matrix<double, 9, 2>::Zero();
  for (int i = 0; i < n_nodes(cell); ++i) out.row(i) = X[static_cast<size_t>(cell[i])].transpose();
  return out;
}

/// D of the header for a and b.
Vector2d swept(const Vector2d& ab, const Vector2d& x) {
  const double r = (x.x() * x.x() - x.y() * x.y()) / 2, q = x.x() * x.y();
  return {ab[0] * r + ab[1] * q, ab[0] * q - ab[1] * r};
}

/// What is at a sample of a cell.
struct Spot {
  Vector2d x;
  Eigen::Matrix<double, 9, 2> G;  // derivatives of the shape functions along x and y
  double area;
};
Spot spot(const Shapes& shapes, double weight, const Eigen::Matrix<double, 9, 2>& X) {
  const Matrix2d map = X.transpose() * shapes.d;  // columns: by the coordinates of the cell
  return {X.transpose() * shapes.N, shapes.d * map.inverse(), weight * std::abs(map.determinant())};
}

template <class Use>
void each_spot(const std::vector<Vector2d>& X, const std::vector<Cell>& cells, const Use& use) {
  for (const Cell& cell : cells) {
    const auto of_cell = places(X, cell);
    for (const Sample& s : samples(SectionMesh::is_triangle(cell))) use(cell, s.shapes, spot(s.shapes, s.weight, of_cell));
  }
}

Eigen::Matrix<double, 9, 3> values(const Eigen::MatrixXd& u, const Cell& cell) {
  Eigen::Matrix<double, 9, 3> out = Eigen::Matrix<double, 9, 3>::Zero();
  for (int i = 0; i < n_nodes(cell); ++i) out.row(i) = u.row(cell[i]);
  return out;
}

}  // namespace

std::array<double, 2> extreme_jacobian(const SectionMesh& mesh, const Cell& cell, double size) {
  const auto X = places(mesh.X, cell);
  std::array<double, 2> out{1e300, -1e300};
  const auto take = [&](const Shapes& s) {
    const double det = (X.transpose() * s.d).determinant() / (size * size);
    out = {std::min(out[0], det), std::max(out[1], det)};
  };
  for (const Shapes& s : nodal(SectionMesh::is_triangle(cell))) take(s);
  for (const Sample& s : samples(SectionMesh::is_triangle(cell))) take(s.shapes);
  return out;
}

SectionFace meshed_face(const SectionMesh& mesh, double nu) {
  SectionFace face;
  SectionArea& area = face.area;
  std::vector<Vector2d> X = mesh.X;
  const Vector2d origin = X.front();  // near: a face may be far from the origin of its file
  for (Vector2d& x : X) x -= origin;
  Vector2d first = Vector2d::Zero();
  each_spot(X, mesh.cells, [&](const Cell&, const Shapes&, const Spot& p) { area.A += p.area, first += p.area * p.x; });
  const Vector2d centre = first / area.A;
  for (Vector2d& x : X) x -= centre;
  each_spot(X, mesh.cells, [&](const Cell&, const Shapes&, const Spot& p) {
    area.I1 += p.area * p.x.y() * p.x.y(), area.I2 += p.area * p.x.x() * p.x.x(), area.I12 += p.area * p.x.x() * p.x.y();
    const double r2 = p.x.squaredNorm();
    area.H1 += p.area * p.x.x() * r2, area.H2 += p.area * p.x.y() * r2, area.I4 += p.area * r2 * r2;
  });
  // columns of u and f: torsion, forces along 1 and 2 by 1; a and b of these in columns
  const Matrix2d ab = (Matrix2d() << area.I2, area.I12, area.I12, area.I1).finished().inverse();
  const auto n = static_cast<Eigen::Index>(X.size());
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(n, 3);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Cell& cell : mesh.cells) {
    const auto of_cell = places(X, cell);
    Eigen::Matrix<double, 9, 9> K = Eigen::Matrix<double, 9, 9>::Zero();
    Eigen::Matrix<double, 9, 3> F = Eigen::Matrix<double, 9, 3>::Zero();
    for (const Sample& s : samples(SectionMesh::is_triangle(cell))) {
      const Spot p = spot(s.shapes, s.weight, of_cell);
      K += p.area * p.G * p.G.transpose();
      F.col(0) += p.area * p.G * Vector2d(p.x.y(), -p.x.x());
      for (int k = 0; k < 2; ++k)
        F.col(1 + k) += p.area * (nu * p.G * swept(ab.col(k), p.x) + 2 * (1 + nu) * ab.col(k).dot(p.x) * s.shapes.N);
    }
    for (int i = 0; i < n_nodes(cell); ++i) {
      f.row(cell[i]) += F.row(i);
      for (int j = 0; j < n_nodes(cell); ++j)
        if (cell[i] > 0 && cell[j] > 0) entries.emplace_back(cell[i] - 1, cell[j] - 1, K(i, j));  // the first node is held
    }
  }
  Eigen::SparseMatrix<double> K(n - 1, n - 1);
  K.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(K);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(n, 3);
  u.bottomRows(n - 1) = factors.solve(f.bottomRows(n - 1));

  area.J = area.I1 + area.I2 - u.col(0).dot(f.col(0));
  // shear stress by the forces of the problems and by torsion, at a spot
  const auto stress = [&](const Cell& cell, const Spot& p) {
    const Eigen::Matrix<double, 2, 3> slope = p.G.transpose() * values(u, cell);
    Eigen::Matrix<double, 2, 3> out;
    for (int k = 0; k < 2; ++k) out.col(k) = (slope.col(1 + k) - nu * swept(ab.col(k), p.x)) / (2 * (1 + nu));
    out.col(2) = (slope.col(0) + Vector2d(-p.x.y(), p.x.x())) / area.J;
    return out;
  };
  Matrix2d flexibility = Matrix2d::Zero();
  Vector2d moment = Vector2d::Zero(), warping = Vector2d::Zero();  // of these stresses about the origin; w times the growth of axial stress
  each_spot(X, mesh.cells, [&](const Cell& cell, const Shapes& shapes, const Spot& p) {
    const Eigen::Matrix<double, 2, 3> t = stress(cell, p);
    flexibility += p.area * t.leftCols<2>().transpose() * t.leftCols<2>();
    moment += p.area * t.leftCols<2>().transpose() * Vector2d(-p.x.y(), p.x.x());
    warping += p.area * values(u, cell).col(0).dot(shapes.N) * (ab.transpose() * p.x);
  });
  area.s1 = -warping[1], area.s2 = warping[0];
  const Vector2d twist = -(warping + moment);  // torsion that brings the forces to the shear centre
  flexibility -= twist * twist.transpose() / area.J;
  const Matrix2d stiffness = flexibility.inverse() / area.A;
  area.shear_1 = stiffness(0, 0), area.shear_2 = stiffness(1, 1), area.shear_12 = stiffness(0, 1);

  face.points.reserve(X.size());
  for (const Vector2d& x : X) face.points.push_back({x, Eigen::Matrix<double, 2, 3>::Zero()});
  std::vector<double> weight(X.size());
  for (const Cell& cell : mesh.cells) {  // the mean of the cells of a node
    const auto of_cell = places(X, cell);
    const bool is_triangle = SectionMesh::is_triangle(cell);
    for (int i = 0; i < n_nodes(cell); ++i) {
      const Spot p = spot(nodal(is_triangle)[static_cast<size_t>(i)], 1, of_cell);
      Eigen::Matrix<double, 2, 3> t = stress(cell, p);
      t.leftCols<2>() += t.col(2) * twist.transpose();
      const auto node = static_cast<size_t>(cell[i]);
      face.points[node].shear += p.area * t, weight[node] += p.area;
    }
    if (is_triangle)
      for (const auto& [a, b, c] : {std::array{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
        face.cells.push_back({cell[a], cell[b], cell[c], -1});
    else
      for (const auto& [a, b, c, d] : {std::array{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}})
        face.cells.push_back({cell[a], cell[b], cell[c], cell[d]});
  }
  for (size_t i = 0; i < X.size(); ++i) face.points[i].shear /= weight[i];
  return face;
}

}  // namespace hilo
