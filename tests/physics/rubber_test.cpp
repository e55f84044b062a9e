// SPDX-License-Identifier: GPL-3.0-or-later
// Mooney-Rivlin and Ogden at a point: closed forms, derivatives, work of a step.
#include <gtest/gtest.h>

#include <variant>

#include "physics/material/mooney_rivlin.hpp"
#include "physics/material/neo_hookean.hpp"
#include "physics/material/ogden.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test::rubber_test {
namespace {

using Law = std::variant<MooneyRivlin, Ogden>;

Vec6 stress(const Law& law, const Vec6& e0, const Vec6& e1, Mat6* D = nullptr) {
  Vec6 s = Vec6::Zero();
  double rows[6][6] = {};
  std::visit([&](const auto& m) { m.template stress<double>(e0.data(), e1.data(), s.data(), D ? rows : nullptr); }, law);
  if (D) *D = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows[0]);
  return s;
}
double energy(const Law& law, const Vec6& e) {
  return std::visit([&](const auto& m) { return m.template energy<double>(e.data()); }, law);
}
Vec6 green(const Mat3& F) {
  const Mat3 g = (F.transpose() * F - Mat3::Identity()) / 2;
  Vec6 e;
  e << g(0, 0), g(1, 1), g(2, 2), 2 * g(1, 2), 2 * g(0, 2), 2 * g(0, 1);
  return e;
}
Mat3 cauchy(const Law& law, const Mat3& F) {
  const Vec6 s = stress(law, green(F), green(F));
  Mat3 S;
  S << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return F * S * F.transpose() / F.determinant();
}
Mat3 stretches(double a, double b, double c) { return Vec3(a, b, c).asDiagonal(); }

const MooneyRivlin mooney{0.3e6, 0.11e6, 40e6};
const Ogden three{{{0.62e6, 1.3}, {0.00118e6, 5.0}, {-0.00981e6, -2.0}}, 30e6};  // Ogden's exponents for rubber
const Law laws[] = {mooney, three, MooneyRivlin{0.2e6, 0, 1e6}, Ogden{{{1e6, 2}}, 2e6}, Ogden{{{1e6, -7.5}, {0.4e6, 9}}, 4e6}};

Vec6 some_strain(double size, int seed) {
  Vec6 e;
  for (int k = 0; k < 6; ++k) e[k] = size * scatter(23 * seed + k) * (k < 3 ? 1 : 2);
  return e;
}

// Truth: closed forms of incompressible pulls, J = 1: differences of principal Cauchy stresses.
TEST(Rubber, MooneyRivlinHasTheStressOfItsClosedForms) {
  const double c10 = mooney.c10, c01 = mooney.c01, tolerance = 1e-8 * (c10 + c01);
  for (const double l : {0.5, 0.98, 1.02, 1.5, 3.0}) {
    const Mat3 pulled = cauchy(mooney, stretches(l, 1 / std::sqrt(l), 1 / std::sqrt(l)));
    EXPECT_NEAR(pulled(0, 0) - pulled(1, 1), 2 * (l * l - 1 / l) * (c10 + c01 / l), tolerance);
    const Mat3 both = cauchy(mooney, stretches(l, l, 1 / (l * l)));
    EXPECT_NEAR(both(0, 0) - both(2, 2), 2 * (l * l - std::pow(l, -4)) * (c10 + c01 * l * l), 10 * tolerance * l * l);
    Mat3 F = Mat3::Identity();
    F(0, 1) = l;
    EXPECT_NEAR(cauchy(mooney, F)(0, 1), 2 * l * (c10 + c01), tolerance);
  }
}
TEST(Rubber, OgdenHasTheStressOfItsClosedForms) {
  for (const double l : {0.5, 0.98, 1.02, 1.5, 3.0}) {
    double uniaxial = 0, biaxial = 0, shear = 0;
    for (const auto& [mu, a] : three.terms) {
      uniaxial += 2 * mu / a * (std::pow(l, a) - std::pow(l, -a / 2));
      biaxial += 2 * mu / a * (std::pow(l, a) - std::pow(l, -2 * a));
      shear += 2 * mu / a * (std::pow(l, a) - std::pow(l, -a)) / (l + 1 / l);
    }
    const Mat3 pulled = cauchy(three, stretches(l, 1 / std::sqrt(l), 1 / std::sqrt(l)));
    EXPECT_NEAR(pulled(0, 0) - pulled(1, 1), uniaxial, 1e-8 * three.shear());
    const Mat3 both = cauchy(three, stretches(l, l, 1 / (l * l)));
    EXPECT_NEAR(both(0, 0) - both(2, 2), biaxial, 1e-8 * three.shear() * std::pow(l, 4));
    Mat3 F = Mat3::Identity();
    F(0, 1) = l - 1 / l;  // whose principal stretches are l and 1/l
    EXPECT_NEAR(cauchy(three, F)(0, 1), shear, 1e-8 * three.shear());
  }
}

// Truth: the mean stress is K (J - 1), whatever the shape: the rest of W does not see the volume.
TEST(Rubber, MeanStressIsThatOfTheVolume) {
  const double K[] = {40e6, 30e6};
  for (const int i : {0, 1})
    for (const double J : {0.8, 1.0, 1.3}) {
      const Mat3 F = std::cbrt(J) * stretches(1.7, 0.8, 1 / (1.7 * 0.8));
      EXPECT_NEAR(cauchy(laws[i], F).trace() / 3, K[i] * (J - 1), 1e-8 * K[i]);
    }
}

