// SPDX-License-Identifier: GPL-3.0-or-later
// Contact along paths of equilibrium, and by methods that take the force of a gap at an instant.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "dynamics/kept_run.hpp"
#include "scene_parts.hpp"
#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::contact_path_test {
namespace {

/// A ball of 0.1 m on a rail along x, which a spring of 100 N/m holds and a force of 200 N pushes, before a wall of 300 N/m.
const std::string cart = pushed_cart(200) + R"([[obstacle]]
kind = "plane"
name = "wall"
at = [1.1, 0, 0]
axis = [-1, 0, 0]
[[obstacle]]
kind = "sphere"
name = "skin"
on = "cart"
radius = 0.1
[[contact]]
name = "c"
a = "wall"
b = "skin"
stiffness = 300
)";

// Truth: 100 x + 300 (x - 1) = 200 p behind the wall.
TEST(ContactPath, OfABallThatMeetsAWall) {
  const Case c("contact");
  c.write("scene.toml", cart + "[time]\nanalysis = \"path\"\nsteps = 7\n");
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results r = c.results();
  const auto x = r.history("probe/cart"), p = r.history("path");
  for (Eigen::Index k = 0; k < x.rows(); ++k) EXPECT_NEAR(100 * x(k, 0) + 300 * std::max(0., x(k, 0) - 1), 200 * p(k, 0), 1e-6) << k;
  EXPECT_NEAR(x(x.rows() - 1, 0), 1.25, 1e-9);
  EXPECT_NEAR(r.history("contact/c")(x.rows() - 1, 0), -75, 1e-6);
}

// Truth: the same by load steps, frictionless and so without memory.  Both surfaces move, and the lower one is met in other facets.
TEST(ContactPath, OfTwoSurfacesEndsWhereLoadStepsEnd) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.n[0] = A.n[1] = 3, A.n[2] = 2, A.low = Vec3(-0.25, -0.25, -0.5), A.high = Vec3(1.25, 1.25, 0);
  B.n[0] = B.n[1] = 2, B.n[2] = 2, B.low = Vec3(0, 0, 0.02), B.high = Vec3(1, 1, 0.52);
  for (const double friction : {0., 0.3}) {
    Case c("contact");
    c.use(together(block_mesh(A), block_mesh(B)));
    const auto text = [&](const char* analysis, int steps) {
      return fmt::format(R"(
material.m = {{E = 1e6, nu = 0.3, density = 1000}}
region."*" = {{material = "m"}}
contact = [{{name = "c", a = "A", b = "B", friction = {}}}]
motion = [{{kind = "fixed", name = "floor", on = "Azmin"}}]
spring = [{{kind = "bushing", name = "s", b = "Bzmax", at = [0.5, 0.5, 0.52], stiffness = [1e6, 1e6, 2e5], angular_stiffness = [1e6, 1e6, 1e6]}}]
load = [{{kind = "force", name = "f", on = "Bzmax", force = [0, 0, -1e4]}}]
probe = [{{name = "top", on = "Bzmax"}}]
output.fields = ["displacement"]
time = {{analysis = "{}", steps = {}}}
solver.tolerance = 1e-11
)",
                         friction, analysis, steps);
    };
    c.write("static.toml", text("static", 4)), c.write("path.toml", text("path", 6));
    for (const char* name : {"static", "path"}) {
      succeeded(c.run(fmt::format("hilo-solve --quiet {}.toml mesh.h5 -o {}.h5", name, name)), name);
    }
    const Results loads(c / "static.h5"), path(c / "path.h5");
    const double force = loads.history("contact/c").bottomRows(1)(0, 2), most = friction > 0 ? 2e-3 : 1e-7;
    EXPECT_GT(force, 1e3) << "they meet";
    EXPECT_NEAR(path.history("contact/c").bottomRows(1)(0, 2) / force, 1, most);
    const double low = loads.history("probe/top").bottomRows(1)(0, 2) - 0.52;
    EXPECT_NEAR((path.history("probe/top").bottomRows(1)(0, 2) - 0.52) / low, 1, most);
    if (friction > 0) expect_goes_on(c.path(), text("path", 6), "mesh.h5", {2, 4, 6});
  }
}

