// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces against each other: energy and momenta of every step at any length of it, whatever the regions are, and closed forms.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>

#include "dynamics/kept_run.hpp"
#include "share.hpp"
#include "succeeded.hpp"
#include "verify/contact/collision.hpp"

namespace hilo::test::surfaces_test {
namespace {

/// Two blocks, B turned and above a face of A with a corner ahead.
Mesh blocks(Shape a, Shape b) {
  BlockOptions A, B;
  A.shape = a, A.n[0] = A.n[1] = 3, A.n[2] = 2, A.high = Vec3(1, 1, 0.6), A.regions = {"A"};
  B.shape = b, B.n[0] = 2, B.n[1] = B.n[2] = 3, B.high = Vec3(0.7, 0.9, 1), B.regions = {"B"};
  const Mat3 turn = (Eigen::AngleAxisd(0.5, Vec3::UnitZ()) * Eigen::AngleAxisd(0.4, Vec3::UnitY())).toRotationMatrix();
  double low = 0;
  for (int k = 0; k < 8; ++k) low = std::min(low, (turn * Vec3(k & 1 ? 0.35 : -0.35, k & 2 ? 0.45 : -0.45, k & 4 ? 0.5 : -0.5))[0]);
  B.map = [=](const Vec3& x) { return Vec3(turn * (x - Vec3(0.35, 0.45, 0.5)) + Vec3(1.01 - low, 0.45, 0.25)); };
  return together(block_mesh(A), block_mesh(B));
}

std::string stiff_if_rigid(Fidelity a, Fidelity b) {
  return a == Fidelity::rigid && b == Fidelity::rigid ? " --set contact.c.modulus=2e6 --set contact.c.layer=0.2" : "";
}

void expect_kept(const Worst& w, const std::string& what) {
  EXPECT_LT(w.energy, 1e-11) << what;
  EXPECT_LT(w.momentum, 1e-11) << what;
  EXPECT_LT(w.angular, 1e-11) << what;
  EXPECT_LE(w.given_back, 1e-15) << what;
}

// Truth: nothing acts from outside.  A contact takes some 0.06 s; momenta of each block are about 1200 kg m/s and 300 kg m^2/s.
TEST(Surfaces, BlocksKeepEnergyAndMomentaAtAnyStep) {
  using enum Fidelity;
  for (const auto& [a, b] : {std::pair{nonlinear, nonlinear}, {nonlinear, rigid}, {linear, nonlinear}, {rigid, linear}, {rigid, rigid}}) {
    Case c("contact");
    c.use(blocks(Shape::hex8, Shape::hex8), {a, b});
    for (const char* friction : {"0", "0.3"})
      for (const double share : shares) {
        const std::string what = fmt::format("{} {} mu {} share {}", word(a), word(b), friction, share);
        const Results r =
            c.solved(fmt::format("--set contact.c.friction={} --set time.step={} --set time.end={} --set solver.tolerance=1e-12{}",
                                 friction, 0.06 * share, share < 0.1 ? 0.1 : 0.3, stiff_if_rigid(a, b)),
                     "run.h5", "blocks");
        const Worst w = worst_of(r, 1200, 300);
        expect_kept(w, what);
        EXPECT_TRUE(share > 0.4 || w.met > 0) << what;
      }
  }
}

TEST(Surfaces, EveryShapeOfCellMeetsAnother) {
  for (const auto& [a, b] :
       {std::pair{Shape::tet4, Shape::hex8}, {Shape::tet10, Shape::hex20}, {Shape::wedge6, Shape::tet10}, {Shape::hex20, Shape::wedge15}}) {
    Case c("contact");
    c.use(blocks(a, b));
    const std::string what = fmt::format("{} {}", info(a).name, info(b).name);
    const Worst w = worst_of(c.solved("--set time.end=0.12 --set solver.tolerance=1e-12", "run.h5", "blocks"), 1200, 300);
    expect_kept(w, what);
    EXPECT_GT(w.met, 3) << what;
  }
}

// What starts wholly inside the other, far from its facets, would meet nothing.
TEST(Surfaces, APartInsideAnotherIsRefused) {
  for (const double off : {1.3, 4.}) {
    BlockOptions A, B;
    A.regions = {"A"}, B.regions = {"B"};
    A.n[0] = A.n[1] = A.n[2] = 3, A.high = Vec3(3, 3, 3), B.high = Vec3(0.3, 0.3, 0.3);
    B.map = [=](const Vec3& x) { return Vec3(x + off * Vec3::Ones()); };
    Case c("contact");
    c.use(together(block_mesh(A), block_mesh(B)));
    const Ran ran = c.solve("--quiet --set time.end=1e-3 --set time.step=1e-3", "run.h5", off < 3 ? 2 : 0, "blocks");
    EXPECT_EQ(ran.err.find("\"B\" starts inside \"A\"") != std::string::npos, off < 3) << ran.err;
  }
}

// Truth: bars of equal length change their velocities in the time in which a wave runs there and back, 2/3 s.
TEST(Surfaces, EqualBarsChangeVelocities) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.n[2] = B.n[2] = 100;
  A.high = B.high = Vec3(0.1, 0.1, 10);
  B.map = [](const Vec3& x) { return Vec3(x + Vec3(0, 0, 10.01)); };
  Case c("contact");
  c.use(together(block_mesh(A), block_mesh(B)));
  const Results r = c.solved("", "run.h5", "bars");
  EXPECT_NEAR(r.history("probe/a").bottomRows(1)(0, 5), 0, 1e-3);
  EXPECT_NEAR(r.history("probe/b").bottomRows(1)(0, 5), 0.1, 1e-3);
  const auto f = r.history("contact/c");
  double began = 0, ended = 0;
  for (Eigen::Index k = 1; k < f.rows(); ++k)
    if (f(k, 3) > 0) began = began == 0 ? r.t()[k] : began, ended = r.t()[k];
  EXPECT_NEAR(ended - began, 2. / 3, 0.02 * 2 / 3);
  EXPECT_NEAR(f(r.index(0.4), 2), 30 * 0.01 * 0.05, 0.03 * 0.015) << "rho c A v/2";
}

/// Two blocks of 1 x 1 x .5 m, one above the other.
Mesh stack(Shape a, Shape b, int n_a, int n_b) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.shape = a, B.shape = b;
  A.n[0] = A.n[1] = n_a, B.n[0] = B.n[1] = n_b, A.n[2] = B.n[2] = 3;
  A.high = Vec3(1, 1, 0.5), B.low = Vec3(0, 0, 0.5), B.high = Vec3(1, 1, 1);
  return together(block_mesh(A), block_mesh(B));
}

