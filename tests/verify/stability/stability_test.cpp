// SPDX-License-Identifier: GPL-3.0-or-later
// What statics, starts from equilibrium and paths say of stability: a bar on a torsion spring under a load that buckles it, and columns.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::stability_test {
namespace {

/// A bar of 1 m on a torsion spring of 100 N m/rad, upright: it buckles at 100 N.
std::string bar(double side, const std::string& time) {
  return body("bar", 1, {0, 0, 0.5}, {0.1, 0.1, 0.1}) + axial("revolute", "pin", "ground", "bar", Vec3::Zero(), {0, 1, 0}) +
         spring("torsion", "k", "ground", "bar", "axis = [0, 1, 0]\nstiffness = 100") +
         force("P", "bar", {side, 0, -150}, "at = [0, 0, 1]") + probe("tip", "bar", "at = [0, 0, 1]") + "[time]\n" + time;
}

/// 100 angle = 150 sin(angle) + side cos(angle) on the side that the side load pushes to, by halving.
double leaning(double side) {
  double low = 0.5, high = 3;
  while (high - low > 1e-14) {
    const double mid = (low + high) / 2;
    (100 * mid < 150 * std::sin(mid) + side * std::cos(mid) ? low : high) = mid;
  }
  return low;
}

struct Bar : Case {
  Bar() : Case("stability") {}
  double tip(const std::string& text, std::string& said) {
    write("bar.toml", text);
    const Ran ran = succeeded(run("hilo-solve bar.toml -o run.h5"));
    said = ran.err;
    const auto x = results().history("probe/tip");
    return x(x.rows() - 1, 0);
  }
};

}  // namespace

// Truth: with a side load of .15 N the bar leans as it pushes, and no state on the way is unstable, also where both branches are stable at
// the end of a step.
TEST(StaticStability, TheBranchOfTheSideLoadIsFollowed) {
  Bar c;
  std::string said;
  for (const char* steps : {"1", "2", "4", "10", "20", "40", "100"})
    for (const double side : {0.15, -0.15}) {
      const double x = c.tip(bar(side, std::string("analysis = \"static\"\nsteps = ") + steps + "\n"), said);
      EXPECT_NEAR(x, std::copysign(std::sin(leaning(std::abs(side))), side), 1e-8) << steps << " steps\n" << said;
      EXPECT_NE(text_of(c / "run.json").find("\"unstable_states\": 0"), std::string::npos);
    }
}

// Truth: without one the upright bar is lost at 2/3 of the load; either side is right, and it is told.
TEST(StaticStability, APerfectBarIsToldAndLeft) {
  Bar c;
  std::string said;
  const double x = c.tip(bar(0, "analysis = \"static\"\nsteps = 10\n"), said);
  EXPECT_NEAR(std::abs(x), std::sin(leaning(0)), 1e-8);
  expect_words(said,
               "the equilibrium is not stable: an eigenvalue of the "
               "tangent is below zero");
  EXPECT_NE(said.find("body \"bar\""), std::string::npos) << said;
}

// Truth: the start takes the deeper of the stable states.
TEST(StaticStability, AStartFromEquilibriumTakesAStableOne) {
  Bar c;
  std::string said;
  const double x = c.tip(bar(0.15, "start = \"equilibrium\"\nend = 0.1\nstep = 0.01\n"), said);
  EXPECT_NEAR(x, std::sin(leaning(0.15)), 1e-7) << said;
  const double hanging =
      c.tip(body("bob", 2, {0, 0, 1}, {0.1, 0.1, 0.1}) + axial("revolute", "pin", "ground", "bob", Vec3::Zero(), {0, 1, 0}) +
                probe("tip", "bob", "at = [0.2, 0, 1]") + in_time(0.1, 0.01, "start = \"equilibrium\""),
            said);
  EXPECT_NEAR(hanging, 0.2, 1e-9) << "no weight: any attitude will do";
  EXPECT_EQ(said.find("not stable"), std::string::npos) << said;
}

namespace {

/// A pendulum of 3 kg, 0.7 m up, on its hinge, with what holds its turn.
std::string upright(const std::string& held, const std::string& time) {
  return "gravity = [0, 0, -9.80665]\n" + body("p", 3, {0, 0, 0.7}, {0.2, 0.3, 0.1}) +
         axial("revolute", "pin", "ground", "p", Vec3::Zero(), {0, 1, 0}) + held + "[time]\n" + time;
}

}  // namespace

