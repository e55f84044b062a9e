// SPDX-License-Identifier: GPL-3.0-or-later
// benchmarks.md O6, rj17 rj11 rj12: one mass on a guide and a spring, closed forms of the forced and of the damped oscillator.
#include "verify/verify.hpp"

namespace hilo::test {
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

TEST(GuidedMass, UndampedOscillatesAboutItsRestForAThousandRadians) {
  const Case c("guided_mass");
  const Ran ran = c.solve("--quiet", "run.h5", 0, "settling");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  EXPECT_NEAR(r.at("probe/mass", 1)[0], 0.914828, 5e-4);  // phase error of the method: omega t (omega h)^2/12 = 2e-4
}

TEST(GuidedMass, DampedSettlesAsTheClosedFormSays) {
  const Case c("guided_mass");
  const Ran ran = c.solve("--quiet --set spring.spring.damping=1e-7", "run.h5", 0, "settling");
  ASSERT_EQ(ran.exit, 0);
  const Results r = c.results();
  EXPECT_NEAR(r.at("probe/mass", 0.05)[0], 0.960246, 1e-4);
  EXPECT_NEAR(r.at("probe/mass", 0.1)[0], 1.278038, 1e-4);
  EXPECT_NEAR(r.at("probe/mass", 1)[0], 1.0000028, 1e-6);
  const auto x = r.history("probe/mass").col(0).eval();
  Eigen::Index top = 0;
  EXPECT_NEAR(x.maxCoeff(&top), 1.670535, 1e-5);
  EXPECT_NEAR(r.t()[top], 0.0319744, 5e-5);
  EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * r.history("energy").col(0).maxCoeff());
}

}  // namespace
}  // namespace hilo::test
