// SPDX-License-Identifier: GPL-3.0-or-later
// Rubber and wood through the whole program: what a free bar keeps, and what a beam does.
#include "verify/verify.hpp"

namespace hilo::test::laws_test {
namespace {

// Truth: energy to 1e-10 and momenta to 1e-12 of a free bar that bends as it tumbles, whatever its law and cells.
TEST(Laws, OfRubberAndWoodKeepEnergyAndMomentaOfATumblingBar) {
  for (const Shape shape : {Shape::hex8, Shape::tet10, Shape::hex20r})
    for (const char* law : {"rubber", "nearly_incompressible", "ogden", "wood"}) {
      Case c("laws");
      c.use(block_mesh({.shape = shape, .n = {4, 1, 1}, .high = {1, 0.1, 0.1}}));
      const std::string shorter = shape == Shape::hex8 ? "" : " --set time.end=0.4";
      const Results r = c.solved(std::string("--set 'region.block.material=\"") + law + "\"'" + shorter, "run.h5", "tumbling");
      const auto e = r.history("energy"), p = r.history("momentum");
      const double top = e.col(0).maxCoeff();
      EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-10 * top) << law << " " << info(shape).name;
      EXPECT_LT(((e.col(0) + e.col(1)).array() - e(0, 0) - e(0, 1)).abs().maxCoeff(), 1e-10 * top) << law << " " << info(shape).name;
      EXPECT_GT(e.col(1).maxCoeff(), 1e-3 * top) << "a bar that really bends";
      const Vec3 before = p.row(0).tail<3>(), after = p.row(p.rows() - 1).tail<3>();
      EXPECT_LT((after - before).norm(), 1e-12 * before.norm() * 10) << law << " " << info(shape).name;
    }
}

// Truth: Timoshenko's beam, u = F L^3/(3 E1 I) + F L/(k G A), k = 5/6, by the moduli of its own axis, with hexahedra one cell high: bending
// is by the law's moduli and not by those of an isotropic mean.  Along the grain, and across it.
TEST(Laws, BeamOfWoodBendsByItsOwnModuli) {
  for (const bool along : {true, false}) {
    Case c("laws");
    Mesh m = block_mesh({.n = {20, 1, 1}, .high = {1, 0.05, 0.05}});
    add_node_set(m, "foot", [](const Vec3& x) { return std::abs(x[0]) < 1e-9; });
    c.use(m);
    const Results r =
        c.solved(along ? "" : "--set 'material.wood.axis_1=[0, 1, 0]' --set 'material.wood.axis_2=[1, 0, 0]'", "run.h5", "beam");
    const double h = 0.05, F = 10 * h * h, I = h * h * h * h / 12, E = along ? 11e9 : 0.9e9, G = along ? 0.6e9 : 0.04e9;
    const auto at = r.history("probe/tip");
    const double exact = F / (3 * E * I) + F / (5. / 6 * G * h * h);
    EXPECT_NEAR(at(at.rows() - 1, 2) - at(0, 2), exact, 0.02 * exact) << along;
  }
}

}  // namespace
}  // namespace hilo::test::laws_test
