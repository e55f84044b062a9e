// Least stretch and det F at the points of a solid cell.
#pragma once
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <span>

#include "base/math.hpp"
#include "physics/solid.hpp"

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

/// Smallest det F over the points of the mass rule; 1 where it is above zero everywhere: det dx/dxi tells that alone.
template <class S>
double least_det_of(std::span<const Vec3> X, std::span<const Vec3> x) {
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