// Truth: one term of alpha = 2 is Mooney-Rivlin's law with c01 = 0, two of 2 and -2 are all of it: mu = 2 c10 and 2 c01.
TEST(Rubber, OgdenOfTwoTermsIsMooneyRivlin) {
  const Ogden same{{{2 * mooney.c10, 2}, {2 * mooney.c01, -2}}, mooney.K};
  for (int k = 0; k < 20; ++k) {
    const Vec6 e0 = some_strain(0.15, k), e1 = some_strain(0.2, 100 + k);
    EXPECT_NEAR(energy(same, e1), energy(mooney, e1), 1e-12 * mooney.K);
    EXPECT_LT((stress(same, e1, e1) - stress(mooney, e1, e1)).norm(), 1e-12 * mooney.K);
    EXPECT_LT((stress(same, e0, e1) - stress(mooney, e0, e1)).norm(), 0.05 * mooney.K) << "two discrete gradients of one energy";
  }
}

// Truth: s.(e1 - e0) = W1 - W0 whatever the step, and no division by a small one.
TEST(Rubber, WorkOfAStepIsTheChangeOfEnergy) {
  for (const Law& law : laws) {
    const double K = std::visit([](const auto& m) { return m.K; }, law);
    for (int k = 0; k < 80; ++k) {
      const double size = 0.3 * std::pow(10., -(k % 10));
      const Vec6 e0 = some_strain(0.15, k / 10), e1 = k % 10 < 2 ? some_strain(size / 2, 50 + k) : Vec6(e0 + some_strain(size, 50 + k));
      const Vec6 s = stress(law, e0, e1);
      EXPECT_NEAR(s.dot(e1 - e0), energy(law, e1) - energy(law, e0), 1e-14 * K) << k;
      EXPECT_LT(s.norm(), 50 * K);
    }
  }
}

// Truth: at equal ends the stress is dW/de; central differences of two widths, extrapolated.
TEST(Rubber, StressIsTheDerivativeOfEnergy) {
  for (const Law& law : laws)
    for (int seed = 0; seed < 6; ++seed) {
      // one at rest, one with two equal stretches, one of shear alone, then any
      Vec6 e = some_strain(0.15, seed);
      if (seed == 0) e.setZero();
      if (seed == 1) e << 0.2, -0.1, -0.1, 0, 0, 0;
      if (seed == 2) e << 0, 0, 0, 0, 0, 0.3;
      Mat6 D;
      const Vec6 s = stress(law, e, e, &D);
      for (int k = 0; k < 6; ++k) {
        const auto difference = [&](double h) {
          Vec6 up = e, down = e;
          up[k] += h, down[k] -= h;
          return (energy(law, up) - energy(law, down)) / (2 * h);
        };
        EXPECT_NEAR(s[k], (4 * difference(5e-4) - difference(1e-3)) / 3, 1e-8 * D.norm()) << seed << " " << k;
      }
    }
}

// Truth: D = ds/de1 over a step; at equal ends half the second derivative of W, which is symmetric.
TEST(Rubber, TangentIsTheDerivativeOfTheStress) {
  for (const Law& law : laws)
    for (int seed = 0; seed < 8; ++seed)
      for (const double size : {0.0, 1e-5, 0.02, 0.3}) {
        Vec6 e0 = some_strain(0.12, seed);
        if (seed == 0) e0.setZero();
        if (seed == 1) e0 << 0.2, -0.1, -0.1, 0, 0, 0;
        const Vec6 e1 = size > 0.1 ? some_strain(0.15, 70 + seed) : Vec6(e0 + some_strain(size, 70 + seed));
        Mat6 D;
        stress(law, e0, e1, &D);
        for (int k = 0; k < 6; ++k) {
          const auto difference = [&](double h) {
            Vec6 up = e1, down = e1;
            up[k] += h, down[k] -= h;
            return Vec6((stress(law, e0, up) - stress(law, e0, down)) / (2 * h));
          };
          const Vec6 exact = (4 * difference(1e-4) - difference(2e-4)) / 3;
          EXPECT_LT((D.col(k) - exact).norm(), 1e-8 * D.norm()) << seed << " " << size << " " << k;
        }
        if (size > 0) continue;
        EXPECT_LT((D - D.transpose()).norm(), 1e-10 * D.norm());
      }
}

// Truth: at rest the tangent is that of the moduli that linear() says; at equal ends D is half of it.
TEST(Rubber, ModuliAtSmallStrainAreThoseItSays) {
  for (const Law& law : laws) {
    const Lame c = std::visit([](const auto& m) { return m.linear(); }, law);
    Mat6 D;
    double exact[6][6] = {};
    stress(law, Vec6::Zero(), Vec6::Zero(), &D);
    add_linear_tangent(c, 0.5, exact);
    EXPECT_LT((D - Eigen::Map<const Mat6>(exact[0])).norm(), 1e-12 * D.norm());
  }
}

/// Truth: the energy of the linear moduli, that of the law but for a share of the strain.  At strains of 1e-9 mu is 1e18 times the energy:
/// a difference of terms of the size of mu would leave no digit.
template <class M>
void keeps_digits(const M& law) {
  const Lame c = law.linear();
  for (int seed = 0; seed < 20; ++seed)
    for (const double size : {1e-9, 1e-7, 1e-5}) {
      const Vec6 e = some_strain(size, seed);
      const double trace = e.head<3>().sum(),
                   exact = c.lambda / 2 * trace * trace + c.mu * (e.head<3>().squaredNorm() + e.tail<3>().squaredNorm() / 2);
      EXPECT_NEAR(law.template energy<double>(e.data()) / exact, 1, 1e-6 + 30 * size) << seed << " " << size;
    }
}
TEST(Rubber, EnergyAtSmallStrainHasItsDigits) {
  for (const Law& law : laws) std::visit([](const auto& m) { keeps_digits(m); }, law);
  keeps_digits(NeoHookean{{4e9, 3e9}});
}

}  // namespace
}  // namespace hilo::test::rubber_test
