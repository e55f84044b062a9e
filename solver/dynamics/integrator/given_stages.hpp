// SPDX-License-Identifier: GPL-3.0-or-later
// What moves by a law at three coupled stages: it obeys q'' = law''(t) by their collocation, as all else obeys its forces, and comes out of
// the step where and as fast as the law does.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "system/collocation.hpp"
#include "system/system.hpp"

namespace hilo {

class GivenStages {
 public:
  /// The motions over a step from q0 and v0 with tableau A; false where their turn is too large for the step.
  bool find(const System& system, const Collocation& step, const Eigen::Matrix3d& A, const Config& q0, const Config& v0);
  bool any() const { return system_; }
  /// Into increments from q0 and h w of bodies at stage i.
  void put(int i, Config& dq, std::vector<Vec3>& turn) const;
  /// Positions and velocities of the end.
  void put_end(Config& q) const;
  void put_rates(Config& v) const;

 private:
  bool turn(const Collocation& step, const Eigen::Matrix3d& A, const Mat3& R0, const Mat3& V0, size_t b);

  const System* system_ = nullptr;  // null: nothing moves
  Config q_[3], a_[3], dq_[3], q1_, v1_;
  std::array<std::vector<Vec3>, 3> turn_;
};

}  // namespace hilo
