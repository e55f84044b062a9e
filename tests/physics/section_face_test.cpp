// SPDX-License-Identifier: GPL-3.0-or-later
// Shear stress on faces of sections against closed forms.
#include "physics/section_face.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hilo::test::section_face_test {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr double nu = 0.3;

SectionArea round_area(double ro, double ri) {
  const double I = pi * (std::pow(ro, 4) - std::pow(ri, 4)) / 4;
  return {.A = pi * (ro * ro - ri * ri), .I1 = I, .I2 = I, .J = 2 * I};
}
Vec6 force(double V1, double V2, double T = 0) { return (Vec6() << V1, V2, 0, 0, 0, T).finished(); }
/// The stress at the point nearest to a place.
Vector2d shear_near(const SectionFace& face, const Vector2d& at, const Vec3& V1_V2_T) {
  const SectionFace::Point* found = &face.points.front();
  for (const auto& p : face.points)
    if ((p.at - at).norm() < (found->at - at).norm()) found = &p;
  EXPECT_LT((found->at - at).norm(), 1e-9);
  return found->shear * V1_V2_T;
}

// Saint-Venant's shear of a circle: (3 + 2 nu)/(2 + 2 nu) V/A in the middle, (1 + 2 nu)/(1 + nu) V/A at the sides, none above and below
// [timoshenko-goodier, 119].
TEST(SectionFace, ACircleHasSaintVenantsShear) {
  const double r = 0.02;
  const SectionFace face = round_face(round_area(r, 0), r, 0, nu);
  const double A = face.area.A;
  EXPECT_NEAR(shear_near(face, {0, 0}, {0, 1, 0}).y(), (3 + 2 * nu) / (2 + 2 * nu) / A, 1e-9 / A);
  EXPECT_NEAR(shear_near(face, {r, 0}, {0, 1, 0}).y(), (1 + 2 * nu) / (1 + nu) / A, 1e-9 / A);
  EXPECT_NEAR(shear_near(face, {-r, 0}, {0, 1, 0}).y(), (1 + 2 * nu) / (1 + nu) / A, 1e-9 / A);
  EXPECT_NEAR(shear_near(face, {0, r}, {0, 1, 0}).norm(), 0, 1e-9 / A);
  EXPECT_NEAR(shear_near(face, {0, -r}, {1, 0, 0}).x(), (1 + 2 * nu) / (1 + nu) / A, 1e-9 / A);
  EXPECT_NEAR(shear_near(face, {r, 0}, {0, 0, 1}).y(), 2 / (pi * r * r * r), 1e-9 / (r * r * r));
  EXPECT_NEAR(shear_near(face, {0, r}, {0, 0, 1}).x(), -2 / (pi * r * r * r), 1e-9 / (r * r * r));
}

// Of a thin tube: 2 V/A at the sides, T/(2 pi r^2 t) all round.
TEST(SectionFace, AThinTubeHasTheFlowOfThinWalls) {
  const double ro = 0.1, ri = 0.0999;
  const SectionFace face = round_face(round_area(ro, ri), ro, ri, nu);
  EXPECT_NEAR(shear_near(face, {ro, 0}, {0, 1, 0}).y() * face.area.A, 2, 3e-3);
  EXPECT_NEAR(shear_near(face, {0, ri}, {0, 0, 1}).norm() * 2 * pi * ro * ri * (ro - ri), 1, 3e-3);
}

// Saint-Venant's table of rectangles: T/(0.208 a^3) for a square; for two to one T/(0.246 h b^2) amid the long sides, 0.795 of it amid
// the short ones [timoshenko-goodier, 109].
TEST(SectionFace, ARectangleHasSaintVenantsTorsion) {
  const double a = 0.03;
  const auto face = [](double b, double h) {
    return full_face({.A = b * h, .I1 = b * h * h * h / 12, .I2 = h * b * b * b / 12, .J = torsion_of_rectangle(b, h)}, b, h);
  };
  EXPECT_NEAR(shear_near(face(a, a), {a / 2, 0}, {0, 0, 1}).y() * a * a * a, 1 / 0.208, 2e-3 / 0.208);
  const Vector2d long_side = shear_near(face(a, 2 * a), {-a / 2, 0}, {0, 0, 1}), short_side = shear_near(face(a, 2 * a), {0, a}, {0, 0, 1});
  EXPECT_NEAR(-long_side.y() * 2 * a * a * a, 1 / 0.246, 2e-3 / 0.246);
  EXPECT_NEAR(short_side.x() / long_side.y(), 0.795, 1.5e-3);
  EXPECT_NEAR(shear_near(face(a, 2 * a), {a / 2, a}, {0, 0, 1}).norm() * a * a * a, 0, 1e-9) << "none in a corner";
  EXPECT_NEAR(shear_near(face(a, 2 * a), {a / 2, 0}, {0, 1, 0}).y(), 1.5 / (2 * a * a), 1e-9 / (a * a));
}

