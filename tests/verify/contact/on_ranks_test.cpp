// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts and ties on ranks.  Truth: the run that one rank makes of the same scene; nothing else may depend on who has which cell.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "succeeded.hpp"
#include "verify/contact/clip.hpp"
#include "verify/ties/tied_blocks.hpp"

namespace hilo::test::on_ranks_test {
namespace {

enum class Division {
  scattered,  // each cell anywhere
  away,       // rank 0, which evaluates pairs, has no cell; rank 1 one cell; the last one the rest
  by_parts,   // hilo-solve divides
};

/// A scene and its mesh, to be run on any number of ranks.
struct Scene {
  std::string folder, text, options;  // the text, or the name of a file in the folder
  Mesh mesh;
  std::vector<Fidelity> fidelity;
};

/// Largest differences from the run of one rank: of histories over their peaks, by groups of columns that have one unit; of displacements.
struct Off {
  double history = 0, field = 0;
  std::string where;
};

Off off(const Results& one, const Results& other) {
  Off out;
  const auto look = [&](const std::string& name, Eigen::Index first, Eigen::Index n, double scale) {
    const Eigen::MatrixXd a = one.history(name).middleCols(first, n), b = other.history(name).middleCols(first, n);
    if (a.rows() != b.rows()) {
      out.history = HUGE_VAL, out.where = name;
      return;
    }
    const double most = std::max(a.cwiseAbs().maxCoeff(), scale), d = (a - b).cwiseAbs().maxCoeff() / most;
    if (!(d <= out.history)) out.history = d, out.where = fmt::format("{} {}", name, first);
  };
  const double energy = one.history("energy").leftCols(3).cwiseAbs().maxCoeff();
  look("energy", 0, 5, energy), look("momentum", 0, 3, 1), look("momentum", 3, 3, 1);
  for (const char* group : {"contact", "probe", "tie"})
    if (one.file().has(std::string("/history/") + group))
      for (const std::string& name : one.file().list(std::string("/history/") + group)) {
        const std::string path = std::string(group) + "/" + name;
        look(path, 0, 3, 1e-12);
        if (*group == 't') look(path, 3, 3, one.history(path).leftCols(3).cwiseAbs().maxCoeff());  // at an arm of 1 m
        for (Eigen::Index k = 3; k < 8 && *group == 'c'; ++k) look(path, k, 1, k == 7 ? 1 : k == 6 ? energy : 1e-3);
      }
  if (!one.file().list("/field").empty()) {
    const auto a = one.field("displacement"), b = other.field("displacement");
    double most = 0;
    for (const Vec3& x : a) most = std::max(most, x.norm());
    for (size_t i = 0; i < a.size(); ++i) out.field = std::max(out.field, (a[i] - b[i]).norm() / most);
  }
  return out;
}

class OnRanks {
 public:
  explicit OnRanks(Scene scene) : scene_(std::move(scene)), case_(scene_.folder) {
    const bool is_named = !scene_.text.empty() && scene_.text.find('\n') == std::string::npos;
    case_.write("scene.toml", is_named ? text_of(case_.source(scene_.text + ".toml")) : scene_.text);
    if (scene_.mesh.n_cells() == 0) return;
    write_mesh(case_ / "mesh.h5", scene_.mesh, {"test"});
    write_tags(case_ / "tags.h5", case_ / "mesh.h5", scene_.fidelity, {"test"});
    if (std::ranges::find(scene_.fidelity, Fidelity::linear) == scene_.fidelity.end()) return;
    const Ran ran = case_.run("hilo-reduce --quiet scene.toml tags.h5 " + scene_.options + " -o modes.h5");  // modes found anew differ
    EXPECT_EQ(ran.exit, 0) << ran.err;
    scene_.options += " --modes modes.h5";
  }
  Results alone() const { return solved(1, "tags.h5", "one.h5"); }
  Results on(int ranks, Division division) const {
    std::string mesh = "tags.h5";
    if (division != Division::by_parts) {
      const auto n = static_cast<int>(scene_.mesh.n_cells());
      std::vector<std::int32_t> rank(scene_.mesh.n_cells());
      for (int c = 0; c < n; ++c)
        rank[c] = division == Division::away ? (c == 0 ? 1 : ranks - 1) : std::min(ranks - 1, int(ranks * (scatter(7 * c) + 1) / 2));
      mesh = fmt::format("parts-{}.h5", ranks);
      write_parts(case_ / mesh, case_ / "tags.h5", ranks, rank, {"test"});
    }
    return solved(ranks, mesh, "run.h5");
  }
  Results solved(int ranks, const std::string& mesh, const std::string& output, const std::string& more = "") const {
    const std::string launcher = ranks == 1 ? "" : fmt::format("timeout 120 mpirun -n {} ", ranks);
    succeeded(
        case_.run("export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
                  "OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_hwloc_base_binding_policy=none OPENBLAS_NUM_THREADS=1\n" +
                  launcher + "hilo-solve --quiet scene.toml " + (scene_.mesh.n_cells() ? mesh + " " : "") + scene_.options + " " + more +
                  " -o " + output));
    return Results(case_ / output);
  }
  const Case& place() const { return case_; }

