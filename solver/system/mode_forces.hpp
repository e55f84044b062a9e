// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on what a linear region carries, as forces of its amplitudes, and what they add to the tangent where the region moves.
//
// What is carried, a node, a point or a direction y = R r + sum_j Y_j phi_j (and the centre where it is a point), takes a force f to
//   amplitude j:  (R^ phi_j).f        R^ = (R_left)^-T
// beside force and moment arm x f of the body.  With y' = slope (theta x y_end + R d eta) of the left configuration, and
// R^' = slope R^ R^T skew(theta) R^ (R that of the end), the tangent has
//   moment by eta_j:    slope (R phi_j) x f            eta_j by theta:   slope (R^ phi_j) x (R R^^T f)
#pragma once
#include "system/pass.hpp"

namespace hilo {

/// R^ of a stage.
Mat3 left_turn(const Stage& s, int body);

class ModeForces {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  ModeForces(const Modes& modes, Pass& pass);
  /// f on what has these shapes; the body's share is the caller's.
  void add(std::span<const Vec3> shapes, const Vec3& f);
  /// Over body and amplitudes (6 + 3 n_blocks), zero at first; only with a tangent.
  Matrix& tangent();
  /// Everything to the residual and the tangent of the pass.
  void finish();

 private:
  Pass& p_;
  const Modes& modes_;
  Mat3 left_turn_, turn_;
  bool used_ = false;
  Eigen::VectorXd r_;
  Matrix K_;
};

}  // namespace hilo