// Truth: 10 th = m g L sin(th) = 19.288 N m at th = +-1.92882, more than half a turn from the other side: whole turns begin there as they
// were on the way, and all stays at rest.
TEST(StaticStability, TheSideThatIsLeftToWindsNothing) {
  Bar c;
  const double weight = 3 * 9.80665 * 0.7, at = 1.9288157299592192;
  const auto solve = [&](const std::string& held, const std::string& time) {
    c.write("upright.toml", upright(held, time));
    succeeded(c.run("hilo-solve --quiet upright.toml -o run.h5"));
    return c.results();
  };
  const std::string torsion = spring("torsion", "k", "ground", "p", "axis = [0, 1, 0]\nstiffness = 10"),
                    bushing = spring("bushing", "k", "ground", "p", "at = [0, 0, 0]\naxis = [0, 0, 1]\nangular_stiffness = [0, 10, 0]"),
                    rest = "start = \"equilibrium\"\n";
  for (const std::string& held : {torsion, bushing}) {
    const Results r = solve(held, rest + "end = 0.1\nstep = 0.02\n");
    const auto angle = r.history("coordinate/pin").col(1);
    EXPECT_NEAR(std::abs(angle[0]), at, 1e-6) << held;
    EXPECT_NEAR(std::abs(r.history("spring/k")(0, 4)), weight * std::sin(at), 1e-4) << held;
    EXPECT_LT(r.history("energy").col(0).maxCoeff(), 1e-9) << held;
  }
  EXPECT_NEAR(std::abs(solve(torsion, rest + "analysis = \"modes\"\nmodes = 1\n").history("coordinate/pin")(0, 1)), at, 1e-6);
  const std::string stop = spring("torsion", "k", "ground", "p", "axis = [0, 1, 0]\nstiffness = 0.001") +
                           "[[stop]]\nkind = \"angle\"\nname = \"s\"\njoint = \"pin\"\nlower = -2.2\nupper = 2.2\nstiffness = 1000\n";
  for (const std::string& time : {rest + "end = 0.1\nstep = 0.02\n", std::string("analysis = \"static\"\nsteps = 4\n")}) {
    const auto angle = solve(stop, time).history("coordinate/pin").col(1);
    const double turned = std::abs(angle[angle.size() - 1]);
    EXPECT_NEAR(1000 * (turned - 2.2) + 0.001 * turned, weight * std::sin(turned), 1e-4) << time;
  }
}

// Truth: a load along a straight linkage moves nothing before it buckles, and load steps from a wound spring begin at no rest: both are
// told with what finds an answer.
TEST(StaticStability, WhatMovesNothingAndWhatIsWoundAreTold) {
  Bar c;
  const auto said = [&](const std::string& scene) {
    c.write("scene.toml", scene);
    const Ran ran = c.run("hilo-solve --quiet scene.toml -o run.h5");
    EXPECT_EQ(ran.exit, 3) << ran.err;
    return ran.err;
  };
  expect_words(said(bar(0, "analysis = \"path\"\nsteps = 20\nreach = 0.3\n")), "the load moves nothing until it buckles");
  const std::string wound =
      said("gravity = [0, 0, -9.80665]\n" + body("p", 3, {0, 0, -0.7}, {0.2, 0.3, 0.1}) +
           axial("revolute", "pin", "ground", "p", Vec3::Zero(), {0, 1, 0}) +
           spring("torsion", "k", "ground", "p", "axis = [0, 1, 0]\nstiffness = 30\nangle = 10") + in_steps(20, "", "static"));
  expect_words(wound, "time.start = \"equilibrium\"");
  EXPECT_EQ(wound.find("\"path\""), std::string::npos) << wound;
}

// Truth: the same by path, in tens of states.
TEST(LoadPath, OfABarWithASmallSideLoadArrives) {
  Bar c;
  std::string said;
  for (const char* steps : {"5", "20", "50"}) {
    EXPECT_NEAR(c.tip(bar(0.15, std::string("analysis = \"path\"\nsteps = ") + steps + "\n"), said), std::sin(leaning(0.15)), 1e-8);
    EXPECT_LT(c.results().t().size(), 200) << steps;
  }
}

