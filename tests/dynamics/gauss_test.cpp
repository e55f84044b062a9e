// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss collocation (docs/gauss.md): orders against RK4 without joints or multipliers, what it keeps, its matrix of all stages against
// differences, and what it refuses.
#include "base/registry.hpp"
#include "dynamics/integrator/make.hpp"
#include "dynamics/scenes.hpp"
#include "linear/tangent_reader.hpp"
#include "system/along.hpp"

namespace hilo::test::gauss_test {
namespace {

TEST(Gauss, IsOfOrderSixInPositionVelocityAccelerationAndReaction) {
  const Workplace w;
  for (OrderCase c : {pend3d(w), top(w), slider(w)}) {
    const double h = c.scene == "top.toml" ? 4e-3 : c.scene == "slider.toml" ? 0.04 : 0.1;
    const Errors coarse = errors(w, c, integrator("gauss"), h), fine = errors(w, c, integrator("gauss"), h / 2);
    const auto order = [&](double Errors::*e) { return std::log2(coarse.*e / fine.*e); };
    EXPECT_GT(order(&Errors::x), 5.5) << c.scene << " " << coarse.x << " " << fine.x;
    EXPECT_GT(order(&Errors::v), 5.5) << c.scene << " " << coarse.v << " " << fine.v;
    EXPECT_GT(order(&Errors::a), 5.5) << c.scene << " " << coarse.a << " " << fine.a;
    double size = 0;  // of the force, whose shares of redundant rows are found to 1e-12
    for (const Truth& truth : c.truth) size = std::max(size, truth.force.norm());
    EXPECT_TRUE(order(&Errors::force) > 5.5 || fine.force < 1e-12 * size)
        << c.scene << " " << coarse.force << " " << fine.force << " of " << size;
  }
}

/// Two bodies that fly, joined by a revolute and by a spring whose force is not linear in what it measures.
std::string fliers() {
  return body("a", 2, {0.5, 0, 0}, {0.01, 0.17, 0.17}, "") + body("b", 1, {1, 0.4, 0}, {0.06, 0.01, 0.06}) +
         joint("revolute", "mid", "a", "b", {1, 0, 0}, "axis = [0, 0, 1]\n") +
         "[[spring]]\nkind = \"axial\"\nname = \"spring\"\na = \"a\"\nb = \"b\"\nat_a = [0, 0, 0.1]\nat_b = [1, 0.8, 0]\nstiffness = 500\n"
         "length = 1.1\n"
         "[[initial]]\non = [\"a\"]\nvelocity = [0.3, 1, -0.5]\nspin = [3, 1, 2]\nabout = [0, 0, 0]\n"
         "[[initial]]\non = [\"b\"]\nspin = [-1, 2, 4]\nabout = [1, 0, 0]\n"
         "[[probe]]\nname = \"tip\"\non = \"b\"\nat = [1, 0.8, 0]\n[time]\nend = 4\nstep = 0.01\nintegrator = \"gauss\"\n";
}

TEST(Gauss, KeepsEnergyMomentaAndJoints) {
  const Workplace w;
  w.write("scene.toml", fliers());
  ASSERT_EQ(w.run("hilo-solve --quiet scene.toml -o run.h5").exit, 0);
  const Results r(w / "run.h5");
  const auto energy = r.history("energy"), momentum = r.history("momentum");
  const Eigen::Index last = energy.rows() - 1;
  double total = 0, scale = 0;
  for (Eigen::Index i = 0; i <= last; ++i) {
    total = std::max(total, std::abs(energy.row(i).head(3).sum() - energy.row(0).head(3).sum()));
    scale = std::max(scale, energy(i, 0));
  }
  EXPECT_LT(total, 1e-11 * scale);
  EXPECT_EQ(energy(last, 4), 0) << "nothing is taken away at this step";
  for (int k = 0; k < 6; ++k) EXPECT_LT((momentum.col(k).array() - momentum(0, k)).abs().maxCoeff(), 1e-11 * momentum.row(0).norm()) << k;
  EXPECT_LT(r.history("constraint").maxCoeff(), 1e-13);
}

// Energy that joints do not allow is taken where the step is too long for it to be small, and told: the account closes all the same.
TEST(Gauss, TellsTheEnergyThatALongStepLoses) {
  const Workplace w;
  w.write("scene.toml", fliers());
  ASSERT_EQ(w.run("hilo-solve --quiet scene.toml -o run.h5 --set time.step=0.16").exit, 0);
  const auto energy = Results(w / "run.h5").history("energy");
  const Eigen::Index last = energy.rows() - 1;
  EXPECT_GT(energy(last, 4), 1e-8 * energy(0, 0));
  EXPECT_LT(energy.col(5).cwiseAbs().maxCoeff(), 1e-11 * energy(0, 0));
}

/// An arm that a law turns, a bob on it that a moment and a spring to the ground drive besides.
std::string moved() {
  return "gravity = [0, 9.81, 2]\n" + body("arm", 2, {0.5, 0.2, 0.1}, {0.3, 0.2, 0.4}) +
         body("bob", 1, {1, 0.2, -0.5}, {0.06, 0.05, 0.02}) +
         "[[motion]]\nkind = \"rotation\"\nname = \"drive\"\non = \"arm\"\nat = [0, 0, 1]\naxis = [1, 2, 2]\nangle = 3\n"
         "history = {t = [-0.2, 1], value = [0, 1], interpolation = \"smoother\"}\n" +
         joint("spherical", "top", "arm", "bob", {1, 0.2, 0}) +
         "[[spring]]\nkind = \"axial\"\nname = \"spring\"\na = \"ground\"\nb = \"bob\"\nat_a = [0, 0, 0]\nat_b = [1, 0.2, -1]\nstiffness = "
         "30\n"
         "length = 1\n[[load]]\nkind = \"torque\"\nname = \"push\"\non = \"bob\"\ntorque = [1, 3, 2]\n"
         "[[probe]]\nname = \"tip\"\non = \"bob\"\nat = [1, 0.2, -1]\n[time]\nend = 0.4\nstep = 0.01\n";
}

// What moves by a law, and a moment, do the work that is told of them.
TEST(Gauss, TheWorkOfMotionsAndMomentsIsExact) {
  const Workplace w;
  w.write("scene.toml", moved());
  for (const std::string h : {"0.01", "0.04"}) {
    succeeded(w.run("hilo-solve --quiet scene.toml -o run.h5 --set time.step=" + h + " " + integrator("gauss")));
    const auto energy = Results(w / "run.h5").history("energy");
    EXPECT_GT(energy.col(3).cwiseAbs().maxCoeff(), 1);
    EXPECT_LT(energy.col(5).cwiseAbs().maxCoeff(), 1e-12 * energy.col(0).maxCoeff()) << h;
  }
}

// Truth: hilo's Radau at a hundredth of the step.  A driven angle, a rack, a universal and a constant-velocity joint have rows that are
// functions of their measures; a wheel has rows of velocities; an arm moves by a law.
TEST(Gauss, IsOfOrderSixWithEveryKindOfRow) {
  const Workplace w;
  const std::string shaft = "gravity = [0, 9.81, 2]\n" + body("motor", 2, {0, 0, 0}, {0.02, 0.03, 0.04}) +
                            body("shaft", 1, {0, 0, 1}, {0.05, 0.06, 0.02}) + body("end", 1, {0, 0.2, 2}, {0.05, 0.06, 0.02}) +
                            joint("revolute", "drive", "ground", "motor", {0, 0, 0},
                                  "axis = [0, 0, 1]\nangle = 2\nhistory = {t = [0, 1], value = [0, 1], interpolation = \"smoother\"}\n") +
                            joint("universal", "cross", "motor", "shaft", {0, 0, 0.5}, "axis = [1, 0, 0]\nx = [0, 1, 0]\n") +
                            joint("constant-velocity", "cv", "shaft", "end", {0, 0, 1.5}, "axis = [0, 0, 1]\n") +
                            "[[probe]]\nname = \"tip\"\non = \"end\"\nat = [0.3, 0.2, 2]\n[time]\nend = 0.4\nstep = 1\n";
  const std::string disc =
      "gravity = [0, 0, -9.81]\n" + body("disc", 2, {0, 0, 0.3}, {0.05, 0.09, 0.05}) +
      "[[joint]]\nkind = \"rolling\"\nname = \"road\"\na = \"ground\"\nb = \"disc\"\nat = [0, 0, 0.3]\naxis = [0, 0, 1]\n"
      "radius = 0.3\naxle = [0, 1, 0]\n[[initial]]\non = [\"disc\"]\nspin = [0.4, 6, 0.5]\nabout = [0, 0, 0]\n"
      "[[probe]]\nname = \"tip\"\non = \"disc\"\nat = [0.1, 0.1, 0.3]\n[time]\nend = 0.4\nstep = 1\n";
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"shaft", shaft}, {"disc", disc}, {"moved", moved()}}) {
    w.write(name + ".toml", text);
    const auto end = [&](const std::string& method, const std::string& h) {
      succeeded(w.run("hilo-solve --quiet " + name + ".toml -o run.h5 --set solver.tolerance=1e-12 --set time.step=" + h + " " +
                      integrator(method)));
      return Vec3(Results(w / "run.h5").at("probe/tip", 0.4).head<3>());
    };
    const Vec3 truth = end("radau", "0.0004");
    const double coarse = (end("gauss", "0.04") - truth).norm(), fine = (end("gauss", "0.02") - truth).norm();
    EXPECT_GT(std::log2(coarse / fine), 5.3) << name << " " << coarse << " " << fine;
  }
}

