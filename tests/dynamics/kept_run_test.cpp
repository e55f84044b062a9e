// SPDX-License-Identifier: GPL-3.0-or-later
// What a run remembers can be kept between two steps: another run that goes on from there takes the same steps, bit by bit, with every
// integrator, whatever the scene remembers; results, counts and verdict of the audit are those of the run that was never left.
#include "dynamics/kept_run.hpp"

#include "dynamics/integrator_kinds.hpp"
#include "dynamics/scenes.hpp"
#include "ranks.hpp"
#include "verify/plasticity/uniaxial.hpp"

namespace hilo::test::kept_run_test {
namespace {

std::string revolute(const std::string& name, const std::string& a, const std::string& b, const Vec3& at, const std::string& more = "") {
  return joint("revolute", name, a, b, at, "axis = [0, 0, 1]\n" + more);
}

/// Bodies alone: a loop with redundant rows on a clock of its own, a stop that remembers its blows, a spring and a screw that count turns,
/// a bead on a curve, a motor with friction, a drive and a motion with kinks, a load that jumps.
std::string machine(bool with_motion = true) {
  const Vec3 bar(0.08, 0.08, 0.08);
  return "gravity = [0, -9.81, 0]\n" + body("crank", 1, {0, 0.5, 0}, bar) + body("rocker", 1, {1, 0.5, 0}, bar) +
         body("coupler", 2, {0.5, 1, 0}, {0.01, 0.3, 0.3}) + revolute("A0", "ground", "crank", {0, 0, 0}) +
         revolute("B0", "crank", "coupler", {0, 1, 0}) + revolute("A1", "ground", "rocker", {1, 0, 0}) +
         revolute("B1", "rocker", "coupler", {1, 1, 0}) + body("arm", 2, {0.3, 3, 0}, {0.01, 0.05, 0.05}) +
         revolute("pin", "ground", "arm", {0, 3, 0}) +
         "[[spring]]\nkind = \"torsion\"\nname = \"coil\"\na = \"ground\"\nb = \"arm\"\naxis = [0, 0, 1]\nstiffness = 3\n"
         "[[stop]]\nkind = \"angle\"\nname = \"limit\"\njoint = \"pin\"\nlower = -0.4\nupper = 0.4\nstiffness = 2e3\nrestitution = 0.6\n" +
         body("nut", 1, {0, 6, 0}, {0.02, 0.02, 0.02}) +
         joint("screw", "thread", "ground", "nut", {0, 6, 0}, "axis = [0, 0, 1]\npitch = 0.31415926535897931\n") +
         body("bead", 0.5, {1, 9, 0}, {0.001, 0.001, 0.001}) +
         joint("point-on-curve", "wire", "ground", "bead", {1, 9, 0},
               "points = [[1, 9, 0], [1.4, 8.7, 0.2], [1.8, 8.5, 0], [2.4, 8.1, -0.3], [3, 7.8, 0]]\n") +
         body("wheel", 5, {-3, 0, 0}, {0.3, 0.3, 0.4}) + revolute("bearing", "ground", "wheel", {-3, 0, 0}) +
         "[[motor]]\nkind = \"rotary\"\nname = \"drive\"\njoint = \"bearing\"\nrate = [0, 50]\ntorque = [20, 0]\n"
         "[[friction]]\nname = \"rub\"\njoint = \"bearing\"\ncoefficient = 0.2\nradius = 0.05\nslip_velocity = 1e-2\n" +
         body("turned", 2, {-6.5, 0, 0}, {0.01, 0.2, 0.2}) +
         revolute("servo", "ground", "turned", {-7, 0, 0},
                  "angle = 2\nhistory = {t = [0, 0.1, 0.2], value = [0, 0.2, 1], interpolation = \"smooth\"}\n") +
         body("hung", 1, {-6, 0, 0}, {0.1, 0.1, 0.1}) + joint("spherical", "link", "turned", "hung", {-6, 0, 0}) +
         body("cart", 1, {-9, 0, 0}, {0.1, 0.1, 0.1}) + body("bob", 1, {-9, -1, 0}, {0.1, 0.1, 0.1}) +
         joint("spherical", "rope", "cart", "bob", {-9, 0, 0}) +
         (with_motion ? "[[motion]]\nkind = \"translation\"\nname = \"shuttle\"\non = \"cart\"\ndisplacement = [1, 0, 0]\n"
                        "history = {t = [0, 0.0837, 0.3], value = [0, 0.1, -0.1]}\n"
                      : "") +
         "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"coupler\"\nforce = [3, 1, 0]\n"
         "history = {t = [0, 0.1037, 0.1037, 1], value = [0.5, 1, 4, 1]}\n"
         "[[initial]]\non = [\"arm\"]\nspin = [0, 0, 5]\nabout = [0, 3, 0]\n"
         "[[initial]]\non = [\"nut\"]\nspin = [0, 0, 20]\nvelocity = [0, 0, 1]\n"
         "[[initial]]\non = [\"crank\"]\nspin = [0, 0, -3]\n[[probe]]\nname = \"far\"\non = \"bob\"\nat = [-9, -1.5, 0]\n"
         "[[sensor]]\nname = \"seat\"\non = \"coupler\"\n[time]\nend = 0.2\nstep = 5e-3\n[output]\ninterval = 0.04\n";
}

/// A bar, partly rigid, of a material with damping, on a hinge with a body: written as mesh.h5 and tags.h5.
std::string bar(const std::filesystem::path& folder, const std::string& law, Fidelity block = Fidelity::nonlinear) {
  const BlockOptions o{
      .n = {6, 1, 1}, .high = {1.2, 0.2, 0.2}, .regions = {"foot", "block"}, .region_of = [](const Vec3& x) { return x[0] < 0.3 ? 0 : 1; }};
  if (Comm::world().rank == 0) {
    Mesh mesh = block_mesh(o);
    add_node_set(mesh, "edge", [](const Vec3& x) { return x[0] > 1.19 && x[2] < 0.01; });
    write_mesh((folder / "mesh.h5").string(), mesh, {"test"});
    write_tags((folder / "tags.h5").string(), (folder / "mesh.h5").string(), {Fidelity::rigid, block}, {"test"});
  }
  Comm::world().barrier();
  return "gravity = [0, 0, -9.81]\n[material.m]\n" + law + "E = 1e7\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n" +
         "damping = 1e-3\n" + body("bob", 20, {1.2, 0.1, -0.5}, {1, 1, 1}) +
         joint("revolute", "hinge", "xmax", "bob", {1.2, 0.1, 0.1}, "axis = [0, 1, 0]\n") +
         "[[spring]]\nkind = \"bushing\"\nname = \"mount\"\nb = \"foot\"\nat = [0, 0.1, 0.1]\nstiffness = [3e4, 4e4, 5e4]\n"
         "angular_stiffness = [1e3, 2e3, 3e3]\n"
         "[[load]]\nkind = \"traction\"\nname = \"wind\"\non = \"zmax\"\ntraction = [0, 2000, -9000]\n"
         "history = {t = [0, 0.021, 0.021, 1], value = [0, 1, 0.4, 0.4]}\n"
         "[[probe]]\nname = \"tip\"\non = \"xmax\"\n[time]\nend = 0.06\nstep = 2e-3\n[output]\ninterval = 0.01\n"
         "[solver]\ntolerance = 1e-9\n";
}
const std::string metal = "kind = \"j2\"\nyield = 2e4\nhardening = 1e5\nkinematic = 2e5\n";

std::string method(const std::string& word) { return "time.integrator=\"" + word + "\""; }

class KeptRuns : public testing::TestWithParam<std::string> {
 public:
  KeptRuns() { quiet_warnings(true); }
  ~KeptRuns() override { quiet_warnings(false); }
};

TEST_P(KeptRuns, GoOnBitByBitWithBodies) {
  const Folder folder;
  expect_goes_on(folder.path(), machine(GetParam() != "gauss"), "", {1, 2, 5, 21, 30}, {method(GetParam())});
}

TEST_P(KeptRuns, GoOnBitByBit) {
  const Folder folder;
  const Scene scene = Scene::parse("[time]\nend = 1\nstep = 1\n", "scene.toml", std::vector{method(GetParam())});
  const bool remembers = integrator_kind(scene.table("time")).carries_state;
  expect_goes_on(folder.path(), bar(folder.path(), remembers ? metal : ""), "tags.h5", {1, 4, 13}, {method(GetParam())});
}

TEST_P(KeptRuns, GoOnBitByBitWithLinearRegions) {
  const Folder folder;
  expect_goes_on(folder.path(), bar(folder.path(), "", Fidelity::linear), "tags.h5", {1, 4, 13}, {method(GetParam())});
}

TEST_P(KeptRuns, GoOnBitByBitWithStepsByTolerance) {
  const Folder folder;
  expect_goes_on(folder.path(), machine(GetParam() != "gauss"), "", {1, 3, 20, 30},
                 {method(GetParam()), "time.tolerance=1e-5", "time.end=0.12"});
}

const auto name_of = [](const testing::TestParamInfo<std::string>& p) {
  std::string name = p.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
};
INSTANTIATE_TEST_SUITE_P(Integrators, KeptRuns, testing::ValuesIn(choices("time", "integrator")), name_of);

// Steps of all lengths, so that less is recalled of longer ones.
TEST(KeptRun, GoesOnWithWhatDissipationRecalls) {
  const Folder folder;
  for (const Fidelity block : {Fidelity::nonlinear, Fidelity::linear})
    expect_goes_on(folder.path(), bar(folder.path(), block == Fidelity::nonlinear ? metal : "", block), "tags.h5", {1, 2, 3, 14},
                   {"time.dissipation=0.2", "time.tolerance=1e-5"});
}

// Steps that are halved around instants at which the run is kept.
TEST(KeptRun, GoesOnBetweenStepsThatWereCut) {
  const Folder folder;
  std::set<long> every, second;
  for (long k = 1; k <= 40; ++k) every.insert(k);
  for (long k = 1; k <= 30; ++k) second.insert(2 * k);
  EXPECT_GT(expect_goes_on(folder.path(), machine(), "", every, {"solver.iterations=1", "time.end=0.3", "time.step=0.03"}).cuts, 2);
  EXPECT_GT(
      expect_goes_on(folder.path(), machine(), "", second, {"solver.iterations=1", "time.tolerance=1e-3", "stop.limit.stiffness=2e6"}).cuts,
      2);
}

// Clocks of mechanisms, which the start of a run finds, leave no estimate by steps alone.
TEST(KeptRun, GoesOnWithAnErrorThatStepsTell) {
  const Folder folder;
  const std::vector<std::string> by_steps{"time.error_estimate=\"steps\""};
  const std::string swing = "gravity = [0, 0, -9.81]\n" + body("rod", 1, {5, 0, 0}, {1e-3, 1e-3, 1e-3}) +
                            joint("revolute", "hinge", "ground", "rod", {5, 0, 0.3}, "axis = [0, 1, 0]\n") + in_time(0.02, 1e-3);
  for (const std::string& scene : {swing, swing + "integrator = \"generalized-alpha\"\n", machine()})
    expect_goes_on(folder.path(), scene, "", {1, 7}, by_steps);
}

TEST(KeptRun, GoesOnWithEachOfTheSerialSolvers) {
  const Folder folder;
  for (const char* kind : {"klu", "cholesky", "umfpack"})
    expect_goes_on(folder.path(), bar(folder.path(), metal), "tags.h5", {3, 14}, {std::string("solver.kind=\"") + kind + "\""});
}

TEST(KeptRun, GoesOnInAStaticAnalysis) {
  const Folder folder;
  write_mesh(folder / "mesh.h5", block_mesh({.n = {2, 1, 1}}), {"test"});
  const RunReport report =
      expect_goes_on(folder.path(), uniaxial_cycle(), "mesh.h5", {1, 7, 8, 20}, {"solver.iterations=3", "solver.cuts=20"});
  EXPECT_GT(report.cuts, 0);
  EXPECT_NE(told(folder / "later.h5").find("not checked: a static analysis"), std::string::npos) << "why its energy is not checked";
}

TEST(KeptRun, GoesOnOnAPath) {
  const Folder folder;
  write_mesh(folder / "mesh.h5", block_mesh({.n = {4, 1, 1}, .high = {4, 1, 1}}), {"test"});
  const std::string scene =
      "[material.m]\n" + metal + "E = 1e6\nnu = 0.3\ndensity = 1\n[region.\"*\"]\nmaterial = \"m\"\n" +
      "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n" +
      "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"xmax\"\nforce = [0, 0, -3e3]\n[time]\nanalysis = \"path\"\nsteps = 12\n";
  expect_goes_on(folder.path(), scene, "mesh.h5", {1, 2, 5, 9}, {});
}

// What is kept gives up factors of matrices, so the steps behind it differ from those of a run that is not kept: by round-off.
TEST(KeptRun, IsTheRunThatWasNotKeptButForRoundOff) {
  const Folder folder;
  KeptRun kept(folder.path(), machine(), "", {}), plain(folder.path(), machine(), "", {});
  kept.run("kept.h5", {2, 11, 17}), plain.run("plain.h5", {});
  const Results a(folder / "kept.h5"), b(folder / "plain.h5");
  for (const char* history : {"probe/far", "joint/A0", "joint/bearing", "energy", "sensor/seat"})
    EXPECT_LT((a.history(history) - b.history(history)).cwiseAbs().maxCoeff(), 1e-8 * b.history(history).cwiseAbs().maxCoeff()) << history;
}

TEST(KeptRun, RefusesWhatBelongsToAnotherSceneOrIsCutShort) {
  const Folder folder;
  KeptRun one(folder.path(), machine(), "", {}), other(folder.path(), machine() + body("more", 1, {9, 9, 9}, {1, 1, 1}), "", {});
  one.run("run.h5", {3});
  const Kept kept = one.kept().at(3);
  Kept cut = kept;
  cut.bytes.pop_back();
  EXPECT_THROW(other.run("run.h5", {}, kept), Error);
  EXPECT_THROW(one.run("run.h5", {}, cut), Error);
}

TEST(DISABLED_KeptOnRanks, GoesOnBitByBit) { expect_goes_on(".", machine(), "", {4, 20}, {"time.end=0.15"}); }
TEST(DISABLED_KeptOnRanks, GoesOnBitByBitWithCells) { expect_goes_on(".", bar(".", metal), "tags.h5", {3, 14}, {"time.dissipation=0.2"}); }
TEST(DISABLED_KeptOnRanks, GoesOnBitByBitWhereARankHasNoCell) {
  if (Comm::world().rank == 0) {
    write_mesh("one.h5", block_mesh({}), {"test"});
    write_tags("one-tags.h5", "one.h5", {Fidelity::rigid}, {"test"});
  }
  Comm::world().barrier();
  expect_goes_on(".",
                 "gravity = [0, 0, -9.81]\n[material.m]\nE = 1e7\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n" +
                     joint("revolute", "hinge", "ground", "xmin", {0, 0, 0}, "axis = [0, 1, 0]\n") + "[time]\nend = 0.02\nstep = 1e-3\n",
                 "one-tags.h5", {3, 14});
}

TEST(KeptRun, GoesOnOnTwoRanks) {
  const Folder folder;
  expect_passes_on(2, "KeptOnRanks", folder.path().string());
}

}  // namespace
}  // namespace hilo::test::kept_run_test