namespace {

/// A steel column of 1 m x 20 mm x 20 mm, ten hexahedra of 20 nodes on end, clamped at one end.
std::string column(const std::string& force, const std::string& analysis, int steps) {
  return solid(2e11, 0.3, 7800, "bar", "kind = \"stvk\"") + held("left") + load("force", "P", "right", "force = " + force + "") +
         probe("tip", "right") + in_steps(steps, "", analysis);
}
/// How far aside the tip of a column of 1 m stands under P times Euler's load: P = (2 K(k)/pi)^2, 2 k/K(k) [timoshenko-gere-1961].
double elastica(double P) {
  double low = 0.01, high = 0.999;
  while (high - low > 1e-12) {
    const double k = (low + high) / 2;
    (std::pow(2 * std::comp_ellint_1(k) / M_PI, 2) < P ? low : high) = k;
  }
  return 2 * low / std::comp_ellint_1(low);
}
const double euler = std::pow(M_PI / 2, 2) * 2e11 * std::pow(0.02, 4) / 12;

struct Column : Case {
  Column() : Case("stability") {
    write("column.geo",
          R"(N = 10; h = 0.01; Point(1) = {0, -h, -h}; Point(2) = {0, h, -h}; Point(3) = {0, h, h}; Point(4) = {0, -h, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve {1:4} = 2; Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface {1}; Recombine Surface {1};
b[] = Extrude {1, 0, 0} {Surface{1}; Layers{N}; Recombine;};
Physical Volume("bar") = {b[1]}; Physical Surface("left") = {1}; Physical Surface("right") = {b[0]};
)");
    EXPECT_EQ(run("hilo-import --quiet column.geo --order 2 -o mesh.h5").exit, 0);
  }
  Ran solve_column(const std::string& text) {
    write("column.toml", text);
    return run("hilo-solve column.toml mesh.h5 -o run.h5");
  }
};

}  // namespace

// Truth: a perfect column loses its stability at Euler's load, told on the way of a path that goes on upright.
TEST(LoadPath, OfAPerfectColumnTellsEulersLoad) {
  Column c;
  const Ran ran = c.solve_column(column("[-10000, 0, 0]", "path", 20));
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const std::string all = ran.out + ran.err;
  const size_t at = all.find("stability is lost at ");
  ASSERT_NE(at, std::string::npos) << all;
  EXPECT_NEAR(std::stod(all.substr(at + 21)), euler / 10000, 0.01 * euler / 10000) << all;
}

// Truth: the elastica of a cantilever column: P/P_E = (2 K(k)/pi)^2 with k = sin(alpha/2) of the slope alpha of the tip, whose way aside is
// 2 k L/K(k) [timoshenko-gere-1961]; with a small side load it arrives there in tens of states.
TEST(LoadPath, OfAColumnWithASmallSideLoadArrivesInTensOfStates) {
  Column c;
  for (const char* side : {"1", "10"}) {
    const Ran ran = c.solve_column(column(std::string("[-10000, ") + side + ", 0]", "path", 20));
    ASSERT_EQ(ran.exit, 0) << ran.err;
    const auto tip = c.results().history("probe/tip");
    EXPECT_LT(tip.rows(), 100);
    EXPECT_NEAR(tip(tip.rows() - 1, 1), elastica(10000 / euler), 0.03) << "side load " << side;
  }
}

// Truth: the same elastica, by load steps: the perfect column is told and left, that with a side load follows it.
TEST(StaticStability, AColumnEndsOnTheElastica) {
  Column c;
  for (const char* side : {"0", "1", "10"}) {
    const Ran ran = c.solve_column(column(std::string("[-10000, ") + side + ", 0]", "static", 10));
    ASSERT_EQ(ran.exit, 0) << ran.err;
    const auto tip = c.results().history("probe/tip");
    EXPECT_NEAR(std::hypot(tip(tip.rows() - 1, 1), tip(tip.rows() - 1, 2)), elastica(10000 / euler), 0.03) << "side load " << side;
    if (side != std::string("1")) {  // such a mesh bends a little more easily across a
                                     // corner of its section than that holds it
      EXPECT_EQ(ran.err.find("not stable") != std::string::npos, side[0] == '0') << ran.err;
    }
  }
}