// Truth: RK4 after five steps of 1.8 rad, and the energy; the audit refuses more than 2 rad.
TEST(Gauss, HoldsAtNearlyTwoRadiansAStep) {
  const Workplace w;
  const OrderCase c = top(w);
  succeeded(
      w.run("hilo-solve --quiet top.toml -o run.h5 --set time.step=0.012 --set time.end=0.06 --set solver.cuts=0 " + integrator("gauss")));
  const Results r(w / "run.h5");
  EXPECT_LT((r.at("probe/tip", c.t[0]).head<3>() - c.truth[0].x).norm(), 1e-4);  // 4e-5 of an arm of 1 m
  const auto e = r.history("energy");
  EXPECT_LT(((e.col(0) + e.col(2)).array() - e(0, 0) - e(0, 2)).abs().maxCoeff(), 3e-5 * e(0, 0));
}

/// A bar of two halves that flies and spins, the second one rigid, where `head` is true, with a body on a hinge there.
struct FlyingBar {
  std::string name, law;
  Shape shape = Shape::hex8;
  bool head = false;
  double width = 0.1, spin = 1;  // of 18 rad/s
  bool hinge = true;
  int cells = 2;  // half of them the second one's
  bool shell = false;
};
std::string flying_bar(const Workplace& w, const FlyingBar& c) {
  write_mesh(w / "mesh.h5",
             block_mesh({.shape = c.shape,
                         .n = {c.cells, 1, 1},
                         .high = Vec3(0.5, c.width, c.shell ? c.width / 5 : c.width),
                         .regions = {"bar", "head"},
                         .region_of = [](const Vec3& x) { return x[0] > 0.25 ? 1 : 0; }}),
             {"test"});
  write_tags(w / "tags.h5", w / "mesh.h5", {Fidelity::nonlinear, c.head ? Fidelity::rigid : Fidelity::nonlinear}, {"test"});
  std::string text = "[material.m]\n" + c.law + "\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n" + (c.shell ? "shell = true\n" : "") +
                     fmt::format("[[initial]]\non = [\"bar\", \"head\"]\nvelocity = [1, 2, 3]\nspin = [{}, {}, {}]\n", 3 * c.spin,
                                 15 * c.spin, 10 * c.spin);
  if (c.head && c.hinge)
    text += body("bob", 1, {0.6, 0.05, 0.05}, {0.01, 0.02, 0.02}) +
            joint("revolute", "hinge", "head", "bob", {0.5, 0.05, 0.05}, "axis = [0, 1, 0]\n");
  return text +
         "[[probe]]\nname = \"tip\"\non = \"bar\"\nat = [0, 0, 0]\n[time]\nend = 0.1\nstep = 0.01\nintegrator = \"gauss\"\n"
         "[solver]\ntolerance = 1e-13\n";
}
const std::string soft = "E = 1e6\nnu = 0.3", rubber = "kind = \"neo-hookean\"\nE = 1e6\nnu = ",
                  wood =
                      "kind = \"orthotropic\"\nE1 = 2e6\nE2 = 1e6\nE3 = 5e5\nnu12 = 0.3\nnu13 = 0.3\nnu23 = 0.3\nG12 = 4e5\n"
                      "G13 = 3e5\nG23 = 2e5";

