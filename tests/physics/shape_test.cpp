// SPDX-License-Identifier: GPL-3.0-or-later
// Shape functions: interpolation, completeness and the degree to which the rules integrate, against exact values.
#include "physics/cell_strain.hpp"
#include "physics/cells.hpp"

namespace hilo::test::shape_test {
namespace {

template <class S>
class ShapeFunctions : public testing::Test {};
struct ShapeName {
  template <class S>
  static std::string GetName(int) {
    return std::string(info(ShapeOf<S>::shape).name);
  }
};
using AllShapes = testing::Types<Tet4, Tet10, Wedge6, Wedge15, Hex8, Hex20, Hex20R>;
TYPED_TEST_SUITE(ShapeFunctions, AllShapes, ShapeName);

/// Points inside the reference cell.
template <class S>
std::vector<Vec3> inner_points() {
  std::vector<Vec3> points;
  const auto corners = local_corners<S>();
  for (int k = 0; k < 6; ++k) {
    Vec3 x = Vec3::Zero();
    double sum = 0;
    for (size_t a = 0; a < corners.size(); ++a) {
      const double w = 1.05 + scatter(17 * k + static_cast<int>(a));
      x += w * corners[a], sum += w;
    }
    points.push_back(x / sum);
  }
  return points;
}

/// Truth: int over the reference cell of x^i y^j z^k; tetrahedron i! j! k!/(i + j + k + 3)!.
template <class S>
double monomial(int i, int j, int k) {
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  const auto even = [](int n) { return n % 2 ? 0.0 : 2.0 / (n + 1); };
  if (is_tet<S>) return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
  if (is_wedge<S>) return factorial(i) * factorial(j) / factorial(i + j + 2) * even(k);
  return even(i) * even(j) * even(k);
}

template <class Rule>
double integrate(const Rule& rule, int i, int j, int k) {
  double sum = 0;
  for (size_t p = 0; p < std::size(rule.w); ++p)
    sum += rule.w[p] * std::pow(rule.xi[p][0], i) * std::pow(rule.xi[p][1], j) * std::pow(rule.xi[p][2], k);
  return sum;
}

TYPED_TEST(ShapeFunctions, AreOneAtTheirOwnNodeAndZeroAtTheOthers) {
  using S = TypeParam;
  const auto nodes = local_nodes<S>();
  ASSERT_EQ(static_cast<int>(nodes.size()), S::n);
  for (int b = 0; b < S::n; ++b) {
    double N[S::n];
    S::values(nodes[b].data(), N);
    for (int a = 0; a < S::n; ++a) EXPECT_NEAR(N[a], a == b, 1e-15) << "node " << a << " at node " << b;
  }
}

TYPED_TEST(ShapeFunctions, AddUpToOneAndReproducePosition) {
  using S = TypeParam;
  const auto nodes = local_nodes<S>();
  for (const Vec3& at : inner_points<S>()) {
    double N[S::n], dN[S::n][3], sum = 0;
    S::values(at.data(), N);
    S::gradients(at.data(), dN);
    Vec3 x = Vec3::Zero(), slope = Vec3::Zero();
    Mat3 J = Mat3::Zero();
    for (int a = 0; a < S::n; ++a) {
      const Vec3 g(dN[a][0], dN[a][1], dN[a][2]);
      sum += N[a], x += N[a] * nodes[a], slope += g, J += nodes[a] * g.transpose();
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_LT((x - at).norm(), 1e-14);
    EXPECT_LT(slope.norm(), 1e-14) << "gradients of a constant";
    EXPECT_LT((J - Mat3::Identity()).norm(), 1e-13) << "gradients of the position";
  }
}

TYPED_TEST(ShapeFunctions, HaveTheGradientsOfTheirValues) {
  using S = TypeParam;
  const double h = 1e-3;  // values are of degree at most 4 along a line: this five-point difference is exact
  for (const Vec3& at : inner_points<S>())
    for (int i = 0; i < 3; ++i) {
      double N[4][S::n], dN[S::n][3];
      const double step[4] = {-2, -1, 1, 2};
      for (int k = 0; k < 4; ++k) S::values(Vec3(at + step[k] * h * Vec3::Unit(i)).data(), N[k]);
      S::gradients(at.data(), dN);
      for (int a = 0; a < S::n; ++a) EXPECT_NEAR(dN[a][i], (N[0][a] - 8 * N[1][a] + 8 * N[2][a] - N[3][a]) / (12 * h), 1e-11);
    }
}

template <class S>
class QuadraticShapeFunctions : public testing::Test {};
using QuadraticShapes = testing::Types<Tet10, Wedge15, Hex20, Hex20R>;
TYPED_TEST_SUITE(QuadraticShapeFunctions, QuadraticShapes, ShapeName);

TYPED_TEST(QuadraticShapeFunctions, ReproduceEveryQuadratic) {
  using S = TypeParam;
  const auto nodes = local_nodes<S>();
  for (const Vec3& at : inner_points<S>()) {
    double N[S::n];
    S::values(at.data(), N);
    Mat3 xx = Mat3::Zero();
    for (int a = 0; a < S::n; ++a) xx += N[a] * nodes[a] * nodes[a].transpose();
    EXPECT_LT((xx - at * at.transpose()).norm(), 1e-14);
  }
}

TYPED_TEST(ShapeFunctions, MassRuleIsExactForEveryProductOfTwo) {
  using S = TypeParam;
  const bool quadratic = S::n != local_corners<S>().size();
  const int degree = quadratic ? 4 : 2;
  const auto rule = S::mass_rule();
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; j <= degree; ++j)
      for (int k = 0; k <= degree; ++k) {
        // a product of two shape functions: total degree 2 x 1 or 2 x 2 in a simplex, per axis in a cube
        if (is_tet<S> && i + j + k > degree) continue;
        if (is_wedge<S> && i + j > degree) continue;
        EXPECT_NEAR(integrate(rule, i, j, k), monomial<S>(i, j, k), 1e-14) << i << j << k;
      }
}

TYPED_TEST(ShapeFunctions, StiffnessRuleFillsTheCell) {
  using S = TypeParam;
  EXPECT_NEAR(integrate(S::rule(), 0, 0, 0), monomial<S>(0, 0, 0), 1e-14);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(integrate(S::rule(), i == 0, i == 1, i == 2), monomial<S>(i == 0, i == 1, i == 2), 1e-14);
}

/// Truth: x = xi (1 + c (eta^2 - 1/3)) has det F = 1 at the eight points of the stress, 1 - c/3 at the centre, 1 - 2 c/15 or more
/// elsewhere.
TEST(LeastDet, OfHex20rSeesAFoldBetweenThePointsOfTheStress) {
  const auto nodes = local_nodes<Hex20R>();
  std::vector<Vec3> X, x;
  for (const double c : {0.0, 2.9, 3.3}) {
    X.clear(), x.clear();
    for (const Vec3& at : nodes) X.push_back(2 * at), x.emplace_back(2 * at[0] * (1 + c * (at[1] * at[1] - 1. / 3)), 2 * at[1], 2 * at[2]);
    EXPECT_GT(least_stretch(Shape::hex20r, X, x, 0), 0.1) << "the points of the stress see no fold";
    EXPECT_NEAR(least_det(Shape::hex20r, X, x), c > 3 ? 1 - c / 3 : 1, 1e-14);
  }
}

}  // namespace
}  // namespace hilo::test::shape_test