// Truth: a bar of perfect plasticity bears the yield stress times its section, a little less as it grows thinner, and then no more.
TEST(LoadPath, OfAPlasticBarTellsItsLimit) {
  Case c("stability");
  c.write("bar.geo",
          R"(h = 0.005; Point(1) = {0, -h, -h}; Point(2) = {0, h, -h}; Point(3) = {0, h, h}; Point(4) = {0, -h, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Transfinite Curve {1:4} = 2; Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface {1}; Recombine Surface {1};
b[] = Extrude {1, 0, 0} {Surface{1}; Layers{10}; Recombine;};
Physical Volume("bar") = {b[1]}; Physical Surface("left") = {1}; Physical Surface("right") = {b[0]};
)");
  c.write("bar.toml", solid(2e11, 0.0, 1.0, "bar", "kind = \"j2\"\nyield = 250e6") + held("left") +
                          body("mass", 100, {1, 0, 0}, {1, 1, 1}) + joint("fixed", "head", "right", "mass", {1, 0, 0}) +
                          axial("prismatic", "guide", "ground", "mass", {1, 0, 0}, {1, 0, 0}) + force("force", "mass", {50000, 0, 0}) +
                          probe("mass") + in_steps(20, "reach = 0.02", "path"));
  ASSERT_EQ(c.run("hilo-import --quiet bar.geo -o mesh.h5").exit, 0);
  const Ran ran = succeeded(c.run("hilo-solve bar.toml mesh.h5 -o run.h5"));
  const auto path = c.results().history("path"), mass = c.results().history("probe/mass");
  const double yields = 250e6 / 2e11, largest = 0.5 * std::exp(-yields);
  EXPECT_NEAR(path.col(0).maxCoeff(), largest, 1e-3 * largest);
  for (Eigen::Index k = 0; k < path.rows(); ++k)
    if (mass(k, 0) > 1 + 2 * yields) {
      EXPECT_NEAR(path(k, 0), 0.5, 0.05 * 0.5) << "flat: the section alone falls, by the stretch of the cells that "
                                                  "flow";
    }
  EXPECT_NE((ran.out + ran.err).find("largest load"), std::string::npos);
}

// Truth: a column is stable below Euler's load and not above, and the upright bar not above two thirds of its load.  Solvers that cannot
// count say so.
TEST(StaticStability, EverySolverTellsOrSaysThatItDoesNot) {
  Column c;
  c.write("column.toml", column("[-1, 0, 0]", "static", 4));
  c.write("bar.toml", bar(0, "analysis = \"static\"\nsteps = 2\n"));
  const auto solve = [&](int ranks, const std::string& what, bool counts, bool stable) {
    const std::string command = "hilo-solve -o run.h5 " + what;
    const Ran ran = ranks == 1 ? c.run(command) : mpirun(ranks, command, c.path());
    SCOPED_TRACE(command + "\n" + ran.err);
    const std::string json = text_of(c / "run.json");
    EXPECT_EQ(ran.exit, 0);
    EXPECT_EQ(ran.err.find("stability was not examined") == std::string::npos, counts);
    EXPECT_EQ(json.find("unstable_states") != std::string::npos, counts);
    EXPECT_EQ(ran.err.find("the equilibrium is not stable") == std::string::npos, stable || !counts);
    if (counts && stable) {
      EXPECT_NE(json.find("\"unstable_states\": 0"), std::string::npos);
    }
  };
  const auto load = [](double share) { return fmt::format(" --set 'load.P.force=[{}, 0, 0]'", -share * euler); };
  for (const int ranks : {1, 2, 3}) {
    const std::string parts = ranks == 1 ? "mesh.h5" : "parts.h5";
    if (ranks > 1) {
      ASSERT_EQ(c.run(fmt::format("hilo-part --quiet mesh.h5 -n {} -o parts.h5", ranks)).exit, 0);
    }
    solve(ranks, "column.toml " + parts + " --set solver.kind=direct" + load(0.95), true, true);
    solve(ranks, "column.toml " + parts + " --set solver.kind=bddc" + load(1.1), false, false);
    if (ranks == 2) solve(ranks, "column.toml " + parts + " --set solver.kind=direct" + load(1.5), true, false);
  }
  solve(1, "bar.toml --set solver.kind=direct", true, false);
  solve(1, "bar.toml --set solver.kind=direct --set 'load.P.force=[0, 0, -99]'", true, true);
}