TEST(Gauss, KeepsEnergyAndMomentaOfCells) {
  const Workplace w;
  for (const FlyingBar& c : {FlyingBar{"hex8", soft},
                             {"head", soft, Shape::hex8, true, 0.1, 0.2},
                             {"tet4", soft, Shape::tet4},
                             {"tet10", "E = 1e6\nnu = 0.49", Shape::tet10, false, 0.1, 0.3},
                             {"hex20r", "E = 1e6\nnu = 0.49", Shape::hex20r, false, 0.1, 0.3},
                             {"orthotropic", wood},
                             {"shell", soft, Shape::hex8, false, 0.1, 1, false, 4, true},
                             {"shell and head", soft, Shape::hex8, true, 0.1, 0.2, true, 4, true},
                             {"neo-hookean", rubber + "0.3", Shape::hex8, true, 0.1, 0.2},
                             {"rubber", rubber + "0.49", Shape::wedge6}}) {
    w.write("scene.toml", flying_bar(w, c));
    const Ran ran = w.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5 --set solver.cuts=0");
    ASSERT_EQ(ran.exit, 0) << c.name << ran.err;
    const Results r(w / "run.h5");
    const auto energy = r.history("energy"), momentum = r.history("momentum");
    ASSERT_EQ(energy.rows(), 11);
    const Eigen::VectorXd total = energy.col(0) + energy.col(1) + energy.col(4);  // with what hinges do not allow of the velocities
    EXPECT_LT(energy(10, 4), c.head ? 1e-5 * total[0] : 1e-300) << c.name;
    EXPECT_LT((total.array() - total[0]).abs().maxCoeff(), 1e-11 * total[0]) << c.name;
    EXPECT_GT(energy.col(1).maxCoeff(), 1e-6 * total[0]) << c.name << ", which really bends";
    for (int k = 0; k < 6; ++k)
      EXPECT_LT((momentum.col(k).array() - momentum(0, k)).abs().maxCoeff(), 1e-11 * momentum.row(0).norm()) << c.name << k;
  }
}

