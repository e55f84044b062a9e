// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/ellipsoid.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hilo {

Ellipsoid ellipsoid_of(const Entry& e) {
  const auto& J = e.numbers("inertia");
  Mat3 tensor = Mat3::Zero();
  for (int i = 0; i < 3; ++i) tensor(i, i) = J[static_cast<size_t>(i)];
  if (J.size() == 6) tensor(0, 1) = tensor(1, 0) = J[3], tensor(0, 2) = tensor(2, 0) = J[4], tensor(1, 2) = tensor(2, 1) = J[5];
  if (e.has("axes")) {
    Mat3 R;
    for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = e.numbers("axes")[static_cast<size_t>(i)];
    tensor = R.transpose() * tensor * R;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(tensor);
  const Vec3 I = principal.eigenvalues();
  Ellipsoid b{e.name, e.vector3("com"), principal.eigenvectors(), Vec3::Zero()};
  if (b.axes.determinant() < 0) b.axes.col(0) *= -1;
  for (int i = 0; i < 3; ++i)
    b.radii[i] = e.number("mass") > 0 ? std::sqrt(std::max(0.0, 2.5 * (I.sum() - 2 * I[i]) / e.number("mass"))) : 0;
  return b;
}

}  // namespace hilo
