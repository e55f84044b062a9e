// SPDX-License-Identifier: GPL-3.0-or-later
// Axial stress in beams that twist: fibres are inclined, so that tension resists a twist and compression drives it [wagner-1936].
#include "verify/beams/beam_scene.hpp"

namespace hilo::test::twist_test {
namespace {

constexpr double pi = std::numbers::pi, E = 2.1e11, G = E / 2.6;

std::string made_of(const std::string& section, const std::string& orientation = "") {
  return fmt::format("[section.s]\n{}\n[material.m]\nE = {}\nnu = 0.3\ndensity = 7850\n{}", section, E, orientation);
}
/// Saint-Venant's constant of a strip b x t.
double of_strip(double b, double t) { return b * t * t * t / 3 * (1 - 0.630 * t / b); }

class BeamTwist : public BeamPlace {
 protected:
  /// A strip of 50 x 1 mm, half a metre long, clamped at one end: the turn of the other, and how far it comes nearer.
  std::pair<double, double> strip(double pull, double torque, const std::string& fidelity = "") {
    const Results r = solved(made_of("kind = \"rectangle\"\nwidth = 0.05\nheight = 0.001") +
                             beam_of("[[0, 0, 0], [0.5, 0, 0]]", 8, "material = \"m\"\na = \"ground\"\n" + fidelity) +
                             push("arm.end", {pull, 0, 0}) + twist("arm.end", {torque, 0, 0}) + in_steps(4));
    const Eigen::RowVectorXd x = r.history("body/arm.8").bottomRows(1);
    return {std::atan2(x[8] - x[2], x[7] - x[1]), 0.5 - x[0]};
  }
  /// The smallest factor of the loads, and that of the reversed ones.
  std::pair<double, double> factors(const std::string& scene) {
    work.write("scene.toml", scene + "[time]\nanalysis = \"buckling\"\nmodes = 6\n");
    succeeded(ran = work.run("hilo-solve scene.toml -o run.h5"));
    const Eigen::VectorXd rows = Results(work / "run.h5").history("buckling").bottomRows(6).col(0);
    double one = 1e300, other = 1e300;
    for (const double x : rows) (x > 0 ? one : other) = std::min(x > 0 ? one : other, std::abs(x));
    return {one, other};
  }
};

// T = (GJ + N Ip/A) w + E (int r^4 - Ip^2/A) w^3/2, w the twist by length, and the strip comes nearer by Ip/A w^2/2.
TEST_F(BeamTwist, AStripResistsItByItsTensionAndByItself) {
  const double b = 0.05, t = 0.001, A = b * t, Ip = b * t * (b * b + t * t) / 12, GJ = G * of_strip(b, t);
  const double warp = E * t * std::pow(b, 5) / 180;
  const auto turn = [&](double N, double T) {
    double w = 0;
    for (int i = 0; i < 50; ++i) w -= ((GJ + N * Ip / A) * w + warp / 2 * w * w * w - T) / (GJ + N * Ip / A + 1.5 * warp * w * w);
    return w;
  };
  const auto [pulled, stretched] = strip(10e3, 0.5);
  EXPECT_NEAR(pulled, 0.5 * turn(10e3, 0.5), 3e-3 * pulled) << "2.7 times as far without";
  EXPECT_LT(strip(0, 0.5).first, 0.5 * 0.5 / GJ);
  const auto [far, nearer] = strip(0, 5);
  EXPECT_NEAR(far, 0.5 * turn(0, 5), 3e-3 * far) << "Weber: 1.7 times as far without";
  EXPECT_NEAR(nearer, 0.5 * Ip / A * std::pow(far / 0.5, 2) / 2, 0.01 * nearer);
}

// An equal angle under compression turns about its corner at GJ/r0^2 (2 % less as it bends with it), and is stable in tension.
TEST_F(BeamTwist, AnAngleTwistsUnderCompressionAndNotUnderTension) {
  const double b = 0.1, t = 0.003, A = t * (2 * b - t);
  const double c = (b * t * b / 2 + (b - t) * t * t / 2) / A, e = std::numbers::sqrt2 * (c - t / 2);
  const double I = (t * b * b * b + (b - t) * t * t * t) / 12 + b * t * std::pow(b / 2 - c, 2) + (b - t) * t * std::pow(t / 2 - c, 2);
  const double r2 = 2 * I / A + e * e, GJ = G * (of_strip(b, t) + of_strip(b - t, t));
  const std::string column = made_of(fmt::format("kind = \"L\"\nwidth = {0}\nheight = {0}\nthickness = {1}", b, t)) +
                             beam_of("[[0, 0, 0], [0, 0, 1]]", 16, "material = \"m\"") +
                             joint("universal", "foot", "ground", "arm.0", Vec3::Zero(), "axis = [1, 0, 0]\nx = [0, 1, 0]") +
                             axial("in-line", "head", "ground", "arm.end", Vec3(0, 0, 1), Vec3::UnitZ()) + push("arm.end", {0, 0, -1000});
  const auto [pressed, pulled] = factors(column);
  EXPECT_NEAR(pressed * 1000, GJ / r2, 0.03 * GJ / r2) << "425 kN without";
  EXPECT_GT(pulled, 3 * pressed) << "115 kN without";
}

// A T under end moments, flange pressed or pulled: P/2 (+-beta + sqrt(beta^2 + 4 GJ/P)), P = pi^2 E I/L^2 [trahair-1993].
TEST_F(BeamTwist, ATUnderMomentsTipsSoonerWithItsWebPressed) {
  const double b = 0.1, h = 0.15, f = 0.01, w = 0.008, L = 4, A = b * f + (h - f) * w;
  const double c = (b * f * (h - f / 2) + (h - f) * w * (h - f) / 2) / A, up = h - f / 2 - c, down = c - (h - f) / 2;
  const double Ix = b * f * f * f / 12 + b * f * up * up + w * std::pow(h - f, 3) / 12 + (h - f) * w * down * down;
  const double Iy = (f * b * b * b + (h - f) * w * w * w) / 12, P = pi * pi * E * Iy / (L * L);
  const auto fourth = [&](double y) { return std::pow(y, 4) / 4; };  // int y^3
  const double web = w * (fourth(h - f - c) - fourth(-c)) + w * w * w / 12 * (h - f) * -down;
  const double flange = b * (fourth(h - c) - fourth(h - f - c)) + b * b * b / 12 * f * up;
  const double beta = (web + flange) / Ix - 2 * up, GJ = G * (of_strip(b, f) + of_strip(h - f, w));
  const Vec3 M(1000, 0, 0);
  const auto [one, other] =
      factors(made_of(fmt::format("kind = \"T\"\nwidth = {}\nheight = {}\nflange = {}\nweb = {}", b, h, f, w)) +
              beam_of("[[0, 0, 0], [0, 4, 0]]", 24, "material = \"m\"\norientation = [0, 0, 1]") +
              joint("universal", "foot", "ground", "arm.0", Vec3::Zero(), "axis = [1, 0, 0]\nx = [0, 0, 1]") +
              axial("in-line", "head", "ground", "arm.end", Vec3(0, L, 0), Vec3::UnitY()) +
              axial("in-plane", "fork", "ground", "arm.end", Vec3(0, L, 0.5), Vec3::UnitX()) + twist("arm.0", M) + twist("arm.end", -M));
  const double root = std::sqrt(beta * beta + 4 * GJ / P), low = P / 2 * (root - std::abs(beta)), high = P / 2 * (root + std::abs(beta));
  EXPECT_NEAR(1000 * std::min(one, other), low, 0.01 * low) << "21.9 kN m without";
  EXPECT_NEAR(1000 * std::max(one, other), high, 0.02 * high) << "the same without";
}

}  // namespace
}  // namespace hilo::test::twist_test
