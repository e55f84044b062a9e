// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles in load steps: closed forms of what rests, is pressed and is pushed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "base/shell_shape.hpp"
#include "dynamics/kept_run.hpp"
#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::load_steps_test {
namespace {

constexpr double g = 9.81;

Eigen::VectorXd last(const Results& r, const std::string& history) { return r.history(history).bottomRows(1).transpose(); }

/// Least and largest contact pressure of the nodes of a plane z = const, at the end [Pa].
std::pair<double, double> pressures(const Results& r, const Mesh& mesh, double z) {
  const auto p = r.table("/field/" + r.steps().back() + "/contact_pressure");
  std::pair<double, double> out{1e300, -1e300};
  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i)
    if (std::abs(mesh.X[i][2] - z) < 1e-9) out = {std::min(out.first, p(i, 0)), std::max(out.second, p(i, 0))};
  return out;
}

/// A block of 1 x 1 x 1 m, E 1 MPa, nu 0, on a plane; `more` holds and loads it.
struct OnPlane : Case {
  /// A region below it instead.
  void add_base() {
    BlockOptions o;
    o.regions = {"base"}, o.n[0] = o.n[1] = 4, o.n[2] = 2, o.low = Vec3(-0.5, -0.5, -0.5), o.high = Vec3(1.5, 1.5, 0);
    mesh = together(block_mesh(o), mesh);
    use(mesh, {Fidelity::nonlinear, Fidelity::nonlinear});
  }
  OnPlane(const std::string& more, Shape shape, Fidelity fidelity) : Case("contact") {
    BlockOptions o;
    o.shape = shape;
    o.n[0] = o.n[1] = 2, o.n[2] = 4;
    mesh = block_mesh(o);
    use(mesh, {fidelity});
    std::ofstream(*this / "scene.toml") << "[material.m]\nE = 1e6\nnu = 0\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n"
                                           "[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n"
                                           "[[contact]]\nname = \"c\"\na = \"ground\"\nb = \"block\"\n[time]\nanalysis = \"static\"\n"
                                        << more;
  }
  Mesh mesh;
  Results run(const std::string& options = "") const {
    succeeded(Case::run("hilo-solve --quiet scene.toml tags.h5 " + options + " -o run.h5"));
    return Results(*this / "run.h5");
  }
};

// Truth: uniaxial stress p, and layers of 100 E/l at the foot: the top sinks by p (1 + l/100)/E to first order in p/E.
TEST(LoadSteps, ABlockIsPressedOnAPlane) {
  const std::string press =
      "steps = 1\n[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"zmax\"\npressure = 10\n"
      "[[motion]]\nkind = \"fixed\"\nname = \"x\"\non = \"xmin\"\ncomponents = [\"x\"]\n"
      "[[motion]]\nkind = \"fixed\"\nname = \"y\"\non = \"ymin\"\ncomponents = [\"y\"]\n"
      "[[probe]]\nname = \"top\"\non = \"zmax\"\n";
  for (const Shape shape : {Shape::hex8, Shape::tet4, Shape::hex20, Shape::tet10}) {
    const OnPlane c(press, shape, Fidelity::nonlinear);
    const Results r = c.run();
    EXPECT_NEAR(last(r, "contact/c")[2], 10, 1e-8);
    const double l = shape == Shape::tet4 || shape == Shape::tet10 ? 0.25 / 3 : 0.25;  // volume over the area of the facet
    EXPECT_NEAR(last(r, "probe/top")[2] - 1, -1e-5 * (1 + l / 100), 3e-5 * 1e-5) << info(shape).name;
    const auto [least, most] = pressures(r, c.mesh, 0);
    EXPECT_NEAR(least, 10, 1e-7) << info(shape).name;
    EXPECT_NEAR(most, 10, 1e-7) << info(shape).name;
    EXPECT_EQ(pressures(r, c.mesh, 0.5).second, 0) << info(shape).name;
  }
}

