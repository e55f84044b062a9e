// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of meshed faces against closed forms of Saint-Venant's torsion and flexure.
#include "physics/section_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "physics/section_face.hpp"
#include "physics/thin_walls.hpp"

namespace hilo::test::section_mesh_test {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr double nu = 0.3;

/// Rows and columns of cells over the unit square, carried to the face by `map`; a node for each place.
class FaceMesh {
 public:
  explicit FaceMesh(bool triangles = false) : triangles_(triangles) {}
  void add(int n, int m, const std::function<Vector2d(double, double)>& map) {
    const auto node = [&](int i, int j) {
      const Vector2d x = map(i / (2.0 * n), j / (2.0 * m));
      const auto [at, is_new] =
          number_.emplace(std::pair{std::llround(x.x() * 1e9), std::llround(x.y() * 1e9)}, static_cast<int>(mesh.X.size()));
      if (is_new) mesh.X.push_back(x);
      return at->second;
    };
    for (int i = 0; i < 2 * n; i += 2)
      for (int j = 0; j < 2 * m; j += 2) {
        const auto at = [&](int a, int b) { return node(i + a, j + b); };
        if (triangles_) {
          mesh.cells.push_back({at(0, 0), at(2, 0), at(2, 2), at(1, 0), at(2, 1), at(1, 1), -1, -1, -1});
          mesh.cells.push_back({at(0, 0), at(2, 2), at(0, 2), at(1, 1), at(1, 2), at(0, 1), -1, -1, -1});
        } else {
          mesh.cells.push_back({at(0, 0), at(2, 0), at(2, 2), at(0, 2), at(1, 0), at(2, 1), at(1, 2), at(0, 1), at(1, 1)});
        }
      }
  }
  void rectangle(double x0, double x1, double y0, double y1, int n, int m) {
    add(n, m, [=](double r, double s) { return Vector2d(x0 + (x1 - x0) * r, y0 + (y1 - y0) * s); });
  }
  /// Of a ring, from one angle to another.
  void ring(double ri, double ro, double from, double to, int n, int m) {
    add(n, m, [=](double r, double s) {
      const double radius = ri + (ro - ri) * r, angle = from + (to - from) * s;
      return Vector2d(radius * std::cos(angle), radius * std::sin(angle));
    });
  }
  SectionMesh mesh;

 private:
  bool triangles_;
  std::map<std::pair<long long, long long>, int> number_;
};

/// A disc of radius 1, or what `map` makes of it: a square in the middle and four pieces around.
SectionMesh disc(
    int n, const std::function<Vector2d(const Vector2d&)>& map = [](const Vector2d& x) { return x; }) {
  FaceMesh out;
  const double a = 0.4;
  out.add(n, n, [&](double r, double s) { return map(Vector2d(a * (2 * r - 1), a * (2 * s - 1))); });
  for (int side = 0; side < 4; ++side) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(side * pi / 2).toRotationMatrix();
    out.add(n, n, [&](double r, double s) {
      const double angle = pi / 4 * (2 * s - 1);
      const Vector2d inner(a, a * (2 * s - 1)), outer(std::cos(angle), std::sin(angle));
      return map(turn * ((1 - r) * inner + r * outer));
    });
  }
  return out.mesh;
}

SectionMesh rectangle(double b, double h, int n, int m, bool triangles = false) {
  FaceMesh out(triangles);
  out.rectangle(-b / 2, b / 2, -h / 2, h / 2, n, m);
  return out.mesh;
}

/// 1/k of the energy of shear along the sides 2 a of a rectangle 2 a x 2 b: 6/5 by the parabola, the rest by div grad p = nu/(1 + nu) V y/I
/// with p = 0 on the border, as a double series [timoshenko-goodier, 121].
double shear_flexibility(double a, double b) {
  const double A = 4 * a * b, I = A * a * a / 3, load = nu / (1 + nu) / I;
  double sum = 0;
  for (int m = 0; m < 400; ++m)
    for (int n = 1; n < 400; ++n) {
      const double k = (2 * m + 1) * pi / (2 * a), l = n * pi / b;
      // load y = sum c cos(k x) sin(l y)
      const double c = load * (m % 2 ? -1 : 1) * 2 / (a * k) * (n % 2 ? 1 : -1) * 2 / l;
      sum += c * c / (k * k + l * l) * a * b;
    }
  return 1.2 + A * sum;
}