// V Q/(I t) and Bredt's T/(2 A t).
TEST(SectionFace, ABoxHasItsFlow) {
  const double b = 0.06, h = 0.1, t = 0.001, bm = b - t, hm = h - t;
  const SectionArea area{.A = 2 * t * (bm + hm), .I1 = t * hm * hm * (hm / 6 + bm / 2), .I2 = t * bm * bm * (bm / 6 + hm / 2), .J = 1};
  const SectionFace face = hollow_face(area, b, h, t);
  const double Q2 = t * (bm * hm / 2 + hm * hm / 4), Q1 = t * (hm * bm / 2 + bm * bm / 4);  // of half the box, which two walls bear
  EXPECT_NEAR(shear_near(face, {b / 2, 0}, {0, 1, 0}).y(), Q2 / area.I1 / (2 * t), 1e-9 / area.A);
  EXPECT_NEAR(shear_near(face, {-b / 2, 0}, {0, 1, 0}).y(), Q2 / area.I1 / (2 * t), 1e-9 / area.A);
  EXPECT_NEAR(shear_near(face, {0, h / 2 - t}, {1, 0, 0}).x(), Q1 / area.I2 / (2 * t), 1e-9 / area.A);
  EXPECT_NEAR(shear_near(face, {0, h / 2}, {0, 1, 0}).norm(), 0, 1e-9 / area.A);
  EXPECT_NEAR(shear_near(face, {b / 2, 0}, {0, 0, 1}).y(), 1 / (2 * bm * hm * t), 1e-9 / (bm * hm * t));
  EXPECT_NEAR(shear_near(face, {0, h / 2}, {0, 0, 1}).x(), -1 / (2 * bm * hm * t), 1e-9 / (bm * hm * t));
  // the flow of a force adds up to it: trapezoids along the middles of the four walls
  for (const Vec3& V : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    Vector2d sum = Vector2d::Zero();
    const size_t n = face.points.size() / 2;
    for (size_t i = 0; i < n; ++i) {
      const auto mid = [&](size_t k) -> Vector2d { return (face.points[k].at + face.points[k + n].at) / 2; };
      const Vector2d d = mid((i + 1) % n) - mid(i);
      const auto along = [&](size_t k) { return d.normalized().dot(face.points[k].shear * V); };
      const double end = i % 8 == 7 ? 2 * along(i) - along(i - 1) : along(i + 1);  // the next is of another wall
      sum += t * (along(i) + end) / 2 * d;
    }
    EXPECT_LT((sum - V.head<2>()).norm(), 0.03);
  }
}

/// Sums of the flow over an open section, by Simpson's rule along its parts.
Vector2d total(const SectionFace& face, const OpenShape& shape, const Vec3& V) {
  Vector2d sum = Vector2d::Zero();
  size_t first = 0;
  for (const auto& part : shape.parts) {
    for (size_t i = 0; i <= 8; ++i) {
      const auto& p = face.points[first + 2 * i];
      const auto& q = face.points[first + 2 * i + 1];
      sum += (i % 8 == 0 ? 1 : i % 2 == 1 ? 4 : 2) / 24.0 * part.b * part.h * (p.shear + q.shear) / 2 * V;
    }
    first += 18;
  }
  return sum;
}

