// SPDX-License-Identifier: GPL-3.0-or-later
// The cell kernels of every shape and law: work, derivative, objectivity, balance, mass, rate terms.
#include <Eigen/Eigenvalues>

#include "physics/cells.hpp"
#include "physics/dual.hpp"

namespace hilo::test::solid_test {
namespace {

template <class S_, class M_>
struct Pair {
  using S = S_;
  using M = M_;
};
template <class P>
class Solid : public testing::Test {
 public:
  using S = typename P::S;
  using M = typename P::M;
  // a cell that is no parallelepiped, and two states far from each other: a quarter turn and 25 % of strain apart
  const std::vector<Vec3> X = some_cell<S>(0.08), x0 = bent(X, 0.4, 0.10, 1), x1 = bent(X, 1.2, 0.15, 2);
  const std::vector<double> X_ = flat(X), x0_ = flat(x0), x1_ = flat(x1);
};
struct PairName {
  template <class P>
  static std::string GetName(int) {
    std::string law(P::M::name);
    std::replace(law.begin(), law.end(), '-', '_');
    return std::string(info(ShapeOf<typename P::S>::shape).name) + "_" + law;
  }
};
using SV = StVenantKirchhoff;
using NH = NeoHookean;
using MR = MooneyRivlin;
using OT = Orthotropic;
using Pairs =
    testing::Types<Pair<Tet4, SV>, Pair<Tet10, SV>, Pair<Wedge6, SV>, Pair<Wedge15, SV>, Pair<Hex8, SV>, Pair<Hex20, SV>, Pair<Hex20R, SV>,
                   Pair<Tet4, NH>, Pair<Tet10, NH>, Pair<Wedge6, NH>, Pair<Wedge15, NH>, Pair<Hex8, NH>, Pair<Hex20, NH>, Pair<Hex20R, NH>,
                   Pair<Tet10, MR>, Pair<Hex8, MR>, Pair<Hex20R, MR>, Pair<Tet10, OT>, Pair<Hex8, OT>, Pair<Hex20R, OT>>;
TYPED_TEST_SUITE(Solid, Pairs, PairName);

std::vector<Dual> constant(const std::vector<double>& v) { return {v.begin(), v.end()}; }

// Truth: S is a discrete gradient and B_mid (x1 - x0) = E1 - E0, so f.(x1 - x0) is the change of W whatever the step.  1e-13 of the work:
// round-off.
TYPED_TEST(Solid, WorkOfTheForceIsTheChangeOfEnergy) {
  using F = TestFixture;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    const auto step = evaluate_cell<typename F::S, typename F::M>(c, this->X_, this->x0_, this->x1_);
    const auto start = evaluate_cell<typename F::S, typename F::M>(c, this->X_, this->x0_, this->x0_);
    double work = 0, size = 0;
    for (size_t i = 0; i < step.f.size(); ++i)
      work += step.f[i] * (this->x1_[i] - this->x0_[i]), size += std::abs(step.f[i] * (this->x1_[i] - this->x0_[i]));
    ASSERT_GT(step.least_det, 0);
    EXPECT_NEAR(work, step.energy - start.energy, 1e-13 * size);
    EXPECT_GT(std::abs(work), 1e-4 * size) << "a step that does work";
  }
}

// Truth: with x0 = x1 the force is that of the end point, the gradient of W; the derivative of W by dual numbers is exact.
TYPED_TEST(Solid, ForceIsTheDerivativeOfEnergy) {
  using F = TestFixture;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    const auto at = evaluate_cell<typename F::S, typename F::M>(c, this->X_, this->x1_, this->x1_);
    const double scale = largest(at.f);
    for (size_t j = 0; j < this->x1_.size(); ++j) {
      auto x = constant(this->x1_);
      x[j].d = 1;
      const auto dual = evaluate_cell<typename F::S, typename F::M, Dual>(c, constant(this->X_), x, x, {.tangent = false});
      EXPECT_NEAR(at.f[j], dual.energy.d, 1e-12 * scale) << "component " << j;
    }
  }
}