// Truth: p at every node of the foot, of facets too that lie on two obstacles, each under a half; it lifts off without impacts.
TEST(LoadSteps, ABlockIsPressedOnTwoObstacles) {
  OnPlane c(
      "steps = 2\nend = 1\n[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"zmax\"\npressure = 10\n"
      "[[motion]]\nkind = \"fixed\"\nname = \"x\"\non = \"xmin\"\ncomponents = [\"x\"]\n"
      "[[motion]]\nkind = \"fixed\"\nname = \"y\"\non = \"ymin\"\ncomponents = [\"y\"]\n"
      "[[obstacle]]\nkind = \"box\"\nname = \"left\"\nat = [-0.75, 0.5, -1]\nsize = [2, 3, 2]\n"
      "[[obstacle]]\nkind = \"box\"\nname = \"right\"\nat = [1.25, 0.5, -1]\nsize = [2, 3, 2]\n"
      "[[contact]]\nname = \"d\"\na = \"right\"\nb = \"block\"\n",
      Shape::hex8, Fidelity::nonlinear);
  {
    const Ran ran = c.Case::run("hilo-solve --quiet scene.toml tags.h5 --set 'contact.c.a=\"left\"' -o run.h5");
    ASSERT_EQ(ran.exit, 0) << ran.err;
    const Results r(c / "run.h5");
    EXPECT_NEAR(last(r, "contact/c")[2], 2.5, 0.05);
    EXPECT_NEAR(last(r, "contact/c")[2] + last(r, "contact/d")[2], 10, 1e-7);
    const auto [least, most] = pressures(r, c.mesh, 0);
    EXPECT_NEAR(least, 10, 0.02);
    EXPECT_NEAR(most, 10, 0.02);
  }
}

// Truth: what a load step presses and the next one lifts has no impact.
TEST(LoadSteps, WhatIsLiftedHasNoImpact) {
  const OnPlane c(
      "steps = 4\nend = 1\n[[motion]]\nkind = \"translation\"\nname = \"t\"\non = \"zmax\"\ndisplacement = [0, 0, -1e-3]\n"
      "history = {t = [0, 0.25, 0.5, 0.75, 1], value = [0, 1, -1, 1, -1]}\n",
      Shape::hex8, Fidelity::nonlinear);
  const Ran ran = c.Case::run("hilo-solve scene.toml tags.h5 -o run.h5");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.err.find("impact"), std::string::npos) << ran.err;
}

// Truth: the sum of the tractions mu p, whatever the block's own deformation; the work of friction is that of the way its foot goes.  It
// slides on an obstacle or on another region in the steps that were asked for: friction is no jump to another branch.
TEST(LoadSteps, ABlockIsPressedAndPushed) {
  const std::string push =
      "steps = 10\nend = 1\n[[motion]]\nkind = \"translation\"\nname = \"down\"\non = \"top\"\ncomponents = [\"z\"]\n"
      "displacement = [0, 0, -1e-3]\nhistory = {t = [0, 0.5, 1], value = [0, 1, 1]}\n"
      "[[motion]]\nkind = \"translation\"\nname = \"aside\"\non = \"top\"\ncomponents = [\"x\", \"y\"]\n"
      "displacement = [0.03, 0.04, 0]\nhistory = {t = [0, 0.5, 1], value = [0, 0, 1]}\n"
      "[set]\ntop = {kind = \"plane\", at = [0, 0, 1], axis = [0, 0, 1]}\n";
  for (const bool on_region : {false, true}) {
    OnPlane c(push + (on_region ? "[[motion]]\nkind = \"fixed\"\nname = \"floor\"\non = \"low\"\n"
                                  "[set.low]\nkind = \"plane\"\nat = [0, 0, -0.5]\naxis = [0, 0, 1]\n"
                                : ""),
              Shape::hex8, Fidelity::nonlinear);
    if (on_region) c.add_base();
    const Results r = c.run(std::string("--set contact.c.friction=0.3") + (on_region ? " --set 'contact.c.a=\"base\"'" : ""));
    const Eigen::VectorXd f = last(r, "contact/c");
    EXPECT_NEAR(f[2], on_region ? 750 : 1000, on_region ? 150 : 10) << "half as deep as the block is high, and wider";
    EXPECT_NEAR(f[0] / f[2], -0.3 * 0.6, 2e-3);
    EXPECT_NEAR(f[1] / f[2], -0.3 * 0.8, 2e-3);
    EXPECT_NEAR(std::hypot(f[0], f[1]), 0.3 * f[2], 5e-4 * f[2]);
    EXPECT_NEAR(f[6], 0.3 * f[2] * f[5], 0.02 * f[6]);
    EXPECT_NEAR(f[5], 0.05, 0.003) << "less what the block shears";
    EXPECT_NEAR(last(r, "energy")[4], f[6], 1e-9 * f[6]);
    EXPECT_LE(c.reported("steps"), 12);
    EXPECT_LT(c.reported("newton_iterations"), 100);
    expect_goes_on(c.path(), text_of(c / "scene.toml"), "tags.h5", {2, 6, 9},
                   {"contact.c.friction=0.3", on_region ? "contact.c.a=\"base\"" : "time.steps=10"});
  }
}

