// SPDX-License-Identifier: GPL-3.0-or-later
// Least stretch and det F at the points of a solid cell.
#pragma once
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>

#include "base/math.hpp"
#include "physics/stress_of_law.hpp"

namespace hilo {

/// Smallest singular value of F over the points; those that are above `floor` by a bound are not looked at.
template <class S>
double least_stretch_of(std::span<const Vec3> X, std::span<const Vec3> x, double floor) {
  double least = 1e300;
  for (int p = 0; p < S::n_points; ++p) {
    double g[S::n][3], F_[3][3];
    solid::point_gradients<S>(p, X[0].data(), g);
    solid::gradient<S::n>(x[0].data(), g, F_);
    Mat3 F;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F(i, j) = F_[i][j];
    const Mat3 C = F.transpose() * F;
    double bound = 1e300;  // Gershgorin's circles
    for (int i = 0; i < 3; ++i) bound = std::min(bound, 2 * C(i, i) - C.row(i).cwiseAbs().sum());
    if (bound > floor * floor) continue;
    least = std::min(least, std::max(0.0, Eigen::SelfAdjointEigenSolver<Mat3>(C, Eigen::EigenvaluesOnly).eigenvalues()[0]));
  }
  return std::sqrt(least);
}

/// What bounds det dx/dxi over the points of the mass rule from below.  With A = dx/dxi at the centre, and y_a what is left of the nodes
/// behind the affine map of A, column j at a point is A_j + sum_a dN_a,j y_a: off by at most slope_j max |y_a|.
template <class S>
struct AffinePart {
  Quadrature<S::n> nodes = stress::node_points<S>();  // from their mean
  double dN[S::n][3];
  double slope[3] = {};
  AffinePart() {
    double centre[3] = {};
    for (int a = 0; a < S::n; ++a)
      for (int i = 0; i < 3; ++i) centre[i] += nodes.xi[a][i] / S::n;
    S::gradients(centre, dN);
    for (int a = 0; a < S::n; ++a)
      for (int i = 0; i < 3; ++i) nodes.xi[a][i] -= centre[i];
    constexpr const auto& table = mass_table<S>;
    for (int p = 0; p < S::n_mass_points; ++p)
      for (int j = 0; j < 3; ++j) {
        double sum = 0;
        for (int a = 0; a < S::n; ++a) sum += std::abs(table.dN[p][a][j]);
        slope[j] = std::max(slope[j], sum);
      }
  }
  /// Whether det dx/dxi is above zero at every point for certain.
  bool is_unfolded(std::span<const Vec3> x) const {
    Mat3 A = Mat3::Zero();
    Vec3 mean = Vec3::Zero();
    for (int a = 0; a < S::n; ++a) {
      for (int j = 0; j < 3; ++j) A.col(j) += dN[a][j] * x[a];
      mean += x[a] / S::n;
    }
    double most = 0;  // |y_a|^2
    for (int a = 0; a < S::n; ++a) {
      const double* xi = nodes.xi[a];
      most = std::max(most, (x[a] - mean - A.col(0) * xi[0] - A.col(1) * xi[1] - A.col(2) * xi[2]).squaredNorm());
    }
    const double r = std::sqrt(most);
    double with = 1, without = 1;
    for (int j = 0; j < 3; ++j) {
      const double length = A.col(j).norm();
      with *= length + slope[j] * r, without *= length;
    }
    return A.determinant() > with - without;
  }
};

/// Smallest det F over the points of the mass rule; 1 where it is above zero everywhere: det dx/dxi tells that alone.
template <class S>
double least_det_of(std::span<const Vec3> X, std::span<const Vec3> x) {
  static const AffinePart<S> affine;
  if (affine.is_unfolded(x)) return 1;
  constexpr const auto& table = mass_table<S>;
  const auto det = [](std::span<const Vec3> at, const double(*dN)[3]) {
    Mat3 J = Mat3::Zero();
    for (int a = 0; a < S::n; ++a)
      for (int j = 0; j < 3; ++j) J.col(j) += dN[a][j] * at[a];
    return J.determinant();
  };
  double least = 1;
  for (int p = 0; p < S::n_mass_points; ++p)
    if (const double now = det(x, table.dN[p]); !(now > 0)) least = std::min(least, now / det(X, table.dN[p]));
  return least;
}

}  // namespace hilo
