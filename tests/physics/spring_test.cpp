// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and dampers: discrete gradients of their potentials, never a source of energy.
#include "physics/spring.hpp"

#include "physics/connectors.hpp"
#include "physics/coordinates.hpp"

namespace hilo::test::spring_test {
namespace {

using Values = SpringLaw::Values;

struct Kind {
  std::string name;
  std::function<hilo::Spring(const Config&)> make;
  std::function<Values(int)> state;  // admissible measures
};

const Stiffness some_stiffness{
    .along = Vec3(100, 200, 50), .damping = Vec3(3, 0, 5), .about = Vec3(20, 10, 30), .angular_damping = Vec3(1, 2, 3)};

hilo::Spring give_way(const std::string& kind, const Config& q) { return make_compliant(place(kind), some_stiffness, q); }

hilo::Spring friction(const std::string& kind, double radius, const Config& q) {
  const hilo::Joint host = joint(kind, q);
  return friction_in(host, *host.kind, q, {.coefficient = 0.3, .radius = radius, .preload = 5, .slip_velocity = 3});
}

std::vector<Kind> kinds() {
  const Carrier a{1, -1}, b{2, -1};
  const auto any = [](int seed) {
    Values e{};
    for (int i = 0; i < max_measures; ++i) e[i] = 0.7 * scatter(seed + 13 * i);
    return e;
  };
  const auto attitude = [=](int first, int seed) {  // nine products by columns behind others
    Values e = any(seed);
    Mat3::Map(&e[first]) = turn(1.6 * scattered(seed));
    return e;
  };
  const auto with_rotation = [=](int first) { return [=](int seed) { return attitude(first, seed); }; };
  const auto bushing = [=](const Vec3& about, const Vec3& damping) {
    return [=](const Config& q) {
      const Stiffness s{.along = Vec3(100, 200, 50), .damping = Vec3(3, 0, 5), .about = about, .angular_damping = damping};
      return make_bushing({.a = a, .b = b, .at = joint_point, .frame = some_frame(), .stiffness = s}, q);
    };
  };
  const auto tilt_and_twist = [=](int seed) {  // three products of the axis, then twice the sine and
                                               // cosine of half a turn apart
    Values e = any(seed);
    const Mat3 R = turn(1.6 * scattered(seed));
    for (int i = 0; i < 3; ++i) e[3 + i] = R(i, 2);
    return e[6] = R(1, 0) - R(0, 1), e[7] = R(0, 0) + R(1, 1), e;
  };
  const auto turned = [](int seed) {
    const double t = 1.5 * scatter(seed);
    return Values{std::sin(t), std::cos(t)};
  };
  return {{"axial",
           [=](const Config& q) {
             return make_axial_spring(
                 {.a = a, .b = b, .at_a = joint_point, .at_b = other_point, .stiffness = 250, .damping = 30, .length = 1.1}, q);
           },
           [](int seed) { return Values{std::pow(1 + 0.6 * scatter(seed), 2)}; }},
          {"torsion",
           [=](const Config& q) {
             return make_torsion_spring({.a = a, .b = b, .frame = some_frame(), .stiffness = 40, .damping = 3, .angle = 0.2}, q);
           },
           turned},
          {"bushing", bushing(some_stiffness.about, some_stiffness.angular_damping), with_rotation(3)},
          {"bushing_free_about_x", bushing({0, 10, 30}, some_stiffness.angular_damping), tilt_and_twist},
          {"bushing_stiff_about_y", bushing({0, 10, 0}, some_stiffness.angular_damping), tilt_and_twist},
          {"bushing_that_damps", bushing({0, 0, 0}, {1, 5, 1}), with_rotation(3)},
          {"support",
           [=](const Config& q) {
             return make_support({.a = a,
                                  .b = b,
                                  .at = joint_point,
                                  .frame = some_frame(),
                                  .stiffness = 900,
                                  .restitution = 0.4,
                                  .rest_speed = 0.5,
                                  .clearance = 0.1,
                                  .tangential_stiffness = Vec3(70, 20, 0),
                                  .tangential_damping = Vec3(2, 1, 0)},
                                 q);
           },
           any},
          {"rope",
           [=](const Config& q) {
             return make_distance_stop({.a = a,
                                        .b = b,
                                        .at_a = joint_point,
                                        .at_b = other_point,
                                        .stop = {.lower = 0.8, .upper = 1.1, .stiffness = 300, .restitution = 0.6, .rest_speed = 1}},
                                       q);
           },
           [](int seed) { return Values{std::pow(1 + 0.6 * scatter(seed), 2)}; }},
          {"angle_stop",
           [=](const Config& q) {
             return along_joint(joint("revolute", q), q, Freedom::angle,
                                make_stop({.lower = -0.4, .upper = 0.5, .stiffness = 80, .restitution = 0.3, .rest_speed = 2}));
           },
           turned},
          {"slide_stop",
           [=](const Config& q) {
             return along_joint(joint("cylindrical", q), q, Freedom::slide,
                                make_stop({.lower = -0.2, .upper = 0.1, .stiffness = 80, .restitution = 0, .rest_speed = 2}));
           },
           any},
          {"compliant_fixed", [=](const Config& q) { return give_way("fixed", q); }, with_rotation(3)},
          {"compliant_prismatic", [=](const Config& q) { return give_way("prismatic", q); }, with_rotation(2)},
          {"compliant_universal", [=](const Config& q) { return give_way("universal", q); }, any},
          {"compliant_revolute", [=](const Config& q) { return give_way("revolute", q); }, tilt_and_twist},
          {"compliant_spherical", [=](const Config& q) { return give_way("spherical", q); }, any},
          {"compliant_constant_velocity", [=](const Config& q) { return give_way("constant-velocity", q); }, any},
          {"compliant_distance", [=](const Config& q) { return give_way("distance", q); },
           [](int seed) { return Values{std::pow(1 + 0.6 * scatter(seed), 2)}; }},
          {"compliant_screw", [=](const Config& q) { return give_way("screw", q); },
           [=](int seed) {
             Values e = any(seed);
             const Values turn = turned(seed);
             return e[6] = turn[0], e[7] = turn[1], e;
           }},
          {"friction_revolute", [=](const Config& q) { return friction("revolute", 0.2, q); }, turned},
          {"friction_prismatic", [=](const Config& q) { return friction("prismatic", 0, q); }, any},
          {"friction_cylindrical", [=](const Config& q) { return friction("cylindrical", 0.2, q); },
           [=](int seed) {
             const Values e = turned(seed);
             return Values{scatter(seed + 4), e[0], e[1]};
           }},
          {"friction_spherical", [=](const Config& q) { return friction("spherical", 0.2, q); },
           [](int seed) {
             const Mat3 R = turn(2 * scattered(seed));
             Values e{};
             for (int i = 0; i < 9; ++i) e[i] = R(i / 3, i % 3);
             return e;
           }}};
}

class Spring : public testing::TestWithParam<Kind> {
 protected:
  const hilo::Spring c = GetParam().make(somewhere(3));
  static double dot(const std::array<double, max_measures>& s, const Values& from, const Values& to) {
    double sum = 0;
    for (int i = 0; i < max_measures; ++i) sum += s[i] * (to[i] - from[i]);
    return sum;
  }
};
INSTANTIATE_TEST_SUITE_P(EveryKind, Spring, testing::ValuesIn(kinds()), [](const auto& p) { return p.param.name; });

// Truth: s.(e1 - e0) = W(e1) - W(e0) for finite steps, in and out of contact too.
TEST_P(Spring, WorkOfAStepIsTheChangeOfItsEnergy) {
  for (int seed = 0; seed < 40; ++seed) {
    const Values e0 = GetParam().state(seed), e1 = GetParam().state(1000 + seed);
    Response step, start;
    c.law->elastic(e0, e1, step), c.law->elastic(e0, e0, start);
    EXPECT_NEAR(dot(step.s, e0, e1), step.energy - start.energy, 1e-13 * (step.energy + start.energy + 1));
    EXPECT_GE(step.energy, 0);
  }
}

// Truth: D = ds/de1; central differences of step 1e-6 leave 1e-9 of truncation and 1e-9 of round-off.
TEST_P(Spring, TangentIsTheDerivativeOfItsForce) {
  for (int seed = 0; seed < 40; ++seed) {
    const Values e0 = GetParam().state(seed), e1 = GetParam().state(1000 + seed);
    const Interval step{0.1, 0.7, 40};
    Response at;
    c.law->elastic(e0, e1, at), c.law->viscous(e0, e1, step, at);
    for (int j = 0; j < max_measures; ++j) {
      Values up = e1, down = e1;
      up[j] += 1e-6, down[j] -= 1e-6;
      Response p, m;
      c.law->elastic(e0, up, p), c.law->viscous(e0, up, step, p);
      c.law->elastic(e0, down, m), c.law->viscous(e0, down, step, m);
      for (int i = 0; i < max_measures; ++i) EXPECT_NEAR(at.D[i][j], (p.s[i] - m.s[i]) / 2e-6, 1e-5 * (1 + std::abs(at.D[i][j]))) << i << j;
    }
  }
}

// Truth: a damper's force is a positive multiple of its rate, and what it does not give back is what it says it dissipated.
TEST_P(Spring, DamperTakesEnergyAndSaysHowMuch) {
  double total = 0;
  for (int seed = 0; seed < 40; ++seed) {
    const Values e0 = GetParam().state(seed), e1 = GetParam().state(1000 + seed);
    Response r;
    c.law->viscous(e0, e1, {0.05, 1, 300}, r);
    EXPECT_GE(r.dissipated, -1e-13);
    EXPECT_NEAR(dot(r.s, e0, e1), r.dissipated, 1e-12 * (1 + r.dissipated));
    total += r.dissipated;
  }
  EXPECT_GT(total, 0);
}

// Truth: Hooke at a standstill: W = k/2 x^2, force k x along the line that shortens the spring.
TEST(AxialSpring, PullsWithItsStiffnessTimesItsExtension) {
  const Config q = somewhere(3);
  const double length = (other_point - joint_point).norm(), k = 250, free = 1.1;
  const hilo::Spring c =
      make_axial_spring({.a = {1, -1}, .b = {2, -1}, .at_a = joint_point, .at_b = other_point, .stiffness = k, .length = free}, q);
  const Values e{c.value(0, q)};
  Response r;
  c.law->elastic(e, e, r);
  ConnectorGradient g;
  gradient(c, q, g);
  const Vec6 f = force_on_b(c, g, r.s.data(), q);
  const Vec3 expected = -k * (length - free) * (other_point - joint_point) / length;
  EXPECT_LT((f.head<3>() - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT(f.tail<3>().norm(), 1e-12 * expected.norm());
  EXPECT_NEAR(r.energy, k / 2 * (length - free) * (length - free), 1e-12);
}

// Truth: the angle of a spring that has been wound up three turns is 6 pi, not 0.
TEST(TorsionSpring, CountsItsTurns) {
  const Config q = somewhere(3);
  const hilo::Spring c = make_torsion_spring({.a = {1, -1}, .b = {2, -1}, .frame = some_frame(), .stiffness = 40}, q);
  const Vec3 axis = some_frame().col(2);
  double angle = 0;
  Values before{c.value(0, q), c.value(1, q)};
  double work = 0;
  while (angle < 6 * M_PI - 1e-9) {
    angle += M_PI / 4;
    Config turned = q;
    turned.R[2] = turn(angle * axis) * q.R[2];
    const Values now{c.value(0, turned), c.value(1, turned)};
    Response r;
    c.law->elastic(before, now, r);
    work += r.s[0] * (now[0] - before[0]) + r.s[1] * (now[1] - before[1]);
    EXPECT_NEAR(r.energy, 20 * angle * angle, 1e-10 * r.energy);
    EXPECT_NEAR(work, r.energy, 1e-11 * r.energy);
    c.law->commit(now, {});
    before = now;
  }
  ConnectorGradient g;
  Response r;
  c.law->elastic(before, before, r);
  gradient(c, q, g);
  const Vec6 f = force_on_b(c, g, r.s.data(), q);
  EXPECT_LT((f.tail<3>() + 40 * 6 * M_PI * axis).norm(), 1e-9) << "moment on b turns it back";
}

// Truth: the bushing's small-displacement limit is six independent springs in its frame.
TEST(Bushing, IsSixSpringsForSmallMotions) {
  const Config q = somewhere(3);
  const Mat3 frame = some_frame();
  const Vec3 k(100, 200, 50), ka(20, 10, 30), u(1e-6, -2e-6, 3e-6), w(2e-6, 1e-6, -1e-6);
  const hilo::Spring c =
      make_bushing({.a = {1, -1}, .b = {2, -1}, .at = joint_point, .frame = frame, .stiffness = {.along = k, .about = ka}}, q);
  Config p = q;
  const Mat3 B = turn(frame * w);
  p.c[2] = joint_point + B * (q.c[2] - joint_point) + frame * u, p.R[2] = B * q.R[2];
  const Values e = c.values(p);
  Response r;
  c.law->elastic(e, e, r);
  ConnectorGradient g;
  gradient(c, p, g);
  const Vec6 f = force_on_b(c, g, r.s.data(), p);
  EXPECT_LT((frame.transpose() * f.head<3>() + k.cwiseProduct(u)).norm(), 1e-9);
  EXPECT_LT((frame.transpose() * f.tail<3>() + ka.cwiseProduct(w)).norm(), 1e-9);
}

// Truth: moved a little, a compliant joint answers along and about each axis of its frame that it holds, and along no other.
TEST(CompliantJoint, IsASpringAlongWhatItHolds) {
  const Config q = somewhere(3);
  const Mat3 frame = some_frame();
  const Vec3 k(100, 200, 50), ka(20, 10, 30), u(1e-6, -2e-6, 3e-6), w(2e-6, 1e-6, -1e-6);
  const std::map<std::string, std::pair<Vec3, Vec3>> held{
      {"fixed", {{1, 1, 1}, {1, 1, 1}}},     {"spherical", {{1, 1, 1}, {0, 0, 0}}},         {"revolute", {{1, 1, 1}, {1, 1, 0}}},
      {"universal", {{1, 1, 1}, {0, 1, 0}}}, {"constant-velocity", {{1, 1, 1}, {0, 0, 1}}}, {"planar", {{0, 0, 1}, {1, 1, 0}}},
      {"in-plane", {{0, 0, 1}, {0, 0, 0}}},  {"in-line", {{1, 1, 0}, {0, 0, 0}}},           {"cylindrical", {{1, 1, 0}, {1, 1, 0}}},
      {"prismatic", {{1, 1, 0}, {1, 1, 1}}}};
  for (const auto& [kind, axes] : held) {
    ASSERT_FALSE(hilo::joint_kinds().at(kind).holds.empty());
    const hilo::Spring c = make_compliant(place(kind), {.along = k, .about = ka}, q);
    Config p = q;
    const Mat3 B = turn(frame * w);
    p.c[2] = joint_point + B * (q.c[2] - joint_point) + frame * u, p.R[2] = B * q.R[2];
    const Values e = c.values(p);
    Response r;
    c.law->elastic(e, e, r);
    ConnectorGradient g;
    gradient(c, p, g);
    const Vec6 f = force_on_b(c, g, r.s.data(), p);
    EXPECT_LT((frame.transpose() * f.head<3>() + k.cwiseProduct(axes.first).cwiseProduct(u)).norm(), 1e-9) << kind;
    EXPECT_LT((frame.transpose() * f.tail<3>() + ka.cwiseProduct(axes.second).cwiseProduct(w)).norm(), 1e-9) << kind;
  }
  EXPECT_EQ(missing_stiffness(hilo::joint_kinds().at("revolute"), {.along = k, .about = Vec3(1, 1, 0)}), "");
  EXPECT_EQ(missing_stiffness(hilo::joint_kinds().at("revolute"), {.along = k, .about = Vec3(1, 0, 1)}), "angular_stiffness");
  EXPECT_EQ(missing_stiffness(hilo::joint_kinds().at("in-plane"), {.along = Vec3(1, 1, 0), .about = ka}), "stiffness");
}

// Truth: a unilateral contact pushes when closed, never pulls, whatever its damper.
TEST(Support, NeverPulls) {
  const Config q = somewhere(3);
  const hilo::Spring c = make_support(
      {.a = {1, -1}, .b = {2, -1}, .at = joint_point, .frame = some_frame(), .stiffness = 900, .damping = 80, .rest_speed = 1e-3}, q);
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j) {
      Response r;
      const Values e0{0.01 * i}, e1{0.01 * j};
      c.law->elastic(e0, e1, r), c.law->viscous(e0, e1, {0.01}, r);
      EXPECT_LE(r.s[0], 1e-12) << "gap from " << e0[0] << " to " << e1[0];
      if (i > 0 && j > 0) {
        EXPECT_EQ(r.s[0], 0);
      }
      Response start;
      c.law->elastic(e0, e0, start);
      EXPECT_NEAR(r.s[0] * (e1[0] - e0[0]), r.energy - start.energy + r.dissipated, 1e-12);
      EXPECT_GE(r.dissipated, -1e-12);
    }
}

}  // namespace
}  // namespace hilo::test::spring_test