// Truth: mu p A, however many steps: points whose pressure passes zero slide in each of them.
TEST(LoadSteps, ABlockSlidesInManySteps) {
  OnPlane c(
      "steps = 64\nend = 0.8\n[[motion]]\nkind = \"translation\"\nname = \"down\"\non = \"top\"\ncomponents = [\"z\"]\n"
      "displacement = [0, 0, -1e-3]\nhistory = {t = [0, 0.5, 1], value = [0, 1, 1]}\n"
      "[[motion]]\nkind = \"translation\"\nname = \"aside\"\non = \"top\"\ncomponents = [\"x\", \"y\"]\n"
      "displacement = [0.03, 0.04, 0]\nhistory = {t = [0, 0.5, 1], value = [0, 0, 1]}\n"
      "[set]\ntop = {kind = \"plane\", at = [0, 0, 1], axis = [0, 0, 1]}\nlow = {kind = \"plane\", at = [0, 0, -0.5], axis = [0, 0, 1]}\n"
      "[[motion]]\nkind = \"fixed\"\nname = \"floor\"\non = \"low\"\n",
      Shape::hex8, Fidelity::nonlinear);
  c.add_base();
  const Results r = c.run("--set contact.c.friction=0.3 --set 'contact.c.a=\"base\"'");
  const Eigen::VectorXd f = last(r, "contact/c");
  EXPECT_NEAR(std::hypot(f[0], f[1]), 0.3 * f[2], 5e-4 * f[2]);
  EXPECT_LE(c.reported("steps"), 65);
}

