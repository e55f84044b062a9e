// SPDX-License-Identifier: GPL-3.0-or-later
#include "machines/pose.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hilo::test {

Pose fitted(const std::vector<Vec3>& X, const std::vector<Vec3>& x, const std::vector<std::int64_t>& nodes) {
  Pose p;
  for (const auto n : nodes) p.X += X[n] / static_cast<double>(nodes.size()), p.c += x[n] / static_cast<double>(nodes.size());
  Mat3 F = Mat3::Zero();
  for (const auto n : nodes) F += (x[n] - p.c) * (X[n] - p.X).transpose();
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 D = Mat3::Identity();
  D(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  p.R = svd.matrixU() * D * svd.matrixV().transpose();
  return p;
}

double unfit(const std::vector<Vec3>& X, const std::vector<Vec3>& x, const std::vector<std::int64_t>& nodes) {
  const Pose p = fitted(X, x, nodes);
  double worst = 0;
  for (const auto n : nodes) worst = std::max(worst, (p.at(X[n]) - x[n]).norm());
  return worst;
}

bool Turned::follow(const Mat3& Ra, const Mat3& Rb, const Vec3& axis) {
  const Vec3 u = axis.unitOrthogonal(), v = axis.normalized().cross(u), w = Ra.transpose() * Rb * u;
  const double now = std::atan2(v.dot(w), u.dot(w));
  bool same = true;
  if (started) {
    const double change = std::remainder(now - angle, 2 * std::numbers::pi);
    const Eigen::AngleAxisd da(Mat3(Ra * a.transpose())), db(Mat3(Rb * b.transpose()));
    const Vec3 mean = (Ra * axis + a * axis).normalized();
    const double turned = mean.dot(db.angle() * db.axis() - da.angle() * da.axis());
    same = std::abs(change - turned) < std::numbers::pi;
    angle += change;
  } else {
    angle = now;
  }
  a = Ra, b = Rb, started = true;
  return same;
}

double opening(const MachineJoint& j, const Pose& a, const Pose& b, const Pose& carrier, double t, double length, Turned* turns) {
  const std::string& kind = j.kind;
  const Vec3 pa = a.at(j.at), pb = b.at(kind == "distance" ? j.at_b : j.at);
  const Vec3 gap = (pb - pa) / length, axis = j.axis.normalized();
  if (kind == "distance") return std::abs((pb - pa).norm() - (j.at_b - j.at).norm()) / length;
  const Vec3 da = a.R * axis, db = b.R * axis;
  const double along = gap.dot(da), across = (gap - along * da).norm(), tilt = (db - da).norm(), apart = gap.norm();
  const double twist = (a.R - b.R).norm();
  if (kind == "spherical") return apart;
  if (kind == "fixed") return std::max(apart, twist);
  if (kind == "revolute") {
    double off = 0;
    if (j.turn != 0) {
      turns[0].follow(a.R, b.R, axis);
      const double s = std::min(1.0, t / j.turn_over), s4 = s * s * s * s;
      off = std::abs(turns[0].angle - j.turn * s4 * (35 + s * (-84 + s * (70 - 20 * s))));
    }
    return std::max({apart, tilt, off});
  }
  if (kind == "cylindrical") return std::max(across, tilt);
  if (kind == "prismatic") return std::max(across, twist);
  if (kind == "planar") return std::max(std::abs(along), tilt);
  if (kind == "in-plane") return std::abs(along);
  if (kind == "in-line") return across;
  if (kind == "universal") {
    const Vec3 x = (j.x - axis * axis.dot(j.x)).normalized();
    return std::max(apart, std::abs(da.dot(b.R * x)));
  }
  if (kind == "constant-velocity") {  // the rotation between the shafts has no part about them
    const Mat3 Q = a.R.transpose() * b.R;
    const Vec3 axial(Q(2, 1) - Q(1, 2), Q(0, 2) - Q(2, 0), Q(1, 0) - Q(0, 1));
    return std::max(apart, std::abs(axial.dot(axis)));
  }
  if (kind == "screw") {
    turns[0].follow(a.R, b.R, axis);
    return std::max({across, tilt, std::abs(along - j.pitch * turns[0].angle / (2 * std::numbers::pi) / length)});
  }
  turns[0].follow(carrier.R, a.R, axis);
  if (kind == "gear") {
    turns[1].follow(carrier.R, b.R, j.axis_b.normalized());
    return std::abs(turns[1].angle - j.ratio * turns[0].angle);
  }
  if (kind == "rack") {
    const Vec3 d = carrier.R * j.axis_b.normalized();
    return std::abs(d.dot(b.at(j.at) - carrier.at(j.at)) - j.radius * turns[0].angle) / length;
  }
  return 0;
}

}  // namespace hilo::test