TEST(SectionMesh, ARectangleHasSaintVenantsConstants) {
  for (const bool triangles : {false, true})
    for (const double h : {1.0, 3.0}) {
      const SectionArea s = meshed_face(rectangle(1, h, 6, 10, triangles), nu).area;
      EXPECT_NEAR(s.A, h, 1e-12 * h);
      EXPECT_NEAR(s.I1, h * h * h / 12, 1e-12 * s.I1);
      EXPECT_NEAR(s.I2, h / 12, 1e-12 * s.I2);
      EXPECT_NEAR(s.J, torsion_of_rectangle(1, h), 1e-3 * s.J);
      EXPECT_NEAR(1 / s.shear_1, shear_flexibility(0.5, h / 2), 5e-4);
      EXPECT_NEAR(1 / s.shear_2, shear_flexibility(h / 2, 0.5), 5e-4);
      EXPECT_LT(std::abs(s.s1) + std::abs(s.s2) + std::abs(s.I12) + std::abs(s.shear_12), 1e-3);
    }
  EXPECT_NEAR(meshed_face(rectangle(1, 2, 4, 8), 0).area.shear_2, 5.0 / 6, 5e-5) << "the parabola";
  EXPECT_NEAR(1 / shear_flexibility(0.5, 0.5), 0.828, 5e-4) << "of docs/beams.md";
}

// Of a circle J = pi/2, and the energy of Love's exact stress (section_face): k = 6 (1 + nu)^2/(7 + 14 nu + 8 nu^2).  The stress in the
// middle, at the sides and above is exact, too.
TEST(SectionMesh, ACircleHasTheStressAndEnergyOfLove) {
  const SectionFace face = meshed_face(disc(8), nu);
  const SectionArea& s = face.area;
  EXPECT_NEAR(s.A, pi, 2e-5);
  EXPECT_NEAR(s.J, pi / 2, 2e-5);
  EXPECT_NEAR(s.shear_1, 6 * (1 + nu) * (1 + nu) / (7 + 14 * nu + 8 * nu * nu), 1e-5);
  EXPECT_NEAR(s.shear_2, s.shear_1, 1e-7);
  const SectionFace exact = round_face({.A = pi, .I1 = pi / 4, .I2 = pi / 4, .J = pi / 2}, 1, 0, nu);
  int found = 0;
  for (const auto& p : exact.points)
    for (const auto& q : face.points)
      if ((p.at - q.at).norm() < 1e-9) {
        ++found;
        EXPECT_LT((p.shear - q.shear).norm(), 2e-3) << p.at.transpose();
      }
  EXPECT_GE(found, 5) << "the middle and the ends of the axes";
}

// J = pi a^3 b^3/(a^2 + b^2), the stress of torsion 2 T/(pi a b^2) at the ends of the short axis.
TEST(SectionMesh, AnEllipseHasItsTorsion) {
  const double a = 2, b = 0.7;
  const SectionFace face = meshed_face(disc(10, [=](const Vector2d& x) { return Vector2d(a * x.x(), b * x.y()); }), nu);
  EXPECT_NEAR(face.area.J, pi * std::pow(a * b, 3) / (a * a + b * b), 1e-4 * face.area.J);
  EXPECT_NEAR(face.area.I1, pi * a * b * b * b / 4, 1e-4 * face.area.I1);
  for (const auto& p : face.points)
    if ((p.at - Vector2d(0, b)).norm() < 1e-9) {
      EXPECT_NEAR(p.shear(0, 2), -2 / (pi * a * b * b), 3e-3 * 0.65);
    }
}

