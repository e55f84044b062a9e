// SPDX-License-Identifier: GPL-3.0-or-later
// Moments of bushings and joints that give way, at any angle: they grow with it, and count its turns.
#include "physics/connectors.hpp"
#include "physics/coordinates.hpp"
#include "physics/spring.hpp"

namespace hilo::test::spring_moment_test {
namespace {

using Values = SpringLaw::Values;

/// Moment on b, in the frame, once b has turned by w (frame axes) about the joint point; a's attitude is `carried`.
Vec3 moment(const hilo::Spring& c, const Config& q, const Vec3& w, const Mat3& carried = Mat3::Identity()) {
  const Mat3 frame = some_frame();
  Config p = q;
  const Mat3 B = carried * turn(frame * w);
  p.R[1] = carried * q.R[1], p.R[2] = B * q.R[2];
  p.c[1] = joint_point + carried * (q.c[1] - joint_point), p.c[2] = joint_point + B * (q.c[2] - joint_point);
  const Values e = c.values(p);
  Response r;
  c.law->elastic(e, e, r);
  ConnectorGradient g;
  gradient(c, p, g);
  return (carried * frame).transpose() * force_on_b(c, g, r.s.data(), p).tail<3>();
}

// Truth: W = k phi^2/2 of the rotation vector gives the moment -k phi about the axis of the turn, however large; about principal axes of
// the stiffness, k_i phi.
TEST(Bushing, MomentGrowsWithTheAngle) {
  const Config q = somewhere(3);
  const auto make = [&](const Vec3& about) {
    return make_bushing({.a = {1, -1}, .b = {2, -1}, .at = joint_point, .frame = some_frame(), .stiffness = {.about = about}}, q);
  };
  const hilo::Spring same = make(Vec3::Constant(100)), other = make({20, 10, 30});
  const Mat3 carried = turn(Vec3(0.3, -2, 1));
  for (const double phi : {1e-9, 1e-4, 0.02, 0.5, 1.5, 2.5, 3.1}) {
    const Vec3 n = Vec3(1, -2, 0.7).normalized();
    EXPECT_LT((moment(same, q, phi * n, carried) + 100 * phi * n).norm(), 2e-10 * (1 + phi)) << phi;
    EXPECT_LT((moment(make_compliant(place("fixed"), {.along = Vec3::Ones(), .about = Vec3::Constant(100)}, q), q, phi * n) + 100 * phi * n)
                  .norm(),
              2e-10 * (1 + phi))
        << phi;
    for (int i = 0; i < 3; ++i) {
      const Vec3 e = Vec3::Unit(i), k(20, 10, 30);
      EXPECT_LT((moment(other, q, -phi * e) - k[i] * phi * e).norm(), 2e-10) << phi << i;
    }
    // of a free axis: the tilt; of a stiff one alone: the twist, here over a tilt as well
    EXPECT_LT((moment(make({20, 0, 20}), q, phi * Vec3::UnitX()) + 20 * phi * Vec3::UnitX()).norm(), 1e-11) << phi;
    EXPECT_LT(moment(make({20, 0, 20}), q, phi * Vec3::UnitY()).norm(), 1e-11) << phi;
    EXPECT_LT((moment(make({0, 0, 30}), q, phi * Vec3::UnitZ()) + 30 * phi * Vec3::UnitZ()).norm(), 1e-11) << phi;
  }
}

// Truth: wound up step by step, the work is k phi^2/2: about three stiff axes below a whole turn, about one over any number; beyond half a
// turn the first says so.
TEST(Bushing, CountsItsTurnsAndSaysWhereItsLawEnds) {
  const Config q = somewhere(3);
  const Mat3 frame = some_frame();
  for (const bool alone : {false, true}) {
    const hilo::Spring c = make_bushing(
        {.a = {1, -1}, .b = {2, -1}, .at = joint_point, .frame = frame, .stiffness = {.about = alone ? Vec3(0, 0, 40) : Vec3(40, 50, 40)}},
        q);
    double work = 0;
    Values before = c.values(q);
    for (double angle = 0.25; angle < (alone ? 20 : 6.1); angle += 0.25) {
      Config p = q;
      p.R[2] = turn(angle * frame.col(2)) * q.R[2];
      const Values now = c.values(p);
      Response r;
      c.law->elastic(before, now, r);
      for (int i = 0; i < max_measures; ++i) work += r.s[i] * (now[i] - before[i]);
      EXPECT_NEAR(r.energy, 20 * angle * angle, 1e-10 * r.energy) << angle;
      EXPECT_NEAR(r.energy, work, 1e-10 * r.energy) << angle;
      c.law->commit(now, {});
      EXPECT_EQ(c.law->beyond(now), !alone && angle > M_PI ? "half a turn" : "") << angle;
      before = now;
    }
  }
}

// Truth: the power of dampers c about the axes of a is the sum of c w^2 of the relative angular velocity, at any attitude.
TEST(Bushing, DampersFeelTheAngularVelocityAtAnyAttitude) {
  const Config q = somewhere(3);
  const Mat3 frame = some_frame();
  const Vec3 c3(1, 2, 3.5);
  const hilo::Spring c =
      make_bushing({.a = {1, -1}, .b = {2, -1}, .at = joint_point, .frame = frame, .stiffness = {.angular_damping = c3}}, q);
  for (int seed = 0; seed < 20; ++seed) {
    const double h = 1e-3;
    const Vec3 w = 3 * scattered(seed);  // in the frame
    const Mat3 at = turn(frame * (4 * scattered(seed + 7)));
    Config back = q, ahead = q;
    back.R[2] = turn(-h / 2 * (frame * w)) * at * q.R[2], ahead.R[2] = turn(h / 2 * (frame * w)) * at * q.R[2];
    Response r;
    c.law->viscous(c.values(back), c.values(ahead), {h}, r);
    const double power = c3.dot(w.cwiseAbs2());
    EXPECT_NEAR(r.dissipated / h, power, 1e-5 * power);
  }
}

// Truth: angles of compliant joints: tilt of the axis (revolute), twist of the shafts (constant velocity), the angle missed (universal).
TEST(CompliantJoint, MomentGrowsWithTheAngle) {
  const Config q = somewhere(3);
  const auto of = [&](const char* kind, const Vec3& w) {
    return moment(make_compliant(place(kind), {.along = Vec3::Ones(), .about = Vec3(20, 10, 30)}, q), q, w);
  };
  for (const double phi : {0.02, 0.7, 1.5, 2.5}) {
    EXPECT_LT((of("revolute", {phi, 0, 0}) + Vec3(20 * phi, 0, 0)).norm(), 1e-11);
    EXPECT_LT((of("cylindrical", {0, phi, 0}) + Vec3(0, 10 * phi, 0)).norm(), 1e-11);
    EXPECT_LT(of("planar", {0, 0, phi}).norm(), 1e-11);
    EXPECT_LT((of("prismatic", {0, 0, phi}) + Vec3(0, 0, 30 * phi)).norm(), 1e-11);
    EXPECT_LT((of("constant-velocity", {0, 0, phi}) + Vec3(0, 0, 30 * phi)).norm(), 1e-11);
    EXPECT_LT(of("constant-velocity", {phi / 2, 0, 0}).norm(), 1e-11);
    EXPECT_LT((of("universal", {0, phi / 2, 0}) + Vec3(0, 10 * phi / 2, 0)).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace hilo::test::spring_moment_test
