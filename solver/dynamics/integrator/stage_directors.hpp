// SPDX-License-Identifier: GPL-3.0-or-later
// Directors of one body at three coupled stages whose velocities, not positions, follow the law of rigid bodies:
//   R_i' = w_i x R_i,   R_i = R0 + sum_j a_ij skew(h w_j) R_j,   linear in the R_i, which are not orthonormal.
#pragma once
#include <Eigen/LU>
#include <array>
#include <optional>

#include "system/collocation.hpp"

namespace hilo {

using Mat9 = Eigen::Matrix<double, 9, 9>;
using Vec9 = Eigen::Matrix<double, 9, 1>;

class StageDirectors {
 public:
  /// A: the tableau; w: h times the angular velocities of the stages.
  StageDirectors(const Eigen::Matrix3d& A, const std::array<Vec3, 3>& w);
  /// dX_i of X_i = X0 + sum_j a_ij (skew_j X_j + more_j), for the directors (no `more`) or what turns with them.
  std::array<Mat3, 3> grow(const Mat3& start, const std::array<Mat3, 3>* more = nullptr) const;

  /// How the directors R move by the nine components of w: dR_i - sum_j a_ij skew_j dR_j = sum_j a_ij skew(d w_j) R_j.
  struct Moves {
    std::array<std::array<Mat3, 9>, 3> dR;  // of stage i
    Mat9 turns;                             // their skew parts, dR_i R_i^-1
  };
  Moves moves(const std::array<Mat3, 3>& R) const;
  /// The same by the nine components of these turns.
  std::array<std::array<Mat3, 9>, 3> moves_by_turns(const std::array<Mat3, 3>& R) const;
  /// Changes of w for the turns t (of stage after stage): exactly, or as if the R_i were orthonormal.
  Vec9 spins(const std::array<Mat3, 3>& R, const Vec9& t) const { return moves(R).turns.partialPivLu().solve(t); }
  Vec9 nearly_spins(const std::array<Mat3, 3>& R, const Vec9& t) const;

 private:
  /// Block factors of the matrix of the R_i, I - a_ij skew_j: each pivot is the unit matrix plus what turns.
  struct Factors {
    Mat3 l10, l20, l21, u01, u02, u12, inverse[3];
  };
  const Factors& factors() const;
  /// X_i - sum_j a_ij skew_j X_j = x_i.
  void solve(std::array<Mat3, 3>& x) const;

  Eigen::Matrix3d A_;
  std::array<Vec3, 3> w_;
  mutable std::optional<Factors> factors_;  // made when first asked for
};

}  // namespace hilo
