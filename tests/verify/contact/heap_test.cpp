// SPDX-License-Identifier: GPL-3.0-or-later
// Many balls that all may meet: one contact, whose pairs are found as they come near each other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "succeeded.hpp"
#include "verify/contact/collision.hpp"
#include "verify/verify.hpp"

namespace hilo::test::heap_test {
namespace {

const std::string ranks =
    "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1 "
    "OMPI_MCA_hwloc_base_binding_policy=none OPENBLAS_NUM_THREADS=1\ntimeout 60 mpirun -n 3 ";

/// n balls of different size in a cube, which fly about.
struct Balls : Case {
  int n;
  std::string text, all;
  explicit Balls(int n, double speed = 1) : Case("contact"), n(n) {
    Dice dice(7);
    const int across = static_cast<int>(std::ceil(std::cbrt(n)));
    for (int k = 0; k < n; ++k) {
      const double r = dice(0.06, 0.1), m = 4000 * r * r * r;
      const std::string at =
          fmt::format("[{}, {}, {}]", 0.21 * (k % across), 0.21 * (k / across % across), 0.21 * (k / across / across) + 0.005 * dice());
      text += fmt::format(
          "[[body]]\nname = \"b{0}\"\nmass = {1}\ncom = {2}\ninertia = [{3}, {3}, {3}]\n[[obstacle]]\nkind = \"sphere\"\nname = "
          "\"s{0}\"\non = \"b{0}\"\nat = {2}\nradius = {4}\n[[initial]]\non = [\"b{0}\"]\nvelocity = {5}\nspin = {6}\n",
          k, m, at, 0.4 * m * r * r, r, dice.vector(speed), dice.vector(3));
    }
    all = contact("c", "all", "all");
  }
  static std::string contact(const std::string& name, const std::string& a, const std::string& b) {
    return fmt::format("[[contact]]\nname = \"{}\"\na = \"{}\"\nb = \"{}\"\nmodulus = 1e6\nfriction = 0.3\n", name, a, b);
  }
  Ran solve(const std::string& contacts, const std::string& output, const std::string& launcher = "", const std::string& more = "") const {
    std::ofstream(*this / "scene.toml") << "[solver]\ntolerance = 1e-12\n[time]\nend = 0.1\nstep = 0.002\n" << text << contacts;
    return run(launcher + "hilo-solve --quiet scene.toml -o " + output + " " + more);
  }
  Results solved(const std::string& contacts, const std::string& output, const std::string& launcher = "",
                 const std::string& more = "") const {
    const Ran ran = solve(contacts, output, launcher, more);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    return Results(*this / output);
  }
};

/// Largest difference of the balls' places at the end [m].
double apart(const Results& a, const Results& b, int n) {
  double worst = 0;
  for (int k = 0; k < n; ++k) {
    const auto x = a.history(fmt::format("body/b{}", k)), y = b.history(fmt::format("body/b{}", k));
    worst = std::max(worst, (x.row(x.rows() - 1) - y.row(y.rows() - 1)).cwiseAbs().maxCoeff());
  }
  return worst;
}

// Truth: the run of the same balls whose 1035 pairs the scene names one by one.
TEST(Heap, OfAllPairsIsThePairsOneByOne) {
  const Balls c(46);
  const Results heap = c.solved(c.all, "heap.h5");
  std::string named;
  for (int i = 0; i < c.n; ++i)
    for (int j = i + 1; j < c.n; ++j) named += c.contact(fmt::format("p{}_{}", i, j), fmt::format("s{}", i), fmt::format("s{}", j));
  const Results one_by_one = c.solved(named, "named.h5");
  const auto h = heap.history("heap/c");
  EXPECT_GE(h.col(0).maxCoeff(), 3) << "pairs pressed at once";
  EXPECT_LT(apart(heap, one_by_one, c.n), 1e-9);
  double friction = 0, slipped = 0, deepest = 0;
  for (int i = 0; i < c.n; ++i)
    for (int j = i + 1; j < c.n; ++j) {
      const auto p = one_by_one.history(fmt::format("contact/p{}_{}", i, j));
      friction += p(p.rows() - 1, 6), slipped = std::max(slipped, p(p.rows() - 1, 5)), deepest = std::max(deepest, p.col(3).maxCoeff());
    }
  EXPECT_NEAR(h(h.rows() - 1, 4), friction, 1e-9 * friction);
  EXPECT_NEAR(h.col(1).maxCoeff(), deepest, 1e-9 * deepest);
  EXPECT_GT(slipped, 0);
  // what others name they keep
  const Results beside = c.solved(c.all + c.contact("own", "s0", "s1"), "beside.h5");
  EXPECT_LT(apart(heap, beside, c.n), 1e-9);
  EXPECT_EQ(beside.file().list("/history/contact"), (std::vector<std::string>{"own"}));
}

// Truth: invariants; every step short or long of an impact.
TEST(Heap, KeepsEnergyAndMomenta) {
  for (const double step : {0.0005, 0.004, 0.02}) {
    const Balls c(64, 2);
    const Results r = c.solved(c.all, "run.h5", "", fmt::format("--set time.step={} --set time.end={}", step, 50 * step));
    const auto e = r.history("energy"), p = r.history("momentum");
    EXPECT_GE(r.history("heap/c").col(0).maxCoeff(), 2);
    for (Eigen::Index k = 1; k < e.rows(); ++k) {
      EXPECT_LT(std::abs(e(k, 5) - e(k - 1, 5)), 1e-11 * e(0, 0)) << step;
      EXPECT_LT((p.row(k) - p.row(k - 1)).norm(), 1e-11 * std::sqrt(e(0, 0) * 100)) << step;
      EXPECT_GE(e(k, 4), e(k - 1, 4) - 1e-14 * e(0, 0)) << "friction takes";
    }
  }
}

TEST(Heap, GoesOnAndIsTheSameOnRanks) {
  const Balls c(46);
  const Results one = c.solved(c.all, "one.h5");
  EXPECT_LT(apart(one, c.solved(c.all, "three.h5", ranks), c.n), 1e-9);
  const std::string often = "--checkpoint 5steps";
  const Results whole = c.solved(c.all, "whole.h5", "", often);
  c.solved(c.all, "half.h5", "", often + " --set time.end=0.04");
  succeeded(c.run("hilo-solve --quiet --restart half.h5 --accept --set time.end=0.1 " + often));
  EXPECT_LT(apart(whole, Results(c / "half.h5"), c.n), 1e-12);
  double corrections[2];  // what is kept leaves pairs where they stand in the matrix
  for (const bool kept : {false, true})
    c.solved(c.all, "run.h5", "", kept ? often : ""), corrections[kept] = c.reported("newton_iterations");
  EXPECT_EQ(corrections[0], corrections[1]);
}

TEST(Heap, RefusesWhatCannotBe) {
  const Balls c(46);
  const auto refused = [&](const std::string& contacts, const std::string& why) {
    const Ran ran = c.solve(contacts, "run.h5");
    EXPECT_EQ(ran.exit, 2);
    EXPECT_NE(ran.err.find(why), std::string::npos) << ran.err;
  };
  refused("[[contact]]\nname = \"c\"\na = \"all\"\nb = \"all\"\n", "nothing says how stiff they are");
  Balls deep(46);
  deep.text += "[[obstacle]]\nkind = \"sphere\"\nname = \"large\"\non = \"b0\"\nat = [0, 0, 0]\nradius = 0.3\n";
  const Ran ran = deep.solve(deep.all, "run.h5");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_NE(ran.err.find("m deep in"), std::string::npos) << ran.err;
  const Ran explained = c.run("hilo-solve --quiet scene.toml --explain --set contact.c.modulus=1e6");
  EXPECT_NE(explained.out.find("# contact \"c\": 46 balls, in pairs as they come near each other"), std::string::npos) << explained.err;
}

// Truth: a bullet that goes many radii a step does not pass through the ball before it.
TEST(Heap, NothingGoesThrough) {
  Balls c(46, 0.01);
  c.text +=
      "[[body]]\nname = \"bullet\"\nmass = 1\ncom = [-1, 0.2, 0.2]\ninertia = [1e-3, 1e-3, 1e-3]\n[[obstacle]]\nkind = \"sphere\"\nname = "
      "\"bullet\"\non = \"bullet\"\nat = [-1, 0.2, 0.2]\nradius = 0.05\n[[initial]]\non = [\"bullet\"]\nvelocity = [200, 0, 0]\n";
  const Results r = c.solved(c.all, "run.h5");
  const auto x = r.history("body/bullet");
  EXPECT_LT(x(x.rows() - 1, 0), 19) << "it would be there alone";
  EXPECT_GT(r.history("heap/c").col(5).maxCoeff(), 0);
}

// Truth: each ball of a column carries those above it, by Hertz; in load steps, and where the run starts.
TEST(Heap, AColumnStands) {
  constexpr int n = 50;
  constexpr double r = 0.01, m = 0.01, E = 1e7;
  const Case c("contact");
  std::string text =
      "gravity = [0, 0, -9.81]\n[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n[[contact]]\nname = \"c\"\na = \"all\"\nb = "
      "\"all\"\nmodulus = 1e7\nfriction = 0.3\n[time]\nend = 0.004\nstep = 0.001\nstart = \"equilibrium\"\nsteps = 2\n";
  for (int k = 0; k < n; ++k)
    text += fmt::format(
        "[[body]]\nname = \"b{0}\"\nmass = {2}\ncom = [0, 0, {1}]\ninertia = [1e-6, 1e-6, 1e-6]\n[[obstacle]]\nkind = \"sphere\"\nname = "
        "\"s{0}\"\non = \"b{0}\"\nat = [0, 0, {1}]\nradius = {3}\n[[joint]]\nkind = \"prismatic\"\nname = \"j{0}\"\na = \"ground\"\nb = "
        "\"b{0}\"\nat = [0, 0, {1}]\naxis = [0, 0, 1]\n",
        k, r + 2 * r * k, m, r);
  std::ofstream(c / "scene.toml") << text;
  const double F = (n - 1) * m * 9.81, depth = std::pow(F / (4. / 3 * E * std::sqrt(r / 2)), 2. / 3);
  for (const char* analysis : {"", "--set 'time.analysis=\"static\"' --set 'time.start=\"as given\"'"}) {
    succeeded(c.run(fmt::format("hilo-solve --quiet scene.toml -o run.h5 {}", analysis)));
    const auto heap = Results(c / "run.h5").history("heap/c");
    const auto last = heap.row(heap.rows() - 1);
    EXPECT_EQ(last(0), n - 1);
    EXPECT_NEAR(last(1), depth, 1e-8 * depth);
    EXPECT_NEAR(last(5), F, 1e-8 * F);
  }
}

// SimBenchmark's 216 elastic balls (radius 0.1 m, 10 kg, 6 x 6 x 6 at 0.21 m, dropped from a metre).  Truth: invariants.  Its engines lose
// or gain 16 to 900 J (root of the mean square) at this step.
TEST(Heap, OfSimBenchmarkKeepsItsEnergy) {
  const Case c("contact");
  Dice dice(42);
  std::string text =
      "gravity = [0, 0, -9.81]\n[time]\nend = 0.8\nstep = 0.004\n[solver]\ntolerance = 1e-12\n[[obstacle]]\nkind = "
      "\"plane\"\nname = \"ground\"\n[[contact]]\nname = \"c\"\na = \"all\"\nb = \"all\"\nmodulus = 1e8\n";
  for (int k = 0; k < 216; ++k) {
    const std::string at = fmt::format("[{}, {}, {}]", 0.21 * (k % 6) + 1e-3 * dice(), 0.21 * (k / 6 % 6) + 1e-3 * dice(),
                                       0.21 * (k / 36) + 1e-3 * dice() + 1.101);
    text += fmt::format(
        "[[body]]\nname = \"b{0}\"\nmass = 10\ncom = {1}\ninertia = [0.04, 0.04, 0.04]\n[[obstacle]]\nkind = \"sphere\"\nname = "
        "\"s{0}\"\non = \"b{0}\"\nat = {1}\nradius = 0.1\n",
        k, at);
  }
  std::ofstream(c / "scene.toml") << text;
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results r(c / "run.h5");
  const auto e = r.history("energy"), p = r.history("momentum");
  EXPECT_GT(r.history("heap/c").col(0).maxCoeff(), 30) << "balls press each other";
  for (Eigen::Index k = 1; k < e.rows(); ++k) {
    EXPECT_LT(std::abs(e(k, 5) - e(0, 5)), 1e-9 * std::abs(e(0, 2))) << k;
    EXPECT_LT(p.row(k).head<2>().norm(), 1e-9 * 2160 * 4) << "nothing pushes them sideways";
  }
}

// SimBenchmark's rolling test: 25 balls of 1 kg on a plate of 10 kg that 150 N push over the ground, friction 0.4 below and 0.8 above.
// Truth: f1 = 0.4 (M + 25 m) g, f2 = (F - f1)/M/(3.5/m + 25/M) of each ball, accelerations (F - f1 - 25 f2)/M and f2/m.  The mean square of
// the errors of both velocities, 6e-9 of the best of its engines at a step of a millisecond.
TEST(Heap, OfSimBenchmarkRolls) {
  const Case c("contact");
  constexpr double g = 9.81, r = 0.1, M = 10, F = 150, k = 1e9, E = 1e11;
  const double low = 35 * g / 4 / k, lower = std::pow(g / (4. / 3 * E * std::sqrt(r)), 2. / 3);  // pressed by the weight
  std::string text = fmt::format(
      "gravity = [0, 0, -9.81]\n[time]\nend = 0.4\nstep = 0.01\n[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n[[body]]\nname = "
      "\"plate\"\nmass = 10\ncom = [0, 0, {0}]\ninertia = [100, 100, 200]\n[[obstacle]]\nkind = \"box\"\nname = \"box\"\non = "
      "\"plate\"\nat = [0, 0, {0}]\nsize = [20, 20, 0.1]\n[[obstacle]]\nkind = \"plane\"\nname = \"top\"\non = \"plate\"\nat = [0, 0, "
      "{1}]\n[[contact]]\nname = \"base\"\na = \"ground\"\nb = \"box\"\nfriction = 0.4\nstiffness = 1e9\n[[load]]\nkind = "
      "\"force\"\nname = \"push\"\non = \"plate\"\nforce = [{2}, {3}, 0]\n[[probe]]\nname = \"plate\"\non = \"plate\"\n[[probe]]\nname "
      "= \"ball\"\non = \"b7\"\n",
      0.05 - low, 0.1 - low, F / 2, F * std::sqrt(0.75));
  for (int i = 0; i < 25; ++i)
    text += fmt::format(
        "[[body]]\nname = \"b{0}\"\nmass = 1\ncom = {1}\ninertia = [0.004, 0.004, 0.004]\n[[obstacle]]\nkind = \"sphere\"\nname = "
        "\"s{0}\"\non = \"b{0}\"\nat = {1}\nradius = 0.1\n[[contact]]\nname = \"c{0}\"\na = \"top\"\nb = \"s{0}\"\nfriction = "
        "0.8\nmodulus = 1e11\n",
        i, fmt::format("[{}, {}, {:.17g}]", 2. * (i % 5 - 2), 2. * (i / 5 - 2), 0.1 - low + r - lower));
  std::ofstream(c / "scene.toml") << text;
  succeeded(c.run("hilo-solve --quiet scene.toml -o run.h5"));
  const Results results(c / "run.h5");
  const double f1 = 0.4 * 35 * g, f2 = (F - f1) / M / (3.5 + 25 / M), a1 = (F - f1 - 25 * f2) / M;
  const auto t = results.history("t"), plate = results.history("probe/plate"), ball = results.history("probe/ball");
  double sum = 0;
  for (Eigen::Index n = 0; n < t.rows(); ++n) {
    const Vec3 along(0.5, std::sqrt(0.75), 0);
    sum += (plate.row(n).segment<3>(3).transpose() - a1 * t(n, 0) * along).squaredNorm();
    sum += (ball.row(n).segment<3>(3).transpose() - f2 * t(n, 0) * along).squaredNorm();
  }
  EXPECT_LT(sum / static_cast<double>(t.rows()), 1e-12);
}

}  // namespace
}  // namespace hilo::test::heap_test
