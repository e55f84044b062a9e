// SPDX-License-Identifier: GPL-3.0-or-later
// IVP test set "andrews", PSIDE at 1e-14: angles of the crank, of K3 and of K5 after 0.03 s, 2.5 turns of the crank.
#include "verify/verify.hpp"

namespace hilo::test::squeezer_test {
namespace {

struct Angles {
  double beta, gamma, delta;
};

Angles errors(const std::string& step, const std::string& options = "", double balance = 1e-9) {
  const Case c("squeezer");
  const Results r = c.solved("--set time.step=" + step + " " + options);
  const auto e = r.history("energy");
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), balance * e.col(0).maxCoeff()) << "IFToMM's measure";
  const Vec3 P = r.at("probe/P", 0.03).head<3>(), Q = r.at("probe/Q", 0.03).head<3>(), H = r.at("probe/H", 0.03).head<3>();
  const auto turn = [](double a) { return std::remainder(a, 2 * M_PI); };
  return {turn(std::atan2(P.y(), P.x()) - 15.81077119629904), turn(std::atan2(Q.x() + 0.03635, 0.03273 - Q.y()) - 0.04082224013073101),
          turn(std::atan2(H.y() + 0.00227, H.x() + 0.06934) - 0.5244099658805304)};
}

TEST(Squeezer, AnglesConvergeToTheReferenceAtSecondOrder) {
  const Angles coarse = errors("2e-5"), fine = errors("5e-6");
  EXPECT_LT(std::abs(fine.beta), 1e-3);
  EXPECT_LT(std::abs(fine.gamma), 1e-4);
  EXPECT_LT(std::abs(fine.delta), 1e-4);
  EXPECT_NEAR(std::log2(std::abs(coarse.beta / fine.beta)) / 2, 2, 0.1);
}

// PSIDE's reference has 14 digits; Radau IIA meets as many of them as its step allows.
TEST(Squeezer, RadauMeetsThePublishedDigits) {
  const Angles a = errors("2e-5", "--set 'time.integrator=\"radau\"' --set solver.tolerance=1e-12", 1e-6);
  EXPECT_LT(std::abs(a.beta), 1e-6);
  EXPECT_LT(std::abs(a.gamma), 1e-8);
  EXPECT_LT(std::abs(a.delta), 1e-8);
}

// IFToMM A03 as it is run: 0.05 s, the energy balance the measure of error.
TEST(Squeezer, BalanceOfEnergyHoldsTo50Milliseconds) {
  const Case c("squeezer");
  const auto e = c.solved("--set time.end=0.05 --set time.step=2e-5").history("energy");
  double worst = 0;
  for (Eigen::Index i = 0; i < e.rows(); ++i) worst = std::max(worst, std::abs(e(i, 0) + e(i, 1) - e(0, 0) - e(0, 1) - e(i, 3)));
  EXPECT_LT(worst, 1e-10 * e.col(0).maxCoeff());
}

}  // namespace
}  // namespace hilo::test::squeezer_test
