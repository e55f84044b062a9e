// SPDX-License-Identifier: GPL-3.0-or-later
// Tip of the beam in the frame of the hub: u2 least -0.57385 at 6.7625 s, steady u1 = 5.14e-4 by centrifugal stretch.
#include "succeeded.hpp"
#include "verify/verify.hpp"

namespace hilo::test::spin_up_test {
namespace {

double psi(double t) { return t < 15 ? 0.4 * (t * t / 2 + std::pow(7.5 / M_PI, 2) * (std::cos(2 * M_PI * t / 15) - 1)) : 6 * t - 45; }

/// By every cell, and by 25 modes with strains of the second degree: the spin is half again the first frequency.
class SpinUp : public testing::TestWithParam<Fidelity> {};
TEST_P(SpinUp, TipBendsBackAndIsStretchedAsTheBeamSolution) {
  Case c("spin_up");
  BlockOptions o{.n = {20, 1, 1}};
  const double h = 0.0774597;
  o.low = Vec3(0, -h / 2, -h / 2), o.high = Vec3(10, h / 2, h / 2);
  c.use(block_mesh(o), {GetParam()});
  std::string csv = "t,psi\n";
  char line[80];
  for (int i = 0; i <= 900; ++i) std::snprintf(line, sizeof line, "%.17g,%.17g\n", 0.02 * i, psi(0.02 * i)), csv += line;
  c.write("spin.csv", csv);
  c.write("scene.toml", text_of(c.source("scene.toml")));
  const std::string stiffens = GetParam() == Fidelity::linear ? " --set region.block.stiffening=true" : "";
  succeeded(c.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5" + stiffens));
  const Results r = c.results();
  const auto x = r.history("probe/tip");
  const auto in_hub = [&](Eigen::Index i) -> Vec3 {
    return Eigen::AngleAxisd(-psi(r.t()[i]), Vec3::UnitZ()) * Vec3(x(i, 0), x(i, 1), x(i, 2)) - Vec3(10, 0, 0);
  };
  const std::pair<int, double> table[] = {{2, -0.10238}, {3, -0.21726}, {4, -0.34227},  {5, -0.46846},  {6, -0.54360}, {7, -0.57133},
                                          {8, -0.54288}, {9, -0.46032}, {10, -0.36287}, {11, -0.25740}, {12, -0.15093}};
  double most = 0;
  for (const auto& [t, u2] : table) {
    EXPECT_NEAR(in_hub(r.index(t))[1], u2, 0.01 * 0.57385) << "t = " << t;
    most = std::max(most, std::abs(in_hub(r.index(t))[1] - u2) / 0.57385);
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