// Truth: a bar that friction q [N/m] holds is pulled at its end by F < q L: it slides over F/q of its length, and its end goes F^2/(2 EA
// q); a cycle between F and -F takes 2/3 F^3/(EA q).
TEST(LoadSteps, ABarThatSlidesInPart) {
  constexpr double q = 1500, EA = 1e6, F = 900, end = F * F / (2 * EA * q), loss = 2 * F * F * F / (3 * EA * q);
  Case c("contact");
  BlockOptions o;
  o.n[0] = 20, o.high = Vec3(1, 0.05, 0.02);
  c.use(block_mesh(o), {Fidelity::nonlinear});
  c.write(
      "scene.toml",
      "[material.m]\nE = 1e9\nnu = 0\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n"
      "[[contact]]\nname = \"c\"\na = \"ground\"\nb = \"zmin\"\nfriction = 0.3\n[[probe]]\nname = \"end\"\non = \"xmax\"\n"
      "[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"zmax\"\npressure = 1e5\nhistory = {t = [0, 1, 9], value = [0, 1, 1]}\n"
      "[[load]]\nkind = \"force\"\nname = \"F\"\non = \"xmax\"\nforce = [900, 0, 0]\n"
      "history = {t = [0, 1, 2, 4, 6, 8], value = [0, 0, 1, -1, 1, -1]}\n"
      "[[motion]]\nkind = \"fixed\"\nname = \"side\"\non = \"ymin\"\ncomponents = [\"y\"]\n"
      "[time]\nanalysis = \"static\"\nsteps = 8\nend = 8\n");
  succeeded(c.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
  const Results r(c / "run.h5");
  for (const double t : {2., 4., 6., 8.}) EXPECT_NEAR(r.at("probe/end", t)[0] - 1, (t == 2 || t == 6 ? 1 : -1) * end, 0.03 * end) << t;
  for (const double t : {6., 8.}) EXPECT_NEAR(r.at("contact/c", t)[6] - r.at("contact/c", t - 4)[6], loss, 0.03 * loss) << t;
  EXPECT_LE(c.reported("steps"), 12) << "of eight asked for";
  EXPECT_LT(c.reported("newton_iterations"), 1000);
}

// Truth: its weight.  Contact alone holds it, against what does not move: an obstacle, or a region that is held as a whole.
TEST(LoadSteps, ABlockStands) {
  for (const bool on_region : {false, true}) {
    OnPlane c(std::string("steps = 1\n") + (on_region ? "[[motion]]\nkind = \"fixed\"\nname = \"floor\"\non = \"base\"\n" : ""),
              Shape::hex8, Fidelity::nonlinear);
    if (on_region) c.add_base();
    const Results r =
        c.run(std::string("--set contact.c.friction=0.3 --set 'gravity=[0,0,-9.81]'") + (on_region ? " --set 'contact.c.a=\"base\"'" : ""));
    EXPECT_NEAR(last(r, "contact/c")[2], 1000 * g, 1e-9 * 1000 * g);
  }
}

// Truth: weight over area, and a layer of E E*/layer that a part of 1 t sinks into.  A rigid part stands on it, and holds by friction.
TEST(LoadSteps, ARigidBlockStands) {
  const OnPlane c("steps = 2\n", Shape::hex8, Fidelity::rigid);
  const Results r = c.run("--set 'gravity=[1,0,-9.81]' --set contact.c.friction=0.3 --set contact.c.modulus=1e8 --set contact.c.layer=0.1");
  const Eigen::VectorXd f = last(r, "contact/c");
  EXPECT_NEAR(f[2], 1000 * g, 1e-6);
  EXPECT_NEAR(f[0], -1000, 1e-6);
  const auto [least, most] = pressures(r, c.mesh, 0);
  EXPECT_NEAR((least + most) / 2, 1000 * g, 1e-8 * 1000 * g) << "the push tilts it";
  EXPECT_NEAR((most - least) / 2, 6 * 500, 1e-3 * 3000) << "by 500 N m";
}

// Truth: the law of the lever and Hertz.  A body on three balls stands by friction, and slides off where the push is more than mu m g.
TEST(LoadSteps, ABodyStandsOnThreeBalls) {
  const Case c("contact");
  std::string text =
      "gravity = [0, 0, -9.81]\n[[body]]\nname = \"b\"\nmass = 30\ncom = [0.1, 0.2, 0.4]\ninertia = [1, 1, 1]\n"
      "[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n"
      "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"b\"\nforce = [50, 0, 0]\nat = [0.1, 0.2, 0]\n"
      "[time]\nanalysis = \"static\"\nsteps = 4\n";
  const Vec3 at[] = {Vec3(0.6, 0, 0.1), Vec3(-0.4, 0.5, 0.1), Vec3(-0.4, -0.5, 0.1)};
  for (int k = 0; k < 3; ++k)
    text += fmt::format(
        "[[obstacle]]\nkind = \"sphere\"\nname = \"ball {0}\"\non = \"b\"\nradius = 0.1\nat = [{1}, {2}, {3}]\n"
        "[[contact]]\nname = \"{0}\"\na = \"ground\"\nb = \"ball {0}\"\nmodulus = 1e9\nfriction = 0.3\n",
        k, at[k][0], at[k][1], at[k][2]);
  std::ofstream(c / "scene.toml") << text;
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  Eigen::Matrix3d lever;
  for (int k = 0; k < 3; ++k) lever.col(k) << 1, at[k][0], at[k][1];
  const Vec3 weight = lever.inverse() * (30 * g * Vec3(1, 0.1, 0.2));
  const Results r(c / "run.h5");
  double aside = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd f = last(r, fmt::format("contact/{}", k));
    EXPECT_NEAR(f[2], weight[k], 5e-4 * weight[k]) << "the balls roll a little";
    EXPECT_NEAR(f[3], std::pow(f[2] / (4. / 3 * 1e9 * std::sqrt(0.1)), 2. / 3), 1e-6 * f[3]);
    aside += f[0];
  }
  EXPECT_NEAR(aside, -50, 1e-6);
  const Ran slides = c.run("hilo-solve --quiet scene.toml --set 'load.push.force=[100,0,0]' -o run.h5");
  EXPECT_EQ(slides.exit, 3) << slides.err;
  EXPECT_NE(slides.err.find("a part may slide where friction holds no more"), std::string::npos) << slides.err;
}

