// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/section_face.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hilo {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;
using Shear = Eigen::Matrix<double, 2, 3>;

constexpr int n_along = 8;    // pieces of a side
constexpr int n_around = 36;  // pieces of a circle

/// Cells between a ring of n points from `a` on and one from `b` on.
void add_ring(SectionFace& face, int n, int a, int b) {
  for (int i = 0; i < n; ++i) face.cells.push_back({a + i, a + (i + 1) % n, b + (i + 1) % n, b + i});
}
/// Triangles from a ring of the first n points to the last one.
void add_fan(SectionFace& face, int n) {
  for (int i = 0; i < n; ++i) face.cells.push_back({i, (i + 1) % n, static_cast<int>(face.points.size()) - 1, -1});
}

/// Points of the border of a rectangle about axis 3, from its lower left corner on.
std::vector<Vector2d> border(double b, double h) {
  std::vector<Vector2d> out;
  const Vector2d corner[] = {{-b / 2, -h / 2}, {b / 2, -h / 2}, {b / 2, h / 2}, {-b / 2, h / 2}, {-b / 2, -h / 2}};
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < n_along; ++i) out.emplace_back(corner[side] + (corner[side + 1] - corner[side]) * i / n_along);
  return out;
}

/// Stress by G times the twist, on the border of a rectangle: y along a side of length 2 l, 2 a across (Timoshenko and Goodier, 109).
double twisted_side(double a, double l, double y) {
  double sum = pi * pi / 8;
  for (int n = 1; n < 400; n += 2) {
    const double k = n * pi / (2 * a);
    sum -= std::exp(k * (std::abs(y) - l)) * (1 + std::exp(-2 * k * std::abs(y))) / (1 + std::exp(-2 * k * l)) / (n * n);
  }
  return 16 * a / (pi * pi) * sum;
}

}  // namespace

Vector2d OpenShape::centre() const {
  double A = 0;
  Vector2d sum = Vector2d::Zero();
  for (const Part& p : parts) A += p.b * p.h, sum += p.b * p.h * Vector2d(p.x, p.y);
  return sum / A;
}

SectionFace round_face(const SectionArea& area, double ro, double ri, double nu) {
  SectionFace face{.area = area, .round = true};
  const auto add_circle = [&](double r) {
    const double flow =
        ((0.75 + nu / 2) * (ro * ro + ri * ri + ro * ro * ri * ri / (r * r)) - (0.25 - nu / 2) * r * r) / (2 * (1 + nu) * area.I1);
    for (int i = 0; i < n_around; ++i) {
      const double angle = 2 * pi * i / n_around;
      const Vector2d out(std::cos(angle), std::sin(angle)), round(-out.y(), out.x());
      face.points.push_back({r * out, round * Eigen::RowVector3d(-flow * out.y(), flow * out.x(), r / area.J)});
    }
  };
  add_circle(ro);
  if (ri > 1e-9 * ro) {
    add_circle(ri);
    add_ring(face, n_around, 0, n_around);
  } else {
    const double middle = (3 + 2 * nu) / (2 * (1 + nu)) / area.A;
    face.points.push_back({Vector2d::Zero(), Shear{{middle, 0, 0}, {0, middle, 0}}});
    add_fan(face, n_around);
  }
  return face;
}

SectionFace full_face(const SectionArea& area, double b, double h) {
  SectionFace face{.area = area};
  const auto add = [&](const Vector2d& x, const Vector2d& torsion) {
    const double v1 = 1.5 / area.A * (1 - std::pow(2 * x.x() / b, 2)), v2 = 1.5 / area.A * (1 - std::pow(2 * x.y() / h, 2));
    face.points.push_back({x, Shear{{v1, 0, torsion.x()}, {0, v2, torsion.y()}}});
  };
  for (const Vector2d& x : border(b, h)) {
    const bool upright = std::abs(x.x()) > b / 2 * (1 - 1e-9), level = std::abs(x.y()) > h / 2 * (1 - 1e-9);
    Vector2d torsion = Vector2d::Zero();  // none in the corners
    if (!level) torsion.y() = std::copysign(twisted_side(b / 2, h / 2, x.y()), x.x()) / area.J;
    if (!upright) torsion.x() = -std::copysign(twisted_side(h / 2, b / 2, x.x()), x.y()) / area.J;
    add(x, torsion);
  }
  add(Vector2d::Zero(), Vector2d::Zero());
  add_fan(face, 4 * n_along);
  return face;
}

