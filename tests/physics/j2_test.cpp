// SPDX-License-Identifier: GPL-3.0-or-later
// J2 plasticity at a point: closed forms, tangent, energy, what it remembers.
#include "physics/material/j2.hpp"

#include <gtest/gtest.h>

#include "verify/block_mesh.hpp"

namespace hilo::test::j2_test {
namespace {

constexpr double E = 200e9, nu = 0.3, Y = 400e6;

J2 steel() { return {lame(E, nu), Y}; }

/// A point that steps from strain to strain.
struct Point {
  J2 law;
  std::vector<double> state = std::vector<double>(J2::n_state, 0.0);
  Vec6 e = Vec6::Zero(), s = Vec6::Zero();
  Mat6 D = Mat6::Zero();  // its columns are derivatives
  double energy = 0, dissipated = 0, all_dissipated = 0, p = 0;

  PointStep step_to(const Vec6& to, double dt, bool conserving, double* stress, double* tangent, double* next) const {
    PointStep step{e.data(), to.data(), state.data(), dt, conserving};
    step.s = stress, step.D = tangent, step.h1 = next;
    law.respond(step);
    return step;
  }
  void go(const Vec6& to, double dt = INFINITY, bool conserving = false) {
    std::vector<double> next(state.size());
    double rows[36];
    const PointStep step = step_to(to, dt, conserving, s.data(), rows, next.data());
    D = Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows);
    state = next, e = to, energy = step.energy, dissipated = step.dissipated, all_dissipated += dissipated;
    p = state[J2::plastic_strain];
  }
  /// Stored energy at a strain with the state as it is.
  double stored(const Vec6& at) const { return step_to(at, 0, false, nullptr, nullptr, nullptr).energy; }
};

Vec6 green(const Mat3& F) {
  const Mat3 g = (F.transpose() * F - Mat3::Identity()) / 2;
  Vec6 e;
  e << g(0, 0), g(1, 1), g(2, 2), 2 * g(1, 2), 2 * g(0, 2), 2 * g(0, 1);
  return e;
}
Mat3 kirchhoff(const Mat3& F, const Vec6& s) {
  Mat3 S;
  S << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return F * S * F.transpose();
}
Mat3 stretches(double a, double b, double c) { return Vec3(std::exp(a), std::exp(b), std::exp(c)).asDiagonal(); }

/// Log strain of uniaxial stress tau with plastic strain p along it.
Mat3 uniaxial(double tau, double p) {
  const double side = -nu * tau / E - p / 2;
  return stretches(tau / E + p, side, side);
}

// Truth: tau = s(p) at eps = tau/E + p, in one step or in many, at plastic strains up to 1: linear, saturating and tabled hardening.
TEST(J2Point, UniaxialStressIsThatOfItsHardening) {
  J2 linear = steel(), voce = steel(), table = steel();
  linear.hardening = 3e9;
  voce.hardening = 0.5e9, voce.saturation = 700e6, voce.saturation_rate = 17;
  table.strain = {0, 0.01, 0.1, 0.5}, table.stress = {400e6, 500e6, 600e6, 650e6};
  const auto of_table = [](double p) {
    return p < 0.01  ? 400e6 + 100e6 * p / 0.01
           : p < 0.1 ? 500e6 + 100e6 * (p - 0.01) / 0.09
           : p < 0.5 ? 600e6 + 50e6 * (p - 0.1) / 0.4
                     : 650e6;
  };
  const std::pair<J2, std::function<double(double)>> laws[] = {
      {linear, [](double p) { return Y + 3e9 * p; }},
      {voce, [](double p) { return Y + 0.5e9 * p + (700e6 - Y) * (1 - std::exp(-17 * p)); }},
      {table, of_table}};
  for (const auto& [law, hardened] : laws)
    for (const int steps : {1, 7}) {
      Point at{law};
      for (int k = 1; k <= steps; ++k)
        for (const double p : {1e-3 * k / steps, 0.3 * k / steps, 1.0 * k / steps}) {
          if (p <= at.p) continue;
          const double tau = hardened(p);
          const Mat3 F = uniaxial(tau, p);
          at.go(green(F), INFINITY, k % 2);
          EXPECT_NEAR(at.p, p, 1e-12);
          at.go(green(F), INFINITY, false);  // the stress of a conserving step is that between its ends
          Mat3 exact = Mat3::Zero();
          exact(0, 0) = tau;
          EXPECT_LT((kirchhoff(F, at.s) - exact).norm(), 1e-8 * tau) << p;
        }
    }
}

// Truth: coaxial shear diag(exp e, exp -e, 1): q = 2 sqrt3 mu e, tau = q/sqrt3 on the planes at 45 degrees; before yield and after.
TEST(J2Point, ShearYieldsAtTheYieldStressOverRootThree) {
  J2 law = steel();
  law.hardening = 2e9;
  for (const double e : {1e-4, 0.01, 0.4}) {
    Point at{law};
    const Mat3 F = stretches(e, -e, 0);
    at.go(green(F));
    const double trial = 2 * std::sqrt(3.) * law.c.mu * e, p = std::max(0., (trial - Y) / (3 * law.c.mu + law.hardening));
    const double tau = (trial - 3 * law.c.mu * p) / std::sqrt(3.);
    EXPECT_NEAR(at.p, p, 1e-12);
    EXPECT_LT((kirchhoff(F, at.s) - Mat3(Vec3(tau, -tau, 0).asDiagonal())).norm(), 1e-8 * tau);
  }
}

// Truth: simple shear of a perfectly plastic body: the shear stress stays at yield/sqrt3 whatever the shear.  (A plastic strain that is
// added to the total logarithmic one loses it from a shear of about 1 on.)
TEST(J2Point, SimpleShearOfAPerfectlyPlasticBodyKeepsItsShearStress) {
  Point at{steel()};
  for (int k = 1; k <= 400; ++k) {
    Mat3 F = Mat3::Identity();
    F(0, 1) = 5.0 * k / 400;
    at.go(green(F));
    if (k < 20) continue;
    const Mat3 tau = kirchhoff(F, at.s);
    EXPECT_NEAR(tau(0, 1), Y / std::sqrt(3.), 1e-3 * Y) << F(0, 1);
    EXPECT_LT(std::abs(tau(0, 0)), 0.01 * Y);
  }
}

// Truth: with kinematic hardening the yield surface keeps its size and follows, tau = +-Y + H_k eps_p: a cycle is a parallelogram.
TEST(J2Point, CycleWithKinematicHardeningIsAParallelogram) {
  J2 law = steel();
  law.kinematic = 5e9;
  Point at{law};
  double ep = 0;
  for (const double target : {0.01, -0.02, 0.03, 0.0}) {
    const double sign = target > ep ? 1 : -1;
    for (int k = 1; k <= 3; ++k) {
      const double next = ep + (target - ep) * k / 3, tau = sign * Y + law.kinematic * next;
      const Mat3 F = uniaxial(tau, next);
      at.go(green(F), INFINITY, k % 2);
      at.go(green(F));
      EXPECT_NEAR(kirchhoff(F, at.s)(0, 0), tau, 1e-8 * Y);
      EXPECT_NEAR(at.state[9], next, 1e-12);
    }
    ep = target;
  }
  EXPECT_NEAR(at.p, 0.01 + 0.03 + 0.05 + 0.03, 1e-11);
  EXPECT_NEAR(at.all_dissipated, Y * at.p, 1e-9 * Y) << "what kinematic hardening stores is given back";
}

/// States in several regimes: laws that harden both ways, at different strains.
J2 rich(int i) {
  J2 law{lame(1e9, i % 2 ? 0.3 : 0.45), 20e6};
  law.hardening = i % 3 ? 30e6 : 0, law.saturation = i % 2 ? 35e6 : 20e6, law.saturation_rate = i % 2 ? 5 : 0;
  law.kinematic = i % 3 == 1 ? 50e6 : 0;
  if (i % 4 == 3) law.rate = 10, law.exponent = 3;
  return law;
}
Vec6 some_strain(double size, int seed) {
  Vec6 e;
  for (int k = 0; k < 6; ++k) e[k] = size * scatter(17 * seed + k) * (k < 3 ? 1 : 2);
  return e;
}

// Truth: D = ds/de1.  Central differences of two widths, extrapolated: their error is below 1e-8 of D, but for the round-off of short
// steps.
TEST(J2Point, TangentIsTheDerivativeOfTheStress) {
  int flows = 0;
  for (int i = 0; i < 24; ++i)
    for (const double size : {1e-5, 0.02, 0.15})
      for (const bool conserving : {false, true}) {
        Point at{rich(i)};
        at.go(some_strain(0.1, i), 0.01);
        const Vec6 to = at.e + some_strain(size, 100 + i);
        Vec6 s;
        double rows[36], next[J2::n_state];
        at.step_to(to, 0.01, conserving, s.data(), rows, next);
        flows += next[J2::plastic_strain] > at.p;
        const Mat6 D = Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows);
        const double h = std::min(2e-5, size / 4);
        const auto flows_at = [&](const Vec6& there) {
          double end[J2::n_state];
          at.step_to(there, 0.01, conserving, nullptr, nullptr, end);
          return end[J2::plastic_strain] > at.p;
        };
        for (int k = 0; k < 6; ++k) {
          Vec6 aside = to;
          aside[k] += h;
          const bool above = flows_at(aside);
          aside[k] -= 2 * h;
          if (above != flows_at(to) || above != flows_at(aside)) continue;  // across the yield surface
          const auto difference = [&](double w) {
            Vec6 up = to, down = to, su, sd;
            up[k] += w, down[k] -= w;
            at.step_to(up, 0.01, conserving, su.data(), nullptr, nullptr), at.step_to(down, 0.01, conserving, sd.data(), nullptr, nullptr);
            return Vec6((su - sd) / (2 * w));
          };
          const Vec6 exact = (4 * difference(h / 2) - difference(h)) / 3;
          EXPECT_LT((D.col(k) - exact).norm(), (size < 1e-4 ? 2e-5 : 1e-8) * D.norm()) << i << " " << size << " " << conserving << " " << k;
        }
      }
  EXPECT_GT(flows, 40);
}