// Truth: the stress is -0.1 Pa everywhere; strains of the columns of cells tell it.
TEST(Surfaces, PressBetweenMeshesThatDoNotMatch) {
  for (const Shape shape : {Shape::hex8, Shape::wedge6})
    for (const auto& [factor, limit] : {std::pair{"1", 0.02}, {"100", shape == Shape::hex8 ? 1.5e-3 : 5e-3}}) {
      const Mesh mesh = stack(shape, Shape::hex8, 5, 7);
      Case c("contact");
      c.use(mesh);
      const Results r = c.solved(fmt::format("--set contact.c.factor={}", factor), "run.h5", "pressed");
      const auto u = r.field("displacement");
      double worst = 0;
      for (std::int64_t cell = 0; cell < mesh.n_cells(); ++cell) {
        const auto n = mesh.cell(cell);
        double rise = 0, height = 0;
        const int half = static_cast<int>(n.size()) / 2;
        for (int k = 0; k < half; ++k) rise += u[n[half + k]][2] - u[n[k]][2], height += mesh.X[n[half + k]][2] - mesh.X[n[k]][2];
        worst = std::max(worst, std::abs(1e4 * rise / height / -0.1 - 1));
      }
      EXPECT_LT(worst, limit) << info(shape).name << " " << factor;
      EXPECT_NEAR(r.history("contact/c").bottomRows(1)(0, 2), 0.1, 1e-8);
    }
}

