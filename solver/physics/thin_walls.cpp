// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/thin_walls.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace hilo {

using Eigen::Matrix2d, Eigen::Vector2d;

OpenWalls open_walls(const std::vector<Wall>& walls) {
  double A = 0;
  Vector2d centre = Vector2d::Zero();
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
  const Matrix2d by_force = M.inverse();  // columns: slopes of the stress along the section, of unit forces along 1 and 2
  Matrix2d flexibility = Matrix2d::Zero();
  Vector2d moment = Vector2d::Zero();
  std::vector<Vector2d> out(walls.size());  // flow at b, of both forces
  for (size_t i = 0; i < walls.size(); ++i) {
    const Wall& w = walls[i];
    const double l = (w.b - w.a).norm();
    const Vector2d d = (w.b - w.a) / l, from = w.a - centre;
    Vector2d q0 = Vector2d::Zero();
    for (size_t j = 0; j < i; ++j)
      if ((walls[j].b - w.a).norm() < 1e-9 * l) q0 += out[j];
    const auto flow = [&](double s) -> Vector2d { return q0 - w.t * by_force.transpose() * (s * from + s * s / 2 * d); };
    out[i] = flow(l);
    const double x = std::sqrt(0.6), arm = from.x() * d.y() - from.y() * d.x();
    for (const auto& [at, weight] : std::array<std::pair<double, double>, 3>{{{-x, 5. / 18}, {0, 8. / 18}, {x, 5. / 18}}}) {
      const Vector2d q = flow(l * (1 + at) / 2);
      flexibility += A * weight * l / w.t * q * q.transpose();
      moment += weight * l * arm * q;
    }
  }
  return {{moment[1], -moment[0]}, flexibility.inverse()};
}

}  // namespace hilo
