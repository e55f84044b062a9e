// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that move as rigid bodies, x -> v + w x (x - c), and how such motions are told to a reader.
#pragma once
#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <string>

#include "base/math.hpp"

namespace hilo {

using Motions = Eigen::MatrixXd;  // (6 parts x vectors): v, w times the length of the part

/// A part as a rigid body.
struct Part {
  Vec3 centre = Vec3::Zero();
  double length = 0;  // of its rotations [m]
  std::string name;
  bool are_several = false;  // regions
};

/// Vectors z with z.N z = 0, orthonormal.
Motions null_vectors(const Eigen::SparseMatrix<double>& N);
/// Combinations of the columns of `all` for which `part` (as many columns) vanishes.
Motions vanishing(const Motions& all, const Motions& part);
/// How a part moves in the motions Z (6 x k): "free to move along (0, 0, 1)".
std::string told(const Motions& Z, const Part& part);

}  // namespace hilo
