// SPDX-License-Identifier: GPL-3.0-or-later
// Stresses at points of cells against the closed forms of the laws, and the two-node bar.
#include "physics/stress.hpp"

#include "physics/cells.hpp"

namespace hilo::test::stress_test {
namespace {

class Stress : public testing::TestWithParam<Shape> {
 protected:
  std::vector<Vec3> X = [this] {
    switch (GetParam()) {
      case Shape::tet4:
        return some_cell<Tet4>(0.08);
      case Shape::tet10:
        return some_cell<Tet10>(0.08);
      case Shape::wedge6:
        return some_cell<Wedge6>(0.08);
      case Shape::wedge15:
        return some_cell<Wedge15>(0.08);
      case Shape::hex8:
        return some_cell<Hex8>(0.08);
      default:
        return some_cell<Hex20>(0.08);
    }
  }();
};
INSTANTIATE_TEST_SUITE_P(EveryShape, Stress,
                         testing::Values(Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex8, Shape::hex20,
                                         Shape::hex20r),
                         [](const auto& p) { return std::string(hilo::info(p.param).name); });

Vec6 voigt(const Mat3& s) {
  Vec6 v;
  v << s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1);
  return v;
}

constexpr StressPoints kinds[] = {StressPoints::integration, StressPoints::samples, StressPoints::everywhere};

// Truth: a homogeneous F gives one stress everywhere: J sigma = F (lambda tr E + 2 mu E) F^T, or mu (b - I) + lambda ln J I.
TEST_P(Stress, OfAHomogeneousDeformationIsTheClosedForm) {
  Mat3 F;
  F << 1.2, 0.1, -0.05, 0.2, 0.9, 0.1, -0.1, 0.05, 1.1;
  std::vector<Vec3> x;
  for (const Vec3& p : X) x.push_back(F * p + Vec3(1, 2, 3));
  const double J = F.determinant();
  const Mat3 I = Mat3::Identity(), E = (F.transpose() * F - I) / 2;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    const Mat3 stvk = F * (c.lambda * E.trace() * I + 2 * c.mu * E) * F.transpose() / J;
    const Mat3 neo = (c.mu * (F * F.transpose() - I) + c.lambda * std::log(J) * I) / J;
    for (const auto& [law, exact] : {std::pair{Material(StVenantKirchhoff{c}), stvk}, {NeoHookean{c}, neo}})
      for (const StressPoints kind : kinds) {
        std::vector<StressPoint> points;
        stress_points(GetParam(), law, X, x, kind, points);
        ASSERT_FALSE(points.empty());
        for (const StressPoint& at : points) {
          EXPECT_LT((cauchy(at.F, at.S) - voigt(exact)).norm(), 1e-12 * exact.norm());
          EXPECT_GT(at.w, 0);
        }
      }
    std::vector<Mat3> nodal(X.size());
    nodal_gradients(GetParam(), X, x, nodal);
    for (const Mat3& at : nodal) EXPECT_LT((at - F).norm(), 1e-12);
  }
}

// Truth: no strain, no stress.
TEST_P(Stress, OfARigidMotionIsZero) {
  std::vector<Vec3> x;
  for (const Vec3& p : X) x.push_back(Eigen::AngleAxisd(2, Vec3(1, 1, -1).normalized()).toRotationMatrix() * p + Vec3(1, 2, 3));
  for (const Material& law : both_laws)
    for (const StressPoints kind : kinds) {
      std::vector<StressPoint> points;
      stress_points(GetParam(), law, X, x, kind, points);
      ASSERT_FALSE(points.empty());
      for (const StressPoint& at : points) EXPECT_LT(at.S.norm(), 1e-13 * rubber.mu);
    }
}

// Truth: an edge collapsed to a point (a hexahedron that stands for a wedge) has no volume at that node; gradients there stay finite.
TEST(NodalGradients, StayFiniteWhereACornerIsCollapsed) {
  auto X = local_nodes<Hex8>();
  X[2] = X[1], X[6] = X[5];
  std::vector<Vec3> x;
  for (const Vec3& p : X) x.push_back(1.5 * p);
  std::vector<Mat3> F(8);
  nodal_gradients(Shape::hex8, X, x, F);
  for (const Mat3& at : F) EXPECT_LT((at - 1.5 * Mat3::Identity()).norm(), 1e-10);
}

