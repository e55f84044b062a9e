// SPDX-License-Identifier: GPL-3.0-or-later
// Beams whose section varies along them, against closed forms and integrals over their length.
#include "verify/beams/beam_scene.hpp"

namespace hilo::test::beams_taper_test {
namespace {

constexpr double pi = std::numbers::pi, E = 2e11, G = E / 2.6, rho = 7800;

class BeamTaper : public BeamPlace {};

/// A beam of steel from section "s" to section "e".
std::string taper_of(const std::string& root, const std::string& end, const std::string& points, int cells) {
  return "[section.s]\n" + root + "\n[section.e]\n" + end + "\n[material.m]\nE = 2e11\nnu = 0.3\ndensity = 7800\n" +
         beam_of(points, cells, "section_end = \"e\"\nmaterial = \"m\"\na = \"ground\"");
}
std::string rectangle(double b, double h) { return fmt::format("kind = \"rectangle\"\nwidth = {}\nheight = {}", b, h); }
std::string circle(double d) { return fmt::format("kind = \"circle\"\ndiameter = {}", d); }

/// The integral over 0 to 1, by Simpson.
double integral(const std::function<double(double)>& f) {
  constexpr int n = 2000;
  double sum = f(0) + f(1);
  for (int i = 1; i < n; ++i) sum += (i % 2 ? 4 : 2) * f(static_cast<double>(i) / n);
  return sum / (3 * n);
}

// int m^2/EI + v^2/kGA, int n^2/EA, int t^2/GJ: a rectangle of half the height and two thirds of the width at its tip.
TEST_F(BeamTaper, EndLoadsMeetTheIntegralsOfCompliance) {
  const double L = 1.5, k = 13.0 / (12 + 3.3);
  const auto b = [](double s) { return 0.03 - 0.01 * s; };
  const auto h = [](double s) { return 0.06 - 0.03 * s; };
  const double up =
      integral([&](double s) { return L * (std::pow(L * (1 - s), 2) / (E * b(s) * std::pow(h(s), 3) / 12) + 1 / (k * G * b(s) * h(s))); });
  const double across =
      integral([&](double s) { return L * (std::pow(L * (1 - s), 2) / (E * h(s) * std::pow(b(s), 3) / 12) + 1 / (k * G * b(s) * h(s))); });
  const double stretch = integral([&](double s) { return L / (E * b(s) * h(s)); });
  const Vec3 along = Vec3(1, 2, -0.5).normalized(), axis2 = (Vec3::UnitZ() - along.z() * along).normalized(), axis1 = axis2.cross(along);
  const std::string end = fmt::format("[[0, 0, 0], [{:.17g}, {:.17g}, {:.17g}]]", L * along.x(), L * along.y(), L * along.z());
  for (const int n : {1, 4}) {
    const std::string beam = taper_of(rectangle(0.03, 0.06), rectangle(0.02, 0.03), end, n) + tip_probe() + in_steps(1);
    const Vec3 u = tip(beam + push("arm.end", 0.03 * axis1 + 0.05 * axis2)) - L * along;
    const Vec3 pulled = tip(beam + push("arm.end", 20 * along)) - L * along;
    EXPECT_NEAR(u.dot(axis2) / (0.05 * up), 1, n == 1 ? 3e-4 : 1e-5);
    EXPECT_NEAR(u.dot(axis1) / (0.03 * across), 1, n == 1 ? 3e-4 : 1e-5);
    EXPECT_NEAR(pulled.dot(along) / (20 * stretch), 1, n == 1 ? 1e-5 : 1e-6);
  }
}

// The twist of a cone, 32 T L/(3 pi G) (d1^2 + d1 d0 + d0^2)/(d0 d1)^3, and its weight.
TEST_F(BeamTaper, AConeTwistsAndWeighsAsItShould) {
  const double L = 2, d0 = 0.06, d1 = 0.03, T = 5, mass = rho * pi / 12 * L * (d0 * d0 + d0 * d1 + d1 * d1);
  const Results r = solved("gravity = [0, 0, -9.81]\n" + taper_of(circle(d0), circle(d1), "[[0, 0, 0], [2, 0, 0]]", 2) +
                           twist("arm.end", Vec3(T, 0, 0)) + in_steps(1));
  const Eigen::VectorXd f = r.history("beam/arm").bottomRows(1).transpose();
  EXPECT_NEAR(f.head<3>().norm(), 9.81 * mass, 1e-9 * 9.81 * mass);
  const Eigen::MatrixXd x = r.history("body/arm.2");
  const auto across = [&](Eigen::Index row) -> Vec3 { return (x.row(row).segment<3>(6) - x.row(row).head<3>()).transpose(); };
  const Vec3 n0 = across(0), n1 = across(x.rows() - 1);
  const double angle = 32 * T * L / (3 * pi * G) * (d0 * d0 + d0 * d1 + d1 * d1) / std::pow(d0 * d1, 3);
  EXPECT_NEAR(std::atan2(n0.cross(n1).x(), n0.y() * n1.y() + n0.z() * n1.z()), angle, 2e-4 * angle);
}

// A wedge and a cone that end in an edge and a point have the frequencies 5.315 and 8.719 sqrt(EI/(rho A))/L^2 of their roots [Kirchhoff
// 1879].
TEST_F(BeamTaper, WedgeAndConeHaveKirchhoffsFrequencies) {
  const double L = 2, d = 0.02;
  const auto first = [&](const std::string& root, const std::string& end) {
    return 2 * pi * frequencies(taper_of(root, end, "[[0, 0, 0], [2, 0, 0]]", 64), 1)[0];
  };
  const double wedge = std::sqrt(E * d * d / 12 / rho) / (L * L), cone = std::sqrt(E * d * d / 16 / rho) / (L * L);
  EXPECT_NEAR(first(rectangle(0.2, d), rectangle(0.2, d / 2000)) / wedge, 5.315, 0.002 * 5.315);
  EXPECT_NEAR(first(circle(d), circle(d / 2000)) / cone, 8.719, 0.002 * 8.719);
}

// Stress by the section where it is: 32 F (L - x)/(pi d(x)^3), largest where d is half as large again as at the tip.
TEST_F(BeamTaper, StressIsThatOfTheSectionThere) {
  const double F = 2, L = 1.2, d0 = 0.04, d1 = 0.02;
  const auto at =
      curves(taper_of(circle(d0), circle(d1), fmt::format("[[0, 0, 0], [{}, 0, 0]]", L), 4) + push("arm.end", Vec3(0, 0, F)) + in_steps(1));
  ASSERT_EQ(at.at("s").size(), 8u);
  for (size_t i = 0; i < 8; ++i) {
    const double x = at.at("s")[i], d = d0 + (d1 - d0) * x / L;
    EXPECT_NEAR(at.at("high")[i], 32 * F * (L - x) / (pi * d * d * d), 1e-5 * 32 * F * L / (pi * d0 * d0 * d0));
  }
}

// With d along z from its apex, EI y'' + P y = 0 is y = z sin(q/z1 - q/z), q = z0^2 sqrt(P/EI0): y' = 0 at the root z0.
TEST_F(BeamTaper, AConeBucklesAtItsExactLoad) {
  const double L = 2, d0 = 0.06, d1 = 0.03, z0 = L * d0 / (d0 - d1), z1 = z0 - L, EI0 = E * pi * std::pow(d0, 4) / 64;
  double low = pi / 2, high = pi;  // phi = q/z1 - q/z0, tan(phi) = -q/z0
  for (int i = 0; i < 60; ++i) {
    const double phi = (low + high) / 2, q = phi / (1 / z1 - 1 / z0);
    (std::tan(phi) + q / z0 < 0 ? low : high) = phi;
  }
  const double q = low / (1 / z1 - 1 / z0), exact = EI0 * std::pow(q / (z0 * z0), 2);
  work.write("scene.toml", taper_of(circle(d0), circle(d1), "[[0, 0, 0], [0, 0, 2]]", 12) + push("arm.end", Vec3(0, 0, -1)) +
                               "[time]\nanalysis = \"buckling\"\nmodes = 1\n");
  succeeded(work.run("hilo-solve scene.toml -o run.h5"));
  EXPECT_NEAR(Results(work / "run.h5").history("buckling")(1, 0) / exact, 1, 2e-3);  // shear takes 1e-3
}

TEST_F(BeamTaper, WhatCannotTaperIsRefused) {
  const auto refused = [&](const std::string& root, const std::string& end, const std::string& points, const std::string& what) {
    work.write("scene.toml", taper_of(root, end, points, 2) + in_steps(1));
    expect_end(work.run("hilo-solve scene.toml -o run.h5"), 2, what);
  };
  const std::string straight = "[[0, 0, 0], [1, 0, 0]]";
  refused(circle(0.1), rectangle(0.1, 0.1), straight, "scene.toml:16:");
  refused(circle(0.1), rectangle(0.1, 0.1), straight, "sections \"s\" and \"e\" are of the kinds circle and rectangle");
  refused(circle(0.1), circle(0.1) + "\nshear = [0.8]", straight, "one alone has shear");
}

}  // namespace
}  // namespace hilo::test::beams_taper_test