// Truth: lengths s times as large, of the same material, take s times as long; velocities are the same, forces s^2 times as large.
TEST(Surfaces, ScenesOfAnotherSizeAreTheSame) {
  double first = 0;
  for (const double s : {1., 1e-3, 1e3}) {
    Mesh mesh = blocks(Shape::hex8, Shape::hex8);
    for (Vec3& x : mesh.X) x *= s;
    Case c("contact");
    c.use(mesh);
    const Results r = c.solved(fmt::format("--set time.end={} --set time.step={} --set 'initial.1.spin=[{},0,{}]' "
                                           "--set 'initial.2.spin=[0,{},{}]' --set solver.tolerance=1e-12",
                                           0.12 * s, 0.006 * s, 0.3 / s, 2 / s, 2 / s, 1 / s),
                               "run.h5", "blocks");
    const double force = r.peak("contact/c", 0, 3) / (s * s);
    if (first == 0) first = force;
    EXPECT_GT(first, 1e3);
    EXPECT_NEAR(force, first, 1e-6 * first) << s;
  }
}

// Truth: beside pressure above, only what lies below holds the upper block up, and friction holds it aside; the stress is uniform.
TEST(Surfaces, HoldAPartThatNothingElseHolds) {
  Case c("contact");
  c.use(stack(Shape::hex8, Shape::hex8, 3, 2));
  std::string text = text_of(c.source("pressed.toml"));
  for (const char* name : {"side", "back"}) {
    const size_t at = text.find(fmt::format("[[motion]]\nkind = \"fixed\"\nname = \"{}\"", name));
    text.erase(at, text.find('\n', text.find("components", at)) + 1 - at);
  }
  std::ofstream(c / "held.toml") << text
                                 << "[[load]]\nkind = \"traction\"\nname = \"aside\"\non = \"Bzmax\"\ntraction = [0.02, 0.01, -0.1]\n";
  succeeded(c.run("hilo-solve --quiet held.toml mesh.h5 --set contact.c.friction=0.5 --set load.p.pressure=0 -o run.h5"));
  const Eigen::MatrixXd f = Results(c / "run.h5").history("contact/c").bottomRows(1);
  EXPECT_NEAR(f(0, 2), 0.1, 1e-8);
  EXPECT_NEAR(f(0, 0), -0.02, 1e-8);
  EXPECT_NEAR(f(0, 1), -0.01, 1e-8);
}

// Truth: the diagram of a bolted joint. Plates of stiffness K under a bolt of stiffness k, preload P: the bolt has P K/(K + k) and the
// share k/(K + k) of a pull, and all of it once the pull is P. A preload at the first step is no jump to another branch.
TEST(Surfaces, PartWhenThePullIsThePreload) {
  constexpr double K = 1e4, k = 2500, P = 10;
  Case c("contact");
  c.use(stack(Shape::hex8, Shape::hex8, 3, 2));
  std::string text = text_of(c.source("pressed.toml"));
  const size_t side = text.find("[[motion]]\nkind = \"fixed\"\nname = \"side\"");
  text.erase(side, text.find("[[load]]") - side);
  std::ofstream(c / "bolt.toml") << text
                                 << fmt::format(R"([[joint]]
kind = "prismatic"
name = "shank"
b = "Bzmax"
at = [0.5, 0.5, 1]
axis = [0, 0, 1]
[[spring]]
kind = "axial"
name = "bolt"
b = "Bzmax"
at_a = [0.5, 0.5, 0]
at_b = [0.5, 0.5, 1]
stiffness = {}
preload = {}
)",
                                                k, P);
  const Ran ran = succeeded(c.run("hilo-solve bolt.toml mesh.h5 --set load.p.pressure=-12 --set time.steps=6 -o run.h5"));
  EXPECT_EQ(ran.err.find("jump"), std::string::npos) << ran.err;
  const Results r(c / "run.h5");
  const auto t = r.history("t"), bolt = r.history("spring/bolt"), clamp = r.history("contact/c");
  ASSERT_EQ(t.rows(), 7);
  for (Eigen::Index i = 1; i < t.rows(); ++i) {
    const double pull = 12 * t(i, 0), tension = pull < P ? (P * K + pull * k) / (K + k) : pull;
    EXPECT_NEAR(-bolt(i, 2), tension, 3e-3 * P) << pull;
    EXPECT_NEAR(clamp(i, 2), tension - pull, 3e-3 * P) << pull;
  }
}

