// SPDX-License-Identifier: GPL-3.0-or-later
// Stops, motors and friction as laws of one coordinate.
#include "physics/connectors.hpp"
#include "physics/coordinates.hpp"
#include "physics/impact_loss.hpp"
#include "physics/spring.hpp"

namespace hilo::test::joint_force_test {
namespace {

using Values = SpringLaw::Values;

/// A mass on a law, stepped by the mid-point rule with Newton to round-off: m (v1 - v0)/h = -s, x1 = x0 + h (v0 + v1)/2.
struct Particle {
  double m, x, v;
  void step(SpringLaw& law, double h, double force = 0, double load = 0) {
    double x1 = x + h * v;
    for (int it = 0; it < 60; ++it) {
      Response r;
      law.elastic({x}, {x1}, r), law.viscous({x}, {x1}, {h, 1, load}, r);
      const double residual = 2 * m / (h * h) * (x1 - x - h * v) + r.s[0] - force, d = residual / (2 * m / (h * h) + r.D[0][0]);
      x1 -= d;
      if (std::abs(d) < 1e-15 * (1 + std::abs(x1))) break;
    }
    v = 2 * (x1 - x) / h - v, x = x1;
    law.commit({x}, {v});
  }
};

// Truth: the damper is chosen so that, in exact dynamics, a mass that hits at v leaves at e v, whatever its mass, speed and stiffness.
TEST(Stop, LeavesTheFractionOfTheSpeedThatIsAsked) {
  for (const double e : {1.0, 0.9, 0.7, 0.5, 0.3, 0.1})
    for (const double v : {0.2, 3.0})
      for (const double m : {0.5, 20.0}) {
        const double k = 4000, contact = M_PI * std::sqrt(m / k), h = contact / 2000;
        auto law = make_stop({.lower = -1e9, .upper = 0.01, .stiffness = k, .restitution = e, .rest_speed = 1e-6});
        Particle p{m, 0.01 - 0.3 * h * v, v};
        law->commit({p.x}, {v});
        double peak = 0;
        for (int i = 0; i < 200000 && !(p.v < 0 && p.x < 0.01); ++i) p.step(*law, h), peak = std::max(peak, p.x);
        EXPECT_GT(peak, 0.01);
        EXPECT_NEAR(-p.v / v, e, 2e-3) << "e " << e << " v " << v << " m " << m;
      }
}

// Truth: with e = 1 the discrete gradient gives the kinetic energy back exactly, however coarse the step.
TEST(Stop, GivesAllEnergyBackAtAnyStep) {
  for (const double h : {1e-3, 1e-2, 0.05}) {
    auto law = make_stop({.lower = -0.7, .upper = 0.4, .stiffness = 5e3});
    Particle p{2, 0, 1.5};
    for (int i = 0; i < 2000; ++i) p.step(*law, h);
    Response r;
    law->elastic({p.x}, {p.x}, r);
    EXPECT_NEAR(p.m / 2 * p.v * p.v + r.energy, 2.25, 1e-11) << h;
  }
}

// Truth: y of the damper solves y (1 + e) = ln((1 + y)/(1 - e y)); near e = 1 it is Hunt and Crossley's 3/2 (1 - e).
TEST(Stop, DamperSolvesTheRestitutionEquation) {
  EXPECT_EQ(hunt_crossley(1), 0);
  for (const double e : {0.99, 0.9, 0.5, 0.2, 0.05}) {
    const double y = hunt_crossley(e);
    EXPECT_GT(y, 0);
    EXPECT_NEAR(1 - e * y, (1 + y) * std::exp(-y * (1 + e)), 1e-13) << e;
  }
  EXPECT_NEAR(hunt_crossley(0.999), 1.5e-3, 2e-6);
  EXPECT_NEAR(hunt_crossley(1 - 1.1e-4) / hunt_crossley(1 - 0.9e-4), 1.1 / 0.9, 2e-3);
}

// Truth: what was pressed without an impact comes back with 1 - e y of its energy, at any depth and `rest_speed` that is far below the
// speed; and the way it is pressed in fast is that of an impact, 1 + y times as stiff.
TEST(Stop, WhatIsPressedWithoutAnImpactComesBack) {
  for (const double e : {0.9, 0.5, 0.3, 0.0}) {
    const double m = 2, k = 1000, d = 0.1, y = hunt_crossley(e), least = 1 - std::max(e, 0.01) * y;
    auto law = make_stop({.lower = 0, .stiffness = k, .restitution = e, .rest_speed = 1e-5});
    Particle p{m, -d, 0};
    law->commit({p.x}, {0});
    for (int i = 0; i < 100000 && p.x < 0; ++i) p.step(*law, 1e-4);
    EXPECT_NEAR(p.v, std::sqrt(least * k / m) * d, 2e-3 * p.v + 1e-4) << e;
    Response r;
    law->elastic({-d}, {-d - 1e-6}, r), law->viscous({-d}, {-d - 1e-6}, {1e-9, 1}, r);
    EXPECT_NEAR(r.s[0], -(1 + y) * k * (d + 5e-7), 1e-9 * k) << e;
  }
}

// Truth: a stop pushes back whatever the rate, never pulls.
TEST(Stop, NeverPulls) {
  auto law = make_stop({.lower = -0.5, .upper = 0.5, .stiffness = 900, .restitution = 0.2});
  law->commit({0}, {0.3});
  law->commit({0}, {-0.3});
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j) {
      Response r;
      law->elastic({0.1 * i}, {0.1 * j}, r), law->viscous({0.1 * i}, {0.1 * j}, {0.01}, r);
      if (i >= 0 && j >= 0) {
        EXPECT_GE(r.s[0], -1e-12);
      }
      if (i <= 0 && j <= 0) {
        EXPECT_LE(r.s[0], 1e-12);
      }
      EXPECT_GE(r.dissipated, 0);
    }
}

// Truth: m dv/dt = F0 (1 - v/v0) has v = v0 (1 - exp(-F0 t/(m v0))); the mid-point rule errs by O(h^2).
TEST(Motor, RunsUpAlongTheExponentialOfItsLine) {
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const double h = 0.02 / (1 << level), m = 3, F0 = 12, v0 = 5, T = 1;
    auto law = make_motor({.rate = {0, v0}, .force = {F0, 0}});
    Particle p{m, 0, 0};
    for (int i = 0; i < std::lround(T / h); ++i) p.step(*law, h);
    error[level] = std::abs(p.v - v0 * (1 - std::exp(-F0 * T / (m * v0))));
  }
  EXPECT_LT(error[0], 1e-4);
  EXPECT_NEAR(error[0] / error[1], 4, 0.05);
}

