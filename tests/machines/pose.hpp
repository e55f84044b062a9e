// SPDX-License-Identifier: GPL-3.0-or-later
// Where a rigid thing is, and how far a joint is open, from the definition of each kind and from nothing else.
#pragma once
#include <vector>

#include "machines/machine.hpp"

namespace hilo::test {

/// Material point X sits at c + R (X - X0), and moves at v + V (X - X0).
struct Pose {
  Vec3 X = Vec3::Zero(), c = Vec3::Zero(), v = Vec3::Zero();
  Mat3 R = Mat3::Identity(), V = Mat3::Zero();
  Vec3 at(const Vec3& point) const { return c + R * (point - X); }
};

/// The rotation and place that fit nodes best, and the largest distance of a node from where they put it [m].
Pose fitted(const std::vector<Vec3>& X, const std::vector<Vec3>& x, const std::vector<std::int64_t>& nodes);
double unfit(const std::vector<Vec3>& X, const std::vector<Vec3>& x, const std::vector<std::int64_t>& nodes);

/// The angle of b against a about an axis of a, followed over whole turns.
struct Turned {
  double angle = 0;
  bool started = false;
  Mat3 a, b;
  /// False where the turns that a and b made since the last call about the axis differ from the change of the angle by half a turn.
  bool follow(const Mat3& Ra, const Mat3& Rb, const Vec3& axis);
};

/// The largest residual of a joint: lengths over `length`, directions as cosines, angles in radians.  `turns`: two,
/// kept by the caller; `t`: the time, of driven joints [s].
double opening(const MachineJoint& j, const Pose& a, const Pose& b, const Pose& carrier, double t, double length, Turned* turns);

}  // namespace hilo::test
