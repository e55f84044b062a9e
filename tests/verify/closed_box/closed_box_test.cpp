// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure on a closed surface has the potential p V: E + p V stays, and so does the linear momentum.  V is the volume of the moved cells.
// The force is the mean over the path of the step, which keeps p V exactly and the angular momentum to second order.
#include "verify/free_bar.hpp"

namespace hilo::test::closed_box_test {
namespace {

const std::string scene = tumbling(soft_bar() + load("pressure", "pressure", "surface", "pressure = 2e5"), 1, 0.01,
                                   "interval = 0.01\nfields = [\"displacement\"]");

TEST(ClosedBox, EnergyPlusPressureTimesVolumeStays) {
  for (const Shape shape : {Shape::hex8, Shape::tet4, Shape::wedge6}) {
    SceneCase c(scene);
    const Mesh m = block_mesh({.shape = shape, .n = {3, 2, 2}, .high = {0.6, 0.3, 0.3}});
    c.use(m);
    const Results r = c.solved();
    const auto e = r.history("energy"), p = r.history("momentum");
    const double top = e.col(0).maxCoeff();
    double worst = 0, least = 1e300, most = 0;
    double first = 0;
    for (const std::string& step : r.steps()) {
      Mesh moved = m;
      const auto u = r.field("displacement", step);
      for (size_t a = 0; a < u.size(); ++a) moved.X[a] += u[a];
      double V = 0;
      for (std::int64_t k = 0; k < m.n_cells(); ++k) V += quality(moved, k).volume;
      const auto i = r.index(r.field_time(step));
      const double total = e(i, 0) + e(i, 1) + 2e5 * V;
      if (step == r.steps().front()) first = total;
      worst = std::max(worst, std::abs(total - first)), least = std::min(least, V), most = std::max(most, V);
    }
    EXPECT_LT(worst, 1e-10 * top) << info(shape).name;
    EXPECT_GT(2e5 * (most - least), 1e-3 * top) << "the volume really changes";
    for (Eigen::Index i = 0; i < p.rows(); ++i) {
      ASSERT_LT((p.row(i).head<3>() - p.row(0).head<3>()).norm(), 1e-10 * 54 * 15 * 0.3) << info(shape).name;
    }
  }
}

TEST(ClosedBox, AngularMomentumIsKeptToSecondOrder) {
  SceneCase c(scene);
  c.use(block_mesh({.n = {3, 2, 2}, .high = {0.6, 0.3, 0.3}}));
  const auto drift = [&](const char* step) {
    const auto p = c.solved(std::string("--set output.interval=1 --set time.end=0.5 --set time.step=") + step).history("momentum");
    return (p.rightCols(3).rowwise() - p.row(0).tail<3>()).rowwise().norm().maxCoeff() / p.row(0).tail<3>().norm();
  };
  const double coarse = drift("5e-3"), fine = drift("1.25e-3");
  EXPECT_LT(coarse, 1e-2);
  EXPECT_GT(std::log2(coarse / fine) / 2, 1.6);
}

}  // namespace
}  // namespace hilo::test::closed_box_test
