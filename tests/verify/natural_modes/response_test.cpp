// SPDX-License-Identifier: GPL-3.0-or-later
// Responses by modes against closed forms: to forces and to a base that swings.
#include <complex>
#include <tuple>

#include "verify/natural_modes/natural_modes.hpp"

namespace hilo::test::response_test {
namespace {

// A force at the front shakes a vehicle of two freedoms; its damping is .01 s times its stiffness.
TEST_F(NaturalModes, GiveTheResponseToAHarmonicForce) {
  const double m = 1000, J = 1500, kf = 3e4, kr = 4e4, a = 1.2, b = 1.6;
  const auto corner = [](const std::string& name, double x, double k) {
    return bushing(name, "car", {x, 0, 0}, {0, 0, k}, "damping = " + list({0, 0, 0.01 * k})) +
           probe("at_" + name, "car", "at = " + list({x, 0, 0}));
  };
  modes(body("car", m, {0, 0, 0}, {J, J, J}) + corner("front", a, kf) + corner("rear", -b, kr) +
            axial("planar", "road", "ground", "car", Vec3::Zero(), Vec3::UnitY()),
        3);
  const Ran response =
      succeeded(work.run("hilo-post response run.h5 --force at_front.z --at at_front.z --at at_rear.z --from 0.2 --to 5 --points 50"));
  std::istringstream rows(response.out);
  std::string line;
  std::getline(rows, line);
  EXPECT_NE(line.find("at_rear.z [m/N]"), line.npos) << line;
  int n = 0;
  for (; std::getline(rows, line); ++n) {
    double f = 0, front = 0, front_phase = 0, rear = 0, rear_phase = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &f, &front, &front_phase, &rear, &rear_phase), 5) << line;
    using C = std::complex<double>;
    const double w = 2 * pi * f;
    const C visco(1, 0.01 * w), zz = (kf + kr) * visco - m * w * w, zp = -(kf * a - kr * b) * visco,
                                pp = (kf * a * a + kr * b * b) * visco - J * w * w, det = zz * pp - zp * zp;
    // under 1 N at x = a: heave u and pitch p, with z at x of u - x p
    const C u = (pp + zp * a) / det, p = (-zp - zz * a) / det;
    for (const auto& [at, size, phase] : {std::tuple{u - a * p, front, front_phase}, std::tuple{u + b * p, rear, rear_phase}}) {
      EXPECT_NEAR(size / std::abs(at), 1, 1e-4) << f;
      EXPECT_LT(std::abs(at / std::abs(at) - std::polar(1.0, phase * pi / 180)), 1e-4) << f;
    }
  }
  EXPECT_EQ(n, 50);
}

TEST_F(NaturalModes, GiveTheTransmissibilityOfAMassOnASpring) {
  const double m = 3, k = 1200, c = 20, w0 = std::sqrt(k / m), zeta = c / (2 * std::sqrt(k * m));
  modes(body("mass", m, {0, 0, 0}, {1, 1, 1}) + axial("prismatic", "guide", "ground", "mass", Vec3::Zero(), Vec3::UnitZ()) +
            bushing("s", "mass", Vec3::Zero(), {0, 0, 1200}, "damping = [0, 0, 20]") + probe("top", "mass", "at = [0, 0, 0]") +
            force("push", "mass", {4, 0, 2}) + force("swell", "mass", {0, 0, 8}, "history = {t = [0, 1], value = [0.5, 2]}"),
        3);
  const std::vector<Answer> pushed = answers(work.run("hilo-post response run.h5 --loads --at top.z --from 0.3 --to 30 --points 40"));
  EXPECT_EQ(pushed.size(), 40U);
  for (const Answer& a : pushed) {
    const double w = 2 * pi * a.f;
    EXPECT_LT(std::abs(std::polar(a.size, a.phase * pi / 180) / (6.0 / std::complex<double>(k - m * w * w, c * w)) - 1.0), 1e-5) << a.f;
  }
  const std::string command = "hilo-post response run.h5 --base z --at top.z --from 0.3 --to 30 --points 40 ";
  for (const bool relative : {false, true})
    for (const Answer& a : answers(work.run(command + (relative ? "--relative" : "--of acceleration")))) {
      const double r = 2 * pi * a.f / w0;
      const std::complex<double> bottom(1 - r * r, 2 * zeta * r),
          exact = relative ? -1.0 / (w0 * w0 * bottom) : std::complex<double>(1, 2 * zeta * r) / bottom;
      EXPECT_LT(std::abs(std::polar(a.size, a.phase * pi / 180) / exact - 1.0), 1e-5) << a.f;
    }
  EXPECT_EQ(work.run("hilo-post response run.h5 --at top.z").exit, 1) << "nothing swings";
  EXPECT_EQ(work.run("hilo-post response run.h5 --base z --force top.z").exit, 1) << "two things swing";
  EXPECT_EQ(work.run("hilo-post response run.h5 --base z").exit, 1) << "no probe";
  EXPECT_NE(work.run("hilo-post response run.h5 --base wall.z --at top.z").exit, 0) << "no such motion";
}

