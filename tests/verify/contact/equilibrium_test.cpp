// SPDX-License-Identifier: GPL-3.0-or-later
// Where parts that touch come to rest: from drawn positions apart, onto what is nearest, held by nothing but what presses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/shell_shape.hpp"
#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::contact_equilibrium_test {
namespace {

constexpr double g = 9.81;

/// A ball of 1 kg and 0.1 m at (0, 0, z), held by a spring of `soft` [N/m] to where it is drawn.
std::string ball(const std::string& name, double z, const std::string& soft) {
  return fmt::format(
      "[[body]]\nname = \"{0}\"\nmass = 1\ncom = [0, 0, {1}]\ninertia = [1e-3, 1e-3, 1e-3]\n"
      "[[obstacle]]\nkind = \"sphere\"\nname = \"skin {0}\"\non = \"{0}\"\nat = [0, 0, {1}]\nradius = 0.1\n"
      "[[probe]]\nname = \"{0}\"\non = \"{0}\"\nat = [0, 0, {1}]\n"
      "[[spring]]\nkind = \"bushing\"\nname = \"spring {0}\"\nb = \"{0}\"\nat = [0, 0, {1}]\nstiffness = {2}\n"
      "angular_stiffness = [1, 1, 1]\n",
      name, z, soft);
}

const std::string begin = "gravity = [0, 0, -9.81]\ntime = {start = \"equilibrium\", end = 1e-4, step = 1e-5}\n",
                  floor_below = "[[obstacle]]\nkind = \"plane\"\nname = \"floor\"\nat = [0, 0, -1]\n";

// Truth: the balance of weight, spring and contact on the shelf, 2 cm thick, however high above it the ball is drawn; the floor below is
// not reached.
TEST(ContactEquilibrium, NothingFallsThroughAThinShelf) {
  const Case c("contact");
  for (const double z : {0.62, 0.7, 0.9, 1.5, 5.}) {
    c.write("scene.toml", begin + ball("ball", z, "[1, 1, 1]") + floor_below +
                              "[[obstacle]]\nkind = \"box\"\nname = \"shelf\"\nat = [0, 0, 0.5]\nsize = [1, 1, 0.02]\n"
                              "[[contact]]\nname = \"shelf\"\na = \"shelf\"\nb = \"skin ball\"\nstiffness = 1e5\nfriction = 0.3\n"
                              "[[contact]]\nname = \"floor\"\na = \"floor\"\nb = \"skin ball\"\nstiffness = 1e5\n");
    succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
    EXPECT_NEAR(c.results().history("probe/ball")(0, 2), (1e5 * 0.61 + z - g) / (1e5 + 1), 1e-9) << z;
  }
}

// Truth: the weight presses it in by m g/k, however high above the plane the ball is drawn.
TEST(ContactEquilibrium, ABallThatNothingElseHoldsLiesOnThePlane) {
  const Case c("contact");
  for (const double gap : {5e-4, 0.01, 0.1}) {
    const double z = 0.05 + gap;
    c.write("scene.toml", begin + fmt::format("[[body]]\nname = \"ball\"\nmass = 1\ncom = [0, 0, {0}]\ninertia = [1e-3, 1e-3, 1e-3]\n"
                                              "[[obstacle]]\nkind = \"sphere\"\nname = \"skin\"\non = \"ball\"\nat = [0, 0, {0}]\n"
                                              "radius = 0.05\n[[obstacle]]\nkind = \"plane\"\nname = \"floor\"\n"
                                              "[[contact]]\nname = \"c\"\na = \"floor\"\nb = \"skin\"\nstiffness = 1e5\nfriction = 0.3\n"
                                              "[[probe]]\nname = \"ball\"\non = \"ball\"\n",
                                              z));
    succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
    EXPECT_NEAR(c.results().history("probe/ball")(0, 2), 0.05 - g / 1e5, 1e-9) << gap;
  }
}

// Truth: a block that is held by next to nothing lies on a plate that its edges hold: the plate bears its weight.
TEST(ContactEquilibrium, ABlockLiesOnAThinPlate) {
  const BlockOptions plate{.n = {8, 8, 1}, .low = Vec3(-0.2, -0.2, -0.004), .high = Vec3(0.2, 0.2, 0), .regions = {"plate"}};
  for (const double z : {0.003, 0.05, 0.5}) {
    const BlockOptions block{.n = {2, 2, 2}, .low = Vec3(-0.047, -0.048, z), .high = Vec3(0.053, 0.052, z + 0.1), .regions = {"block"}};
    Mesh mesh = together(block_mesh(plate), block_mesh(block));
    add_node_set(mesh, "edge", [](const Vec3& x) { return std::max(std::abs(x[0]), std::abs(x[1])) > 0.2 - 1e-9; });
    Case c("contact");
    c.use(mesh, {Fidelity::nonlinear, Fidelity::nonlinear});
    c.write("scene.toml", begin + fmt::format("material.M = {{E = 2e9, nu = 0.3, density = 1000}}\nregion.\"*\" = {{material = \"M\"}}\n"
                                              "motion = [{{kind = \"fixed\", name = \"held\", on = \"edge\"}}]\n"
                                              "contact = [{{name = \"c\", a = \"plate\", b = \"block\"}}]\nprobe = [{{name = \"top\", on = "
                                              "\"blockzmax\"}}]\n"
                                              "spring = [{{kind = \"bushing\", name = \"s\", b = \"blockzmax\", at = [0.003, 0.002, {}], "
                                              "stiffness = [1, 1, 1], angular_stiffness = [1, 1, 1]}}]\n",
                                              z + 0.1));
    succeeded(c.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
    const Results r = c.results();
    const double top = r.history("probe/top")(0, 2);
    EXPECT_GT(top, 0.0985) << "through the plate, drawn at " << z;
    EXPECT_NEAR(r.history("contact/c")(1, 2), g + top - z - 0.1, 1e-3) << z;
  }
}

// Truth: 48 E I w = F L^3, friction holds what it has bent to: it stays, and each roller bears half.
TEST(ContactEquilibrium, AStripLiesOnTwoRollersAndStaysThere) {
  constexpr double E = 2.1e11, t = 1e-3, b = 0.02, R = 0.01, half = 0.08, F = 10;
  Mesh strip = block_mesh({.n = {40, 4, 1}, .low = Vec3(-0.1, 0, -t / 2), .high = Vec3(0.1, b, t / 2), .regions = {"strip"}});
  std::ranges::fill(strip.shape, static_cast<std::uint8_t>(shell8));
  add_node_set(strip, "mid", [](const Vec3& x) { return std::abs(x[0]) < 1e-9; });
  Case c("contact");
  c.use(strip, {Fidelity::nonlinear});
  std::string scene = fmt::format(
      "material.steel = {{E = {}, nu = 0.3, density = 7850}}\nregion.\"*\" = {{material = \"steel\"}}\n"
      "load = [{{kind = \"force\", name = \"push\", on = \"mid\", force = [0, 0, {}]}}]\nprobe = [{{name = \"mid\", on = \"mid\"}}]\n"
      "time = {{start = \"equilibrium\", end = 0.01, step = 1e-4}}\n",
      E, -F);
  for (const char* side : {"left", "right"})
    scene += fmt::format(
        "[[obstacle]]\nkind = \"cylinder\"\nname = \"{0}\"\nat = [{1}, 0, {2}]\naxis = [0, 1, 0]\nradius = {3}\n"
        "[[contact]]\nname = \"{0}\"\na = \"{0}\"\nb = \"zmin\"\nfriction = 0.3\n",
        side, side[0] == 'l' ? -half : half, -t / 2 - R, R);
  c.write("scene.toml", scene);
  const Ran ran = succeeded(c.run("hilo-solve scene.toml tags.h5 -o run.h5"));
  EXPECT_EQ(ran.err.find("is not stable"), std::string::npos) << ran.err;
  const Results r = c.results();
  const auto mid = r.history("probe/mid");
  const double L = 2 * half, theory = F * L * L * L / (48 * E * b * t * t * t / 12);
  EXPECT_NEAR(mid(0, 2), -theory, 0.04 * theory) << "points of contact stand 2.9 mm apart, or 4 %";
  EXPECT_NEAR(mid(mid.rows() - 1, 2), mid(0, 2), 1e-6 * theory) << "at rest";
  EXPECT_NEAR(mid(mid.rows() - 1, 0), 0, 1e-5 * theory);
  for (const char* side : {"left", "right"}) EXPECT_NEAR(r.history(fmt::format("contact/{}", side))(1, 2), F / 2, 1e-3 * F) << side;
}

// Truth: a column of two balls falls over, and both lie on the floor.
TEST(ContactEquilibrium, AColumnOfBallsFallsOver) {
  std::string scene = begin + floor_below + "[[contact]]\nname = \"c\"\na = \"all\"\nb = \"all\"\nstiffness = 1e5\n";
  for (const double z : {-0.8, 0.}) scene += ball(fmt::format("at {}", z), z, "[1, 1, 0.001]");
  const Case c("contact");
  c.write("scene.toml", scene);
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results r = c.results();
  for (const double z : {-0.8, 0.})
    EXPECT_NEAR(r.history(fmt::format("probe/at {}", z))(0, 2), -0.9 - (g + 0.001 * (-0.9 - z)) / 1e5, 1e-6) << z;
}

// Truth: the weight, at the start and after, whatever the parts are; next to nothing else holds the upper one.
TEST(ContactEquilibrium, RandomPairsOfBlocksBearTheWeight) {
  Dice dice(11);
  const auto cells = [&](int least, int most) { return static_cast<int>(dice(least, most + 0.999)); };
  for (int k = 0; k < 15; ++k) {
    const double size = dice(0.6, 1.1), gap = std::array{0., 1e-4, 0.01, 0.1, 0.5}[k % 5], tilt = std::array{0., 0.05, 0.1}[k % 3];
    const BlockOptions base{
        .n = {cells(2, 5), cells(2, 5), cells(1, 2)}, .low = Vec3(-0.3, -0.3, -0.2), .high = Vec3(1.4, 1.4, 0), .regions = {"A"}};
    const int across = cells(1, 3);
    const BlockOptions block{.n = {across, across, cells(1, 2)},
                             .high = Vec3(size, size, size),
                             .map =
                                 [=](const Vec3& x) {
                                   const Vec3 c = Vec3::Constant(size / 2);
                                   return Vec3(Eigen::AngleAxisd(tilt, Vec3::UnitX()) * (x - c) + c + Vec3(0, 0, gap + 0.6 * tilt * size));
                                 },
                             .regions = {"B"}};
    Case c("contact");
    using enum Fidelity;
    c.use(together(block_mesh(base), block_mesh(block)), {k % 4 == 3 ? linear : nonlinear, std::array{nonlinear, linear, rigid}[k % 3]});
    c.write("scene.toml", begin + fmt::format("material.m = {{E = {:.3g}, nu = 0.3, density = 1000}}\nregion.\"*\" = {{material = \"m\"}}\n"
                                              "contact = [{{name = \"c\", a = \"A\", b = \"B\", friction = {:.2f}}}]\n"
                                              "motion = [{{kind = \"fixed\", name = \"floor\", on = \"Azmin\"}}]\n"
                                              "spring = [{{kind = \"bushing\", name = \"s\", b = \"Bzmax\", at = [{}, {}, {}], stiffness = "
                                              "[10, 10, 0.001], angular_stiffness = [10, 10, 10]}}]\n",
                                              std::pow(10, dice(6, 9)), dice(0.1, 0.5), size / 2, size / 2, size + gap));
    succeeded(c.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
    const auto f = c.results().history("contact/c");
    const double weight = 1000 * g * size * size * size;
    for (const Eigen::Index row : {Eigen::Index(1), f.rows() - 1}) EXPECT_NEAR(f(row, 2), weight, 1e-5 * weight) << k << " row " << row;
  }
}

// Truth: what is pulled by more than its weight leaves the floor, in load steps and from equilibrium; nothing sticks to it.
TEST(ContactEquilibrium, NothingIsGluedToTheFloor) {
  for (const bool on_base : {false, true}) {
    Mesh mesh = block_mesh({.n = {2, 2, 2}, .high = Vec3(0.1, 0.1, 0.1), .regions = {"block"}});
    if (on_base)
      mesh = together(mesh, block_mesh({.n = {3, 3, 1}, .low = Vec3(-0.1, -0.1, -0.05), .high = Vec3(0.2, 0.2, 0), .regions = {"base"}}));
    Case c("contact");
    c.use(mesh, std::vector<Fidelity>(on_base ? 2 : 1, Fidelity::nonlinear));
    constexpr double weight = 7850 * 1e-3 * g;
    const std::string top = on_base ? "blockzmax" : "zmax";
    const auto run = [&](double pull, const char* time) {
      c.write("scene.toml",
              fmt::format("gravity = [0, 0, -9.81]\nmaterial.M = {{E = 2.1e11, nu = 0.3, density = 7850}}\nregion.\"*\" = {{material = "
                          "\"M\"}}\nload = [{{kind = \"force\", name = \"pull\", on = \"{}\", force = [0, 0, {}]}}]\ntime = {{{}}}\n",
                          top, pull, time) +
                  (on_base ? "motion = [{kind = \"fixed\", name = \"held\", on = \"basezmin\"}]\n"
                             "contact = [{name = \"c\", a = \"base\", b = \"block\", friction = 0.3}]\n"
                           : "obstacle = [{kind = \"plane\", name = \"floor\"}]\n"
                             "contact = [{name = \"c\", a = \"floor\", b = \"block\", friction = 0.3}]\n"));
      return c.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5");
    };
    for (const char* time : {"analysis = \"static\", steps = 2", "start = \"equilibrium\", end = 1e-5, step = 1e-6"}) {
      succeeded(run(0.9 * weight, time));
      EXPECT_NEAR(c.results().history("contact/c").bottomRows(1)(0, 2), 0.1 * weight, 1e-3 * weight) << time;
      for (const double pull : {1.04, 13.}) EXPECT_EQ(run(pull * weight, time).exit, 3) << time << " " << pull;
    }
  }
}

}  // namespace
}  // namespace hilo::test::contact_equilibrium_test
