// SPDX-License-Identifier: GPL-3.0-or-later
// Tip of the beam in the frame of the hub: u2 least -0.57385 at 6.7625 s, steady u1 = 5.14e-4 by centrifugal stretch.
#include "verify/spin_up/spin_up.hpp"

namespace hilo::test::spin_up_test {
namespace {

/// By every cell, and by 25 modes with strains of the second degree: the spin is half again the first frequency.
class SpinUp : public testing::TestWithParam<Fidelity> {};
TEST_P(SpinUp, TipBendsBackAndIsStretchedAsTheBeamSolution) {
  const double h = 0.0774597;
  SceneCase c("");
  c.write("scene.toml", solid(4.666667e9, 1. / 6, 200, "block", "", GetParam() == Fidelity::linear ? "stiffening = true" : "") +
                            SpinUpBeam::turned(c, "xmin") + probe("tip", "xmax") + in_time(18, 0.02) + "[output]\ninterval = 18\n");
  c.use(block_mesh({.n = {20, 1, 1}, .low = Vec3(0, -h / 2, -h / 2), .high = Vec3(10, h / 2, h / 2)}), {GetParam()});
  const Results r = c.solved();
  const auto x = r.history("probe/tip");
  const auto in_hub = [&](Eigen::Index i) { return SpinUpBeam::in_hub(r.t()[i], x.row(i).head<3>()); };
  double most = 0;
  for (int t = 2; t <= 12; ++t) {
    const double off = std::abs(in_hub(r.index(t))[1] - SpinUpBeam::u2[t]) / 0.57385;
    EXPECT_LT(off, 0.01) << "t = " << t;
    most = std::max(most, off);
  }
  double least = 0, when = 0, steady = 0, swing = 0;
  int n = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Vec3 u = in_hub(i);
    if (u[1] < least) least = u[1], when = r.t()[i];
    if (r.t()[i] > 15.5) steady += u[0], swing = std::max(swing, std::abs(u[1])), ++n;
  }
  std::printf("u2: largest error %.2g %% of the largest deflection; least %.5f at %.2f s; u1 at the end %.4g\n", 100 * most, least, when,
              steady / n);
  EXPECT_NEAR(least, -0.57385, 0.01 * 0.57385);
  EXPECT_NEAR(when, 6.7625, 0.05);
  EXPECT_NEAR(steady / n, 5.14e-4, 0.03 * 5.14e-4);
  EXPECT_LT(swing, 0.01);
  EXPECT_NEAR(in_hub(r.index(6))[0], -0.016971, 0.03 * 0.017);
  EXPECT_NEAR(in_hub(r.index(7))[0], -0.018619, 0.03 * 0.0187);
}

INSTANTIATE_TEST_SUITE_P(Levels, SpinUp, testing::Values(Fidelity::nonlinear, Fidelity::linear),
                         [](const auto& p) { return std::string(word(p.param)); });

}  // namespace
}  // namespace hilo::test::spin_up_test
