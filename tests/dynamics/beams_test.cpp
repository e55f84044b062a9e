// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of beams that go on bit by bit, with every integrator.
#include <algorithm>

#include "dynamics/kept_run.hpp"
#include "model/scene.hpp"
#include "ranks.hpp"

namespace hilo::test::beams_test {
namespace {

/// A curved beam that hangs on a hub, and another one on its third section.
std::string scene(const std::string& method) {
  return R"(
gravity = [0, 0, -9.81]
section.s = {kind = "matrix", stiffness = [3e4, 3e4, 5e4], bending = [40, 30, 25], line_mass = 0.5, inertia = [1e-3, 2e-3]}
section.rod = {kind = "circle", diameter = 0.02}
material.m = {E = 1e9, nu = 0.3, density = 1200}
body = [{name = "hub", mass = 2, com = [0, 0, 0], inertia = [0.1, 0.1, 0.1]}]
joint = [{kind = "revolute", name = "axle", b = "hub", at = [0, 0, 0], axis = [0, 1, 0]}]
beam.bow = {path = "arc", points = [[0.1, 0, 0], [0.4, 0.1, 0], [0.8, 0, 0]], cells = [4], section = "s", a = "hub", damping = 1e-3}
beam.tail = {points = [[0.8, 0, 0], [0.8, 0.3, -0.2]], cells = [2], section = "rod", material = "m", a = "bow.end", mass_damping = 0.1}
time = {end = 0.2, step = 0.005, integrator = ")" +
         method + "\"}\n";
}

class KeptBeams : public testing::TestWithParam<std::string> {};
TEST_P(KeptBeams, GoOnBitByBit) {
  const test::Folder folder;
  test::expect_goes_on(folder.path(), scene(GetParam()), "", {7, 20});
}
INSTANTIATE_TEST_SUITE_P(Integrators, KeptBeams, testing::ValuesIn(choices("time", "integrator")), [](const auto& p) {
  std::string name = p.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(DISABLED_KeptBeamsOnRanks, GoOnBitByBit) { test::expect_goes_on(".", scene("energy-momentum"), "", {12}); }
TEST(KeptBeams, GoOnOnTwoRanks) {
  const test::Folder folder;
  test::expect_passes_on(2, "KeptBeamsOnRanks", folder.path().string());
}

}  // namespace
}  // namespace hilo::test::beams_test
