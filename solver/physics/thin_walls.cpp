// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/thin_walls.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hilo {

using Eigen::Matrix2d, Eigen::Vector2d;

namespace {

/// The flow of unit forces along 1 and 2, along each wall from a to b.
struct Flow {
  const std::vector<Wall>& walls;
  double A = 0;
  Vector2d centre = Vector2d::Zero();
  Matrix2d by_force;  // columns: slopes of the stress along the section
  std::vector<Vector2d> at_a;

  explicit Flow(const std::vector<Wall>& of) : walls(of) {
    for (const Wall& w : walls) {
      const double area = (w.b - w.a).norm() * w.t;
      A += area, centre += area * (w.a + w.b) / 2;
    }
    centre /= A;
    Matrix2d M = Matrix2d::Zero();
    for (const Wall& w : walls) {
      const Vector2d d = w.b - w.a, c = (w.a + w.b) / 2 - centre;
      M += d.norm() * w.t * (c * c.transpose() + d * d.transpose() / 12);
    }
    by_force = M.inverse();
    std::vector<Vector2d> at_b;
    for (size_t i = 0; i < walls.size(); ++i) {
      const double l = (walls[i].b - walls[i].a).norm();
      Vector2d q = Vector2d::Zero();
      for (size_t j = 0; j < i; ++j)
        if ((walls[j].b - walls[i].a).norm() < 1e-9 * l) q += at_b[j];
      at_a.push_back(q);
      at_b.push_back((*this)(i, l));
    }
  }
  /// At s from a.
  Vector2d operator()(size_t i, double s) const {
    const Wall& w = walls[i];
    return at_a[i] - w.t * by_force.transpose() * (s * (w.a - centre) + s * s / 2 * (w.b - w.a).normalized());
  }
};

}  // namespace

OpenWalls open_walls(const std::vector<Wall>& walls) {
  const Flow flow(walls);
  Matrix2d flexibility = Matrix2d::Zero();
  Vector2d moment = Vector2d::Zero();
  for (size_t i = 0; i < walls.size(); ++i) {
    const Wall& w = walls[i];
    const double l = (w.b - w.a).norm();
    const Vector2d d = (w.b - w.a) / l, from = w.a - flow.centre;
    const double x = std::sqrt(0.6), arm = from.x() * d.y() - from.y() * d.x();
    for (const auto& [at, weight] : std::array<std::pair<double, double>, 3>{{{-x, 5. / 18}, {0, 8. / 18}, {x, 5. / 18}}}) {
      const Vector2d q = flow(i, l * (1 + at) / 2);
      flexibility += flow.A * weight * l / w.t * q * q.transpose();
      moment += weight * l * arm * q;
    }
  }
  return {{moment[1], -moment[0]}, flexibility.inverse()};
}

Matrix2d flow_near(const std::vector<Wall>& walls, const Vector2d& at, const Vector2d& along) {
  const Flow flow(walls);
  double nearest = std::numeric_limits<double>::infinity();
  Matrix2d out = Matrix2d::Zero();
  for (size_t i = 0; i < walls.size(); ++i) {
    const Vector2d d = (walls[i].b - walls[i].a).normalized();
    if (std::abs(d.dot(along)) < 0.9) continue;
    const double s = std::clamp(d.dot(at - walls[i].a), 0.0, (walls[i].b - walls[i].a).norm());
    if (const double far = (walls[i].a + s * d - at).norm(); far < nearest) nearest = far, out = d * flow(i, s).transpose();
  }
  return out;
}

}  // namespace hilo
