// SPDX-License-Identifier: GPL-3.0-or-later
// Rows that are linear in the velocities, A(q) v = 0, and come from no position: rolling without slip, knife edges.
//
// Each row says that the material point of b at the contact does not move against that of a along a direction t:
//   t.(v_b + w_b x s_b - v_a - w_a x s_a) = 0,      forces t lambda on b at the contact, -t lambda on a.
// Taken at the configuration of the constraint gradients and with the velocity of the stage; at the mid-point, where the increment of a
// body is its mid-point velocity times h, A^T lambda does no work at any step size.
#pragma once
#include "physics/joint.hpp"

namespace hilo {

/// Where b touches a, and along which directions it may not slip.
class VelocityRows {
 public:
  struct Contact {
    Vec3 arm = Vec3::Zero();  // from b's centre to the contact [m]
    Vec3 t[2] = {Vec3::Zero(), Vec3::Zero()};
  };
  virtual ~VelocityRows() = default;
  virtual int n_rows() const = 0;
  /// For the directors of a and b, which need not be of unit length.
  virtual Contact contact(const Mat3& Ra, const Mat3& Rb) const = 0;
  /// Its change by changes of the directors.
  virtual Contact change(const Mat3& Ra, const Mat3& Rb, const Mat3& dRa, const Mat3& dRb) const = 0;
};

/// The velocity rows of a joint at positions q and velocities v (null: at rest).
class Slip {
 public:
  Slip(const Joint& joint, const Config& q, const Config* v);
  int n = 0;
  double value[2] = {};            // t.(slip velocity) [m/s]
  Eigen::Matrix<double, 2, 12> A;  // over translation and rotation of a, then of b
  /// Force and moment about b's centre on b; the reaction on a about a's centre is -(A^T lambda) of its own columns.
  Vec6 force(const double* lambda) const { return -A.rightCols<6>().topRows(n).transpose() * Eigen::Map<const Eigen::VectorXd>(lambda, n); }

  /// Changes of an end: of centre, directors and their velocities.
  struct Move {
    Vec3 c, v;
    Mat3 R, V;
  };
  struct Change {
    double value[2] = {};
    Eigen::Matrix<double, 2, 12> A;
  };
  Change change(const Move& a, const Move& b) const;

 private:
  struct End {
    Vec3 c, v, w;
    Mat3 R, V, T;  // T: inverse of (tr(R R^T) I - R R^T)/2
  };
  static End end_of(const Config& q, const Config* v, int body);
  static Vec3 spin_change(const End& e, const Move& m);
  void fill(const VelocityRows::Contact& at, const Vec3& arm_a, Eigen::Matrix<double, 2, 12>& out) const;
  const VelocityRows& rows_;
  End a_, b_;
  VelocityRows::Contact at_;
  Vec3 arm_a_;
};

/// Disc or wheel of radius `ratio` with the axle `axis_b` carried by b, or a ball where it is zero, on a plane carried by a: centre `at`,
/// normal the third column of the frame.  Row 1 keeps the height of the centre, rows 2 and 3 the rolling along x and y of the frame.
Joint make_rolling(const JointPlace& place, const Config& q);
/// A point of b that moves along its edge `axis_b` and not across it, in a plane with the normal `axis`: one row.
Joint make_knife_edge(const JointPlace& place, const Config& q);

/// Their rows of joint_kinds().
std::vector<JointKind> rolling_kinds();

}  // namespace hilo