// Truth: weight and push, whatever share of its points slides before the others hold it.
TEST(ContactPath, ABlockIsPushedAndHeldByFriction) {
  BlockOptions o;
  o.n[0] = o.n[1] = o.n[2] = 2, o.high = Vec3(0.1, 0.1, 0.05);
  Case c("contact");
  c.use(block_mesh(o));
  const double weight = 7800 * 0.1 * 0.1 * 0.05 * 981;
  for (const double push : {0.2, 0.28}) {
    c.write("scene.toml", fmt::format(R"(
gravity = [0, 0, -981]
material.m = {{E = 2e9, nu = 0.3, density = 7800}}
region."*" = {{material = "m"}}
obstacle = [{{kind = "plane", name = "ground"}}]
contact = [{{name = "c", a = "ground", b = "block", friction = 0.3}}]
load = [{{kind = "force", name = "f", on = "block", force = [{}, 0, 0]}}]
time = {{analysis = "path", steps = 4}}
)",
                                      push * weight));
    const Ran ran = c.run("hilo-solve --quiet scene.toml mesh.h5 -o run.h5");
    ASSERT_EQ(ran.exit, 0) << push << ran.err;
    const Eigen::MatrixXd force = Results(c / "run.h5").history("contact/c").bottomRows(1);
    EXPECT_NEAR(force(0, 0) / weight, -push, 1e-6);
    EXPECT_NEAR(force(0, 2) / weight, 1, 1e-6);
  }
}

// Truth: a ball that falls from 0.05 m on a spring is back there after 2 sqrt(2 H/g) + the time of the contact, 2 (pi - atan(v w/g))/w.
TEST(ContactAtAnInstant, ABallFallsAndComesBack) {
  constexpr double g = 9.81, H = 0.05, k = 1e4, m = 1;
  const double w = std::sqrt(k / m), v = std::sqrt(2 * g * H), there = 2 * v / g + 2 * (std::numbers::pi - std::atan(v * w / g)) / w;
  const std::string ball = fmt::format(R"(
gravity = [0, 0, -{}]
body = [{{name = "ball", mass = {}, com = [0, 0, {}], inertia = [0.004, 0.004, 0.004]}}]
obstacle = [{{kind = "plane", name = "ground"}}, {{kind = "sphere", name = "skin", on = "ball", radius = 0.1, at = [0, 0, {}]}}]
contact = [{{name = "c", a = "ground", b = "skin", stiffness = {}}}]
probe = [{{name = "p", on = "ball"}}]
)",
                                       g, m, 0.1 + H, 0.1 + H, k);
  for (const char* method : {"generalized-alpha", "newmark", "hht", "wbz", "mid-point", "bdf2", "bathe"}) {
    const Case c("contact");
    c.write("scene.toml", ball + fmt::format("time = {{end = {}, step = 1e-4, integrator = \"{}\"}}\n", there, method));
    succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"), method);
    const Results r = c.results();
    EXPECT_NEAR(r.history("probe/p").bottomRows(1)(0, 2), 0.1 + H, 0.01 * H) << method;
    EXPECT_NEAR(r.history("contact/c").col(2).minCoeff(), -0, 1e-9) << method << ": it never pulls";
    EXPECT_NEAR(r.history("contact/c").col(2).maxCoeff(), m * g + std::sqrt(m * g * m * g + k * m * v * v), 0.02 * v * std::sqrt(k * m))
        << method;
  }
}

// A bullet of 100 m/s, steps of 0.1 m: a ball in its way is not passed without a word.
TEST(ContactAtAnInstant, NothingGoesThrough) {
  const Case c("contact");
  c.write("scene.toml", R"(
body = [{name = "bullet", mass = 1, com = [-0.96, 0, 0], inertia = [1, 1, 1]}]
obstacle = [{kind = "sphere", name = "post", radius = 0.02}, {kind = "sphere", name = "skin", on = "bullet", radius = 0.01, at = [-0.96, 0, 0]}]
contact = [{name = "c", a = "post", b = "skin", stiffness = 1e3}]
initial = [{on = ["bullet"], velocity = [100, 0, 0]}]
time = {end = 0.02, step = 1e-3, integrator = "generalized-alpha"}
solver.cuts = 0
)");
  const Ran ran = c.run("hilo-solve --quiet scene.toml -o run.h5");
  EXPECT_EQ(ran.exit, 3) << ran.err;
  EXPECT_NE(ran.err.find("goes through the obstacle"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test::contact_path_test