// Truth: what is linear along the axes of a quadratic cell is found at its nodes from its samples; weights of a constant sum to 1.
TEST_P(Stress, OfTheNodesIsExtrapolatedFromTheSamples) {
  std::vector<StressPoint> points;
  stress_points(GetParam(), StVenantKirchhoff{rubber}, X, X, StressPoints::samples, points);
  const Eigen::MatrixXd& W = to_nodes(GetParam(), 0);
  ASSERT_EQ(W.cols(), static_cast<Eigen::Index>(points.size()));
  EXPECT_LT((W.rowwise().sum() - Eigen::VectorXd::Ones(W.rows())).norm(), 1e-12);
  if (X.size() <= 8) return;
  const auto straight = GetParam() == Shape::tet10     ? local_nodes<Tet10>()
                        : GetParam() == Shape::wedge15 ? local_nodes<Wedge15>()
                                                       : local_nodes<Hex20>();
  stress_points(GetParam(), StVenantKirchhoff{rubber}, straight, straight, StressPoints::samples, points);
  for (int i = 0; i < 3; ++i)
    for (size_t a = 0; a < straight.size(); ++a) {
      double value = 0;
      for (size_t p = 0; p < points.size(); ++p) value += W(a, p) * points[p].X[i];
      EXPECT_NEAR(value, straight[a][i], 1e-12);
    }
}

// Truth: pure bending of a slender brick, u_x = -k x y, u_y = k x^2/2 + nu k (y^2 - z^2)/2, u_z = nu k y z, has sigma_xx = -E k y alone:
// linear in y, so one quadratic cell, and the assumed strains of the one-point hexahedron, hold it exactly in the small-strain limit.
TEST(BendingStress, IsLinearOverTheHeightOfOneHexahedron) {
  const double E = 2e11, nu = 0.3, k = 1e-6;
  const Lame c = lame(E, nu);
  for (const Shape shape : {Shape::hex8, Shape::hex20}) {
    auto X = shape == Shape::hex8 ? local_nodes<Hex8>() : local_nodes<Hex20>();
    std::vector<Vec3> x;
    for (Vec3& p : X) {
      p = Vec3(0.3 * p[0], 0.1 * p[1], 0.05 * p[2]);
      x.push_back(p + k * Vec3(-p[0] * p[1], p[0] * p[0] / 2 + nu * (p[1] * p[1] - p[2] * p[2]) / 2, nu * p[1] * p[2]));
    }
    for (const StressPoints kind : kinds) {
      std::vector<StressPoint> points;
      stress_points(shape, StVenantKirchhoff{c}, X, x, kind, points);
      ASSERT_FALSE(points.empty());
      for (const StressPoint& at : points) {
        Vec6 exact = Vec6::Zero();
        exact[0] = -E * k * at.X[1];
        EXPECT_LT((cauchy(at.F, at.S) - exact).norm(), 1e-5 * E * k * 0.1) << info(shape).name;
      }
    }
  }
}

TEST(VonMises, IsTheStressOfATensionAndRootThreeOfAShear) {
  Vec6 s = Vec6::Zero();
  s[0] = -3;
  EXPECT_DOUBLE_EQ(von_mises(s), 3);
  s[1] = s[2] = -3;
  EXPECT_DOUBLE_EQ(von_mises(s), 0);
  s.setZero(), s[4] = 2;
  EXPECT_DOUBLE_EQ(von_mises(s), 2 * std::sqrt(3.0));
}

