// SPDX-License-Identifier: GPL-3.0-or-later
// NAFEMS 5T: peak deflection 1.043 mm at 0.0117 s, peak fibre stress 18.76 MPa, static deflection 0.538 mm; within 2 %.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::deep_beam_test {
namespace {

Mesh beam(Shape shape, int along) {
  Mesh m = block_mesh({.shape = shape, .n = {along, 2, 2}, .low = {0, -1, -1}, .high = {10, 1, 1}});
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  add_node_set(m, "axis A", [&](const Vec3& x) { return near(x[0], 0) && near(x[1], 0); });  // the neutral line of the end faces
  add_node_set(m, "axis B", [&](const Vec3& x) { return near(x[0], 10) && near(x[1], 0); });
  add_node_set(m, "axis", [&](const Vec3& x) { return near(x[1], 0) && near(x[2], 0); });
  add_node_set(m, "middle", [&](const Vec3& x) { return near(x[0], 5) && near(x[1], 0) && near(x[2], 0); });
  return m;
}

/// Simply supported, 1e6 N/m over the 2 m of the top face all at once, 2 % damping of all modes.
const std::string scene = solid(2e11, 0.3, 8000, "block", "", "damping = 7.46e-5\nmass_damping = 5.36") + held("axis A", "xy") +
                          held("axis B", "y") + held("axis", "z") + load("traction", "load", "ymax", "traction = [0, 5e5, 0]") +
                          probe("middle") + in_time(0.02, 1e-4) + fields("\"displacement\", \"stress\"", "interval = 1e-4");

TEST(DeepBeam, StaticDeflectionIsThatOfNafems) {
  for (const auto& [shape, along] : {std::pair{Shape::hex8, 20}, {Shape::hex20, 10}}) {
    SceneCase c(scene);
    c.use(beam(shape, along));
    const Results r = c.solved("--set 'time.analysis=\"static\"' --set time.end=1");
    EXPECT_NEAR(r.at("probe/middle", 1)[1] * 1e3, 0.538, 0.02 * 0.538) << info(shape).name;
    // the supports carry 10 MN
    EXPECT_NEAR(r.at("motion/axis A xy", 1)[1] + r.at("motion/axis B y", 1)[1], -1e7, 1);
  }
}

TEST(DeepBeam, SuddenLoadPeaksWhereNafemsSaysWithItsStress) {
  SceneCase c(scene);
  const Mesh m = beam(Shape::hex8, 20);
  c.use(m);
  const Results r = c.solved();
  const auto y = r.history("probe/middle").col(1).eval();
  Eigen::Index top = 0;
  EXPECT_NEAR(y.maxCoeff(&top) * 1e3, 1.043, 0.02 * 1.043);
  EXPECT_NEAR(r.t()[top], 0.0117, 2e-4);
  double stress = 0;
  for (const std::string& step : r.steps()) {
    const auto s = r.table("/field/" + step + "/stress");
    for (std::int64_t a = 0; a < m.n_nodes(); ++a)
      if (std::abs(m.X[a][0] - 5) < 1e-9 && std::abs(m.X[a][1]) > 0.99) stress = std::max(stress, std::abs(s(a, 0)));
  }
  EXPECT_NEAR(stress, 18.76e6, 0.03 * 18.76e6);
}

}  // namespace
}  // namespace hilo::test::deep_beam_test
