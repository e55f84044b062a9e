// SPDX-License-Identifier: GPL-3.0-or-later
// Linear regions give way where contact presses them in.
#include <gtest/gtest.h>

#include <fstream>

#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::pressed_in_test {
namespace {

using enum Fidelity;

/// A ball that is pressed into the middle of a block of 1 x 1 x 0.6 m, or, `two`, into a second block on top of it, by a little.
struct Pressed : Case {
  Pressed(Fidelity level, bool two) : Case("contact") {
    BlockOptions o, up;
    o.regions = {"block"}, o.n[0] = o.n[1] = 8, o.n[2] = 4, o.high = Vec3(1, 1, 0.6);
    up.regions = {"up"}, up.n[0] = up.n[1] = 4, up.n[2] = 2, up.low = Vec3(0.3, 0.3, 0.6), up.high = Vec3(0.7, 0.7, 0.8);
    two ? use(together(block_mesh(o), block_mesh(up)), {level, level}) : use(block_mesh(o), {level});
    std::ofstream(*this / "scene.toml") << R"(
[material.m]
E = 1e9
nu = 0.3
density = 1000
[region."*"]
material = "m"
[set.spot]
kind = "box"
of = ["block"]
low = [0.24, 0.24, 0.59]
high = [0.76, 0.76, 0.61]
[set.under]
kind = "box"
of = ["block"]
low = [-1, -1, -0.01]
high = [2, 2, 0.01]
[[motion]]
kind = "fixed"
name = "base"
on = "under"
[[body]]
name = "punch"
mass = 1
com = [0.5, 0.5, 0.9]
inertia = [1, 1, 1]
[[motion]]
kind = "translation"
name = "drive"
on = "punch"
displacement = [0, 0, -1e-4]
history = {t = [0, 1], value = [0, 1]}
[time]
analysis = "static"
steps = 1
end = 1
)"
                                        << (two ? R"(
[set.foot]
kind = "box"
of = ["up"]
low = [0.2, 0.2, 0.59]
high = [0.8, 0.8, 0.61]
[set.head]
kind = "box"
of = ["up"]
low = [0.2, 0.2, 0.79]
high = [0.8, 0.8, 0.81]
[[motion]]
kind = "translation"
name = "press"
on = "head"
displacement = [0, 0, -1e-4]
history = {t = [0, 1], value = [0, 1]}
[[contact]]
name = "c"
a = "spot"
b = "foot"
)"
                                                : R"(
[[obstacle]]
kind = "sphere"
name = "ball"
on = "punch"
at = [0.5, 0.5, 300.6]
radius = 300
[[contact]]
name = "c"
a = "ball"
b = "spot"
)");
  }
  Ran solve(const std::string& more = "") const { return Case::run("hilo-solve scene.toml tags.h5 " + more + " -o run.h5"); }
  double force(const std::string& more = "") const {
    succeeded(solve(more));
    return Results(*this / "run.h5").history("contact/c")(1, 7);
  }
};

// Truth: cells in the small, of which the linear region has all that the contact can tell apart.  By its lowest modes alone the spot is
// half as stiff again.
TEST(LinearContact, GivesWayAsCellsDo) {
  for (const bool two : {false, true}) {
    const double cells = Pressed(nonlinear, two).force();
    const Pressed modes(linear, two);
    EXPECT_NEAR(modes.force() / cells, 1, 1e-3) << two;
    if (!two) {
      EXPECT_NEAR(modes.force("--set 'region.*.interface=[\"spot\"]'") / cells, 1, 1e-3);
    }
    EXPECT_GT(modes.force("--set 'region.*.interface=[\"none\"]'"), (two ? 1.05 : 1.5) * cells) << two;
  }
}

// More nodes than may have modes of their own: told.
TEST(LinearContact, TellsThatItDoesNot) {
  const Pressed c(linear, false);
  const Ran ran = c.solve("--set 'contact.c.b=\"block\"'");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.err.find("it gives way too little"), std::string::npos) << ran.err;
  EXPECT_EQ(c.solve("--set 'contact.c.b=\"block\"' --set 'region.*.interface=[\"spot\"]'").err.find("too little"), std::string::npos);
}

// Truth: the same.  A set that names other nodes, or some of those that are touched, or more than may have modes of their own, takes
// nothing away from what contact may touch, in whatever order.
TEST(LinearContact, GivesWayBesideWhatElseIsNamed) {
  const double cells = Pressed(nonlinear, false).force();
  const Pressed c(linear, false);
  std::ofstream(c / "scene.toml", std::ios::app) << R"(
[set.half]
kind = "box"
of = ["block"]
low = [0.24, 0.24, 0.59]
high = [0.51, 0.76, 0.61]
)";
  for (const char* sets : {"\"xmin\"", "\"half\"", "\"zmax\"", "\"zmax\", \"spot\"", "\"spot\", \"zmax\""})
    EXPECT_NEAR(c.force(std::string("--set 'region.*.interface=[") + sets + "]'") / cells, 1, 1e-3) << sets;
}

// A set that one of several regions has, named for all of them.
TEST(LinearContact, ASetOfOneOfSeveralRegions) {
  const Pressed c(linear, true);
  EXPECT_NEAR(c.force("--set 'region.*.interface=[\"spot\"]'") / Pressed(nonlinear, true).force(), 1, 1e-3);
}

TEST(LinearContact, RefusesSetsThatAreNone) {
  const Pressed c(linear, false);
  for (const auto& [set, text] : {std::pair{"spott", "no set of facets"}, {"block", "no set of facets"}}) {
    const Ran ran = c.solve(std::string("--set 'region.*.interface=[\"") + set + "\"]'");
    EXPECT_EQ(ran.exit, 2) << ran.err;
    EXPECT_NE(ran.err.find(text), std::string::npos) << ran.err;
  }
}

}  // namespace
}  // namespace hilo::test::pressed_in_test