// Truth: K = df/dx1, exact by dual numbers through the same force, for a finite step with elastic, rate and inertia terms.
TYPED_TEST(Solid, TangentIsTheDerivativeOfTheForce) {
  using F = TestFixture;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    const Wish wish{.elastic = 1, .viscous = 0.3, .density = 1200, .mass_slope = 2e3};
    auto a = flat(bent(this->X, 0.1, 0.2, 9));
    const auto at = evaluate_cell<typename F::S, typename F::M>(c, this->X_, this->x0_, this->x1_, wish, &a);
    const double scale = largest(at.K);
    const size_t n = this->x1_.size();
    Wish force_only = wish;
    force_only.tangent = false;
    for (size_t j = 0; j < n; ++j) {
      auto x = constant(this->x1_), da = constant(a);
      x[j].d = 1, da[j].d = wish.mass_slope;
      const auto dual = evaluate_cell<typename F::S, typename F::M, Dual>(c, constant(this->X_), constant(this->x0_), x, force_only, &da);
      for (size_t i = 0; i < n; ++i) ASSERT_NEAR(at.K[i * n + j], dual.f[i].d, 1e-12 * scale) << i << "," << j;
    }
  }
}

// Truth: a hyperelastic end point has a symmetric second derivative.
TYPED_TEST(Solid, TangentOfTheEndPointIsSymmetric) {
  using F = TestFixture;
  const auto at = evaluate_cell<typename F::S, typename F::M>(rubber, this->X_, this->x1_, this->x1_);
  const size_t n = this->x1_.size();
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < i; ++j) ASSERT_NEAR(at.K[i * n + j], at.K[j * n + i], 1e-13 * largest(at.K));
}

// Truth: E = 0 in every rotated configuration, so a step from one rotation to another strains nothing at its ends.
TYPED_TEST(Solid, RigidMotionGivesNoForceAndNoEnergy) {
  using F = TestFixture;
  std::vector<Vec3> x;
  for (const Vec3& p : this->X) x.push_back(Eigen::AngleAxisd(2, Vec3(0.3, -1, 0.6).normalized()).toRotationMatrix() * p + Vec3(3, -2, 1));
  const auto turned = flat(x);
  const auto small = evaluate_cell<typename F::S, typename F::M>(rubber, this->X_, turned, turned),
             step = evaluate_cell<typename F::S, typename F::M>(rubber, this->X_, this->X_, turned);
  const double stiff = largest(small.K);
  EXPECT_LT(largest(small.f), 1e-14 * stiff);
  EXPECT_LT(largest(step.f), 1e-14 * stiff);
  EXPECT_LT(std::abs(small.energy), 1e-15 * stiff) << "round-off of ln J";
  EXPECT_NEAR(small.least_det, 1, 1e-14);
}

// Truth: internal forces are in balance: no resultant, no moment about the mid-point configuration (S is symmetric).
TYPED_TEST(Solid, ForcesAreInBalance) {
  using F = TestFixture;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    const auto at = evaluate_cell<typename F::S, typename F::M>(c, this->X_, this->x0_, this->x1_, {.viscous = 0.2});
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (int a = 0; a < F::S::n; ++a) {
      const Vec3 f(at.f[3 * a], at.f[3 * a + 1], at.f[3 * a + 2]);
      sum += f, moment += (this->x0[a] + this->x1[a]).cross(f) / 2;
    }
    EXPECT_LT(sum.norm(), 1e-13 * largest(at.f) * F::S::n);
    EXPECT_LT(moment.norm(), 1e-13 * largest(at.f) * F::S::n);
  }
}

// Truth: S_v = viscous C (E1 - E0) with C positive definite: its work is a positive quadratic form of E1 - E0.
TYPED_TEST(Solid, RateTermsAlwaysDissipate) {
  using F = TestFixture;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    for (int seed = 0; seed < 20; ++seed) {
      const auto from = flat(bent(this->X, 0.1 * seed, 0.1, 40 + seed)), to = flat(bent(this->X, 0.2 * seed, 0.1, 90 + seed));
      const auto at = evaluate_cell<typename F::S, typename F::M>(c, this->X_, from, to, {.elastic = 0, .viscous = 0.7});
      double work = 0;
      for (size_t i = 0; i < at.f.size(); ++i) work += at.f[i] * (to[i] - from[i]);
      EXPECT_GT(at.dissipated, 0);
      EXPECT_NEAR(work, at.dissipated, 1e-12 * at.dissipated);
    }
  }
}