/// A plate of 3 x 1 x `thick` m, its top at z = 0, and a block of .3 x .3 x .2 m above its middle.
Mesh plate(double thick, double gap) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.n[0] = 14, A.n[1] = 5, B.n[0] = B.n[1] = B.n[2] = 2;
  A.low = Vec3(-1, -0.5, -thick), A.high = Vec3(2, 0.5, 0), B.low = Vec3(-0.15, -0.15, gap), B.high = Vec3(0.15, 0.15, 0.2 + gap);
  return together(block_mesh(A), block_mesh(B));
}

// Truth: v^2/(2 mu g), over the facets of a plate that is held.
TEST(Surfaces, SlideToRestOverManyFacets) {
  for (const Fidelity level : {Fidelity::nonlinear, Fidelity::linear}) {
    Case c("contact");
    c.use(plate(0.1, 0), {Fidelity::rigid, level});
    std::ofstream(c / "slide.toml") << "gravity = [0, 0, -9.81]\n"
                                    << text_of(c.source("plate.toml")) << "[[motion]]\nkind = \"fixed\"\nname = \"held\"\non = \"A\"\n";
    succeeded(c.run("hilo-solve --quiet slide.toml tags.h5 --set contact.c.friction=0.3 -o run.h5"));
    const Results r = c.results();
    const auto x = r.history("probe/b");
    const double v2 = 1.04, way = v2 / (2 * 0.3 * 9.81);
    const Eigen::Index last = x.rows() - 1;
    EXPECT_NEAR((x.row(last) - x.row(0)).head<2>().norm(), way, 5e-3 * way) << word(level);
    EXPECT_NEAR((x(last, 1) - x(0, 1)) / (x(last, 0) - x(0, 0)), 0.2, 2e-3) << "it slides straight on";
    EXPECT_NEAR(r.history("energy").bottomRows(1)(0, 4), 18 * v2 / 2, 0.01 * 9 * v2) << word(level);
  }
}

