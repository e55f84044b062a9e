// SPDX-License-Identifier: GPL-3.0-or-later
// Centre of gravity and pivot force of the heavy top, integrated independently (RK4 on absolute coordinates, converged to
// 1e-9).
#include "verify/verify.hpp"

namespace hilo::test::heavy_top_test {
namespace {

TEST(HeavyTop, CentreIsWithinAMillimetreOverTwoSeconds) {
  const Case c("heavy_top");
  const Results r = c.solved();
  const std::pair<double, Vec3> table[] = {
      {0.1, {0.421296659, 0.894571974, -0.149164701}},   {0.2, {0.605550561, 0.598957682, -0.523983027}},
      {0.5, {-0.702468297, -0.021165185, -0.711400258}}, {1.0, {0.173343964, 0.640088592, -0.748490791}},
      {1.5, {-0.968165716, 0.250306062, -0.001422084}},  {2.0, {-0.150416823, -0.724165592, -0.673022270}}};
  for (const auto& [t, x] : table) EXPECT_LT((r.at("probe/cg", t).head<3>() - x).norm(), 1e-3) << "t = " << t << " s at h = 5e-5 s";
  // force on the ground, minus that on the top; the pivot's frame is the inertial one
  const std::pair<double, Vec3> forces[] = {
      {0.1, {361.056, 295.393, 212.267}}, {1.0, {517.601, 396.843, -404.575}}, {2.0, {260.735, -613.613, -309.717}}};
  for (const auto& [t, f] : forces) EXPECT_LT((-r.at("joint/pivot", t).head<3>() - f).norm(), 1e-3 * f.norm()) << "t = " << t;
}

// Truth: a symmetric top keeps its energy 5435.696790866 J and its spin about its own axis, 150 rad/s.
TEST(HeavyTop, KeepsEnergyAndSpin) {
  const Case c("heavy_top");
  const Results r = c.solved("--set time.step=1e-3");
  const auto e = r.history("energy");
  for (Eigen::Index i = 0; i < e.rows(); ++i) ASSERT_NEAR(e(i, 0) + e(i, 2), 5435.696790866, 1e-5);  // the table's digits
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * 5435.7);
  const auto points = r.history("body/top"), l = r.history("momentum");  // spin about the axis: L . axis = 0.46875 omega
  for (Eigen::Index i = 0; i < e.rows(); i += 50) {
    const Vec3 axis = points.row(i).head<3>().transpose();
    EXPECT_NEAR(l.row(i).tail<3>().dot(axis) / 0.46875, 150, 1e-3) << "to second order: velocities of directors are averaged over a step";
  }
}

TEST(HeavyTop, CentreConvergesAtSecondOrder) {
  const Case c("heavy_top");
  const Vec3 exact(0.605550561, 0.598957682, -0.523983027);
  const auto error = [&](const std::string& h) {
    return (c.solved("--set time.end=0.2 --set time.step=" + h).at("probe/cg", 0.2).head<3>() - exact).norm();
  };
  const double coarse = error("4e-4"), middle = error("2e-4"), fine = error("1e-4");
  EXPECT_NEAR(std::log2(coarse / middle), 2, 0.1);
  EXPECT_NEAR(std::log2(middle / fine), 2, 0.1);
}

}  // namespace
}  // namespace hilo::test::heavy_top_test