// Truth: Stribeck.  A ring of Z balls without play, each as stiff against either race: the ball at an angle psi from the load bears
// 4 F/Z cos(psi), those above it nothing.  Friction alone keeps balls from rolling away.
TEST(LoadSteps, ABallBearing) {
  constexpr int Z = 12;
  constexpr double r = 0.01, inner = 0.05, F = 1000;
  const Case c("contact");
  std::string text = fmt::format(
      "[[body]]\nname = \"shaft\"\nmass = 1\ncom = [0, 0, 0]\ninertia = [1e-3, 1e-3, 1e-3]\n"
      "[[obstacle]]\nkind = \"cylinder\"\nname = \"outer\"\naxis = [0, 0, 1]\nradius = {}\ninside = true\n"
      "[[obstacle]]\nkind = \"cylinder\"\nname = \"inner\"\non = \"shaft\"\naxis = [0, 0, 1]\nradius = {}\n"
      "[[joint]]\nkind = \"planar\"\nname = \"flat\"\na = \"ground\"\nb = \"shaft\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n"
      "[[spring]]\nkind = \"bushing\"\nname = \"twist\"\nb = \"shaft\"\nat = [0, 0, 0]\nangular_stiffness = [0, 0, 1]\n"
      "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"shaft\"\nforce = [{}, 0, 0]\n[time]\nanalysis = \"static\"\nsteps = 4\n",
      inner + 2 * r, inner, F);
  for (int i = 0; i < Z; ++i) {
    const double psi = 2 * std::numbers::pi * i / Z, x = (inner + r) * std::cos(psi), y = (inner + r) * std::sin(psi);
    text += fmt::format(
        "[[body]]\nname = \"ball {0}\"\nmass = 0.03\ncom = [{1}, {2}, 0]\ninertia = [1e-6, 1e-6, 1e-6]\n"
        "[[obstacle]]\nkind = \"sphere\"\nname = \"surface {0}\"\non = \"ball {0}\"\nat = [{1}, {2}, 0]\nradius = {3}\n"
        "[[spring]]\nkind = \"bushing\"\nname = \"cage {0}\"\nb = \"ball {0}\"\nat = [{1}, {2}, 0]\nstiffness = [1, 1, 1]\n"
        "angular_stiffness = [1e-3, 1e-3, 1e-3]\n",
        i, x, y, r);
    for (const char* race : {"outer", "inner"})
      text += fmt::format("[[contact]]\nname = \"{0} {1}\"\na = \"{0}\"\nb = \"surface {1}\"\nstiffness = 1e8\nfriction = 0.1\n", race, i);
  }
  c.write("scene.toml", text);
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results run(c / "run.h5");
  for (int i = 0; i < Z; ++i)
    for (const char* race : {"outer", "inner"})
      EXPECT_NEAR(last(run, fmt::format("contact/{} {}", race, i)).head<3>().norm(),
                  4 * F / Z * std::max(0.0, std::cos(2 * std::numbers::pi * i / Z)), 1e-6 * F)
          << race << " " << i;
}