// Plates whose equal meshes hit each other flat: every point is over the border of two triangles, and nothing slips.  Truth: no force along
// the plates; Newton's method needs as few iterations as without contact, two or three a step.
TEST(Surfaces, FlatMeshesThatMatch) {
  BlockOptions A, B;
  A.n[0] = A.n[1] = B.n[0] = B.n[1] = 20, A.n[2] = B.n[2] = 1, A.regions = {"A"}, B.regions = {"B"};
  A.high = Vec3(0.2, 0.2, 0.01), B.low = Vec3(0, 0, 0.01001), B.high = Vec3(0.2, 0.2, 0.02001);
  Case c("contact");
  c.use(together(block_mesh(A), block_mesh(B)), {Fidelity::nonlinear, Fidelity::nonlinear});
  std::ofstream(c / "scene.toml")
      << "[material.soft]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"soft\"\n[[contact]]\n"
         "name = \"c\"\na = \"A\"\nb = \"B\"\n[[initial]]\non = [\"B\"]\nvelocity = [0, 0, -1]\n[time]\nend = "
         "1.2e-4\nstep = 2e-5\n";
  succeeded(c.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5"));
  const auto force = Results(c / "run.h5").history("contact/c");
  EXPECT_GT(force.col(2).maxCoeff(), 1000);
  EXPECT_LT(force.leftCols<2>().cwiseAbs().maxCoeff(), 1e-6 * force.col(2).maxCoeff());
  EXPECT_LE(c.reported("newton_iterations"), 6 * 4);
  EXPECT_EQ(c.reported("cuts"), 0);
}

// Truth: what is shot at a plate does not come out behind it, however many thicknesses it flies in a step.
TEST(Surfaces, NothingGoesThroughAPlate) {
  for (const double thicknesses : {0.5, 2., 8., 30.}) {
    Case c("contact");
    c.use(plate(0.02, 0.31));
    const Results r =
        c.solved(fmt::format("--set 'initial.1.velocity=[0,0,-10]' --set time.step={} --set time.end={} --set solver.tolerance=1e-12",
                             thicknesses * 0.002, std::max(0.08, 6 * thicknesses * 0.002)),
                 "run.h5", "plate");
    const auto a = r.history("probe/a"), b = r.history("probe/b");
    EXPECT_GT((b - a).col(2).minCoeff(), 0.01) << thicknesses << ": the plate bends";
    EXPECT_LT(r.history("contact/c").col(3).maxCoeff(), 0.02) << thicknesses;
    EXPECT_GT(b.col(5).minCoeff(), -10 - 1e-9) << thicknesses << ": nothing is sped up";
    EXPECT_GT(b(b.rows() - 1, 5), -8) << thicknesses << ": they have met";
    EXPECT_LT(worst_of(r, 180, 180).energy, 1e-11) << thicknesses;
  }
}

// Truth: 42 kg at 8.3 m/s have 1.4 kJ, and the layers of a plate as soft as this store 0.9 kJ over its thickness: the run says so.
TEST(Surfaces, DeepOnesAreTold) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.n[0] = A.n[1] = 4, A.low = Vec3(-1, -1, -0.1), A.high = Vec3(1, 1, 0), B.low = Vec3(-0.2, -0.15, 0.38), B.high = Vec3(0.2, 0.2, 0.68);
  Case c("contact");
  c.use(together(block_mesh(A), block_mesh(B)), {Fidelity::nonlinear, Fidelity::nonlinear});
  const std::string run = "hilo-solve scene.toml tags.h5 -o run.h5";
  std::ofstream(c / "scene.toml")
      << "[material.m]\nE = 3.24e5\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n[[contact]]\nname = "
         "\"c\"\na = \"A\"\nb = \"B\"\n[[initial]]\non = [\"B\"]\nvelocity = [0, 0, -8.3]\n[time]\nend = 0.2\nstep "
         "= 0.02\n";
  const Ran deep = c.run(run), shallow = c.run(run + " --set initial.1.velocity=[0,0,-1] --set time.end=0.6");
  EXPECT_NE(deep.err.find("contact \"c\": a depth of 0."), std::string::npos) << deep.err;
  EXPECT_EQ(shallow.err.find("a depth of"), std::string::npos) << shallow.err;
}

/// A plate of .7 x .3 x .1 m, its top at z = 0, and a block of .2 m half a millimetre above it.
Mesh table() {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.n[0] = 14, A.n[1] = 3, B.n[0] = B.n[1] = B.n[2] = 2;
  A.low = Vec3(-0.2, -0.15, -0.1), A.high = Vec3(0.5, 0.15, 0), B.low = Vec3(-0.1, -0.1, 5e-4), B.high = Vec3(0.1, 0.1, 0.2005);
  return together(block_mesh(A), block_mesh(B));
}

constexpr const char* static_steps = "--set time.analysis='\"static\"' --set time.steps=40";