 private:
  Scene scene_;
  Case case_;
};

void expect_same_on(const OnRanks& runs, const std::vector<std::pair<int, Division>>& ways, double limit, const std::string& what) {
  const Results one = runs.alone();
  for (const auto& [ranks, division] : ways) {
    const Off d = off(one, runs.on(ranks, division));
    EXPECT_LT(d.history, limit) << what << " on " << ranks << ": " << d.where;
    EXPECT_LT(d.field, limit) << what << " on " << ranks;
  }
}

using enum Fidelity;
using enum Division;

Mesh brick() {
  BlockOptions o;
  o.n[0] = 3, o.n[1] = o.n[2] = 2, o.high = Vec3(1, 0.6, 0.4);
  return block_mesh(o);
}

TEST(OnRanks, ABlockSlidesOnThePlane) {
  const std::string slides =
      "--set 'gravity=[0,0,-9.81]' --set 'obstacle.ground.at=[0,0,0]' --set contact.c.friction=0.3 --set material.soft.E=2e8 "
      "--set 'initial.1.velocity=[1,0,0]' --set 'initial.1.spin=[0,0,0.5]' --set time.end=0.04 --set time.step=2e-3 "
      "--set solver.tolerance=1e-13";
  for (const Fidelity level : {nonlinear, linear, rigid}) {
    const std::string stiff = level == rigid ? " --set contact.c.modulus=2e8 --set contact.c.layer=0.2" : "";
    const OnRanks runs({"contact", "drop", slides + stiff, brick(), {level}});
    const auto ways = level == nonlinear ? std::vector{std::pair{2, scattered}, {3, away}} : std::vector{std::pair{2, scattered}};
    expect_same_on(runs, ways, 1e-9, std::string(word(level)));
  }
}

TEST(OnRanks, BodiesMeet) {
  expect_same_on(OnRanks({"contact", "two", "--set solver.tolerance=1e-13", {}, {}}), {{2, by_parts}, {3, by_parts}}, 1e-9, "bodies");
}

/// Two blocks, B turned and above a face of A with a corner ahead.
Mesh blocks() {
  BlockOptions A, B;
  A.n[0] = A.n[1] = 3, A.n[2] = 2, A.high = Vec3(1, 1, 0.6), A.regions = {"A"};
  B.n[0] = 2, B.n[1] = B.n[2] = 3, B.high = Vec3(0.7, 0.9, 1), B.regions = {"B"};
  const Mat3 turn = (Eigen::AngleAxisd(0.5, Vec3::UnitZ()) * Eigen::AngleAxisd(0.4, Vec3::UnitY())).toRotationMatrix();
  double low = 0;
  for (int k = 0; k < 8; ++k) low = std::min(low, (turn * Vec3(k & 1 ? 0.35 : -0.35, k & 2 ? 0.45 : -0.45, k & 4 ? 0.5 : -0.5))[0]);
  B.map = [=](const Vec3& x) { return Vec3(turn * (x - Vec3(0.35, 0.45, 0.5)) + Vec3(1.01 - low, 0.45, 0.25)); };
  return together(block_mesh(A), block_mesh(B));
}
const std::string collide = "--set solver.tolerance=1e-13 --set time.end=0.15";

// Momenta of each block are about 1200 kg m/s and 300 kg m^2/s.
TEST(OnRanks, BlocksCollideWithFriction) {
  for (const auto& [a, b] : {std::pair{nonlinear, nonlinear}, {linear, nonlinear}, {rigid, linear}}) {
    const OnRanks runs({"contact", "blocks", collide, blocks(), {a, b}});
    const bool all = a == nonlinear;
    expect_same_on(
        runs, all ? std::vector{std::pair{2, scattered}, {3, away}, {7, scattered}} : std::vector{std::pair{3, all ? away : scattered}},
        1e-9, fmt::format("{} {}", word(a), word(b)));
    if (!all) continue;
    const Worst w = worst_of(Results(runs.place() / "run.h5"), 1200, 300);
    EXPECT_LT(std::max({w.energy, w.momentum, w.angular}), 1e-11);
    EXPECT_GT(w.met, 3);
  }
}

TEST(OnRanks, TheArmsOfAClipMeet) {
  const OnRanks runs({"contact", "clip", "--set solver.tolerance=1e-13 --set time.end=0.044 --set time.step=4e-3", clip(), {nonlinear}});
  expect_same_on(runs, {{2, scattered}, {3, away}}, 1e-9, "clip");
  EXPECT_GT(worst_of(Results(runs.place() / "run.h5"), 60, 20).met, 1);
}

// Points of one block lie on the borders of the other one's triangles, and are as near to two of them.
TEST(OnRanks, ABlockIsPushedInLoadSteps) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.n[0] = A.n[1] = 4, A.low = Vec3(-0.5, -0.5, -0.5), A.high = Vec3(1.5, 1.5, 0);
  B.n[0] = B.n[1] = 2, B.n[2] = 2;
  expect_same_on(OnRanks({"contact", "pushed", "", together(block_mesh(A), block_mesh(B)), {nonlinear, nonlinear}}),
                 {{2, by_parts}, {3, scattered}}, 1e-8, "pushed");
}

Mesh stack(bool bent) {
  BlockOptions A, B;
  A.regions = {"A"}, B.regions = {"B"};
  A.n[0] = A.n[1] = 2, B.n[0] = B.n[1] = 3, A.n[2] = B.n[2] = 2;
  A.high = Vec3(1, 1, 0.5), B.low = Vec3(0, 0, 0.5), B.high = Vec3(1, 1, 1);
  const auto rise = [](const Vec3& x) { return 0.08 * std::sin(std::numbers::pi * x[0]) * (1 + x[1]); };
  if (bent) A.map = [=](const Vec3& x) { return Vec3(x + Vec3(0, 0, 2 * x[2] * rise(x))); };
  if (bent) B.map = [=](const Vec3& x) { return Vec3(x + Vec3(0, 0, 2 * (1 - x[2]) * rise(x))); };
  Mesh m = together(block_mesh(A), block_mesh(B));
  for (const int k : {0, 1})
    for (std::int64_t i = 0; i < m.n_nodes(); ++i)
      if (std::abs(m.X[i][k]) < 1e-9) m.node_sets[k == 0 ? "side" : "back"].push_back(i);
  return m;
}

// From 0.1 m above, by steps from rest.
TEST(OnRanks, ABlockComesToRestOnAnother) {
  const BlockOptions A{.n = {3, 3, 1}, .low = Vec3(-0.2, -0.2, -0.2), .high = Vec3(1.2, 1.2, 0), .regions = {"A"}},
      B{.n = {2, 2, 2}, .low = Vec3(0, 0, 0.1), .high = Vec3(1, 1, 1.1), .regions = {"B"}};
  const std::string scene = R"(
gravity = [0, 0, -9.81]
material.m = {E = 1e6, nu = 0.3, density = 1000}
region."*" = {material = "m"}
contact = [{name = "c", a = "A", b = "B", friction = 0.3}]
motion = [{kind = "fixed", name = "floor", on = "Azmin"}, {kind = "fixed", name = "guide", on = "Bzmax", components = ["x", "y"]}]
probe = [{name = "top", on = "Bzmax"}]
time = {start = "equilibrium", end = 1e-3, step = 1e-4}
solver.tolerance = 1e-12
output.fields = ["displacement"]
)";
  const OnRanks runs({"contact", scene, "", together(block_mesh(A), block_mesh(B)), {nonlinear, nonlinear}});
  expect_same_on(runs, {{2, scattered}, {3, away}}, 1e-8, "blocks");
}