// A double tee, and a channel whose flanges bear what turns it: V Q/(I t), (T t/J) on both sides of a wall, and all flow adds up to V.
TEST(SectionFace, OpenWallsHaveTheirFlow) {
  const double b = 0.08, h = 0.12, t = 0.001, hm = h - t;
  const OpenShape tee{{{0, -hm / 2, b, t}, {0, hm / 2, b, t}, {0, 0, t, h - 2 * t}},
                      {{{-b / 2, -hm / 2}, {0, -hm / 2}, t},
                       {{b / 2, -hm / 2}, {0, -hm / 2}, t},
                       {{-b / 2, hm / 2}, {0, hm / 2}, t},
                       {{b / 2, hm / 2}, {0, hm / 2}, t},
                       {{0, -hm / 2}, {0, hm / 2}, t}}};
  const SectionArea area{
      .A = t * (2 * b + hm), .I1 = t * hm * hm * (hm / 12 + b / 2), .I2 = t * b * b * b / 6, .J = (2 * b + hm) * t * t * t / 3};
  const SectionFace face = open_face(area, tee);
  const double Q = t * (b * hm / 2 + hm * hm / 8);
  EXPECT_NEAR(shear_near(face, {t / 2, 0}, {0, 1, 0}).y(), Q / area.I1 / t, 1e-6 * Q / area.I1 / t);
  EXPECT_NEAR(shear_near(face, {b / 4, hm / 2 + t / 2}, {0, 1, 0}).x(), b / 4 * hm / 2 / area.I1, 1e-6 / area.A);
  EXPECT_NEAR(shear_near(face, {t / 2, 0}, {0, 0, 1}).y(), t / area.J, 1e-9 * t / area.J);
  EXPECT_NEAR(shear_near(face, {-t / 2, 0}, {0, 0, 1}).y(), -t / area.J, 1e-9 * t / area.J);
  EXPECT_LT((total(face, tee, {0, 1, 0}) - Vector2d(0, 1)).norm(), 0.025);

  const OpenShape channel{{{0, 0, t, h}, {b / 2, hm / 2, b - t, t}, {b / 2, -hm / 2, b - t, t}},
                          {{{b - t / 2, hm / 2}, {0, hm / 2}, t}, {{0, hm / 2}, {0, -hm / 2}, t}, {{0, -hm / 2}, {b - t / 2, -hm / 2}, t}}};
  const SectionFace c = open_face(area, channel);
  EXPECT_LT((total(c, channel, {0, 1, 0}) - Vector2d(0, 1)).norm(), 0.025);
  EXPECT_LT((total(c, channel, {1, 0, 0}) - Vector2d(1, 0)).norm(), 0.025);
}

// A force in the centre of area twists a section about its shear centre; an askew section bends about its principal axes.
TEST(SectionFace, TheStressIsAboutShearCentreAndPrincipalAxes) {
  SectionFace face{.area = {.A = 2, .I1 = 3, .I2 = 5, .J = 1, .I12 = 1.5, .s1 = 0.25, .s2 = -0.5}};
  face.points.push_back({Vector2d(0.7, -0.4), Eigen::Matrix<double, 2, 3>{{0, 0, 0}, {0, 0, 2}}});
  EXPECT_NEAR(stress_at(face, face.points[0], force(0, 3)).shear, 2 * 0.25 * 3, 1e-12);
  EXPECT_NEAR(stress_at(face, face.points[0], force(3, 0)).shear, 2 * 0.5 * 3, 1e-12);
  EXPECT_NEAR(stress_at(face, face.points[0], force(0, 3, 0.75)).shear, 0, 1e-12) << "through the shear centre";
  // the stress a + b X1 + c X2 whose moments are M1 = int s X2, M2 = -int s X1
  const double b = 1.1, c = -0.6, M1 = c * 3 + b * 1.5, M2 = -(b * 5 + c * 1.5);
  const SectionStress s = stress_at(face, face.points[0], (Vec6() << 0, 0, 8, M1, M2, 0).finished());
  EXPECT_NEAR(s.axial, 4 + b * 0.7 - c * 0.4, 1e-12);
}

// Round sections have points in the direction of the moment, wherever it is.
TEST(SectionFace, ARoundSectionIsAlikeInAllDirections) {
  const double r = 0.02;
  const SectionFace face = round_face(round_area(r, 0.015), r, 0.015, nu);
  for (const double angle : {0.0, 0.04, 1.0, 2.5}) {
    const StressRange s = stress_range(face, (Vec6() << 0, 0, 10, 5 * std::cos(angle), 5 * std::sin(angle), 2).finished());
    const double bending = 5 * r / face.area.I1, axial = 10 / face.area.A, twist = 2 * r / face.area.J;
    EXPECT_NEAR(s.high, axial + bending, 1e-9 * bending);
    EXPECT_NEAR(s.low, axial - bending, 1e-9 * bending);
    EXPECT_NEAR(s.von_mises, std::hypot(axial + bending, std::sqrt(3.0) * twist), 1e-9 * bending);
  }
}

}  // namespace
}  // namespace hilo::test::section_face_test