// Truth: s.(e1 - e0) = W1 - W0 + D and D >= 0, whatever the step: elastic, flowing, turning back, relaxing.
TEST(J2Point, WorkIsStoredOrDissipated) {
  for (int i = 0; i < 24; ++i) {
    Point at{rich(i)};
    double scale = 0;
    for (int k = 0; k < 60; ++k) {
      const double size = std::pow(10., -1 - k % 9) * 0.5;
      const double W0 = at.stored(at.e);
      const Vec6 from = at.e;
      at.go(k % 7 == 6 ? at.e : Vec6(some_strain(0.05, i + k / 9) + some_strain(size, 31 * i + k)), 0.003, true);
      const double work = at.s.dot(at.e - from);
      scale = std::max({scale, std::abs(work), at.energy, at.dissipated});
      EXPECT_NEAR(work, at.energy - W0 + at.dissipated, 1e-12 * scale) << i << " " << k;
      EXPECT_GE(at.dissipated, 0);
      EXPECT_NEAR(at.stored(at.e), at.energy, 1e-13 * scale) << "the state holds what was stored";
      EXPECT_LT(at.s.norm(), 1e9) << "no division by a small step";
    }
    EXPECT_GT(at.all_dissipated, 0);
  }
}

// Truth: a conserving step tends to the stress between its ends: it differs from the mean of theirs by the square of the step.
TEST(J2Point, ConservingStressIsOfSecondOrder) {
  Point at{rich(0)};
  at.go(some_strain(0.1, 3));
  double before = INFINITY;
  for (const double size : {4e-3, 2e-3, 1e-3}) {
    Point one = at, two = at;
    const Vec6 to = at.e + some_strain(size, 77);
    Vec6 s0;
    at.step_to(at.e, INFINITY, false, s0.data(), nullptr, nullptr);
    one.go(to, INFINITY, true), two.go(to);
    const double off = (one.s - (s0 + two.s) / 2).norm();
    EXPECT_LT(off, before);
    before = 0.3 * off;
  }
}

