// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/face.hpp"

#include <Eigen/Eigenvalues>

namespace hilo {

Face::Face(std::span<const Vec3> nodes, const Vec3& mean) {
  constexpr double flat = 1e-6;  // share below which the nodes lie in a plane: bent by a thousandth of their extent
  Mat3 spread = Mat3::Zero();
  for (const Vec3& x : nodes) spread += (x - mean) * (x - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(spread);
  axes = principal.eigenvectors(), second = spread.trace();
  is_point = nodes.size() < 2;
  share = is_point ? Vec3(Vec3::Zero()) : Vec3(principal.eigenvalues() / second);
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a <= b; ++a)
      if (share[a] > flat && share[b] > flat) stretches.emplace_back(a, b);
}

}  // namespace hilo