// Truth: a block pressed on a flat plate by a given way slides over it without friction: no force along it, and the same force on it.
TEST(Surfaces, SlidePressedWithoutFriction) {
  Case c("contact");
  c.use(table());
  for (const char* names : {"", "--set contact.c.a=Azmax --set contact.c.b=Bzmin"})
    for (const std::string how : {static_steps, "--set time.step=4e-3", "--set time.step=1e-3"}) {
      const std::string what = fmt::format("{} {}", names, how);
      const Results r = c.solved(fmt::format("{} {}", names, how), "run.h5", "slid");
      const auto f = r.history("contact/c");
      const Eigen::Index from = r.index(0.3), n = f.rows() - from;
      const double pressed = f(from, 2);
      EXPECT_GT(pressed, 1e4) << what;
      EXPECT_NEAR(f.col(2).tail(n).minCoeff(), pressed, 0.05 * pressed) << what;
      EXPECT_NEAR(f.col(2).tail(n).maxCoeff(), pressed, 0.05 * pressed) << what;
      EXPECT_LT(f.col(0).tail(n).cwiseAbs().maxCoeff(), 0.03 * pressed) << what;
      EXPECT_NEAR(f.col(0).tail(n).mean(), 0, 2e-3 * pressed) << what;
    }
}

// Truth: a block that has gone off the plate is not held by where the plate was; what it stored is in the balance, of friction too.
TEST(Surfaces, LeaveTheEdgeOfASet) {
  Case c("contact");
  c.use(table());
  for (const char* names : {"--set contact.c.a=Azmax", "--set contact.c.b=Bzmin", "--set contact.c.a=Azmax --set contact.c.b=Bzmin"})
    for (const auto& [how, friction] : {std::pair<std::string, double>{static_steps, 0},
                                        {"--set time.step=4e-3", 0},
                                        {"--set time.step=4e-3", 0.05},
                                        {"--set time.step=4e-3", 1}}) {
      const std::string what = fmt::format("{} {} mu {}", names, how, friction);
      const char* within = how == static_steps ? " --set 'gravity=[0,0,-1]'" : " --set solver.tolerance=1e-12";
      const Results r =
          c.solved(fmt::format("{} {} --set 'motion.x.displacement=[1.2,0,0]' --set contact.c.friction={}{}", names, how, friction, within),
                   "run.h5", "slid");
      const auto f = r.history("contact/c");
      EXPECT_GT(f(r.index(0.4), 2), 1e4) << what;
      EXPECT_EQ(f(f.rows() - 1, 2), 0) << what;
      EXPECT_EQ(f(f.rows() - 1, 3), 0) << what << ": no depth is left";
      if (how != static_steps) {
        EXPECT_LT(worst_of(r, 1, 1).energy, 1e-11) << what;
        EXPECT_LE(worst_of(r, 1, 1).given_back, 1e-15) << what;
      }
    }
}

// Truth: the weight above, whether regions or sets of their facets are named.
TEST(Surfaces, SetsOfFacetsMeetAsRegionsDo) {
  Case c("contact");
  c.use(stack(Shape::tet10, Shape::hex20, 2, 3));
  for (const char* names : {"", "--set contact.c.a=Azmax --set contact.c.b=Bzmin", "--set contact.c.a=A --set contact.c.b=Bzmin"})
    EXPECT_NEAR(c.solved(names, "run.h5", "pressed").history("contact/c").bottomRows(1)(0, 2), 0.1, 1e-8) << names;
}

TEST(Surfaces, GoOnBitByBit) {
  Case c("contact");
  const Mesh mesh = blocks(Shape::hex8, Shape::hex8);
  write_mesh(c / "mesh.h5", mesh, {"test"});
  write_tags(c / "tags.h5", c / "mesh.h5", {Fidelity::nonlinear, Fidelity::linear}, {"test"});
  expect_goes_on(c.path(), text_of(c.source("blocks.toml")), "mesh.h5", {2, 5, 8, 12}, {"time.end=0.12"});
  expect_goes_on(c.path(), text_of(c.source("blocks.toml")), "tags.h5", {2, 5, 8, 12}, {"time.end=0.12"});
}

