// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/cell_gradients.hpp"

#include "physics/shape/from_outside.hpp"
#include "physics/stress_of_law.hpp"

namespace hilo {
namespace {

template <class S, int P>
void at_points(const Tabulated<S, P>& table, std::span<const Vec3> X, CellGradients& out) {
  out.volume.resize(P), out.dN.resize(static_cast<size_t>(P) * S::n);
  for (int p = 0; p < P; ++p) {
    double g[S::n][3];
    out.volume[p] = table.w[p] * solid::reference_gradients<S::n>(table.dN[p], X[0].data(), g);
    for (int a = 0; a < S::n; ++a) out.dN[static_cast<size_t>(p) * S::n + a] = Vec3(g[a][0], g[a][1], g[a][2]);
  }
}

}  // namespace

void cell_gradients(Shape shape, const Material& material, std::span<const Vec3> X, CellGradients& out) {
  out.volume.clear(), out.dN.clear();
  if (shape_from_outside(shape)) {  // F is linear in the displacements
    std::vector<StressPoint> points;
    std::vector<Vec3> x(X.begin(), X.end());
    for (size_t a = 0; a < X.size(); ++a) {
      x[a][0] += 1;
      stress_points(shape, material, X, x, StressPoints::integration, points);
      x[a] = X[a];
      out.volume.resize(points.size()), out.dN.resize(points.size() * X.size());
      for (size_t p = 0; p < points.size(); ++p) {
        out.volume[p] = points[p].w;
        out.dN[p * X.size() + a] = points[p].F.row(0).transpose() - Vec3::UnitX();
      }
    }
    return;
  }
  of_shape(shape, false, [&]<class S>() {
    if constexpr (std::is_same_v<S, Hex8>) {
      out.volume.resize(1), out.dN.resize(8);
      double g[8][3];
      out.volume[0] = solid::point_gradients<S>(0, X[0].data(), g);
      for (int a = 0; a < 8; ++a) out.dN[a] = Vec3(g[a][0], g[a][1], g[a][2]);
    } else if constexpr (std::is_base_of_v<Hex20, S>) {
      at_points(stress::barlow_table, X, out);
    } else {
      at_points(stiffness_table<S>, X, out);
    }
    return true;
  });
}

/// Of a tetrahedron that is strained alike everywhere.
Eigen::Matrix<double, 6, 6> moduli_at_rest(const Material& material) {
  const std::array<Vec3, 4> X{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  constexpr int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
  Eigen::Matrix<double, 6, 6> out;
  std::vector<StressPoint> points;
  for (int k = 0; k < 6; ++k) {
    std::array<Vec3, 4> x = X;
    Mat3 strain = Mat3::Zero();
    strain(row[k], column[k]) += 0.5, strain(column[k], row[k]) += 0.5;
    for (Vec3& at : x) at += (strain * at).eval();
    small_strain_points(Shape::tet4, material, X, x, StressPoints::integration, points);
    out.col(k) = points.front().S;
  }
  return out;
}

}  // namespace hilo