// sqrt(3)/80 of the fourth power of the side, and 20 T/a^3 amid each side [timoshenko-goodier, 107].
TEST(SectionMesh, AnEquilateralTriangleHasItsTorsion) {
  for (const double turn : {0.0, 0.4}) {
    FaceMesh out;  // three quadrangles that meet in the middle
    const Eigen::Matrix2d to = Eigen::Rotation2Dd(turn).toRotationMatrix();
    const double h = std::sqrt(3.0) / 2;
    const Vector2d corner[] = {{0, 0}, {1, 0}, {0.5, h}}, centre(0.5, h / 3);
    for (int k = 0; k < 3; ++k) {
      const Vector2d a = corner[k], b = (a + corner[(k + 1) % 3]) / 2, d = (a + corner[(k + 2) % 3]) / 2;
      out.add(5, 5, [&](double r, double s) {
        return Vector2d(to * ((1 - r) * (1 - s) * a + r * (1 - s) * b + r * s * centre + (1 - r) * s * d + Vector2d(3, -2)));
      });
    }
    const SectionFace face = meshed_face(out.mesh, nu);
    const SectionArea& s = face.area;
    EXPECT_NEAR(s.J, std::sqrt(3.0) / 80, 5e-5 * s.J);
    EXPECT_LT(std::hypot(s.s1, s.s2), 1e-9) << "the shear centre";
    EXPECT_NEAR(s.I1, s.I2, 1e-12);
    EXPECT_NEAR(s.shear_1, s.shear_2, 1e-9) << "alike in all directions";
    double most = 0;
    for (const auto& p : face.points) most = std::max(most, p.shear.col(2).norm());
    EXPECT_NEAR(most, 20, 0.2);
  }
}

// A tube is a face with a hole: J = I1 + I2, the energy of Love's exact stress.
TEST(SectionMesh, ATubeHasTheConstantsOfItsRing) {
  for (const double ri : {0.2, 0.9}) {
    FaceMesh out;
    for (int k = 0; k < 4; ++k) out.ring(ri, 1, k * pi / 2, (k + 1) * pi / 2, ri < 0.5 ? 12 : 2, 6);
    const SectionFace face = meshed_face(out.mesh, nu);
    const SectionArea& s = face.area;
    EXPECT_NEAR(s.J, pi / 2 * (1 - std::pow(ri, 4)), 2e-5 * s.J);
    const SectionFace exact = round_face({.A = s.A, .I1 = s.I1, .I2 = s.I2, .J = s.J}, 1, ri, nu);
    double energy = 0;  // of Love's stress by a force of 1, over the ring
    constexpr int n = 400;
    for (int i = 0; i < n; ++i) {
      const double r = ri + (1 - ri) * (i + 0.5) / n, within = ri * ri / (r * r), to = 8 * (1 + nu) * s.I1;
      const double out_of = (3 + 2 * nu) * (1 + ri * ri - r * r - within) / to;
      const double round = ((3 + 2 * nu) * (1 + ri * ri + within) - (1 - 2 * nu) * r * r) / to;
      energy += pi * r * (out_of * out_of + round * round) * (1 - ri) / n;
    }
    EXPECT_NEAR(s.shear_1, 1 / (s.A * energy), 1e-4);
    EXPECT_NEAR(s.shear_2, s.shear_1, 1e-6);
    int found = 0;
    for (const auto& p : exact.points)
      for (const auto& q : face.points)
        if ((p.at - q.at).norm() < 1e-9) {
          ++found;
          EXPECT_LT((p.shear - q.shear).norm(), 2e-2 * p.shear.norm()) << p.at.transpose();
        }
    EXPECT_GE(found, 8);
  }
}

