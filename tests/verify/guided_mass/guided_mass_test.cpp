// SPDX-License-Identifier: GPL-3.0-or-later
// FEBio rj17 rj11 rj12: one mass on a guide and a spring, closed forms of the forced and of the damped oscillator.
#include "verify/verify.hpp"

namespace hilo::test::guided_mass_test {
namespace {

// z(t) = 8/5 (7 + 8 cos 2 pi t) sin^4(pi t)
double exact(double t) { return 1.6 * (7 + 8 * std::cos(2 * M_PI * t)) * std::pow(std::sin(M_PI * t), 4); }

TEST(GuidedMass, FollowsItsForcedOscillation) {
  const Case c("guided_mass");
  EXPECT_NEAR(exact(0.25), 2.8, 1e-12);
  EXPECT_NEAR(exact(1.2), 1.8090170, 1e-7);
  const auto worst = [&](const std::string& step) {
    const Results r = c.solved("--set time.step=" + step);
    const auto x = r.history("probe/block");
    double error = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) error = std::max(error, std::abs(x(i, 2) - exact(r.t()[i])));
    return error;
  };
  const double coarse = worst("2e-3"), fine = worst("5e-4");
  EXPECT_LT(coarse, 0.005) << "FEBio's stored answer at this step is off by 0.021";
  EXPECT_LT(fine, 3e-4);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.05);
}

// m x" + d x' + k x = m g from rest at x = 0, where the spring is slack.  With w^2 = k/m, s = d/(2 m), v^2 = w^2 - s^2:
//   x = m g/k (1 - exp(-s t) (cos v t + s/v sin v t)),     highest at t = pi/v
struct Settling {
  double m = 4e-9, k = 3.924e-5, g = 9810, d = 0;  // settling.toml
  double rest() const { return m * g / k; }
  double w() const { return std::sqrt(k / m); }
  double s() const { return d / (2 * m); }
  double v() const { return std::sqrt(k / m - s() * s()); }
  double x(double t) const { return rest() * (1 - std::exp(-s() * t) * (std::cos(v() * t) + s() / v() * std::sin(v() * t))); }
};
constexpr double h = 5e-5;  // step of settling.toml

TEST(GuidedMass, UndampedOscillatesAboutItsRestForAThousandRadians) {
  const Case c("guided_mass");
  const Ran ran = c.solve("--quiet --set time.end=10", "run.h5", 0, "settling");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  const Settling exact;
  ASSERT_GT(exact.w() * 10, 990);
  const auto x = r.history("probe/mass");
  for (Eigen::Index i = 0; i < x.rows(); i += 100) {
    const double t = r.t()[i], late = exact.w() * t * std::pow(exact.w() * h, 4);  // phase, of fourth order by the clock
    ASSERT_NEAR(x(i, 0), exact.x(t), exact.rest() * late + 1e-9) << "t = " << t;
  }
}

TEST(GuidedMass, DampedSettlesAsTheClosedFormSays) {
  const Case c("guided_mass");
  const Ran ran = c.solve("--quiet --set spring.spring.damping=1e-7", "run.h5", 0, "settling");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  Settling exact;
  exact.d = 1e-7;
  const auto x = r.history("probe/mass").col(0).eval();
  // second order: phase w t (w h)^2/12 and damping s t (w h)^2/4 on what is left of the oscillation, at most 1e-5 of it
  for (Eigen::Index i = 0; i < x.size(); i += 100) ASSERT_NEAR(x[i], exact.x(r.t()[i]), 2e-5 * exact.rest()) << "t = " << r.t()[i];
  Eigen::Index top = 0;
  EXPECT_NEAR(x.maxCoeff(&top), exact.x(M_PI / exact.v()), 2e-5);
  EXPECT_NEAR(r.t()[top], M_PI / exact.v(), h);
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * r.history("energy").col(0).maxCoeff());
}

}  // namespace
}  // namespace hilo::test::guided_mass_test
