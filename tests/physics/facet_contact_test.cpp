// SPDX-License-Identifier: GPL-3.0-or-later
// The gradients of a point over a triangle: exact ways, no resultant and no moment, no slip in rigid motions; the tangent.
#include "physics/contact/facet_contact.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace hilo::test::facet_contact_test {
namespace {

using Points = std::array<Vec3, 4>;  // the point, and the corners

OverTriangle<double> over(const Points& x) {
  return {triple<double>(x[0] - x[1]), triple<double>(x[2] - x[1]), triple<double>(x[3] - x[1])};
}

class FacetContact : public ::testing::Test {
 protected:
  double throw_of(double size) { return size * std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vec3 vector(double size) { return {throw_of(size), throw_of(size), throw_of(size)}; }
  Points place() {
    Points x{Vec3(0.3, 0.3, -0.02) + vector(0.1), vector(0.2), Vec3(1, 0, 0) + vector(0.2), Vec3(0, 1, 0) + vector(0.2)};
    return x;
  }
  Points moved(const Points& x, double size) {
    Points out = x;
    for (Vec3& p : out) p += vector(size);
    return out;
  }
  std::mt19937 random_{7};
};

PointLaw law(double friction, double restitution = 1) {
  return {.k = 3, .hertz = 0, .kt = 2, .friction = friction, .radius = 0, .loss = ImpactLoss(restitution), .slow = 1e-3};
}
constexpr double restitutions[] = {1, 0.7, 0};

/// Forces on the point and the three corners.
std::array<Vec3, 4> on_all(const FacetForce<double>& f) {
  const Vec3 p = values(f.on_point), b = values(f.on_second), c = values(f.on_third);
  return {p, -(p + b + c), b, c};
}

// Truth: V, the bristle and friction take what the forces work over the step; forces have neither a resultant nor a moment in its mean.
TEST_F(FacetContact, KeepsEnergyAndMomentaOfAnyMotion) {
  for (const double friction : {0., 0.3, 2.})
    for (const double size : {1e-3, 1e-1, 0.5})
      for (int k = 0; k < 500; ++k) {
        const Points x0 = place(), x1 = moved(x0, size);
        const OverTriangle<double> z0 = over(x0), z1 = over(x1);
        if (dot(unit(cross(z0.t1, z0.t2)), unit(cross(z1.t1, z1.t2))) < 0) continue;
        FacetPast past;
        past.gap = k % 3 == 0 ? gap_of(z0) : throw_of(0.05), past.offset = gap_of(z0) - past.gap;
        if (friction > 0) past.bent = {throw_of(0.01), throw_of(0.01)};
        const PointLaw l = law(friction, restitutions[k % 4 % 3]);
        past.approach = 0.1;
        const FacetForce<double> f = over_step(l, z0, z1, past, 0.1);
        const auto F = on_all(f);
        double work = 0, top = 0;
        Vec3 moment = Vec3::Zero();
        for (int i = 0; i < 4; ++i)
          work += F[i].dot(x1[i] - x0[i]), moment += (0.5 * (x0[i] + x1[i])).cross(F[i]), top = std::max(top, F[i].norm());
        const auto bent = [](const std::array<double, 2>& u) { return u[0] * u[0] + u[1] * u[1]; };
        const double stored = l.potential(f.gap) - l.potential(past.gap) + l.kt / 2 * (bent(f.bent) - bent(past.bent));
        EXPECT_NEAR(work, stored + f.dissipated, 1e-13 * (1 + top)) << size;
        EXPECT_LT(moment.norm(), 1e-13 * (1 + top)) << size;
        EXPECT_GE(f.dissipated, -1e-15) << size;
        if (past.offset == 0) {
          EXPECT_NEAR(f.gap, gap_of(z1), 1e-13) << "the way is the change of the gap";
        }
      }
}

TEST_F(FacetContact, RigidMotionsDoNotSlip) {
  for (int k = 0; k < 200; ++k) {
    const Points x0 = place();
    const Vec3 axis = vector(1).normalized(), by = vector(3);
    const double angle = throw_of(2);
    Points x1;
    for (int i = 0; i < 4; ++i) x1[i] = Eigen::AngleAxisd(angle, axis) * x0[i] + by;
    FacetPast past;
    past.gap = -0.01, past.offset = gap_of(over(x0)) + 0.01, past.bent = {0.001, -0.0005};
    const FacetForce<double> f = over_step(law(5), over(x0), over(x1), past);
    EXPECT_NEAR(f.gap, past.gap, 1e-14);
    EXPECT_NEAR(f.bent[0], past.bent[0], 1e-14);
    EXPECT_NEAR(f.bent[1], past.bent[1], 1e-14);
  }
}

/// A configuration whose derivatives are those by r, t1 and t2.
OverTriangle<Jet<9>> seeded(const OverTriangle<double>& z) {
  const auto from = [](const Triple<double>& a, int first) {
    Triple<Jet<9>> out;
    for (int i = 0; i < 3; ++i) out[i] = Jet<9>(a[i]), out[i].d[first + i] = 1;
    return out;
  };
  return {from(z.r, 0), from(z.t1, 3), from(z.t2, 6)};
}

/// Derivatives of all forces against differences of them, where neither a slide nor the contact begins between; how many were compared.
template <class Law>
int compare_slopes(const OverTriangle<double>& z1, const Law& force) {
  const FacetForce<Jet<9>> f = force(seeded(z1));
  if (!f.acts) return 0;
  int compared = 0;
  for (int j = 0; j < 9; ++j) {
    constexpr double step = 1e-6;
    OverTriangle<double> up = z1, down = z1;
    (j < 3 ? up.r : j < 6 ? up.t1 : up.t2)[j % 3] += step;
    (j < 3 ? down.r : j < 6 ? down.t1 : down.t2)[j % 3] -= step;
    const FacetForce<double> a = force(up), b = force(down);
    if ((a.slid > 0) != (b.slid > 0) || a.acts != b.acts || (a.gap > 0) != (b.gap > 0)) continue;
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(f.on_point[i].d[j], (a.on_point[i] - b.on_point[i]) / (2 * step), 1e-5);
      EXPECT_NEAR(f.on_second[i].d[j], (a.on_second[i] - b.on_second[i]) / (2 * step), 1e-5);
      EXPECT_NEAR(f.on_third[i].d[j], (a.on_third[i] - b.on_third[i]) / (2 * step), 1e-5);
    }
    ++compared;
  }
  return compared;
}

// A point that has come in from the side, g* = 0, has an offset below zero.
TEST_F(FacetContact, TangentIsTheSlopeOfTheForces) {
  int compared = 0;
  for (const double gap : {-0.02, 0.})
    for (const double friction : {0., 0.05, 2.})
      for (int k = 0; k < 100; ++k) {
        const Points x0 = place(), x1 = moved(x0, 0.05);
        FacetPast past;
        past.gap = gap, past.offset = gap_of(over(x0)) - past.gap, past.bent = {throw_of(0.01), throw_of(0.01)};
        past.approach = 0.1;
        const PointLaw l = law(friction, k % 3 == 0 ? 0.7 : 1);
        compared += compare_slopes(over(x1), [&](const auto& z) { return over_step(l, over(x0), z, past, 0.1); });
      }
  EXPECT_GT(compared, 3000);
}

TEST_F(FacetContact, TangentOfLoadStepsIsTheSlopeOfTheForces) {
  int compared = 0;
  for (const double friction : {0., 0.05, 2.})
    for (int k = 0; k < 200; ++k) {
      const Points x0 = place(), x1 = moved(x0, 0.05);
      FacetPast past;
      past.bent = {throw_of(0.01), throw_of(0.01)};
      compared += compare_slopes(over(x1), [&](const auto& z) { return at_end(law(friction), over(x0), z, past, 1e-3, 1e300); });
    }
  EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace hilo::test::facet_contact_test