// Truth: F = 48 E I w/L^3 of a beam whose ends slide over rollers, L less what these roll in by: 3 R w/L at either end.  The contact is 1e7
// times as stiff as the strip bends.
TEST(LoadSteps, AThinStripIsBentOverRollers) {
  constexpr double E = 2.1e11, t = 1e-3, b = 0.02, R = 0.01, half = 0.08;
  Mesh strip = block_mesh({.n = {40, 4, 1}, .low = Vec3(-0.1, 0, -t / 2), .high = Vec3(0.1, b, t / 2), .regions = {"strip"}});
  std::ranges::fill(strip.shape, static_cast<std::uint8_t>(shell8));
  add_node_set(strip, "mid", [](const Vec3& x) { return std::abs(x[0]) < 1e-9; });
  Case place("contact");
  place.use(strip, {Fidelity::nonlinear});
  const auto run = [&](double w, double friction, int steps) {
    std::string scene = fmt::format(
        "material.steel = {{E = {}, nu = 0.3, density = 7850}}\nregion.\"*\" = {{material = \"steel\"}}\n"
        "motion = [{{kind = \"translation\", name = \"down\", on = \"mid\", displacement = [0, 0, {}], history = {{t = [0, 1], value = [0, "
        "1]}}}}]\n"
        "time = {{analysis = \"static\", steps = {}}}\n",
        E, -w, steps);
    for (const char* side : {"left", "right"})
      scene += fmt::format(
          "[[obstacle]]\nkind = \"cylinder\"\nname = \"{0}\"\nat = [{1}, 0, {2}]\naxis = [0, 1, 0]\nradius = {3}\n"
          "[[contact]]\nname = \"on the {0}\"\na = \"{0}\"\nb = \"zmin\"\nfriction = {4}\n",
          side, side[0] == 'l' ? -half : half, -t / 2 - R, R, friction);
    place.write("scene.toml", scene);
    succeeded(place.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
    EXPECT_LT(place.reported("newton_iterations"), 40 * steps) << w;
    EXPECT_EQ(place.reported("cuts"), 0) << w;
    const Results r(place / "run.h5");
    return last(r, "contact/on the left")[2] + last(r, "contact/on the right")[2];
  };
  const double w = 2e-3, L = 2 * half - 2 * R * 3 * w / (2 * half), theory = 48 * E * (b * t * t * t / 12) * w / (L * L * L);
  EXPECT_NEAR(run(w, 0, 2), theory, 0.03 * theory);
  run(0.03, 0.3, 10);
}

// Truth: F = 48 E I w/L^3, as above, of a strip that nothing but two rollers and a punch holds, all three drawn as they touch: without
// friction it is free along itself and across.  With it, the answer is that of any number of steps, to what friction remembers.
TEST(LoadSteps, AStripIsBentInThreePoints) {
  constexpr double E = 2.1e11, t = 4e-3, b = 0.02, R = 0.01, half = 0.08, w = 5e-3;
  Case place("contact");
  place.use(block_mesh({.n = {40, 2, 2}, .low = Vec3(-0.1, 0, -t / 2), .high = Vec3(0.1, b, t / 2), .regions = {"strip"}}),
            {Fidelity::nonlinear});
  const auto force = [&](double friction, int steps) {
    std::string scene = fmt::format(
        "gravity = [0, 0, -9.81]\nmaterial.steel = {{E = {}, nu = 0.3, density = 7850}}\nregion.\"*\" = {{material = \"steel\"}}\n"
        "body = [{{name = \"ram\", mass = 1, com = [0, 0, {}], inertia = [1, 1, 1]}}]\n"
        "motion = [{{kind = \"translation\", name = \"down\", on = \"ram\", displacement = [0, 0, {}], history = {{t = [0, 1], value = [0, "
        "1]}}}}]\ntime = {{analysis = \"static\", steps = {}}}\n",
        E, R + t / 2, -w, steps);
    for (const auto& [name, x, side, on] :
         {std::tuple("left", -half, -1., ""), {"right", half, -1., ""}, {"punch", 0., 1., "on = \"ram\"\n"}})
      scene += fmt::format(
          "[[obstacle]]\nkind = \"cylinder\"\nname = \"{0}\"\nat = [{1}, 0, {2}]\naxis = [0, 1, 0]\nradius = {3}\n{4}"
          "[[contact]]\nname = \"at {0}\"\na = \"{0}\"\nb = \"{5}\"\nfriction = {6}\n",
          name, x, side * (R + t / 2), R, on, side < 0 ? "zmin" : "zmax", friction);
    place.write("scene.toml", scene);
    succeeded(place.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
    EXPECT_LE(place.reported("cuts"), 8 * steps) << friction;
    return -last(Results(place / "run.h5"), "contact/at punch")[2];
  };
  const double L = 2 * half - 2 * R * 3 * w / (2 * half), theory = 48 * E * (b * t * t * t / 12) * w / (L * L * L);
  EXPECT_NEAR(force(0, 4), theory, 0.03 * theory);
  const double few = force(0.2, 4);
  EXPECT_NEAR(few, theory, 0.03 * theory);
  EXPECT_NEAR(force(0.2, 10), few, 1e-3 * few);
}

// Truth: weight and pressure, on each plate those of what lies above it, wherever the plates were drawn.
TEST(LoadSteps, WhatIsDrawnApartComesToLie) {
  constexpr double rho = 7850, side = 0.1, t = 0.01, p = 1e5, weight = rho * side * side * t * g, pressed = p * side * side;
  const auto plate = [&](const char* name, double z) {
    return block_mesh({.n = {4, 4, 1}, .low = Vec3(0, 0, z), .high = Vec3(side, side, z + t), .regions = {name}});
  };
  Case place("contact");
  place.use(together(plate("low", 2e-3), plate("up", t + 5e-3)), {Fidelity::nonlinear, Fidelity::rigid});
  place.write(
      "scene.toml",
      fmt::format("gravity = [0, 0, {}]\nmaterial.steel = {{E = 2.1e11, nu = 0.3, density = {}}}\nregion.\"*\" = {{material = \"steel\"}}\n"
                  "obstacle = [{{kind = \"plane\", name = \"floor\"}}]\n"
                  "contact = [{{name = \"on the floor\", a = \"floor\", b = \"low\", friction = 0.2}},\n"
                  "{{name = \"on the other\", a = \"low\", b = \"up\", friction = 0.2}}]\n"
                  "load = [{{kind = \"pressure\", name = \"p\", on = \"upzmax\", pressure = {}}}]\n"
                  "time = {{analysis = \"static\", steps = 2}}\n",
                  -g, rho, p));
  succeeded(place.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
  const Results r(place / "run.h5");
  EXPECT_NEAR(last(r, "contact/on the floor")[2], pressed + 2 * weight, 1e-6 * pressed);
  EXPECT_NEAR(last(r, "contact/on the other")[2], pressed + weight, 1e-3 * pressed) << "of a pressure that turns with the plate";
  place.use(plate("low", 2e-3), {Fidelity::nonlinear});
  place.write("scene.toml",
              "gravity = [0, 0, -9.81]\nmaterial.steel = {E = 2.1e11, nu = 0.3, density = 7850}\nregion.low = {material = \"steel\"}\n"
              "obstacle = [{kind = \"cylinder\", name = \"post\", at = [1, 0, 0], axis = [0, 0, 1], radius = 0.1}]\n"
              "contact = [{name = \"beside it\", a = \"post\", b = \"low\"}]\ntime = {analysis = \"static\", steps = 2}\n");
  const Ran falls = place.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5");
  expect_end(falls, 3, "\"low\" is free to move");
  expect_words(falls.err, "m apart");
}

// Truth: two leaves that rub on each other bear F as two beams side by side, F L^3/(6 E I), but for what friction takes, mu t/L of it;
// where loads only grow, the answer is that of any number of steps.
TEST(LoadSteps, TwoLeavesRubOnEachOther) {
  constexpr double E = 2.1e11, t = 1e-3, b = 0.02, L = 0.2, F = 4;
  Mesh leaf[2];
  for (int k = 0; k < 2; ++k) {
    leaf[k] = block_mesh({.n = {20, 2, 1}, .low = Vec3(0, 0, k * t), .high = Vec3(L, b, (k + 1) * t), .regions = {k ? "up" : "low"}});
    std::ranges::fill(leaf[k].shape, static_cast<std::uint8_t>(shell8));
  }
  Case place("contact");
  place.use(together(leaf[0], leaf[1]), {Fidelity::nonlinear, Fidelity::nonlinear});
  double tip[2];
  for (const int k : {0, 1}) {
    place.write(
        "scene.toml",
        fmt::format("material.steel = {{E = {}, nu = 0, density = 7850}}\nregion.\"*\" = {{material = \"steel\"}}\n"
                    "contact = [{{name = \"c\", a = \"lowzmax\", b = \"upzmin\", friction = 0.2}}]\n"
                    "motion = [{{kind = \"fixed\", name = \"1\", on = \"lowxmin\"}}, {{kind = \"fixed\", name = \"2\", on = \"upxmin\"}}]\n"
                    "load = [{{kind = \"force\", name = \"tip\", on = \"upxmax\", force = [0, 0, {}]}}]\n"
                    "probe = [{{name = \"tip\", on = \"upxmax\"}}]\ntime = {{analysis = \"static\", steps = {}}}\n",
                    E, -F, k ? 4 : 2));
    succeeded(place.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
    EXPECT_EQ(place.reported("cuts"), 0);
    EXPECT_LT(place.reported("newton_iterations"), 150 * (k ? 4 : 2));  // the way there hangs on rounding
    tip[k] = 1.5 * t - last(Results(place / "run.h5"), "probe/tip")[2];
  }
  const double theory = F * L * L * L / (6 * E * b * t * t * t / 12);
  EXPECT_NEAR(tip[0], theory, 0.01 * theory);
  EXPECT_NEAR(tip[1], tip[0], 1e-9 * theory);
}

// Truth: Lame's pressure of two rings that overlap.  Flat facets whose nodes lie opposite each other bear it; those that face each other
// askew do not, as their sag is as large as the overlap: the run says so.
TEST(LoadSteps, APressFitOfFacetsThatFaceEachOtherAskewIsTold) {
  constexpr double a = 0.03, b = 0.05, c = 0.07, E = 210e9, overlap = 2e-5, h = 0.005;
  const double pressure = E * overlap / b * (b * b - a * a) * (c * c - b * b) / (2 * b * b * (c * c - a * a));
  for (const int n : {16, 22}) {
    BlockOptions rings[2];
    for (BlockOptions& o : rings) {
      const bool outer = &o == &rings[1];
      o.regions = {outer ? "outer" : "inner"}, o.n[0] = 6, o.n[1] = outer ? n : 16;
      o.low = Vec3(outer ? b - overlap / 2 : a, 0, 0), o.high = Vec3(outer ? c : b + overlap / 2, std::numbers::pi / 2, h);
      o.map = [](const Vec3& x) { return Vec3(x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), x[2]); };
    }
    Case place("contact");
    place.use(together(block_mesh(rings[0]), block_mesh(rings[1])), {Fidelity::nonlinear, Fidelity::nonlinear});
    std::string scene =
        "material.steel = {E = 210e9, nu = 0.3, density = 7850}\nregion.\"*\" = {material = \"steel\"}\n"
        "contact = [{name = \"fit\", a = \"inner\", b = \"outer\"}]\ntime = {analysis = \"static\", steps = 1}\n";
    for (const char* part : {"inner", "outer"})
      for (const auto& [set, along] : {std::pair("ymin", "y"), {"ymax", "x"}, {"zmin", "z"}})
        scene +=
            fmt::format("[[motion]]\nkind = \"fixed\"\nname = \"{0} {2}\"\non = \"{0}{1}\"\ncomponents = [\"{2}\"]\n", part, set, along);
    place.write("scene.toml", scene);
    const Ran ran = succeeded(place.run("hilo-solve scene.toml tags.h5 -o run.h5"));
    const double force = last(Results(place / "run.h5"), "contact/fit")[0] / (pressure * b * h);
    const bool told = ran.err.find("is the sag of flat facets that face each other askew") != std::string::npos;
    EXPECT_EQ(told, n != 16) << ran.err;
    if (n == 16)
      EXPECT_NEAR(force, 1, 0.002);
    else
      EXPECT_GT(std::abs(force - 1), 0.1);
  }
}

}  // namespace
}  // namespace hilo::test::load_steps_test
