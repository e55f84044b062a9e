// SPDX-License-Identifier: GPL-3.0-or-later
// Stress where it matters, on the surface: NAFEMS LE10 on coarse meshes, and the rate on a thick tube (Lame) for every shape.
#include "physics/stress.hpp"
#include "verify/surface_stress/le10.hpp"

namespace hilo::test::surface_stress_test {
namespace {

// Truth: sigma_yy = -5.38 MPa at the hole's edge, on top, on the long axis (NAFEMS LE10).
TEST(SurfaceStress, OfCoarseLe10IsNearNafems) {
  for (const auto& [shape, n] :
       {std::pair{Shape::hex20, std::array{4, 6, 2}}, {Shape::hex20, {8, 12, 4}}, {Shape::wedge15, {4, 6, 2}}, {Shape::tet10, {4, 6, 2}}})
    EXPECT_LT(off_le10(shape, n), 0.035) << info(shape).name << " " << n[0] << " x " << n[1] << " x " << n[2];
}

/// Lame's thick tube from r = 1 to 2 under pressure p inside, plane strain: s_r, s_t = A -+ B/r^2, s_z = 2 nu A.
struct Tube {
  static constexpr double p = 1e4, A = p / 3, B = 4 * p / 3;
  static Vec6 stress(const Vec3& X) {
    const double r = std::hypot(X[0], X[1]), c = X[0] / r, s = X[1] / r, radial = A - B / (r * r), hoop = A + B / (r * r);
    Vec6 v;
    v << radial * c * c + hoop * s * s, radial * s * s + hoop * c * c, 0.6 * A, 0, 0, (radial - hoop) * c * s;
    return v;
  }
  double inner = 0, outer = 0;                    // largest error of the stress on the surfaces over p
  double estimate = 0, error = 0, recovered = 0;  // root integrals of squares: recovered less raw, exact less raw, exact less recovered
  double listed = 0;                              // root integral of the square of the file's stress_error
  Tube(Shape shape, int n) {
    SceneCase c(steel_block(
        2e11, held("ymin", "y") + held("ymax", "x") + held("ends", "z") + load("pressure", "inside", "xmin", "pressure = 1e4"), stresses));
    Mesh m = curved(shape, {n, n, 2}, [&](const Vec3& s) {
      const double angle = s[1] * std::numbers::pi / 2, r = 1 + s[0];
      return Vec3(r * std::cos(angle), r * std::sin(angle), 2 * s[2] / n);
    });
    add_node_set(m, "ends", [&](const Vec3& X) { return X[2] < 1e-9 || X[2] > 2.0 / n - 1e-9; });
    c.use(m);
    const Results run = c.solved();
    const auto s = run.table("/field/" + run.steps().back() + "/stress");
    for (std::int64_t a = 0; a < m.n_nodes(); ++a) {
      const double r = std::hypot(m.X[a][0], m.X[a][1]), off = (s.row(a).transpose() - stress(m.X[a])).norm() / p;
      if (r < 1 + 1e-9) inner = std::max(inner, off);
      if (r > 2 - 1e-9) outer = std::max(outer, off);
    }
    const auto u = run.field("displacement");
    const auto file = run.table("/field/" + run.steps().back() + "/stress_error");
    std::vector<StressPoint> points;
    for (std::int64_t e = 0; e < m.n_cells(); ++e) {
      std::vector<Vec3> X, x;
      for (const std::int64_t a : m.cell(e)) X.push_back(m.X[a]), x.push_back(m.X[a] + u[a]);
      stress_points(shape, StVenantKirchhoff{lame(2e11, 0.3)}, X, x, StressPoints::everywhere, points);
      for (const StressPoint& q : points) {
        Vec6 at = Vec6::Zero();
        double told = 0;
        for (size_t a = 0; a < X.size(); ++a) at += q.N[a] * s.row(m.cell(e)[a]).transpose(), told += q.N[a] * file(m.cell(e)[a], 0);
        const Vec6 raw = cauchy(q.F, q.S), exact = stress(q.X);
        const auto square = [&](double value) { return q.w * value * value; };
        estimate += square(von_mises(at - raw)), error += square(von_mises(exact - raw));
        recovered += square(von_mises(exact - at)), listed += square(told);
      }
    }
    for (double* value : {&estimate, &error, &recovered, &listed}) *value = std::sqrt(*value);
  }
};

// Truth: on the surface too the error falls with a power above that of the raw stress: 2 for quadratic cells, 1 for linear ones.
TEST(SurfaceStress, OfAThickTubeConvergesFasterThanTheCellsOwn) {
  for (const auto& [shape, inner, outer] :
       {std::tuple{Shape::hex20, 0.020, 2.2}, {Shape::wedge15, 0.022, 2.0}, {Shape::tet10, 0.025, 2.0}}) {
    const Tube coarse(shape, 4), fine(shape, 8);
    EXPECT_LT(fine.inner, inner) << info(shape).name;
    EXPECT_GT(std::log2(coarse.inner / fine.inner), outer) << info(shape).name;
    EXPECT_GT(std::log2(coarse.outer / fine.outer), 2.3) << info(shape).name;
  }
  const Tube coarse(Shape::hex8, 8), fine(Shape::hex8, 16);
  EXPECT_LT(fine.inner, 0.05);
  EXPECT_GT(std::log2(coarse.inner / fine.inner), 1.6);
}

// Truth: on linear cells recovered stress is nearer to the exact one than raw stress is, and what is between them is the error of the raw
// one. On quadratic ones raw stress is nearly as good inside and the difference, mostly at the surface, overstates the error.  It is never
// less.
TEST(SurfaceStress, ErrorIsNotLessThanThatOfTheRawStress) {
  for (const auto& [shape, most] : {std::pair{Shape::hex8, 1.1}, {Shape::hex20, 3.}, {Shape::wedge15, 2.}, {Shape::tet10, 2.}}) {
    const Tube tube(shape, 8);
    EXPECT_GT(tube.estimate, 0.9 * tube.error) << info(shape).name;
    EXPECT_LT(tube.estimate, most * tube.error) << info(shape).name;
    EXPECT_NEAR(tube.listed, tube.estimate, 0.05 * tube.estimate) << info(shape).name << ": the same as a field of nodes";
    if (shape == Shape::hex8) {
      EXPECT_LT(tube.recovered, 0.3 * tube.error);
    }
  }
}

}  // namespace
}  // namespace hilo::test::surface_stress_test
