// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of points with obstacles: energy and momenta of every step at any length of it, and closed forms of friction.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "dynamics/kept_run.hpp"
#include "succeeded.hpp"
#include "verify/block_mesh.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::contact_test {
namespace {

constexpr double g = 9.81;

// Truth: nothing acts from outside.  A ball of 1 kg meets a ring of 2 kg, spinning, oblique; the contact takes pi sqrt(mu/k) = 0.057 s.
TEST(Contact, BodyOnBodyKeepsEnergyAndMomentaAtAnyStep) {
  const Case c("contact");
  for (const char* friction : {"0", "0.4"})
    for (const double share : shares) {
      const Results r =
          c.solved(fmt::format("--set contact.c.friction={} --set time.step={} --set solver.tolerance=1e-12", friction, 0.057 * share),
                   "run.h5", "two");
      const Worst w = worst_of(r, 1, 0.1);
      EXPECT_LT(w.energy, 1e-11) << friction << " " << share;
      EXPECT_LT(w.momentum, 1e-11) << friction << " " << share;
      EXPECT_LT(w.angular, 1e-11) << friction << " " << share;
      EXPECT_LE(w.given_back, 1e-15) << friction << " " << share;
      EXPECT_TRUE(share > 0.4 || w.met > 0) << share;
      EXPECT_TRUE(share > 0.4 || friction[1] == 0 || r.history("energy").bottomRows(1)(0, 4) > 0.01) << "a contact that really rubs";
    }
}

void take_block(Case& c, Shape shape, Fidelity fidelity) {
  BlockOptions o;
  o.shape = shape;
  o.n[0] = 3, o.n[1] = o.n[2] = 2, o.high = Vec3(1, 0.6, 0.4);
  c.use(block_mesh(o), {fidelity});
}

// Truth: the ground does no work.  A corner of the block comes first; a contact takes some 0.06 s.
TEST(Contact, BlockThrownAtTheGroundKeepsItsEnergyAtAnyStep) {
  for (const Fidelity fidelity : {Fidelity::nonlinear, Fidelity::linear, Fidelity::rigid}) {
    Case c("contact");
    take_block(c, Shape::hex8, fidelity);
    const std::string stiff = fidelity == Fidelity::rigid ? " --set contact.c.modulus=2e6 --set contact.c.layer=0.2" : "";
    for (const char* friction : {"0", "0.5"})
      for (const double share : shares) {
        const Results r =
            c.solved(fmt::format("--set contact.c.friction={} --set time.step={} --set time.end={} --set solver.tolerance=1e-12{}",
                                 friction, 0.06 * share, share < 0.1 ? 0.2 : 0.6, stiff),
                     "run.h5", "drop");
        const Worst w = worst_of(r, 1, 1);
        EXPECT_LT(w.energy, 1e-11) << word(fidelity) << friction << " " << share;
        EXPECT_LE(w.given_back, 1e-15) << word(fidelity) << friction << " " << share;
        EXPECT_TRUE(share > 0.4 || w.met > 0) << share;
      }
  }
}

TEST(Contact, RegionAndFreeBodyKeepEnergyAndMomentaAtAnyStep) {
  for (const Shape shape : {Shape::hex8, Shape::tet10, Shape::hex20, Shape::wedge6})
    for (const Fidelity fidelity : {Fidelity::nonlinear, Fidelity::linear, Fidelity::rigid}) {
      if (shape != Shape::hex8 && fidelity != Fidelity::nonlinear) continue;
      Case c("contact");
      take_block(c, shape, fidelity);
      const std::string stiff = fidelity == Fidelity::rigid ? " --set contact.c.modulus=2e6 --set contact.c.layer=0.2" : "";
      for (const double share : shape == Shape::hex8 ? shares : std::vector<double>{0.2}) {
        const Results r = c.solved(fmt::format("--set time.step={} --set time.end={} --set solver.tolerance=1e-12{}", 0.06 * share,
                                               share < 0.1 ? 0.1 : 0.3, stiff),
                                   "run.h5", "ram");
        const Worst w = worst_of(r, 150, 50);
        EXPECT_LT(w.energy, 1e-11) << info(shape).name << word(fidelity) << share;
        EXPECT_LT(w.momentum, 1e-11) << info(shape).name << word(fidelity) << share;
        EXPECT_LT(w.angular, 1e-11) << info(shape).name << word(fidelity) << share;
        EXPECT_LE(w.given_back, 1e-15) << info(shape).name << word(fidelity) << share;
        EXPECT_GT(w.met, 0) << info(shape).name << word(fidelity) << share;
      }
    }
}

/// A scene whose lengths are `s` times as large, gravity the same: velocities and times go with sqrt(s), masses with s^3, stiffness with
/// s^2.
std::string scaled(double s, const std::string& more = "") {
  const double v = std::sqrt(s), m = s * s * s, J = m * s * s;
  return fmt::format(
      "--set body.block.mass={:.16e} --set 'body.block.com=[0,0,{:.16e}]' --set 'body.block.inertia=[{:.16e},{:.16e},{:.16e}]' "
      "--set 'obstacle.skin.size=[{:.16e},{:.16e},{:.16e}]' --set 'obstacle.skin.at=[0,0,{:.16e}]' --set contact.c.stiffness={:.16e} "
      "--set 'initial.1.velocity=[{:.16e},0,0]' --set time.end={:.16e} --set time.step={:.16e} {}",
      500 * m, 0.25 * s, 52.0833333 * J, 104.1666667 * J, 104.1666667 * J, s, s, 0.5 * s, 0.2499975475 * s, 5e8 * s * s, 3 * v, 1.5 * v,
      0.01 * v, more);
}

// Truth: v^2/(2 mu g).
TEST(Contact, BlockSlidesToRest) {
  const Case c("contact");
  const Results r = c.solved("", "run.h5", "block");
  const auto x = r.history("probe/p");
  const double way = 9 / (2 * 0.3 * g);
  EXPECT_NEAR(x(x.rows() - 1, 0), way, 1e-4 * way);
  EXPECT_NEAR(x(x.rows() - 1, 0), x(x.rows() - 31, 0), 1e-6) << "it stays there";
  EXPECT_NEAR(r.history("energy").bottomRows(1)(0, 4), 500 * 9 / 2., 0.01);
  EXPECT_NEAR(r.history("contact/c").bottomRows(1)(0, 5), way, 1e-3 * way);
}

// Truth: with tan 0.3 and mu 0.5 it stays but for the bristles, m g sin/(4 kt); with tan 0.5 and mu 0.3 it goes g (sin - mu cos) t^2/2.
TEST(Contact, BlockOnASlopeSticksOrSlides) {
  const Case c("contact");
  const auto on_slope = [&](double tangent, double mu) {
    const double a = std::atan(tangent), depth = 500 * g * std::cos(a) / (4 * 5e8);
    return c.solved(
        fmt::format("--set 'gravity=[{:.17g},0,{:.17g}]' --set contact.c.friction={} --set 'initial.1.velocity=[0,0,0]' --set time.end=2 "
                    "--set 'obstacle.skin.at=[0,0,{:.17g}]'",
                    g * std::sin(a), -g * std::cos(a), mu, 0.25 - depth),
        "run.h5", "block");
  };
  const Results stuck = on_slope(0.3, 0.5);
  const auto x = stuck.history("probe/p");
  EXPECT_LT(x.col(0).cwiseAbs().maxCoeff(), 5e-6);
  EXPECT_NEAR(x(x.rows() - 1, 0), x(x.rows() / 2, 0), 1e-6);
  const Results slid = on_slope(0.5, 0.3);
  const auto y = slid.history("probe/p");
  const double a = std::atan(0.5), way = g * (std::sin(a) - 0.3 * std::cos(a)) * 2;
  EXPECT_NEAR(y(y.rows() - 1, 0), way, 1e-9 * way);
}

// Truth: 5/7 of the velocity from 2 v/(7 mu g) on, and no creep after.
TEST(Contact, BallThatSlidesComesToRoll) {
  const Case c("contact");
  const Results r = c.solved("", "run.h5", "ball");
  const auto x = r.history("probe/p");
  const double T = 2 * 5 / (7 * 0.2 * g);
  for (Eigen::Index k = 0; k < x.rows(); ++k) {
    const double t = r.t()[k], v = t < T ? 5 - 0.2 * g * t : 25. / 7;
    EXPECT_NEAR(x(k, 3), v, std::abs(t - T) < 0.01 ? 2e-2 : 5e-3) << t;
  }
  EXPECT_NEAR(x(x.rows() - 1, 3), 25. / 7, 5e-3);
  const double way = 5 * T - 0.1 * g * T * T + 25. / 7 * (1.5 - T);
  EXPECT_NEAR(x(x.rows() - 1, 0), way, 1e-5 * way);
}

// Truth: g sin(a)/(1 + 2/5/sin(b)^2), as a ball in a groove of half angle b rolls about the line through both points that it touches.
TEST(Contact, ABallRollsDownAGroove) {
  const Case c("contact");
  for (const double b : {0.4, 1.3}) {
    const double R = 0.1, high = R / std::sin(b) - 1e-6, a = 0.1;
    std::string text = fmt::format(
        "gravity = [{}, 0, {}]\n[[body]]\nname = \"ball\"\nmass = 4\ncom = [0, 0, {}]\ninertia = [0.016, 0.016, 0.016]\n[[obstacle]]\n"
        "kind = \"sphere\"\nname = \"skin\"\non = \"ball\"\nradius = {}\nat = [0, 0, {}]\n[[probe]]\nname = \"p\"\non = \"ball\"\n"
        "[time]\nend = 1\nstep = 0.01\n",
        g * std::sin(a), -g * std::cos(a), high, R, high);
    for (const int side : {-1, 1})
      text += fmt::format(
          "[[obstacle]]\nkind = \"plane\"\nname = \"{0}\"\naxis = [0, {1}, {2}]\n[[contact]]\nname = \"{0}\"\na = \"{0}\"\nb = \"skin\"\n"
          "stiffness = 1e7\nfriction = 0.5\n",
          side < 0 ? "left" : "right", side * std::cos(b), std::sin(b));
    std::ofstream(c / "groove.toml") << text;
    succeeded(c.run("hilo-solve --quiet groove.toml -o run.h5"));
    const double way = g * std::sin(a) / (1 + 0.4 / (std::sin(b) * std::sin(b))) / 2;
    EXPECT_NEAR(Results(c / "run.h5").at("probe/p", 1)[0], way, 2e-5 * way) << b;
  }
}

// Truth: the same of a region, whose points share the load; it is set down without a bounce, and shakes a little as it stops.
TEST(Contact, RegionSlidesToRest) {
  for (const Fidelity fidelity : {Fidelity::nonlinear, Fidelity::linear, Fidelity::rigid}) {
    Case c("contact");
    take_block(c, Shape::hex8, fidelity);
    const std::string stiff = fidelity == Fidelity::rigid ? " --set contact.c.modulus=2e8 --set contact.c.layer=0.2" : "";
    const Results r = c.solved(
        "--set 'gravity=[0,0,-9.81]' --set 'obstacle.ground.at=[0,0,0]' --set contact.c.friction=0.3 --set material.soft.E=2e8 "
        "--set 'initial.1.velocity=[1,0,0]' --set 'initial.1.spin=[0,0,0]' --set time.end=0.5 --set time.step=1e-3" +
            stiff,
        "run.h5", "drop");
    const double way = 1 / (2 * 0.3 * g);
    const auto x = r.history("probe/p");
    EXPECT_NEAR(x(x.rows() - 1, 0) - x(0, 0), way, 5e-3 * way) << word(fidelity);
    EXPECT_NEAR(r.history("energy").bottomRows(1)(0, 4), 240 * 0.5, 3e-3 * 120) << word(fidelity);
    EXPECT_LT(r.history("energy").bottomRows(1)(0, 0), 3e-4 * 120) << word(fidelity);
  }
}

TEST(Contact, ScenesOfAnotherSizeAreTheSame) {
  const Case c("contact");
  double first = 0;
  for (const double s : {1., 1e-3, 1e3}) {
    const Results r = c.solved(scaled(s), "run.h5", "block");
    const double x = r.history("probe/p").bottomRows(1)(0, 0) / s;
    if (first == 0) first = x;
    EXPECT_NEAR(x, first, 1e-6 * first) << s;
  }
}

// Truth: a ball that falls on a plane comes back to where it fell from; Hertz, approach v: 2.9432 (25/16 m^2/(K^2 v))^(1/5) in all, with
// the depth (5 m v^2/(4 K))^(2/5).
TEST(Contact, BallOfHertzBounces) {
  const Case c("contact");
  const double K = 4. / 3 * 1e7 * std::sqrt(0.1), m = 4.18879, v = 0.5;
  const double time = 2.9432 * std::pow(25. / 16 * m * m / (K * K * v), 0.2), depth = std::pow(5 * m * v * v / (4 * K), 0.4);
  const Results r = c.solved(
      fmt::format("--set contact.c.modulus=1e7 --set 'gravity=[0,0,0]' --set 'obstacle.skin.at=[0,0,0.1]' --set 'body.ball.com=[0,0,0.1]' "
                  "--set 'initial.1.velocity=[0,0,-0.5]' --set time.end={} --set time.step={}",
                  1.5 * time, time / 200),
      "run.h5", "hertz");
  const auto x = r.history("probe/p"), f = r.history("contact/c");
  EXPECT_NEAR(f.col(3).maxCoeff(), depth, 2e-3 * depth);
  EXPECT_NEAR(f.col(2).maxCoeff(), K * std::pow(depth, 1.5), 5e-3 * K * std::pow(depth, 1.5));
  EXPECT_NEAR(x(x.rows() - 1, 5), v, 1e-9);
  EXPECT_NEAR((x(x.rows() - 1, 2) - 0.1) / v, 0.5 * time, 5e-3 * time) << "when it left";
}

// Truth: of a linear bar that falls on rigid ground, contacts from 1 to 1.6667 s, 3.6667 to 4.3333, 6.3333 to 7, and no energy lost
// (Doyen, Ern, Piperno 2011).
TEST(Contact, BarBouncesThreeTimes) {
  Case c("contact");
  BlockOptions o;
  o.n[2] = 100, o.low = Vec3(0, 0, 0.05), o.high = Vec3(0.1, 0.1, 10.05);
  c.use(block_mesh(o));
  // steps of 1/sqrt(2) of the time that a wave takes through a cell: what they add to its period is what the mesh takes from it
  const Results r = c.solved(fmt::format("--set time.step={}", 0.1 / 30 / std::numbers::sqrt2), "run.h5", "bar");
  const auto f = r.history("contact/c"), e = r.history("energy");
  std::vector<double> changes;
  for (Eigen::Index k = 1; k < f.rows(); ++k)
    if ((f(k, 3) > 0) != (f(k - 1, 3) > 0) && (changes.empty() || r.t()[k] > changes.back() + 0.1)) changes.push_back(r.t()[k]);
  const double truth[] = {1, 5. / 3, 11. / 3, 13. / 3, 19. / 3, 7};
  ASSERT_EQ(changes.size(), 6u);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(changes[k], truth[k], 0.05) << k;
  for (int k = 0; k < 6; k += 2) EXPECT_NEAR(changes[k + 1] - changes[k], 2. / 3, 0.02 * 2 / 3) << k;
  EXPECT_LT(e.col(5).cwiseAbs().maxCoeff(), 1e-8 * e.col(0).maxCoeff());
  // the force of the wave, rho c A v, of parts that fall the faster the later it stops them
  double force = 0, n = 0;
  for (Eigen::Index k = 0; k < f.rows(); ++k)
    if (std::abs(r.t()[k] - 1.3) < 0.2) force += f(k, 2), ++n;
  EXPECT_NEAR(force / n, 30 * 0.01 * (0.1 + 0.1 * 0.3), 0.01 * 0.039);
}

/// A body that carries an obstacle of about 1 m, and another one with a ball, or a box where a container or a plane is met, thrown at it.
std::string throw_of(int seed) {
  Dice dice(seed);
  const std::vector<std::string> kinds{
      "kind = \"plane\"\nat = [0, 0, 0.5]",
      "kind = \"sphere\"\nradius = 0.5",
      "kind = \"cylinder\"\nradius = 0.5\naxis = [0, 1, 0]",
      "kind = \"cylinder\"\nradius = 0.6\nlength = 1",
      "kind = \"capsule\"\nradius = 0.4\nlength = 0.7\naxis = [1, 0.2, 0]",
      "kind = \"torus\"\nradius = 0.45\ntube = 0.2",
      "kind = \"box\"\nsize = [1, 0.8, 0.9]\naxis = [0.3, 0.2, 1]",
      "kind = \"box\"\nsize = [2, 2.4, 3]\nat = [0, 0, 1]\ninside = true",
      "kind = \"cylinder\"\nradius = 1.2\nat = [0, 0, 1]\naxis = [0.1, 1, 0]\ninside = true",
      "kind = \"sphere\"\nradius = 1.4\nat = [0, 0, 1]\ninside = true",
  };
  const size_t kind = static_cast<size_t>(seed) % kinds.size();
  const bool hollow = kind == 0 || kind >= 7, box = hollow && dice() < 0.5, hertz = !box && kind < 2;
  const double v = std::pow(10, dice(-1.5, 0.7)), k = std::pow(10, dice(3, 5));
  // a contact takes pi sqrt(m/k), m 0.67 kg
  const double contact = std::numbers::pi * std::sqrt(0.67 / k), step = contact * std::pow(10, dice(-1.5, 0.3));
  const std::string z = hollow && kind > 0 ? "1" : "1.05";
  std::string text = fmt::format(
      "[[body]]\nname = \"A\"\nmass = 2\ninertia = [0.25, 0.3, 0.35]\ncom = [0, 0, 0]\n[[body]]\nname = \"B\"\nmass = 1\n"
      "inertia = [0.015, 0.02, 0.025]\ncom = [0.1, 0.05, {}]\n[[obstacle]]\nname = \"o\"\non = \"A\"\n{}\n[[obstacle]]\nname = \"s\"\non = "
      "\"B\"\nat = [0.12, 0.05, {}]\n{}\n",
      z, kinds[kind], z, box ? "kind = \"box\"\nsize = [0.3, 0.4, 0.2]" : "kind = \"sphere\"\nradius = 0.15");
  text += fmt::format("[[contact]]\nname = \"c\"\na = \"o\"\nb = \"s\"\nfriction = {}\n{} = {}\n", dice() < 0.3 ? 0 : dice(0, 1.5),
                      hertz ? "modulus" : "stiffness", hertz ? 10 * k : k);
  text +=
      fmt::format("[[initial]]\non = [\"A\"]\nvelocity = {}\nspin = {}\n[[initial]]\non = [\"B\"]\nvelocity = [{}, {}, {}]\nspin = {}\n",
                  dice.vector(0.2 * v), dice.vector(v), dice(-0.3, 0.3) * v, dice(-0.3, 0.3) * v, -v, dice.vector(3 * v));
  return text + fmt::format("[solver]\ntolerance = 1e-12\n[time]\nend = {}\nstep = {}\n", std::min(60 * step + 1.5 / v, 400 * step), step);
}

// Truth: nothing acts from outside, whatever is thrown.
TEST(Contact, TwoHundredThrowsKeepEnergyAndMomenta) {
  const Workplace place;
  int met = 0, rubbed = 0;
  for (int seed = 0; seed < 200; ++seed) {
    std::ofstream(place / "scene.toml") << throw_of(seed);
    succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"), std::to_string(seed));
    const Results r(place / "run.h5");
    const auto p = r.history("momentum"), e = r.history("energy");
    const double v = std::sqrt(e.col(0).maxCoeff());
    const Worst w = worst_of(r, 2 * v, v);
    EXPECT_LT(w.energy, 1e-11) << seed;
    EXPECT_LT(w.momentum, 1e-11) << seed;
    EXPECT_LT(w.angular, 1e-11) << seed;
    EXPECT_LE(w.given_back, 1e-14) << seed;
    met += w.met > 0, rubbed += e.bottomRows(1)(0, 4) > 1e-3 * w.top;
  }
  EXPECT_GT(met, 120);
  EXPECT_GT(rubbed, 60);
}

// Truth: a ball whose energy the obstacle can store, at a depth of v sqrt(m/k) below what would part them, stays on its side.  Steps of 0.1
// to 1.5 of the contact begin or end within the obstacle at any depth: one that touches there at one end must not have gone on through it.
TEST(Contact, NothingThatTouchesGoesThrough) {
  struct Shot {
    const char* obstacle;
    double k, v;
  };
  const Workplace place;
  for (const auto& [obstacle, k, v] : {Shot{"cylinder\"\nradius = 0.1\naxis = [0, 1, 0]", 1.9e4, 6.8},
                                       {"box\"\nsize = [2, 4, 0.1]", 2e4, 13},
                                       {"capsule\"\nradius = 0.1\nlength = 1\naxis = [1, 0, 0]", 1.4e5, 13.5},
                                       {"torus\"\nradius = 0.5\ntube = 0.1\nat = [0.5, 0, 0]", 1.6e4, 13},
                                       {"sphere\"\nradius = 0.1", 3.7e4, 13.4}})
    for (const char* method : {"energy-momentum", "generalized-alpha"})
      for (int phase = 0; phase < 6; ++phase) {
        const double h = std::numbers::pi / std::sqrt(k) * std::array{0.7, 1., 1.5, 3., 4., 10.}[phase], z = 0.5 + v * h * phase / 6;
        const std::string at = fmt::format("[0, 0.02, {}]", z);
        std::ofstream(place / "scene.toml") << fmt::format(
            "[[body]]\nname = \"b\"\nmass = 1\ncom = {0}\ninertia = [0.004, 0.004, 0.004]\n[[obstacle]]\nname = \"s\"\non = \"b\"\nkind = "
            "\"sphere\"\nradius = 0.1\nat = {0}\n[[obstacle]]\nname = \"o\"\nkind = \"{1}\n[[contact]]\nname = \"c\"\na = \"o\"\nb = "
            "\"s\"\nstiffness = {2}\n[[initial]]\non = [\"b\"]\nvelocity = [0, 0, {3}]\n[time]\nend = {4}\nstep = {5}\nintegrator = "
            "\"{6}\"\n",
            at, obstacle, k, -v, 2 / v, h, method);
        succeeded(place.run("hilo-solve --quiet scene.toml -o run.h5"), obstacle);
        const auto b = Results(place / "run.h5").history("body/b");
        EXPECT_GT(b(b.rows() - 1, 2), 0) << obstacle << " " << method << " " << phase;
      }
}

// Truth: a ball between four points of facets of 0.25 m, at (0.053, 0.053) about a corner, meets none of them; one of 0.15 m meets some
// anywhere.
TEST(Contact, WhatMayPassBetweenPointsIsTold) {
  BlockOptions o;
  o.n[0] = o.n[1] = 4, o.low = Vec3(-0.5, -0.5, -0.1), o.high = Vec3(0.5, 0.5, 0);
  Case c("contact");
  c.use(block_mesh(o), {Fidelity::nonlinear});
  const auto said = [&](const std::string& obstacle) {
    std::ofstream(c / "scene.toml")
        << "[material.m]\nE = 1e8\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n[[obstacle]]\nname = "
           "\"o\"\nat = [0, 0, 3]\n"
        << obstacle << "\n[[contact]]\nname = \"c\"\na = \"o\"\nb = \"block\"\n[time]\nstep = 0.01\nend = 5\n";
    return c.run("hilo-solve --dry-run scene.toml tags.h5").err.find("may pass between them unseen") != std::string::npos;
  };
  EXPECT_TRUE(said("kind = \"sphere\"\nradius = 0.03"));
  EXPECT_TRUE(said("kind = \"capsule\"\nradius = 0.05\nlength = 2"));
  EXPECT_TRUE(said("kind = \"box\"\nsize = [0.1, 0.1, 2]"));
  EXPECT_FALSE(said("kind = \"sphere\"\nradius = 0.15"));
  EXPECT_FALSE(said("kind = \"box\"\nsize = [1, 2, 0.1]"));
  EXPECT_FALSE(said("kind = \"plane\""));
}

TEST(Contact, GoesOnBitByBit) {
  const Folder folder;
  const Case c("contact");
  expect_goes_on(folder.path(), text_of(c.source("two.toml")), "", {10, 25, 28, 40}, {"contact.c.friction=0.4"});
  expect_goes_on(folder.path(), text_of(c.source("block.toml")), "", {20, 100});
}

}  // namespace
}  // namespace hilo::test::contact_test
