// SPDX-License-Identifier: GPL-3.0-or-later
// A part that meets itself, and surfaces with common nodes.  Truth: the same scene with two surfaces that meet, momenta and energy of what
// nothing acts on, and no force at all in what only bends.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <numbers>

#include "dynamics/kept_run.hpp"
#include "succeeded.hpp"
#include "verify/contact/clip.hpp"

namespace hilo::test::self_test {
namespace {

constexpr const char* soft = "[material.soft]\nE = 2e6\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"soft\"\n";
constexpr const char* itself = "[[contact]]\nname = \"c\"\na = \"block\"\nb = \"block\"\n";

Results ran(const Case& c, const std::string& text, const std::string& options = "", const std::string& output = "run.h5") {
  c.write("scene.toml", text);
  const char* mesh = std::filesystem::exists(c / "tags.h5") ? "tags.h5 " : "mesh.h5 ";
  succeeded(c.run("hilo-solve --quiet scene.toml " + std::string(mesh) + options + " -o " + output));
  return Results(c / output);
}

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double out = 0;
  for (size_t i = 0; i < a.size(); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

// Truth: the faces of the slot as two surfaces that meet, without a common node, and what hangs on the shut arm.
TEST(Self, AClipPressedShutIsAPairOfItsArms) {
  const std::string text = std::string(soft) + itself +
                           "[[load]]\nkind = \"traction\"\nname = \"press\"\non = \"top\"\ntraction = [0, 0, -6e3]\n"
                           "[[motion]]\nkind = \"fixed\"\nname = \"held\"\non = \"bottom\"\n[time]\nanalysis = \"static\"\nsteps = 3\n"
                           "[output]\nfields = [\"displacement\"]\n";
  for (const double friction : {0., 0.2}) {
    Case c("contact");
    c.use(clip());
    const std::string options = fmt::format("--set contact.c.friction={}", friction);
    const Results one = ran(c, text, options), two = ran(c, text, options + " --set contact.c.a=low --set contact.c.b=up", "two.h5");
    const Eigen::RowVectorXd f = one.history("contact/c").bottomRows(1), g = two.history("contact/c").bottomRows(1);
    EXPECT_GT(g[2], 200) << "of 1200 N on the arm";
    EXPECT_NEAR(f[7], g[7], 1e-8 * g[7]) << friction;
    EXPECT_EQ(f.head(3).cwiseAbs().maxCoeff(), 0);
    EXPECT_LT(difference(one.field("displacement"), two.field("displacement")), 1e-9) << friction;
  }
  Case c("contact");  // regions that hang together at the slot's end, each of which has both a face of the slot and others
  c.use(clip(Shape::hex8, true));
  const Results one = ran(c, text, "--set contact.c.a=lower --set contact.c.b=upper"),
                two = ran(c, text, "--set contact.c.a=low --set contact.c.b=up", "two.h5");
  EXPECT_LT(difference(one.field("displacement"), two.field("displacement")), 1e-9);
  EXPECT_NEAR(one.history("contact/c").bottomRows(1)(0, 2), two.history("contact/c").bottomRows(1)(0, 2), 1e-5);
}

// Truth: nothing acts from outside.  The arms have about 60 kg m/s and 20 kg m^2/s.
TEST(Self, ArmsThatHitEachOtherKeepEnergyAndMomenta) {
  using enum Fidelity;
  for (const auto& [shape, level, step, end] : {std::tuple{Shape::hex8, nonlinear, 2e-3, 0.06},
                                                {Shape::hex8, nonlinear, 1e-2, 0.12},
                                                {Shape::hex8, nonlinear, 3e-2, 0.12},
                                                {Shape::tet4, nonlinear, 4e-3, 0.04},
                                                {Shape::hex8, linear, 2e-3, 0.04}}) {
    Case c("contact");
    c.use(clip(shape), {level});
    const Results r =
        ran(c, text_of(c.source("clip.toml")), fmt::format("--set solver.tolerance=1e-12 --set time.step={} --set time.end={}", step, end));
    const Worst w = worst_of(r, 60, 20);
    const std::string what = fmt::format("{} {} {}", info(shape).name, word(level), step);
    EXPECT_LT(w.energy, 1e-10) << what;
    EXPECT_LT(w.momentum, 1e-10) << what;
    EXPECT_LT(w.angular, 1e-10) << what;
    EXPECT_LE(w.given_back, 1e-15) << what;
    EXPECT_GT(w.met, 0) << what;
    EXPECT_LT(r.history("contact/c").col(3).maxCoeff(), 0.05) << what;
  }
}

/// Two blocks in one region.
Mesh apart() {
  BlockOptions A, B;
  A.n[0] = A.n[1] = 3, A.n[2] = 2, A.high = Vec3(0.9, 0.9, 0.6), B.n[0] = 2, B.n[1] = B.n[2] = 3, B.high = Vec3(0.6, 0.9, 0.9);
  const Mat3 turn = (Eigen::AngleAxisd(0.5, Vec3::UnitZ()) * Eigen::AngleAxisd(0.4, Vec3::UnitY())).toRotationMatrix();
  B.map = [=](const Vec3& x) { return Vec3(turn * (x - Vec3(0.3, 0.45, 0.45)) + Vec3(1.5, 0.45, 0.25)); };
  A.regions = {"A"}, B.regions = {"B"};
  Mesh m = together(block_mesh(A), block_mesh(B));
  const std::int64_t first = block_mesh(A).n_nodes();
  for (std::int64_t i = 0; i < m.n_nodes(); ++i) m.node_sets[i < first ? "one" : "other"].push_back(i);
  return m;
}

// Truth: the same blocks as two regions that meet.
TEST(Self, APartOfTwoPiecesIsTwoParts) {
  const auto scene = [](const char* a, const char* b) {
    return fmt::format(
        "{}[[contact]]\nname = \"c\"\na = \"{}\"\nb = \"{}\"\nfriction = 0.3\n[[initial]]\non = [\"one\"]\nvelocity = [2, 0, 0]\n"
        "[[initial]]\non = [\"other\"]\nvelocity = [-2, 0.3, 0.1]\n[output]\nfields = [\"displacement\"]\n[time]\nend = 0.15\nstep = "
        "5e-3\n",
        soft, a, b);
  };
  Mesh mesh = apart();
  Case two("contact");
  two.use(mesh);
  const Results of_two = ran(two, scene("A", "B"), "--set solver.tolerance=1e-12");
  std::ranges::fill(mesh.region, 0);
  mesh.region_name = {"block"}, mesh.region_data.resize(1);
  Case one("contact");
  one.use(mesh);
  const Results of_one = ran(one, scene("block", "block"), "--set solver.tolerance=1e-12");
  const Eigen::VectorXd one_pressing = of_one.history("contact/c").col(7), two_pressing = of_two.history("contact/c").col(7);
  Eigen::Index top = 0;
  const double peak = two_pressing.maxCoeff(&top);
  EXPECT_GT(peak, 1e4);
  EXPECT_LT((one_pressing - two_pressing).head(top + 1).cwiseAbs().maxCoeff(), 1e-9 * peak);
  // as they part, points over the edges of a block may take another of its triangles
  EXPECT_LT((one_pressing - two_pressing).cwiseAbs().maxCoeff(), 0.05 * peak);
  EXPECT_LT(difference(of_one.field("displacement"), of_two.field("displacement")), 0.01) << "of 0.3 m";
}

// Truth: no contact, no force, whatever a part does to itself by strain alone; the answer is that without [[contact]].
TEST(Self, WhatOnlyBendsOrIsCrushedMeetsNothing) {
  BlockOptions cube, sheet, knife;
  cube.n[0] = cube.n[1] = cube.n[2] = 3;
  sheet.n[0] = 12, sheet.n[1] = 3, sheet.n[2] = 1, sheet.high = Vec3(1.2, 0.3, 0.01);
  knife.n[0] = 6, knife.n[1] = 2, knife.n[2] = 2;
  knife.map = [](const Vec3& x) { return Vec3(x[0], x[1], (x[2] - 0.5) * (0.02 + 0.4 * (1 - x[0]))); };
  const auto moved = [](const char* kind, const char* value) {
    return fmt::format(
        "[[motion]]\nkind = \"fixed\"\nname = \"foot\"\non = \"xmin\"\n[[motion]]\nkind = \"{}\"\nname = \"m\"\non = \"xmax\"\n{}\n", kind,
        value);
  };
  struct Bent {
    const char* what;
    Mesh mesh;
    std::string motion;
  };
  const Bent all[] = {{"crushed", block_mesh(cube), moved("translation", "displacement = [-0.3, 0, 0]")},
                      {"sheared", block_mesh(cube), moved("translation", "displacement = [0, 0.6, 0]")},
                      {"bent", block_mesh(sheet), moved("translation", "displacement = [-0.1, 0, 0.4]")},
                      {"twisted", block_mesh(sheet), moved("rotation", "at = [0, 0, 0]\naxis = [1, 0, 0]\nangle = 1")},
                      {"knife", block_mesh(knife), moved("translation", "displacement = [0.2, 0, 0.3]")}};
  for (const auto& [what, mesh, motion] : all)
    for (const char* how : {"analysis = \"static\"\nsteps = 8", "end = 0.5\nstep = 0.025"}) {
      const bool in_time = *how == 'e';
      if (in_time && mesh.n_cells() == 36) continue;  // sheets flutter in steps as long as these
      Case c("contact");
      c.use(mesh);
      const std::string rest = motion + (in_time ? "history = {t = [0, 0.5], value = [0, 1], interpolation = \"smooth\"}\n" : "") +
                               "[output]\nfields = [\"displacement\"]\n[time]\n" + how + "\n";
      const Results with = ran(c, std::string(soft) + itself + rest, "--set solver.kind=direct"),
                    without = ran(c, std::string(soft) + rest, "--set solver.kind=direct", "without.h5");
      EXPECT_EQ(with.history("contact/c").cwiseAbs().maxCoeff(), 0) << what << how;
      EXPECT_LT(difference(with.field("displacement"), without.field("displacement")), 1e-9) << what << how;
    }
}

TEST(Self, GoesOnBitByBit) {
  Case c("contact");
  write_mesh(c / "mesh.h5", clip(), {"test"});
  expect_goes_on(c.path(), text_of(c.source("clip.toml")), "mesh.h5", {3, 9, 14}, {"time.end=0.04"});
}

TEST(Self, WhatCannotBeIsRefused) {
  const auto refused = [](const Mesh& mesh, const std::vector<Fidelity>& levels, const std::string& options, const std::string& words) {
    Case c("contact");
    c.use(mesh, levels);
    c.write("scene.toml", std::string(soft) + itself + "[time]\nend = 1e-3\nstep = 1e-3\n");
    const Ran run = c.run(fmt::format("hilo-solve --quiet scene.toml {} {} -o run.h5", levels.empty() ? "mesh.h5" : "tags.h5", options));
    EXPECT_EQ(run.exit, 2) << words;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  refused(clip(), {Fidelity::rigid}, "", "what is rigid does not meet itself");
  refused(clip(), {}, "--set contact.c.a=up", "facets in common");
  Mesh folded = clip();  // the upper arm lies in the lower one
  for (Vec3& x : folded.X)
    if (x[0] > 0.21 && x[2] > 0.29) x[2] -= 0.2 * std::min(1., (x[0] - 0.2) / 0.3);
  refused(folded, {}, "", "starts inside itself");
}

}  // namespace
}  // namespace hilo::test::self_test