// Truth: Radau at a small step, the same cells.
TEST(Gauss, IsOfOrderSixWithCells) {
  const Workplace w;
  for (const FlyingBar& c : {FlyingBar{"stvk", "E = 1e5\nnu = 0.3", Shape::hex8, false, 0.25, 0.2},
                             {"neo-hookean", "kind = \"neo-hookean\"\nE = 1e5\nnu = 0.3", Shape::hex8, false, 0.25, 0.2},
                             {"head", "E = 1e5\nnu = 0.3", Shape::hex8, true, 0.25, 0.2},
                             {"shell", "E = 1e4\nnu = 0.3", Shape::hex8, false, 0.25, 0.2, false, 2, true}}) {
    w.write("scene.toml", flying_bar(w, c));
    const auto end = [&](const std::string& method, const std::string& h) {
      const Ran ran =
          w.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5 --set time.end=0.08 --set time.step=" + h + " " + integrator(method));
      EXPECT_EQ(ran.exit, 0) << c.name << ran.err;
      return Results(w / "run.h5").at("probe/tip", 0.08);
    };
    const auto truth = end("radau", "0.0005"), coarse = end("gauss", "0.008"), fine = end("gauss", "0.004");
    for (int k = 0; k < 9; k += 3) {  // position, velocity, acceleration
      const double before = (coarse - truth).segment(k, 3).norm(), after = (fine - truth).segment(k, 3).norm();
      EXPECT_GT(std::log2(before / after), 5.3) << c.name << " " << k << " " << before << " " << after;
    }
  }
}

// Truth: one rank.  On three ranks of two cells one has none.
TEST(Gauss, IsTheSameOnRanks) {
  const Workplace w;
  for (const FlyingBar& c : {FlyingBar{"head", rubber + "0.3", Shape::hex8, true, 0.1, 0.2},
                             {"cells", soft, Shape::tet10, false, 0.1, 0.3, false, 8},
                             {"both", rubber + "0.49", Shape::hex8, true, 0.1, 0.2, true, 8}}) {
    w.write("scene.toml", flying_bar(w, c));
    for (const int n : {1, 2, 3})
      succeeded(mpirun(n, fmt::format("hilo-solve --quiet scene.toml tags.h5 -o r{}.h5 --set time.step=0.002 --set time.end=0.004", n),
                       w.path()));
    const Results one(w / "r1.h5");
    for (const char* n : {"r2.h5", "r3.h5"})
      for (const char* name : {"probe/tip", "energy", "momentum"}) {
        const Eigen::MatrixXd truth = one.history(name), found = Results(w / n).history(name);
        EXPECT_LT((found - truth).cwiseAbs().maxCoeff(), 1e-9 * truth.cwiseAbs().maxCoeff()) << c.name << " " << n << " " << name;
      }
  }
}

TEST(Gauss, RefusesWhatItDoesNotKnow) {
  const Workplace w;
  w.write("scene.toml", flying_bar(w, {.name = "rubber", .law = rubber + "0.3", .shell = true}));
  expect_end(w.run("hilo-solve scene.toml tags.h5 -o run.h5"), 2,
             "gauss cannot keep the plastic strain of a material, or the modes of shells");
}

/// Refuses every solve, so that the matrix of all stages is tried.
class Unwilling final : public TangentReader {
 public:
  void add(int, const double*) override {}
  SolveReport solve(std::span<const double>, std::span<double>, double) override { return {false, 0, 0, "unwilling"}; }
};

