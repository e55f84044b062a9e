// SPDX-License-Identifier: GPL-3.0-or-later
// Stress at nodes where it has a kink: a thick tube whose inner part yields, plane strain, no hardening.
#include "physics/stress.hpp"
#include "verify/plasticity/hill.hpp"
#include "verify/surface_stress/le10.hpp"

namespace hilo::test::yielding_test {
namespace {

/// Largest error of the nodal von Mises stress over the yield stress, n cells of hex20r through the wall, loaded to `pressure`.
/// Truth: the yield stress where it yields.  Outside Lame's stress C (1 -+ b^2/r^2), with C from the displacement of the outer face,
/// u = 2 (1 - nu^2) C b/E, and the border where this reaches the yield stress.
double off_yielding(Shape shape, int n, double pressure) {
  constexpr double a = 0.1, b = 0.2, E = 210e9, nu = 0.3, yield = 0.24e7;
  SceneCase c(hill_cylinder(pressure / 0.18));
  Mesh m = curved(shape, {n, n, 1}, [&](const Vec3& s) {
    const double angle = s[1] * std::numbers::pi / 2, r = a + (b - a) * s[0];
    return Vec3(r * std::cos(angle), r * std::sin(angle), 0.02 * s[2]);
  });
  add_node_set(m, "left", [](const Vec3& x) { return x[0] < 1e-9; });
  add_node_set(m, "bottom", [](const Vec3& x) { return x[1] < 1e-9; });
  add_node_set(m, "outer", [](const Vec3& x) { return x[1] < 1e-9 && x[0] > b - 1e-9 && x[2] < 1e-9; });
  c.use(m);
  const Results r = c.solved();
  const auto at = r.history("probe/outer");
  const double C = (at(at.rows() - 1, 0) - b) * E / (2 * (1 - nu * nu) * b);
  const auto s = r.table("/field/" + r.steps().back() + "/stress");
  double worst = 0;
  for (std::int64_t i = 0; i < m.n_nodes(); ++i) {
    const double radius = m.X[i].head<2>().norm(), shear = C * b * b / (radius * radius);
    const double truth = std::min(yield, std::sqrt(3 * shear * shear + std::pow(C * (1 - 2 * nu), 2)));
    Vec6 S = s.row(i).transpose();
    worst = std::max(worst, std::abs(von_mises(S) - truth) / yield);
  }
  return worst;
}

// Truth: above.  The kink lies within a cell, at another place in each: cubics are no worse there than quadratics (11.7, 2.4, 1.0 %).
TEST(SurfaceStress, WhereATubeYieldsConverges) {
  const std::array<int, 3> cells{4, 8, 16};
  const std::array<double, 3> most{0.09, 0.035, 0.012};
  for (int k = 0; k < 3; ++k)
    for (const double pressure : {1.2e6, 1.4e6, 1.5e6, 1.6e6, 1.7e6, 1.8e6})
      EXPECT_LT(off_yielding(Shape::hex20r, cells[k], pressure), most[k]) << cells[k] << " cells, " << pressure << " Pa";
}

}  // namespace
}  // namespace hilo::test::yielding_test