// Truth: a cell free of supports has six zero-energy modes and no more: rank of K in the reference state is 3n - 6.
TYPED_TEST(Solid, HasNoZeroEnergyModeButTheRigidOnes) {
  using F = TestFixture;
  double stiff = 0;
  for (const Lame& c : {rubber, nearly_incompressible}) {
    const auto at = evaluate_cell<typename F::S, typename F::M>(c, this->X_, this->X_, this->X_);
    const int n = 3 * F::S::n;
    const Eigen::MatrixXd K = Eigen::Map<const Eigen::MatrixXd>(at.K.data(), n, n);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    if (stiff == 0) stiff = values[n - 1];  // of rubber: the other's bulk modulus says nothing of its softest mode
    EXPECT_LT(std::abs(values[5]), 1e-12 * values[n - 1]);
    EXPECT_GT(values[6], 1e-5 * stiff);
  }
}

// Truth: sum_ab M_ab = rho V, and int rho X, against a 7-point Gauss rule on each axis; exact for any straight-sided cell.
TYPED_TEST(Solid, MassAndItsFirstMomentAreThoseOfTheVolume) {
  using S = typename TestFixture::S;
  constexpr double g[4] = {0, 0.4058451513773972, 0.7415311855993945, 0.9491079123427585};
  constexpr double w[4] = {0.4179591836734694, 0.3818300505051189, 0.2797053914892766, 0.1294849661688697};
  double volume = 0;
  Vec3 moment = Vec3::Zero();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(S::n, S::n);
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      for (int k = -3; k <= 3; ++k) {
        const auto at = [&](int p) { return p < 0 ? -g[-p] : g[p]; };
        const double u = at(i), v = at(j), z = at(k);
        double weight = w[std::abs(i)] * w[std::abs(j)] * w[std::abs(k)];
        Vec3 xi(u, v, z);
        if (is_wedge<S>) {  // collapsed square (Duffy)
          xi = {(1 + u) / 2, (1 - u) * (1 + v) / 4, z};
          weight *= (1 - u) / 8;
        } else if (is_tet<S>) {
          const double x = (1 + u) / 2, y = (1 - x) * (1 + v) / 2, t = (1 - x - y) * (1 + z) / 2;
          xi = {x, y, t};
          weight *= (1 - x) * (1 - x - y) / 8;
        }
        double N[S::n], dN[S::n][3];
        S::values(xi.data(), N);
        S::gradients(xi.data(), dN);
        Mat3 J = Mat3::Zero();
        Vec3 x = Vec3::Zero();
        for (int a = 0; a < S::n; ++a) J += this->X[a] * Vec3(dN[a][0], dN[a][1], dN[a][2]).transpose(), x += N[a] * this->X[a];
        const Eigen::Map<const Eigen::Matrix<double, S::n, 1>> n(N);
        volume += weight * J.determinant(), moment += weight * J.determinant() * x,
            M += 7800 * weight * J.determinant() * n * n.transpose();
      }
  std::vector<double> a(this->X_.size());
  for (size_t i = 0; i < a.size(); ++i) a[i] = i % 3 == 0;
  const auto at =
      evaluate_cell<S, typename TestFixture::M>(rubber, this->X_, this->X_, this->X_, {.elastic = 0, .density = 7800, .mass_slope = 1}, &a);
  double mass = 0;
  Vec3 first = Vec3::Zero();
  for (int b = 0; b < S::n; ++b) mass += at.f[3 * b], first += at.f[3 * b] * this->X[b];
  EXPECT_NEAR(mass, 7800 * volume, 1e-12 * mass);
  EXPECT_LT((first - 7800 * moment).norm(), 1e-12 * first.norm());
  // the matrix itself: exact where the map is affine (tetrahedra); a product of two shape functions and of a bent map's Jacobian is of
  // higher degree than the rule of the bricks and wedges, by less than 1 % of the largest entry for this cell
  const double bound = is_tet<S> ? 1e-12 : 0.01;
  for (int p = 0; p < S::n; ++p)
    for (int q = 0; q < S::n; ++q) {
      const double slope = at.K[static_cast<size_t>(3 * p) * 3 * S::n + 3 * q];
      ASSERT_NEAR(slope, M(p, q), bound * M.diagonal().maxCoeff()) << p << "," << q;
    }
}

}  // namespace
}  // namespace hilo::test::solid_test