// Half a disc: Trefftz's shear centre is 8/(5 pi) of the radius from the middle of the diameter [timoshenko-goodier, 123, at nu = 0].
TEST(SectionMesh, HalfADiscHasItsShearCentre) {
  FaceMesh out;
  const double a = 0.4;
  out.add(6, 3, [&](double r, double s) { return Vector2d(a * s, a * (2 * r - 1)); });
  for (int side = -1; side < 2; ++side)  // right, below and above; the last two from the diameter on
    out.add(6, side == 0 ? 6 : 3, [&](double r, double s) {
      const double t = side == 0 ? 2 * s - 1 : s, angle = side == 0 ? pi / 4 * t : pi / 2 * side - side * pi / 4 * t;
      const Vector2d inner = side == 0 ? Vector2d(a, a * t) : Vector2d(a * t, side * a), outer(std::cos(angle), std::sin(angle));
      const Vector2d x = (1 - r) * inner + r * outer;
      return x;
    });
  for (auto& cell : out.mesh.cells)  // the piece above is drawn clockwise
    if (extreme_jacobian(out.mesh, cell, 1)[1] < 0)
      cell = {cell[0], cell[3], cell[2], cell[1], cell[7], cell[6], cell[5], cell[4], cell[8]};
  const SectionArea s = meshed_face(out.mesh, nu).area;
  EXPECT_NEAR(s.A, pi / 2, 2e-5);
  EXPECT_NEAR(s.s1 + 4 / (3 * pi), 8 / (5 * pi), 2e-4);
  EXPECT_NEAR(s.s2, 0, 1e-9);
}

// A thin tube with a slit along it: J = 2 pi r t^3/3, the shear centre 2 r from its axis, away from the slit [timoshenko-goodier, 127].
TEST(SectionMesh, ASlitTubeHasItsShearCentreOutside) {
  const double r = 1, t = 0.02, slit = 1e-4;
  FaceMesh out;
  out.ring(r - t / 2, r + t / 2, slit, 2 * pi - slit, 2, 60);
  const SectionArea s = meshed_face(out.mesh, nu).area;
  EXPECT_NEAR(s.J, 2 * pi * r * t * t * t / 3, 0.015 * s.J) << "thin: 0.63 t is not twisted at both ends";
  EXPECT_NEAR(s.s1, -2 * r, 1e-3 * r);
  EXPECT_NEAR(s.s2, 0, 1e-9);
}

// Of thin walls the numbers are those of the flow in the walls: area, J less by 0.63 t of each end, shear centre, shear energy.
TEST(SectionMesh, AThinChannelIsThatOfItsWalls) {
  const double b = 0.5, h = 1, t = 0.01;
  FaceMesh out;
  out.rectangle(0, t, 0, t, 2, 2), out.rectangle(0, t, h - t, h, 2, 2), out.rectangle(0, t, t, h - t, 2, 40);
  out.rectangle(t, b, 0, t, 30, 2), out.rectangle(t, b, h - t, h, 30, 2);
  const SectionArea s = meshed_face(out.mesh, nu).area;
  const double bm = b - t / 2, hm = h - t, e = 3 * bm * bm / (hm + 6 * bm);  // of the shear centre beyond the middle of the web
  const double centre = (2 * (b - t) * t * (b + t) / 2 + h * t * t / 2) / s.A;
  EXPECT_NEAR(s.A, t * (h + 2 * (b - t)), 1e-12);
  EXPECT_NEAR(s.J, (2 * bm + hm) * t * t * t / 3, 0.01 * s.J);
  EXPECT_NEAR(s.s1, t / 2 - e - centre, 2e-3 * b);
  EXPECT_NEAR(s.s2, 0, 1e-6);
  const OpenWalls thin = open_walls({{{bm, hm / 2}, {0, hm / 2}, t}, {{0, hm / 2}, {0, -hm / 2}, t}, {{0, -hm / 2}, {bm, -hm / 2}, t}});
  EXPECT_NEAR(s.shear_1, thin.stiffness(0, 0), 0.01 * s.shear_1);
  EXPECT_NEAR(s.shear_2, thin.stiffness(1, 1), 0.01 * s.shear_2);
}