// Truth: the table is linear between its points and goes on with its first and last segments; its power is what it supplies.
TEST(Motor, FollowsItsTable) {
  auto law = make_motor({.rate = {-1, 0, 2, 3}, .force = {5, 4, 1, 1}});
  const auto force = [&](double rate) {
    Response r;
    law->viscous({0}, {rate * 0.1}, {0.1, 2}, r);
    EXPECT_NEAR(r.supplied, -r.s[0] * rate * 0.1, 1e-12);
    return -r.s[0];
  };
  EXPECT_NEAR(force(-2), 12, 1e-12);
  EXPECT_NEAR(force(-0.5), 9, 1e-12);
  EXPECT_NEAR(force(1), 5, 1e-12);
  EXPECT_NEAR(force(2.5), 2, 1e-12);
  EXPECT_NEAR(force(30), 2, 1e-12);
}

// Truth: a force p times the limit creeps at slip_velocity artanh(p).
TEST(Friction, SticksAsACreepOfTheStatedVelocity) {
  const double mu = 0.4, load = 50, slow = 1e-3, p = 0.6;
  auto law = make_friction({.coefficient = mu, .slip_velocity = slow, .lever = {1}});
  Particle mass{2, 0, 0};
  for (int i = 0; i < 400; ++i) mass.step(*law, 0.01, p * mu * load, load);
  EXPECT_NEAR(mass.v, slow * std::atanh(p), 1e-9);
}

// Truth: ds/d(load) is the derivative of the force.
TEST(Friction, KnowsHowItDependsOnTheLoad) {
  auto law = make_friction({.coefficient = 0.4, .preload = 3, .slip_velocity = 0.2, .lever = {1, 0.5}});
  Response at, up;
  law->viscous({0.1, 0.2}, {0.12, 0.17}, {0.1, 1, 5}, at), law->viscous({0.1, 0.2}, {0.12, 0.17}, {0.1, 1, 6}, up);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(at.by_load[i], up.s[i] - at.s[i], 1e-13);
}

// Truth: two bodies that turn against each other at w about any axis feel the moment mu N r tanh(r w/v) along it, against the slip.
TEST(Friction, OfABallJointOpposesTheRelativeSpin) {
  const Config q = somewhere(4);
  const double mu = 0.3, r = 0.2, N = 70, slow = 1.5, h = 1e-6;
  const hilo::Joint ball = joint("spherical", q);
  const hilo::Spring c = friction_in(ball, *ball.kind, q, {.coefficient = mu, .radius = r, .slip_velocity = slow});
  const Vec3 w(1, -2, 0.5);
  Config q0 = q, q1 = q;
  q0.R[2] = turn(-h / 2 * w) * q.R[2], q1.R[2] = turn(h / 2 * w) * q.R[2];
  Response response;
  c.law->viscous(c.values(q0), c.values(q1), {h, 1, N}, response);
  ConnectorGradient g;
  gradient(c, q, g);
  const Vec6 f = force_on_b(c, g, response.s.data(), q);
  EXPECT_LT(f.head<3>().norm(), 1e-9);
  const double M = mu * N * r * std::tanh(r * w.norm() / slow);
  EXPECT_LT((f.tail<3>() + M * w.normalized()).norm(), 1e-6 * M);
}

// Truth: b turned or slid along the axis of the joint has the angle or displacement it was moved by.
TEST(Freedom, MeasuresWhatTheJointLeavesFree) {
  const Config q = somewhere(2);
  const Mat3 frame = some_frame();
  for (const Freedom freedom : {Freedom::angle, Freedom::slide}) {
    const hilo::Spring c = along_joint(joint("cylindrical", q), q, freedom, make_linear({2}, {0}));
    Config p = q;
    const double moved = 0.4;
    if (freedom == Freedom::angle) {
      const Mat3 B = turn(moved * frame.col(2));
      p.c[2] = joint_point + B * (q.c[2] - joint_point), p.R[2] = B * q.R[2];
    } else {
      p.c[2] += moved * frame.col(2);
    }
    Response r;
    c.law->elastic(c.values(p), c.values(p), r);
    EXPECT_NEAR(r.energy, moved * moved, 1e-12);
    ConnectorGradient g;
    gradient(c, p, g);
    const Vec6 f = force_on_b(c, g, r.s.data(), p);
    const Vec3 along = freedom == Freedom::angle ? f.tail<3>() : f.head<3>(), other = freedom == Freedom::angle ? f.head<3>() : f.tail<3>();
    EXPECT_LT((along + 2 * moved * frame.col(2)).norm(), 1e-12) << "on b, against its motion";
    EXPECT_LT(other.norm(), 1e-12);
  }
}

}  // namespace
}  // namespace hilo::test::joint_force_test
