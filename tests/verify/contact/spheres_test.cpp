// SPDX-License-Identifier: GPL-3.0-or-later
// Two spheres as meshes that do not match, in load steps, against Hertz (Johnson, Contact Mechanics, 1985, section 4.2).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "verify/contact/collision.hpp"

namespace hilo::test {
namespace {

constexpr double R = 0.05, E_star = 2e10 / (2 * (1 - 0.09)), R_star = R / 2;

/// From 0 to `to`: n cells of size h, then each q times the one before.
std::vector<double> graded(double h, int n, double q, double to) {
  std::vector<double> x{0};
  for (double step = h; x.back() < to; x.push_back(x.back() + step))
    if (static_cast<int>(x.size()) > n) step *= q;
  const double stretch = (to - x[n]) / (x.back() - x[n]);
  for (size_t k = n; k < x.size(); ++k) x[k] = x[n] + stretch * (x[k] - x[n]);
  return x;
}

/// A quarter of two half spheres that touch at the origin: columns over a square of this width, cells of a/n there.
Mesh spheres(double a, int n, double q, double width) {
  BlockOptions o[2];
  for (int s = 0; s < 2; ++s) {
    const double h = a / n * (s == 0 ? 1 : 1.1);
    const std::vector<double> x = graded(h, n + 1 - s, q, width), z = graded(h, 3, q, R);
    o[s].regions = {s == 0 ? "A" : "B"};
    o[s].n[0] = o[s].n[1] = static_cast<int>(x.size()) - 1, o[s].n[2] = static_cast<int>(z.size()) - 1;
    const auto at = [](const std::vector<double>& list, double share) {
      return list[static_cast<size_t>(std::lround(share * static_cast<double>(list.size() - 1)))];
    };
    o[s].map = [=](const Vec3& p) {
      const double x1 = at(x, p[0]), x2 = at(x, p[1]), low = R - std::sqrt(R * R - x1 * x1 - x2 * x2);
      const double height = low + (1 - low / R) * at(z, s == 0 ? 1 - p[2] : p[2]);
      return Vec3(x1, x2, s == 0 ? -height : height);
    };
  }
  Mesh mesh = together(block_mesh(o[0]), block_mesh(o[1]));
  for (const auto& [name, axis] : {std::pair{"x", 0}, {"y", 1}})
    add_node_set(mesh, name, [axis = axis](const Vec3& X) { return X[axis] < 1e-12 && std::abs(X[2]) < R - 1e-9; });
  return mesh;
}

/// The force of a quarter, at an approach [N].
double force_of_hertz(double approach) { return E_star * std::sqrt(R_star) * std::pow(approach, 1.5) / 3; }

// Truth: 586.1 kN at 4 mm (a = 10 mm).  There the strain is 0.14, and the pressure is no longer that of Hertz, nor is it in CalculiX.
TEST(Surfaces, SpheresOfHertz) {
  const Mesh mesh = spheres(0.01, 4, 1.35, 0.033);
  Case c("contact");
  c.use(mesh);
  const Results r = c.solved("", "run.h5", "spheres");
  EXPECT_NEAR(force_of_hertz(0.004), 586.1e3 / 4, 30);
  EXPECT_NEAR(r.history("contact/c").bottomRows(1)(0, 2), force_of_hertz(0.004), 0.01 * force_of_hertz(0.004));
  EXPECT_EQ(c.reported("cuts"), 0);
  EXPECT_LT(c.reported("newton_iterations"), 60);
  const Results two = c.solved("--set time.steps=2", "run.h5", "spheres");
  EXPECT_NEAR(two.history("contact/c").bottomRows(1)(0, 2) / r.history("contact/c").bottomRows(1)(0, 2), 1, 1e-8)
      << "however it came there";
}

// Truth: two equal spheres meet in a plane, which either may be.
TEST(Surfaces, ASphereOnAPlaneIsOneOfTwo) {
  Case c("contact");
  c.use(spheres(0.01, 4, 1.35, 0.033));
  const Results r = c.solved("", "run.h5", "on_plane");
  EXPECT_NEAR(r.history("contact/c").bottomRows(1)(0, 2), force_of_hertz(0.004), 0.01 * force_of_hertz(0.004));
  EXPECT_EQ(c.reported("cuts"), 0);
  EXPECT_LT(c.reported("newton_iterations"), 60);
}

// Truth: the pressure under a force, p0 sqrt(1 - r^2/a^2), whatever holds the spheres far away; a is 2 mm, the largest strain 0.03.
TEST(Surfaces, PressureOfHertzWhereStrainIsSmall) {
  const Mesh mesh = spheres(2e-3, 5, 1.45, 0.03);
  Case c("contact");
  c.use(mesh);
  const Results r = c.solved("--set time.steps=2 --set 'motion.pressed.displacement=[0,0,-1.6e-4]'", "run.h5", "spheres");
  const double F = r.history("contact/c").bottomRows(1)(0, 2);
  EXPECT_NEAR(F, force_of_hertz(1.6e-4), 0.02 * F) << "half spheres are not half spaces";
  const double a = std::cbrt(3 * 4 * F * R_star / (4 * E_star)), p0 = 2 * E_star * a / (std::numbers::pi * R_star);
  const auto stress = r.table("/field/" + r.steps().back() + "/stress");
  const auto pressure = r.table("/field/" + r.steps().back() + "/contact_pressure");
  double sum = 0, exact = 0, sum_of_pressures = 0;
  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i) {
    const double rho = mesh.X[i].head<2>().norm();
    if (std::abs(mesh.X[i][2]) > 2e-5 || rho > 0.7 * a) continue;
    sum -= stress(i, 2), exact += p0 * std::sqrt(1 - rho * rho / (a * a));
    sum_of_pressures += pressure(i, 0);
    EXPECT_NEAR(pressure(i, 0), p0 * std::sqrt(1 - rho * rho / (a * a)), 0.08 * p0) << rho;
    EXPECT_NEAR(-stress(i, 2), p0 * std::sqrt(1 - rho * rho / (a * a)), 0.08 * p0) << rho;
  }
  EXPECT_GT(exact, 20 * p0);
  EXPECT_NEAR(sum, exact, 0.03 * exact);
  EXPECT_NEAR(sum_of_pressures, exact, 0.03 * exact);
}

// NAFEMS R0094, problem 1: 35 kN a millimetre on a cylinder of steel of 50 mm, on aluminium.  Truth: Hertz, p0 3585 MPa and half width
// 6.21 mm.  The strain is 0.03 there: pressure and place are of the surface as it is.
TEST(Surfaces, CylinderOnABlock) {
  constexpr double thick = 1e-3, E = 1 / ((1 - 0.09) / 2.1e11 + (1 - 0.09) / 7e10), a = 6.21e-3, p0 = 3.585e9;
  constexpr int n = 24;
  BlockOptions o[2];
  const std::vector<double> x[2] = {graded(a / n, n + 3, 1.3, 0.1), graded(1.1 * a / n, n + 2, 1.3, 0.033)},
                            z[2] = {graded(a / n, 3, 1.3, 0.1), graded(a / n, 3, 1.3, R)};
  for (int s = 0; s < 2; ++s) {
    o[s].regions = {s == 0 ? "A" : "B"};
    o[s].n[0] = static_cast<int>(x[s].size()) - 1, o[s].n[1] = 1, o[s].n[2] = static_cast<int>(z[s].size()) - 1;
    const auto at = [](const std::vector<double>& list, double share) {
      return list[static_cast<size_t>(std::lround(share * static_cast<double>(list.size() - 1)))];
    };
    o[s].map = [&x, &z, at, s](const Vec3& p) {
      const double across = at(x[s], p[0]), low = s == 0 ? 0 : R - std::sqrt(R * R - across * across);
      return Vec3(across, thick * p[1], s == 0 ? -at(z[0], 1 - p[2]) : low + (1 - low / R) * at(z[1], p[2]));
    };
  }
  const Mesh block = block_mesh(o[0]);
  Mesh mesh = together(block, block_mesh(o[1]));
  const auto is_inside = [](const Vec3& X) { return X[2] > -0.1 + 1e-9 && X[2] < R - 1e-9; };
  add_node_set(mesh, "x", [&](const Vec3& X) { return X[0] < 1e-12 && is_inside(X); });
  add_node_set(mesh, "y", is_inside);
  Case c("contact");
  c.use(mesh);
  const Results r = c.solved("", "run.h5", "cylinder");
  const double F = 2 * r.history("contact/c").bottomRows(1)(0, 2) / thick;
  EXPECT_NEAR(F, 3.5e7, 0.01 * 3.5e7) << "the approach is chosen for it";
  EXPECT_NEAR(std::sqrt(F * E / (std::numbers::pi * R)), p0, 0.005 * p0);
  const auto u = r.table("/field/" + r.steps().back() + "/displacement");
  const auto pressure = r.table("/field/" + r.steps().back() + "/contact_pressure");
  double fitted = 0, width = 0;
  for (int s = 0; s < 2; ++s) {
    std::vector<std::array<double, 3>> at;  // X, x, and pressure of the reference area
    for (std::int64_t i = 0; i < mesh.n_nodes(); ++i) {
      const Vec3& X = mesh.X[i];
      const double surface = s == 0 ? 0 : R - std::sqrt(std::max(0., R * R - X[0] * X[0]));
      if ((i < block.n_nodes()) == (s == 0) && X[1] < 1e-9 && X[0] < 2 * a && std::abs(X[2] - surface) < 1e-9)
        at.push_back({X[0], X[0] + u(i, 0), pressure(i, 0)});
    }
    std::ranges::sort(at);
    ASSERT_GT(at.size(), size_t(n));
    double both = 0, square = 0, sum = 0, moment = 0;
    for (size_t k = 0; k + 1 < at.size(); ++k) {
      const double from = at[k][1], to = at[k + 1][1], now = (at[k + 1][0] - at[k][0]) / (to - from),
                   p = now * (at[k][2] + at[k + 1][2]) / 2, middle = (from + to) / 2;
      sum += p * (to - from), moment += p * (to - from) * middle;
      if (middle > 0.7 * a) continue;
      const double e = std::sqrt(1 - middle * middle / (a * a));
      both += p * e, square += e * e;
    }
    fitted += both / square / 2, width += moment / sum * 3 * std::numbers::pi / 4 / 2;
  }
  EXPECT_NEAR(fitted, p0, 0.03 * p0);
  EXPECT_NEAR(width, a, 0.03 * a);
}

}  // namespace
}  // namespace hilo::test