TEST(OnRanks, TiesHold) {
  expect_same_on(OnRanks({"ties", pulled(0.3, 1, planes), "", stack(false), {nonlinear, nonlinear}}), {{2, scattered}, {3, away}}, 1e-9,
                 "pulled");
  for (const Fidelity level : {nonlinear, rigid})
    expect_same_on(OnRanks({"ties", flight(), "", stack(true), {level, nonlinear}}),
                   {{3, level == rigid ? scattered : away}, {4, scattered}}, 1e-9, fmt::format("in flight, a {}", word(level)));
}

// A run that is left in the middle of a contact, or with a bristle bent, goes on on other ranks.
TEST(OnRanks, GoOnOnOthers) {
  const OnRanks both[] = {
      OnRanks({"contact", "blocks", collide, blocks(), {nonlinear, nonlinear}}),
      OnRanks({"contact", "drop", collide + " --set contact.c.friction=0.3 --set time.end=0.152", brick(), {nonlinear}})};
  for (const OnRanks& runs : both) {
    const Results one = runs.alone();
    for (const auto& [first, second] : {std::pair{1, 3}, {3, 2}, {2, 1}}) {
      runs.solved(first, "tags.h5", "left.h5", "--checkpoint 8steps --set time.end=0.06");
      runs.solved(second, "tags.h5", "left.h5", "--restart left.h5");
      const Off d = off(one, Results(runs.place() / "left.h5"));
      EXPECT_LT(std::max(d.history, d.field), 1e-9) << first << " " << second << " " << d.where;
    }
  }
}

}  // namespace
}  // namespace hilo::test::on_ranks_test