/// Differences of the residuals of all three stages, over a step of 0.1 s.
void expect_matrix(const System& system, Eigen::Index rows, double limit) {
  State s;
  s.q = system.start, s.v = system.start_velocity;
  s.lambda.assign(3 * system.n_joint_blocks(), 5.0);
  auto solver = std::make_unique<Along>([](int i) { return i % 30 == 26 ? 0 : std::sin(1.7 * (static_cast<double>(i) * i + 3)); });
  Along& along = *solver;
  Unwilling none;
  const StepTools tools{system, none, {.tolerance = 1e-300}};
  const auto gauss = make_gauss(std::move(solver));
  gauss->solve(tools, s, 0.1, Predictor::velocity);
  ASSERT_EQ(along.b.size(), 3u);
  ASSERT_EQ(along.A.rows(), rows);
  const Eigen::VectorXd product = along.A * along.d, difference = (along.b[1] - 100 * along.b[2] + 99 * along.b[0]) / (9 * Along::step);
  const double scale = (along.A.cwiseAbs() * along.d.cwiseAbs()).maxCoeff();
  for (Eigen::Index i = 0; i < product.size(); ++i) EXPECT_NEAR(product[i], difference[i], limit * scale) << "row " << i;
}

// Truth: differences of the residuals of all three stages.  Bodies turn by a third of a radian in the step; joints whose rows are their
// measures, and rows of velocities, which are exact.
TEST(Gauss, ItsMatrixIsTheDerivativeOfItsEquations) {
  const std::string text =
      body("a", 2, {0.5, 0, 0}, {0.01, 0.17, 0.16}) + body("b", 1, {1, 0.4, 0}, {0.06, 0.01, 0.05}) +
      body("disc", 2, {3, 0, 0.3}, {0.05, 0.09, 0.05}) + joint("spherical", "top", "ground", "a", {0, 0, 0}) +
      joint("revolute", "mid", "a", "b", {1, 0, 0}, "axis = [0, 0, 1]\n") +
      "[[joint]]\nkind = \"rolling\"\nname = \"road\"\na = \"ground\"\nb = \"disc\"\nat = [3, 0, 0.3]\naxis = [0, 0, 1]\nradius = 0.3\n"
      "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"b\"\nforce = [3, 1, 2]\nat = [1, 0.5, 0.1]\n"
      "[[initial]]\non = [\"a\", \"b\"]\nspin = [1, 2, 3]\nabout = [0, 0, 0]\n[[initial]]\non = [\"disc\"]\nspin = [3, 1, -2]\nabout = [3, "
      "0, 0]\n"
      "[time]\nend = 1\nstep = 0.1\nintegrator = \"gauss\"\n";
  const Scene scene = Scene::parse(text, "scene.toml");
  const auto system = build_system(scene, nullptr, Comm::world());
  system->commit(system->start, &system->start_velocity);
  expect_matrix(*system, 90, 2e-6);  // ten blocks a stage: three bodies, and joints of 3, 5 (the sixth, 26, is no row) and 3 rows
}

// The same with cells, whose strains follow the positions of all stages, and a rigid end.
TEST(Gauss, ItsMatrixIsTheDerivativeWithCells) {
  const Workplace w;
  const std::string law = "E = 1e6\nnu = 0.49";
  for (const FlyingBar& c : {FlyingBar{"hex8", law, Shape::hex8, true, 0.1, 0.2, false},
                             {"tet10", law, Shape::tet10, true, 0.1, 0.2, false},
                             {"hex20r", law, Shape::hex20r, true, 0.1, 0.2, false},
                             {"shell", law, Shape::hex8, true, 0.1, 0.2, false, 4, true}}) {
    const Scene scene = Scene::parse(flying_bar(w, c), "scene.toml");
    LocalMesh mesh = read_local_mesh(w / "tags.h5", Comm::world());
    const auto system = build_system(scene, &mesh, Comm::world());
    system->commit(system->start, &system->start_velocity);
    expect_matrix(*system, 9 * system->n_blocks(), 2e-6);
  }
}

// At 0.7 rad a step only that matrix converges.
TEST(Gauss, TakesLongStepsWithCells) {
  const Workplace w;
  w.write("scene.toml", flying_bar(w, {"head", "E = 1e6\nnu = 0.3"}));
  const Ran ran = w.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5 --set solver.cuts=0 --set time.step=0.04 --set time.end=0.2");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const auto energy = Results(w / "run.h5").history("energy");
  EXPECT_LT(energy.col(5).cwiseAbs().maxCoeff(), 1e-11 * energy(0, 0));
}

}  // namespace
}  // namespace hilo::test::gauss_test
