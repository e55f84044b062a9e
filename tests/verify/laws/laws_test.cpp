// SPDX-License-Identifier: GPL-3.0-or-later
// Rubber and wood through the whole program: what a free bar keeps, and what a beam does.
#include "verify/free_bar.hpp"

namespace hilo::test::laws_test {
namespace {

/// A material "m" of these keys, and the region of it.
std::string block_of(const std::string& law) { return "[material.m]\ndensity = 1000\n" + law + "\n[region.block]\nmaterial = \"m\"\n"; }

/// Orthotropic; moduli in units of `E`, along the grain and across it.
std::string wood(double E, const std::array<double, 3>& Es, const std::array<double, 3>& Gs, const std::string& axes) {
  return block_of(
      fmt::format("kind = \"orthotropic\"\nE1 = {}\nE2 = {}\nE3 = {}\nnu12 = 0.37\nnu13 = 0.42\nnu23 = 0.47\n"
                  "G12 = {}\nG13 = {}\nG23 = {}\n{}",
                  E * Es[0], E * Es[1], E * Es[2], E * Gs[0], E * Gs[1], E * Gs[2], axes));
}

// Truth: energy to 1e-10 and momenta to 1e-12 of a free bar that bends as it tumbles, whatever its law and cells.
TEST(Laws, OfRubberAndWoodKeepEnergyAndMomentaOfATumblingBar) {
  const std::string mooney = "kind = \"mooney-rivlin\"\nc10 = 1.2e6\nc01 = 0.5e6\nbulk = ";
  const std::pair<const char*, std::string> laws[] = {
      {"rubber", block_of(mooney + "5e6")},
      {"nearly incompressible", block_of(mooney + "5e9")},
      {"ogden", block_of("kind = \"ogden\"\nmu = [3.2e6, 0.01e6, -0.05e6]\nalpha = [1.3, 5, -2]\nbulk = 5e6")},
      {"wood", wood(1e6, {11, 3, 2}, {0.9, 0.8, 0.5}, "axis_1 = [3, 1, 0.5]\naxis_2 = [-1, 3, 0]")}};
  for (const Shape shape : {Shape::hex8, Shape::tet10, Shape::hex20r})
    for (const auto& [law, bar] : laws) {
      SceneCase c(tumbling(bar, shape == Shape::hex8 ? 2 : 0.4, 0.01, "interval = 1\nfields = [\"displacement\", \"von_mises\"]"));
      c.use(free_bar(shape));
      const Results r = c.solved();
      const std::string what = fmt::format("{} {}", law, info(shape).name);
      expect_kept(r, 1e-10, 1e-11, what);
      EXPECT_LT(r.history("energy").col(5).cwiseAbs().maxCoeff(), 1e-10 * r.history("energy").col(0).maxCoeff()) << what;
    }
}

// Truth: Timoshenko's beam, u = F L^3/(3 E1 I) + F L/(k G A), k = 5/6, by the moduli of its own axis, with hexahedra one cell high: bending
// is by the law's moduli and not by those of an isotropic mean.  Along the grain, and across it.
TEST(Laws, BeamOfWoodBendsByItsOwnModuli) {
  for (const bool along : {true, false}) {
    SceneCase c(wood(1e9, {11, 0.9, 0.5}, {0.7, 0.6, 0.04}, along ? "" : "axis_1 = [0, 1, 0]\naxis_2 = [1, 0, 0]") + held("xmin", "x") +
                held("foot", "yz") + load("traction", "tip", "xmax", "traction = [0, 0, 10]") + probe("tip", "xmax") +
                "[time]\nanalysis = \"static\"\n");
    Mesh m = block_mesh({.n = {20, 1, 1}, .high = {1, 0.05, 0.05}});
    add_node_set(m, "foot", [](const Vec3& x) { return std::abs(x[0]) < 1e-9; });
    c.use(m);
    const Results r = c.solved();
    const double h = 0.05, F = 10 * h * h, I = h * h * h * h / 12, E = along ? 11e9 : 0.9e9, G = along ? 0.6e9 : 0.04e9;
    const auto at = r.history("probe/tip");
    const double exact = F / (3 * E * I) + F / (5. / 6 * G * h * h);
    EXPECT_NEAR(at(at.rows() - 1, 2) - at(0, 2), exact, 0.02 * exact) << along;
  }
}

}  // namespace
}  // namespace hilo::test::laws_test
