// Least stretch at the points of a solid cell.
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

}  // namespace hilo
