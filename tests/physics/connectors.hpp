// SPDX-License-Identifier: GPL-3.0-or-later
// Two bodies in space and connectors between them, for tests of joints and springs.
#pragma once
#include <gtest/gtest.h>

#include "physics/joint.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test {

using Vec12 = Eigen::Matrix<double, 12, 1>;

inline Vec3 scattered(int seed) { return {scatter(seed), scatter(seed + 1), scatter(seed + 2)}; }
inline Mat3 turn(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix() : Mat3::Identity();
}

/// Ground, two bodies and a node somewhere.
inline Config somewhere(int seed) {
  Config q;
  q.x.resize(1), q.c.resize(3, Vec3::Zero()), q.R.resize(3, Mat3::Zero());
  for (int b = 1; b < 3; ++b) q.c[b] = 2 * scattered(seed + 10 * b), q.R[b] = turn(2.5 * scattered(seed + 10 * b + 5));
  q.R[0] = Mat3::Identity();
  q.x[0] = scattered(seed + 77);
  return q;
}

/// q + tau z: linear in tau, z = (u_1, theta_1, u_2, theta_2) with dR = theta x R.
inline Config moved(const Config& q, const Vec12& z, double tau) {
  Config out = q;
  for (int b = 1; b < 3; ++b) {
    out.c[b] += tau * z.segment<3>(6 * (b - 1));
    out.R[b] += tau * skew(z.segment<3>(6 * (b - 1) + 3)) * q.R[b];
  }
  return out;
}

inline Config middle(const Config& a, const Config& b) {
  Config q = a;
  for (size_t i = 0; i < a.c.size(); ++i) q.c[i] = (a.c[i] + b.c[i]) / 2, q.R[i] = (a.R[i] + b.R[i]) / 2;
  for (size_t i = 0; i < a.x.size(); ++i) q.x[i] = (a.x[i] + b.x[i]) / 2;
  return q;
}

/// Increment from q0 to q1: R1 - R0 = w x (R0 + R1)/2, the Cayley vector of R1 R0^T (Rodrigues parameters, from the quaternion).
inline Vec12 increment(const Config& q0, const Config& q1) {
  Vec12 z;
  for (int b = 1; b < 3; ++b) {
    const Eigen::Quaterniond Q(Mat3(q1.R[b] * q0.R[b].transpose()));
    z.segment<3>(6 * (b - 1)) = q1.c[b] - q0.c[b];
    z.segment<3>(6 * (b - 1) + 3) = 2 * Q.vec() / Q.w();
  }
  return z;
}

inline const std::vector<std::string>& joint_kinds() {
  static const std::vector<std::string> kinds{"fixed",    "spherical", "revolute", "cylindrical", "prismatic",        "universal",
                                              "distance", "planar",    "in-plane", "in-line",     "constant-velocity"};
  return kinds;
}

inline Mat3 some_frame() { return frame_of_axis(Vec3(1, 2, -0.5), Vec3(0, 1, 0)); }
inline const Vec3 joint_point(0.4, -0.2, 0.9), other_point(-1, 0.3, 0.2);

inline JointPlace place(const std::string& kind) {
  return {.kind = kind,
          .a = {1, -1},
          .b = {2, -1},
          .at = joint_point,
          .at_b = kind == "distance" ? other_point : joint_point,
          .frame = some_frame()};
}
inline hilo::Joint joint(const std::string& kind, const Config& q) { return make_joint(place(kind), q); }

}  // namespace hilo::test