// Turned and moved, a face has the same numbers in other axes, and the same stress; finer, nearly the same.
TEST(SectionMesh, NumbersTurnWithTheFace) {
  const auto angle_of = [](int n, double turn, const Vector2d& away) {
    FaceMesh out(true);
    out.rectangle(0, 1, 0, 1, n, n), out.rectangle(1, 4, 0, 1, 3 * n, n), out.rectangle(0, 1, 1, 3, n, 2 * n);
    for (Vector2d& x : out.mesh.X) x = Eigen::Rotation2Dd(turn) * x + away;
    return meshed_face(out.mesh, nu);
  };
  const auto tensors = [](const SectionArea& a, double turn) {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(-turn).toRotationMatrix();
    Eigen::Matrix2d second, shear;
    second << a.I2, a.I12, a.I12, a.I1, shear << a.shear_1, a.shear_12, a.shear_12, a.shear_2;
    Eigen::Matrix<double, 2, 5> out;
    out << R * second * R.transpose(), R * shear * R.transpose(), R * Vector2d(a.s1, a.s2);
    return out;
  };
  const SectionFace straight = angle_of(3, 0, {0, 0}), turned = angle_of(3, 0.7, {50, -80}), fine = angle_of(9, 0, {0, 0});
  EXPECT_NEAR(straight.area.J, turned.area.J, 1e-9);
  EXPECT_LT((tensors(straight.area, 0) - tensors(turned.area, 0.7)).norm(), 1e-9);
  EXPECT_LT((tensors(straight.area, 0) - tensors(fine.area, 0)).cwiseAbs().maxCoeff(), 5e-3);
  EXPECT_NEAR(straight.area.J, fine.area.J, 6e-3 * fine.area.J) << "its inner corner is sharp";
  const Vec6 f = (Vec6() << 3, -2, 5, 1, 4, 2).finished();
  Vec6 g = f;
  for (const int k : {0, 3}) g.segment<2>(k) = Eigen::Rotation2Dd(0.7) * f.segment<2>(k);
  const StressRange one = stress_range(straight, f), two = stress_range(turned, g);
  EXPECT_NEAR(one.high, two.high, 1e-9);
  EXPECT_NEAR(one.low, two.low, 1e-9);
  EXPECT_NEAR(one.von_mises, two.von_mises, 1e-9);
}

// Shear stress has the force and the moment that it is of, wherever they act.
TEST(SectionMesh, StressHasItsResultants) {
  FaceMesh out;
  out.rectangle(0, 1, 0, 1, 4, 4), out.rectangle(1, 3, 0, 1, 8, 4), out.rectangle(0, 1, 1, 3, 4, 8);
  const SectionFace face = meshed_face(out.mesh, nu);
  const Vec3 V1_V2_T(2, -1, 3);
  Vec3 sum = Vec3::Zero();  // by Simpson's rule over each cell
  constexpr double w[9] = {1, 1, 1, 1, 4, 4, 4, 4, 16};
  for (const auto& cell : out.mesh.cells)
    for (int i = 0; i < 9; ++i) {
      const auto& p = face.points[static_cast<size_t>(cell[i])];
      const double area = std::abs((out.mesh.X[cell[1]] - out.mesh.X[cell[0]]).x() * (out.mesh.X[cell[2]] - out.mesh.X[cell[1]]).y());
      const Vector2d t = p.shear * V1_V2_T * area * w[i] / 36;
      sum += Vec3(t.x(), t.y(), p.at.x() * t.y() - p.at.y() * t.x());
    }
  EXPECT_NEAR(sum[0], 2, 0.02);
  EXPECT_NEAR(sum[1], -1, 0.02);
  EXPECT_NEAR(sum[2], 3 + face.area.s1 * -1 - face.area.s2 * 2, 0.05);
}

}  // namespace
}  // namespace hilo::test::section_mesh_test