// The tip of a cantilever whose wall swings: (cos bL + cosh bL)/(1 + cos bL cosh bL), by all that stands still and by the motion's name.
TEST_F(NaturalModes, GiveTheSwingOfACantileverOnItsWall) {
  use(beam({1, 0.015, 0.01}, 30));
  modes(steel + motion("fixed", "wall", "xmin", "") + probe("tip", "xmax"), 20);
  for (const std::string base : {"z", "wall.z"}) {
    int n = 0;
    for (const Answer& a :
         answers(work.run("hilo-post response run.h5 --of acceleration --at tip.z --from 0.5 --to 80 --points 60 --base " + base))) {
      const double bl = std::sqrt(2 * pi * a.f / (r_z * wave)), top = std::cos(bl) + std::cosh(bl),
                   bottom = 1 + std::cos(bl) * std::cosh(bl);
      if (std::abs(bottom) < 0.2 * std::abs(top)) continue;  // near a resonance
      EXPECT_NEAR(a.size * (std::abs(a.phase) > 90 ? -1 : 1), top / bottom, 0.02 * std::abs(top / bottom)) << base << " " << a.f;
      ++n;
    }
    EXPECT_GT(n, 30);
  }
}

// A rod between two ends of which one swings along it: the middle by 1/(2 cos(k L/2)); of both it is 1/cos(k L/2).
TEST_F(NaturalModes, GiveTheSwingOfARodOnOneOfItsEnds) {
  use(block_mesh({.n = {10, 1, 1}, .high = {1, 0.05, 0.05}}));
  modes(steel + motion("fixed", "left", "xmin", "") + motion("fixed", "right", "xmax", "") + probe("middle", "block", "at = [0.5, 0, 0]"),
        108);
  const std::string command = "hilo-post response run.h5 --of acceleration --at middle.x --from 10 --to 1500 --points 20 ";
  for (const auto& [base, ends] : {std::pair{"--base left.x", 1}, std::pair{"--base left.x --base right.x", 2}, std::pair{"--base x", 2}})
    for (const Answer& a : answers(work.run(command + base))) {
      const double kl = 2 * pi * a.f / wave;
      EXPECT_NEAR(a.size, ends / (2 * std::cos(kl / 2)), 5e-3 * a.size) << base << " " << a.f;
    }
}

// Mass-proportional damping is a drag against space, which a base that swings pulls its parts through.
TEST_F(NaturalModes, OnABaseThatSwingsFeelTheDragOfSpace) {
  use(block_mesh({}));
  const double E = 1e6, moves = 1000, shared = 500,
               alpha = 6;  // one cell that is stretched: its tip has a third of 3000 kg, a sixth with the wall
  modes(solid(E, 0, 3000, "block", "", "mass_damping = 6") + motion("fixed", "wall", "xmin", "") + probe("tip", "xmax"), 10);
  for (const std::string base : {"x", "wall.x"})
    for (const Answer& a :
         answers(work.run("hilo-post response run.h5 --of acceleration --at tip.x --from 2 --to 10 --points 9 --base " + base))) {
      const std::complex<double> s(0, 2 * pi * a.f), inertia = s * s + alpha * s;
      const std::complex<double> exact = (E - shared * inertia) / (E + moves * inertia);
      EXPECT_LT(std::abs(std::polar(a.size, a.phase * pi / 180) / exact - 1.0), 1e-4) << base << " " << a.f;
    }
}

}  // namespace
}  // namespace hilo::test::response_test
