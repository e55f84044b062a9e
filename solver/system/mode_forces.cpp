// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/mode_forces.hpp"

#include <Eigen/LU>

namespace hilo {

Mat3 left_turn(const Stage& s, int body) { return s.left->R[body].inverse().transpose(); }

ModeForces::ModeForces(const Modes& modes, Pass& pass)
    : p_(pass), modes_(modes), left_turn_(left_turn(pass.s, modes.body)), turn_(pass.s.end->R[modes.body]) {}

ModeForces::Matrix& ModeForces::tangent() {
  if (K_.size() == 0) K_.setZero(6 + 3 * modes_.n_blocks, 6 + 3 * modes_.n_blocks);
  return K_;
}

void ModeForces::add(std::span<const Vec3> shapes, const Vec3& f) {
  if (!used_) r_.setZero(3 * modes_.n_blocks), used_ = true;
  const Vec3 t = left_turn_.transpose() * f, g = turn_ * t;
  for (size_t j = 0; j < shapes.size(); ++j) r_[static_cast<Eigen::Index>(j)] += shapes[j].dot(t);
  if (!p_.K) return;
  Matrix& K = tangent();
  for (size_t j = 0; j < shapes.size(); ++j) {
    const Eigen::Index at = 6 + static_cast<Eigen::Index>(j);
    K.block<3, 1>(3, at) += p_.s.slope * (turn_ * shapes[j]).cross(f);
    K.block<1, 3>(at, 3) += p_.s.slope * (left_turn_ * shapes[j]).cross(g).transpose();
  }
}

void ModeForces::finish() {
  if (used_)
    for (Eigen::Index j = 0; j < r_.size(); ++j) p_.out.r[3 * modes_.block + j] += r_[j];
  if (p_.K && K_.size() > 0) p_.K->add(modes_.clique, K_.data());
}

}  // namespace hilo