// Truth: at a steady rate q = s(p) (1 + (rate of p over the reference)^(1/exponent)).
TEST(J2Point, RateRaisesTheYieldStress) {
  J2 law = steel();
  law.rate = 40, law.exponent = 5;
  for (const double strain_rate : {1e-3, 40.0, 1e4}) {
    Point at{law};
    const double dt = 1e-3 / strain_rate, tau = Y * (1 + std::pow(strain_rate / 40, 0.2));
    for (int k = 0; k <= 20; ++k) at.go(green(uniaxial(tau, strain_rate * dt * k)), k ? dt : 0);
    EXPECT_NEAR(kirchhoff(uniaxial(tau, 0.02), at.s)(0, 0), tau, 1e-6 * tau);
  }
}

// Truth: det Fp = 1; it stays over thousands of steps.
TEST(J2Point, PlasticFlowKeepsTheVolume) {
  Point at{rich(1)};
  for (int k = 0; k < 2000; ++k) at.go(some_strain(0.2, k), 0.01, true);
  Mat3 G = Mat3::Identity();
  for (int i = 0; i < 9; ++i) G(i / 3, i % 3) += at.state[i];
  EXPECT_NEAR(G.determinant(), 1, 1e-11);
  EXPECT_GT(at.p, 10);
}

}  // namespace
}  // namespace hilo::test::j2_test
