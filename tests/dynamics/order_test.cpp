// Orders of position, velocity, acceleration and reaction of a brick hung at its corner (stability.md, PEND3D), against RK4 on Euler's
// equations in the test itself, which has neither joints nor multipliers.
#include "verify/verify.hpp"

namespace hilo::test {
namespace {

const char* const brick = R"(
gravity = [0, 0, -9.81]
[[body]]
name = "brick"
mass = 8
com = [0.5, 0.1, 0.2]
inertia = [0.13333333333333333, 0.77333333333333333, 0.69333333333333333]
[[joint]]
kind = "spherical"
name = "corner"
b = "brick"
at = [0, 0, 0]
[[initial]]
on = ["brick"]
spin = [0.5, 1, 2]
about = [0, 0, 0]
[[probe]]
name = "far"
on = "brick"
at = [1, 0.2, 0.4]
[[sensor]]
name = "seat"
on = "brick"
at = [1, 0.2, 0.4]
[time]
end = 1
step = 1e-3
)";

struct Truth {
  Vec3 x, v, a, force, felt;  // of the far corner; force of the pin; proper acceleration in body axes, g0
};

/// Euler's equations about the fixed corner, J_O w' = -w x J_O w + c x m g in inertial axes, by RK4 with 1e-4 s (error 1e-13).
Truth integrate(double end) {
  const Vec3 c0(0.5, 0.1, 0.2), g(0, 0, -9.81);
  const double m = 8;
  const Mat3 Jc = Vec3(0.13333333333333333, 0.77333333333333333, 0.69333333333333333).asDiagonal();
  const Mat3 JO = Jc + m * (c0.squaredNorm() * Mat3::Identity() - c0 * c0.transpose());
  struct State {
    Mat3 R;
    Vec3 w;
  };
  const auto spin_rate = [&](const State& s) -> Vec3 {
    const Mat3 J = s.R * JO * s.R.transpose();
    return J.inverse() * (-s.w.cross(J * s.w) + (s.R * c0).cross(m * g));
  };
  const auto rate = [&](const State& s) { return State{skew(s.w) * s.R, spin_rate(s)}; };
  const auto plus = [](const State& s, const State& d, double h) { return State{s.R + h * d.R, s.w + h * d.w}; };
  State s{Mat3::Identity(), Vec3(0.5, 1, 2)};
  const int n = static_cast<int>(std::lround(end / 1e-4));
  for (int i = 0; i < n; ++i) {
    const double h = end / n;
    const State k1 = rate(s), k2 = rate(plus(s, k1, h / 2)), k3 = rate(plus(s, k2, h / 2)), k4 = rate(plus(s, k3, h));
    s.R += h / 6 * (k1.R + 2 * k2.R + 2 * k3.R + k4.R), s.w += h / 6 * (k1.w + 2 * k2.w + 2 * k3.w + k4.w);
  }
  const Vec3 wd = spin_rate(s), x = s.R * Vec3(1, 0.2, 0.4), c = s.R * c0;
  const auto acceleration = [&](const Vec3& r) { return Vec3(wd.cross(r) + s.w.cross(s.w.cross(r))); };
  return {x, s.w.cross(x), acceleration(x), m * (acceleration(c) - g), s.R.transpose() * (acceleration(x) - g) / g0};
}

struct Errors {
  double x, v, a, force, felt;
};

Errors errors(const Workplace& w, double t, const std::string& h, const std::string& options) {
  w.write("scene.toml", brick);
  const Ran ran = w.run("hilo-solve --quiet scene.toml -o run.h5 --set time.step=" + h + " " + options);
  EXPECT_EQ(ran.exit, 0) << ran.err;
  const Results r(w / "run.h5");
  const auto p = r.at("probe/far", t);
  const Truth truth = integrate(t);
  return {(p.head<3>() - truth.x).norm(), (p.segment<3>(3) - truth.v).norm(), (p.tail<3>() - truth.a).norm(),
          (r.at("joint/corner", t).head<3>() - truth.force).norm(), (r.at("sensor/seat", t) - truth.felt).norm()};
}

void expect_second_order(double t, const std::string& options, const Errors& limit) {
  const Workplace w;
  const Errors coarse = errors(w, t, "2e-3", options), fine = errors(w, t, "5e-4", options);
  const auto order = [](double a, double b) { return std::log2(a / b) / 2; };
  if (t > 0) {
    EXPECT_GT(order(coarse.x, fine.x), 1.9);
    EXPECT_GT(order(coarse.v, fine.v), 1.9);
  }
  EXPECT_GT(order(coarse.a, fine.a), 1.8) << coarse.a << " " << fine.a;
  EXPECT_GT(order(coarse.force, fine.force), 1.8) << coarse.force << " " << fine.force;
  EXPECT_GT(order(coarse.felt, fine.felt), 1.8);
  EXPECT_LT(fine.x, limit.x);
  EXPECT_LT(fine.v, limit.v);
  EXPECT_LT(fine.a, limit.a);
  EXPECT_LT(fine.force, limit.force);
  EXPECT_LT(fine.felt, limit.felt);
}

TEST(EnergyMomentum, IsOfSecondOrderInPositionVelocityAccelerationAndReaction) {
  expect_second_order(0.5, "", {1e-5, 1e-4, 1e-3, 1e-3, 1e-4});
}
TEST(EnergyMomentum, IsOfSecondOrderInTheLastRowToo) { expect_second_order(1, "", {1e-5, 1e-4, 1e-3, 3e-3, 1e-4}); }
TEST(EnergyMomentum, IsOfSecondOrderInTheFirstRowToo) { expect_second_order(0, "", {1e-14, 1e-14, 1e-3, 1e-3, 1e-4}); }
TEST(GeneralizedAlpha, IsOfSecondOrderInPositionAndVelocity) {
  const Workplace w;
  const std::string ga = "--set 'time.integrator=\"generalized-alpha\"' --set time.rho=0.8";
  const Errors coarse = errors(w, 0.5, "2e-3", ga), fine = errors(w, 0.5, "5e-4", ga);
  EXPECT_GT(std::log2(coarse.x / fine.x) / 2, 1.9);
  EXPECT_GT(std::log2(coarse.v / fine.v) / 2, 1.9);
  EXPECT_LT(fine.x, 2e-5);
}

// Truth: a mass under a force that jumps has the acceleration F/m from the jump on and not a mean of before and after.
TEST(Recorder, TakesTheValueAfterALoadJump) {
  const Workplace w;
  w.write("scene.toml", R"(
[[body]]
name = "mass"
mass = 2
com = [0, 0, 0]
inertia = [1, 1, 1]
[[spring]]
kind = "axial"
name = "spring"
b = "mass"
at_a = [-3, 0, 0]
at_b = [0, 0, 0]
stiffness = 50
[[load]]
kind = "force"
name = "push"
on = "mass"
force = [10, 0, 0]
history = {t = [0.5, 0.5], value = [0, 1]}
[[probe]]
name = "mass"
on = "mass"
[time]
end = 1
step = 2e-3
)");
  const Ran ran = w.run("hilo-solve --quiet scene.toml -o run.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const Results r(w / "run.h5");
  EXPECT_NEAR(r.at("probe/mass", 0.498)[6], 0, 1e-10);
  EXPECT_NEAR(r.at("probe/mass", 0.5)[6], 5, 1e-3) << "5 cos 5 (t - 0.5) to second order";
  EXPECT_NEAR(r.at("probe/mass", 0.502)[6], 5 * std::cos(0.01), 1e-3);
  EXPECT_NEAR(r.at("spring/spring", 0.6)[0], -10 * (1 - std::cos(0.5)), 1e-3);
}

// Truth: a velocity along the rod cannot be; the projection takes exactly that part away (mass norm, point mass) and says how much.
TEST(InitialVelocities, AreProjectedOnTheJointsAndTheChangeIsReported) {
  const Workplace w;
  w.write("scene.toml", R"(
[[body]]
name = "bob"
mass = 2
com = [1, 0, 0]
[[joint]]
kind = "revolute"
name = "pin"
b = "bob"
at = [0, 0, 0]
axis = [0, 0, 1]
[[initial]]
on = ["bob"]
velocity = [0.25, 3, 0]
[[probe]]
name = "bob"
on = "bob"
[time]
end = 0.1
step = 0.01
)");
  const Ran ran = w.run("hilo-solve scene.toml -o run.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.err.find("initial velocities changed"), std::string::npos) << ran.err;
  const auto p = Results(w / "run.h5").at("probe/bob", 0);
  EXPECT_NEAR(p[3], 0, 1e-12);
  EXPECT_NEAR(p[4], 3, 1e-12);
}

// Truth: a hung scene at rest stays at rest: equilibrium of a mass on a spring is m g/k below the free length, and nothing moves
// afterwards.
TEST(Equilibrium, IsAStateTheRunStaysIn) {
  const Workplace w;
  w.write("scene.toml", R"(
gravity = [0, 0, -9.81]
[[body]]
name = "weight"
mass = 4
com = [0, 0, -1]
inertia = [0.1, 0.1, 0.1]
[[spring]]
kind = "axial"
name = "rope"
b = "weight"
at_a = [0, 0, 0]
at_b = [0, 0, -1]
stiffness = 1000
[[probe]]
name = "weight"
on = "weight"
[time]
start = "equilibrium"
end = 1
step = 0.01
)");
  const Ran ran = w.run("hilo-solve --quiet scene.toml -o run.h5");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto x = Results(w / "run.h5").history("probe/weight");
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    ASSERT_NEAR(x(i, 2), -1 - 4 * 9.81 / 1000, 1e-9);
    ASSERT_LT(x.row(i).segment(3, 3).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace hilo::test