// Truth: W = E A L e^2/2 with e = (l^2/L^2 - 1)/2; work over a finite step is its change, K its second derivative in the mid-point sense.
TEST(Bar, ForceIsADiscreteGradientOfItsEnergy) {
  const double Y = 7e10, A = 2e-4, rho = 2700;
  alignas(64) double X[6] = {0, 0, 0, 1, 2, -1}, x0[6] = {0.1, 0, 0, 1.2, 2, -1}, x1[6] = {0, 0.5, 0, -0.8, 2, 1.3}, f[6], K[36], W, W0,
                     unused, a[6] = {};
  const SolidKernel kernel = solid_kernel(Shape::bar2, place_of<StVenantKirchhoff>);
  ASSERT_EQ(kernel.width, 1);
  const StVenantKirchhoff law{lame(Y, 0.3)};
  KernelCall call{};
  call.X = X, call.x0 = x0, call.x1 = x1, call.elastic = 1, call.law = &law, call.f = f, call.K = K, call.energy = &W,
  call.least_det = &unused, call.area = A;
  call.density = rho, call.a = a;
  kernel.call(call);
  const std::vector<double> force(f, f + 6), tangent(K, K + 36);
  const auto energy_of = [&](const double* x) {
    const double L2 = 6, l2 = std::pow(x[3] - x[0], 2) + std::pow(x[4] - x[1], 2) + std::pow(x[5] - x[2], 2);
    return Y * A * std::sqrt(L2) / 8 * std::pow(l2 / L2 - 1, 2);
  };
  EXPECT_NEAR(W, energy_of(x1), 1e-13 * W);
  W0 = energy_of(x0);
  double work = 0;
  for (int i = 0; i < 6; ++i) work += force[i] * (x1[i] - x0[i]);
  EXPECT_NEAR(work, W - W0, 1e-12 * std::abs(W - W0));
  const double h = 1e-5;  // central differences: h^2 relative truncation, 1e-16/h round-off
  for (int j = 0; j < 6; ++j) {
    double side[2][6];
    for (int s = 0; s < 2; ++s) {
      const double keep = x1[j];
      x1[j] += s ? h : -h;
      kernel.call(call);
      x1[j] = keep;
      std::copy(f, f + 6, side[s]);
    }
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(tangent[6 * i + j], (side[1][i] - side[0][i]) / (2 * h), 1e-8 * largest(tangent));
  }
  for (double& v : a) v = 1;
  call.elastic = 0;
  kernel.call(call);
  EXPECT_NEAR(f[0] + f[3], rho * A * std::sqrt(6.0), 1e-13 * rho);
}

// Truth: under uniaxial stress the lateral stress of the law is zero; a cube of the solid's own law gives axial force, energy and area.
TEST(Bar, IsItsMaterialUnderUniaxialStress) {
  const Lame c = rubber;
  for (const Material& material : both_laws)
    for (const double stretch : {0.6, 0.9, 1.001, 1.5, 2.5}) {
      const bool stvk = std::holds_alternative<StVenantKirchhoff>(material);
      if (stvk && stretch > 2) continue;  // its lateral stretch squared, 1 - 2 nu e, is negative there
      const double e_axial = (stretch * stretch - 1) / 2;
      const BarState bar = stvk ? std::get<StVenantKirchhoff>(material).bar(e_axial) : std::get<NeoHookean>(material).bar(e_axial);
      const double lateral = std::sqrt(bar.t);
      const double e[6] = {(stretch * stretch - 1) / 2, (bar.t - 1) / 2, (bar.t - 1) / 2, 0, 0, 0};
      double s[6];
      double W = 0;
      if (stvk)
        StVenantKirchhoff{c}.stress<double>(e, e, s, nullptr), W = StVenantKirchhoff{c}.energy<double>(e);
      else
        NeoHookean{c}.stress<double>(e, e, s, nullptr), W = NeoHookean{c}.energy<double>(e);
      const double scale = c.mu * std::abs(stretch - 1);
      EXPECT_NEAR(s[1], 0, 1e-10 * scale) << stretch;
      EXPECT_NEAR(s[0], bar.S, 1e-10 * scale) << stretch;
      EXPECT_NEAR(W, bar.W, 1e-10 * scale) << stretch;
      const Vec3 X[2] = {Vec3::Zero(), Vec3::UnitX()}, x[2] = {Vec3::Zero(), Vec3(0, 0, stretch)};
      EXPECT_NEAR(bar_stress(material, X, x)[2], bar.S * stretch / (lateral * lateral), 1e-12 * c.mu)
          << "Cauchy stress: force on the area as it is";
    }
}

// Truth: the work of a finite step, long or short, is the change of energy: of a neo-Hookean bar as of any solid.
TEST(Bar, OfANeoHookeanMaterialKeepsEnergy) {
  for (const double step : {1e-9, 1e-4, 0.015, 0.1, 1.0}) {
    const double e0 = -0.2, e1 = e0 + step, h = 1e-6;
    const NeoHookean law{rubber};
    const BarStep s = law.bar_step(e0, e1);
    const double dW = law.bar(e1).W - law.bar(e0).W;
    EXPECT_NEAR(s.S * step, dW, 2e-15 * rubber.mu) << step;
    const double slope = (law.bar_step(e0, e1 + h).S - law.bar_step(e0, e1 - h).S) / (2 * h);
    EXPECT_NEAR(s.slope, slope, 1e-6 * rubber.mu) << step;
  }
}

}  // namespace
}  // namespace hilo::test::stress_test