// The same on ranks: rows of joints are no eigenvalues below zero, paths tell Euler's load, load steps and starts leave what is not stable.
TEST(StaticStability, IsTheSameOnRanksWithJoints) {
  Column c;
  const auto capped = [](const std::string& time) {  // its head is welded to a body that bears the load
    std::string text = column("[0, 0, 0]", "static", 4);
    text.erase(text.find("[time]"));
    return text + body("head", 1.0, {1, 0, 0}, {1e-4, 1e-4, 1e-4}) + joint("fixed", "weld", "right", "head", {1, 0, 0}) +
           force("Q", "head", {-1, 0, 0}) + "[time]\n" + time;
  };
  const auto load = [](double share) { return fmt::format(" --set 'load.Q.force=[{}, 0, 0]'", -share * euler); };
  for (const int ranks : {1, 2, 3}) {
    const std::string parts = fmt::format("parts{}.h5", ranks);
    ASSERT_EQ(c.run(fmt::format("hilo-part --quiet mesh.h5 -n {} -o {}", ranks, parts)).exit, 0);
    const auto solve = [&](const std::string& time, double share) {
      c.write("scene.toml", capped(time));
      const Ran ran = succeeded(mpirun(ranks, "hilo-solve scene.toml " + parts + " -o run.h5" + load(share), c.path()));
      return ran;
    };
    const Ran stable = solve("analysis = \"static\"\nsteps = 4\n", 0.95);
    EXPECT_NE(text_of(c / "run.json").find("\"unstable_states\": 0"), std::string::npos) << ranks << stable.err;
    for (const char* solver : {"direct", "light"}) {
      if (ranks > 1 && solver[0] == 'l') continue;
      const Ran path = solve(fmt::format("analysis = \"path\"\nsteps = 10\n[solver]\nkind = \"{}\"\n", solver), 1.3);
      const std::string all = path.out + path.err;
      const size_t at = all.find("stability is lost at ");
      ASSERT_NE(at, std::string::npos) << all;
      EXPECT_NEAR(std::stod(all.substr(at + 21)) * 1.3, 1, 0.01) << ranks << solver << all;
    }
    if (ranks > 2) continue;  // the ways to another branch take a minute there
    const Ran lost = solve("analysis = \"static\"\nsteps = 4\n", 1.3);
    EXPECT_NE(lost.err.find("the equilibrium is not stable"), std::string::npos) << ranks << lost.err;
    EXPECT_NE(lost.err.find("The run goes on from a stable one"), std::string::npos) << ranks << lost.err;
    const auto tip = c.results().history("probe/tip");
    EXPECT_NEAR(std::hypot(tip(tip.rows() - 1, 1), tip(tip.rows() - 1, 2)), elastica(1.3), 0.03) << ranks;
    for (const char* solver : {"cholesky", "umfpack"})  // a step that is tried after the look at stability is judged by its own matrix
      if (ranks == 1)
        expect_words(c.run(fmt::format("hilo-solve scene.toml {} -o run.h5{} --set solver.kind={}", parts, load(1.3), solver)).err,
                     "the equilibrium is not stable");
    const std::string start = "start = \"equilibrium\"\nend = 2e-4\nstep = 1e-4\n";
    EXPECT_EQ(solve(start, 0.95).err.find("not stable"), std::string::npos) << ranks;
    const Ran bent = solve(start, 1.3);
    EXPECT_NE(bent.err.find("the equilibrium at the start is not stable"), std::string::npos) << ranks;
    EXPECT_NE(bent.err.find("The run starts from a stable one"), std::string::npos) << ranks << bent.err;
    const auto first = c.results().history("probe/tip");
    EXPECT_NEAR(std::hypot(first(0, 1), first(0, 2)), elastica(1.3), 0.03) << ranks;
  }
}

}  // namespace hilo::test::stability_test