/// Two blocks of any shape, size and fidelity, thrown at each other; what the scene is told of them.
std::string thrown(int seed, Case& c) {
  Dice dice(seed + 500);
  constexpr Shape all[] = {Shape::hex8, Shape::tet4, Shape::wedge6, Shape::hex8, Shape::tet10, Shape::hex20};
  constexpr Fidelity levels[] = {Fidelity::nonlinear, Fidelity::nonlinear, Fidelity::rigid, Fidelity::linear};
  const auto pick = [&](int n) { return std::min(n - 1, static_cast<int>(n * dice())); };
  const auto direction = [&] { return Vec3(dice(-1, 1), dice(-1, 1), dice(-1, 1) + 1e-3).normalized(); };
  BlockOptions o[2];
  double radius = 0.01;
  for (int k = 0; k < 2; ++k) {
    o[k].shape = all[pick(6)], o[k].regions = {k == 0 ? "A" : "B"};
    const Vec3 half(dice(0.25, 0.6), dice(0.25, 0.6), dice(0.25, 0.6));
    for (int& n : o[k].n) n = 1 + pick(o[k].shape == Shape::hex8 ? 3 : 2);
    o[k].low = -half, o[k].high = half, radius += half.norm();
  }
  const Vec3 to = direction();
  const Mat3 turn = Eigen::AngleAxisd(dice(0, 3), direction()).toRotationMatrix();
  o[1].map = [=](const Vec3& x) { return Vec3(turn * x + radius * to); };
  const Fidelity a = levels[pick(4)], b = levels[pick(4)];
  c.use(together(block_mesh(o[0]), block_mesh(o[1])), {a, b});
  const double v = std::pow(10, dice(-0.5, 0.7)), step = 0.06 * std::pow(10, dice(-1.2, 0.3));
  const Vec3 flight = -v * to + 0.3 * v * direction();
  return fmt::format(
      "--set 'initial.1.velocity={}' --set 'initial.1.spin={}' --set 'initial.2.velocity=[{},{},{}]' --set 'initial.2.spin={}' "
      "--set contact.c.friction={} --set time.step={} --set time.end={} --set solver.tolerance=1e-12{}",
      dice.vector(0.2 * v), dice.vector(v), flight[0], flight[1], flight[2], dice.vector(2 * v), dice() < 0.3 ? 0 : dice(0, 1.5), step,
      std::min(1.2 / v + 0.15, 150 * step), stiff_if_rigid(a, b));
}

// Truth: nothing acts from outside, whatever is thrown.
TEST(Surfaces, AHundredThrowsKeepEnergyAndMomenta) {  // a quarter of them a day
  int thrown_today = 0, met = 0, rubbed = 0;
  for (int seed = 0; seed < 100; ++seed) {
    if (!today(seed, 4)) continue;
    ++thrown_today;
    Case c("contact");
    const std::string options = thrown(seed, c);
    const Ran ran = c.solve("--quiet " + options, "run.h5", 0, "blocks");
    if (ran.exit != 0) continue;
    const Results r = c.results();
    const auto e = r.history("energy");
    const double size = std::sqrt(2 * e.col(0).maxCoeff() * 500);  // a momentum of that energy
    const Worst w = worst_of(r, size, size);
    expect_kept(w, fmt::format("{}: {}", seed, options));
    met += w.met > 0, rubbed += e.bottomRows(1)(0, 4) > 1e-3 * w.top;
  }
  EXPECT_GT(met, 0.6 * thrown_today);
  EXPECT_GT(rubbed, 0.25 * thrown_today);
}

}  // namespace
}  // namespace hilo::test::surfaces_test