SectionFace hollow_face(const SectionArea& area, double b, double h, double t) {
  SectionFace face{.area = area};
  const double bm = b - t, hm = h - t;
  const auto middle = border(bm, hm);
  for (const double side : {t, -t}) {
    const auto faces = border(b - t + side, h - t + side);
    for (size_t i = 0; i < faces.size(); ++i) {
      const Vector2d& x = middle[i];
      const int wall = static_cast<int>(i) / n_along;  // below, right, above, left
      const Vector2d along[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
      // q/t about axis 3 by a force along 2: none in the middle of the walls above and below; the same by one along 1, turned
      const auto flow = [](double across, double up, double I, double w, double l, bool upright) {
        return (upright ? w / 2 * l / 2 + (l * l / 4 - up * up) / 2 : std::abs(across) * l / 2) / I;
      };
      const double q2 = flow(x.x(), x.y(), area.I1, bm, hm, wall % 2 == 1), q1 = flow(x.y(), x.x(), area.I2, hm, bm, wall % 2 == 0);
      const double right = wall == 1 ? 1 : wall == 3 ? -1 : x.x() < 0 ? -1 : 1, below = wall == 0 ? 1 : wall == 2 ? -1 : x.y() > 0 ? -1 : 1;
      face.points.push_back({faces[i], along[wall] * Eigen::RowVector3d(below * q1, right * q2, 1 / (2 * bm * hm * t))});
    }
  }
  add_ring(face, 4 * n_along, 0, 4 * n_along);
  return face;
}

SectionFace open_face(const SectionArea& area, const OpenShape& shape) {
  SectionFace face{.area = area};
  const Vector2d centre = shape.centre();
  for (const OpenShape::Part& p : shape.parts) {
    const bool level = p.b >= p.h;
    const double t = level ? p.h : p.b, l = level ? p.b : p.h;
    const Vector2d along = level ? Vector2d(1, 0) : Vector2d(0, 1), out(along.y(), -along.x());  // out, along, axis 3
    const int first = static_cast<int>(face.points.size());
    for (int i = 0; i <= n_along; ++i) {
      const Vector2d x = Vector2d(p.x, p.y) + along * l * (static_cast<double>(i) / n_along - 0.5);
      const Eigen::Matrix2d flow = flow_near(shape.walls, x, along) / t;
      for (const double side : {1, -1}) {
        Shear shear;
        shear << flow, side * along * t / area.J;
        face.points.push_back({x + side * t / 2 * out - centre, shear});
      }
      if (i < n_along) face.cells.push_back({first + 2 * i, first + 2 * i + 2, first + 2 * i + 3, first + 2 * i + 1});
    }
  }
  return face;
}

double SectionStress::von_mises() const { return std::sqrt(axial * axial + 3 * shear * shear); }

SectionStress stress_at(const SectionFace& face, const SectionFace::Point& p, const Vec6& f) {
  const SectionArea& a = face.area;
  const double det = a.I1 * a.I2 - a.I12 * a.I12;
  const double k1 = (a.I2 * f[3] + a.I12 * f[4]) / det, k2 = (a.I12 * f[3] + a.I1 * f[4]) / det;  // E times the curvatures
  const double torsion = f[5] - (a.s1 * f[1] - a.s2 * f[0]);                                      // about the shear centre
  return {f[2] / a.A + k1 * p.at.y() - k2 * p.at.x(), (p.shear * Vec3(f[0], f[1], torsion)).norm()};
}

StressRange stress_range(const SectionFace& face, const Vec6& forces) {
  StressRange out{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 0};
  const auto take = [&](const Vec6& f) {
    for (const SectionFace::Point& p : face.points) {
      const SectionStress s = stress_at(face, p, f);
      out.high = std::max(out.high, s.axial), out.low = std::min(out.low, s.axial);
      out.von_mises = std::max(out.von_mises, s.von_mises());
    }
  };
  if (!face.round) {
    take(forces);
    return out;
  }
  for (const int of : {0, 3}) {  // points along the force, and across the moment
    const double size = forces.segment<2>(of).norm();
    const Vector2d x = size > 0 ? Vector2d(forces.segment<2>(of) / size) : Vector2d(1, 0);
    Vec6 f = forces;
    for (const int k : {0, 3}) f[k] = x.x() * forces[k] + x.y() * forces[k + 1], f[k + 1] = x.x() * forces[k + 1] - x.y() * forces[k];
    take(f);
  }
  return out;
}

}  // namespace hilo
