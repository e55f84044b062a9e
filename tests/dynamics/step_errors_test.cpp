// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a fixed step where no second solution runs beside: what single steps add.  Truth: Bathe's method at a small step.
#include "dynamics/kept_run.hpp"
#include "dynamics/scenes.hpp"
#include "ranks.hpp"

namespace hilo::test::step_errors_test {
namespace {

/// A strip of 1 x 0.1 x 0.1 m, of n x m x m hexahedra, clamped at one end, that a force bends at the other: a period of .2 s.
std::string strip(const std::filesystem::path& folder, int n, int m, const std::string& time) {
  if (Comm::world().rank == 0) write_mesh((folder / "mesh.h5").string(), block_mesh({.n = {n, m, m}, .high = {1, 0.1, 0.1}}), {"test"});
  return "[material.m]\nkind = \"stvk\"\nE = 1e8\nnu = 0.3\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n"
         "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n"
         "[[load]]\nkind = \"force\"\nname = \"push\"\non = \"xmax\"\nforce = [0, 0, 25]\n"
         "history = {t = [0, 0.05], value = [0, 1], interpolation = \"smooth\"}\n[[probe]]\nname = \"tip\"\non = \"xmax\"\n[time]\n" +
         time;
}

struct Told {
  double error, told, share, motion;
  std::string json, err;
};

Told run_of(const Workplace& w, const std::string& options, const Results& truth, int ranks = 1) {
  const std::string command = "hilo-solve scene.toml " + std::string(ranks > 1 ? "parts.h5" : "mesh.h5") + " -o run.h5 " + options;
  const Ran ran = succeeded(ranks > 1 ? mpirun(ranks, command, w.path()) : w.run(command));
  const Results r(w / "run.h5");
  double error = 0;  // the largest: at the end it may be about to change its sign
  for (Eigen::Index i = 1; i < r.t().size(); ++i)
    error = std::max(error, (r.at("probe/tip", r.t()[i]) - truth.at("probe/tip", r.t()[i])).head(3).norm());
  return {error,
          number_of(w, "run.json", "end"),
          number_of(w, "run.json", "largest_share"),
          number_of(w, "run.json", "motion"),
          text_of(w / "run.json"),
          ran.err};
}

Results truth_of(const Workplace& w, const std::string& step) {
  succeeded(w.run("hilo-solve --quiet scene.toml mesh.h5 -o truth.h5 --set time.error_estimate='\"never\"' --set time.step=" + step + " " +
                  integrator("bathe")));
  return Results(w / "truth.h5");
}

}  // namespace

// Small enough for a second solution: both tell, at four steps, errors of the size that they have.
TEST(StepErrors, AreThoseOfTheRun) {
  const Workplace w;
  w.write("scene.toml", strip(w.path(), 6, 1, "end = 1\nstep = 0.01\n"));
  const Results truth = truth_of(w, "2.5e-4");
  for (const char* step : {"0.01", "5e-3", "2.5e-3", "1e-3"}) {
    const std::string set = std::string("--set time.step=") + step;
    const Told alone = run_of(w, set + " --set time.error_estimate='\"steps\"'", truth), beside = run_of(w, set, truth);
    EXPECT_NE(alone.json.find("\"by\": \"steps\""), std::string::npos) << alone.json;
    EXPECT_NE(beside.json.find("\"by\": \"a second solution\""), std::string::npos) << beside.json;
    fmt::print("{}: true {:.3g} m, steps {:.3g}, a second solution {:.3g}\n", step, alone.error, alone.told, beside.told);
    EXPECT_GT(alone.told / alone.error, 0.2) << step;
    EXPECT_LT(alone.told / alone.error, 6) << step;
    EXPECT_NEAR(alone.motion, beside.motion, 0.05 * beside.motion);
    EXPECT_EQ(alone.err.find("by the sum of what single steps add") != std::string::npos, alone.share > 0.05) << alone.err;
  }
}

// Above 900 unknowns, on one rank and on two: a step that loses the motion is told, and one that does not is not.
TEST(StepErrors, OfALargeSceneAreTold) {
  const Workplace w;
  w.write("scene.toml", strip(w.path(), 20, 3, "end = 0.4\nstep = 0.01\n"));
  ASSERT_EQ(w.run("hilo-part --quiet mesh.h5 -n 2 -o parts.h5").exit, 0);
  const Results truth = truth_of(w, "1e-3");
  const Told coarse = run_of(w, "--set time.step=0.02", truth), fine = run_of(w, "--set time.step=5e-3", truth);
  fmt::print("true {:.3g} and {:.3g} m, told {:.3g} and {:.3g} m\n", coarse.error, fine.error, coarse.told, fine.told);
  EXPECT_GT(coarse.error, 0.05 * coarse.motion);
  EXPECT_NE(coarse.err.find("positions are off by about"), std::string::npos) << coarse.err;
  EXPECT_LT(fine.error, 0.02 * fine.motion);
  EXPECT_EQ(fine.err.find("positions are off by about"), std::string::npos) << fine.err;
  EXPECT_GT(fine.told / fine.error, 0.2);
  EXPECT_LT(fine.told / fine.error, 6);
  const Told ranks = run_of(w, "--set time.step=0.02", truth, 2);
  EXPECT_NEAR(ranks.told, coarse.told, 1e-3 * coarse.told);
  EXPECT_NE(ranks.err.find("positions are off by about"), std::string::npos) << ranks.err;
}

// A bar of steel that turns, whose vibrations no step resolves: they are small, and are not added up step by step.
TEST(StepErrors, AreNotThoseOfVibrationsThatStayAsSmallAsTheyAre) {
  const Workplace w;
  const BlockOptions o{.n = {24, 3, 3}, .high = {1, 0.1, 0.1}};
  write_mesh(w / "mesh.h5", block_mesh(o), {"test"});
  w.write("scene.toml",
          "[material.m]\nkind = \"stvk\"\nE = 2e11\nnu = 0.3\ndensity = 7800\n[region.block]\nmaterial = \"m\"\n"
          "[[initial]]\non = [\"block\"]\nvelocity = [0, 0, 1]\nspin = [0, 0.5, 0]\nabout = [0.5, 0.05, 0.05]\n"
          "[[load]]\nkind = \"force\"\nname = \"knock\"\non = \"xmax\"\nforce = [2e5, 0, 0]\n"
          "history = {t = [0, 2e-3, 2e-3, 1], value = [1, 1, 0, 0]}\n"
          "[[probe]]\nname = \"tip\"\non = \"xmax\"\n[time]\nend = 2\nstep = 2e-3\n");
  const Ran ran = succeeded(w.run("hilo-solve scene.toml mesh.h5 -o run.h5"));
  EXPECT_LT(number_of(w, "run.json", "largest_share"), 0.01) << text_of(w / "run.json");
  EXPECT_EQ(ran.err.find("positions are off"), std::string::npos) << ran.err;
}

/// A mass on a spring, from the middle at 1 m/s: (v/w) sin(w t), w of 10 rad/s.
const std::string mass_on_a_spring =
    body("mass", 1, Vec3::Zero(), {1, 1, 1}) + spring("bushing", "spring", "ground", "mass", "at = [0, 0, 0]\nstiffness = [100, 0, 0]") +
    initial("mass", "velocity = [1, 0, 0]") + probe("mass") + in_time(3, 0.01, "error_estimate = \"steps\"");

double error_of_the_mass(const Workplace& w) {
  const Results r(w / "run.h5");
  double error = 0;
  for (Eigen::Index i = 1; i < r.t().size(); ++i)
    error = std::max(error, std::abs(r.at("probe/mass", r.t()[i])[0] - 0.1 * std::sin(10 * r.t()[i])));
  return error;
}

// Truth: the closed form, by every method at its own phase error.  The mean of |cos| makes the sum 2/pi of the largest.
TEST(StepErrors, AreThoseOfTheMethod) {
  const Workplace w;
  w.write("scene.toml", mass_on_a_spring);
  for (const std::string method :
       {"\"energy-momentum\"", "\"mid-point\"", "\"newmark\"", "\"newmark\" --set time.beta=0.5",
        "\"generalized-alpha\" --set time.rho=0.8", "\"generalized-alpha\" --set time.rho=0", "\"hht\" --set time.rho=0.5",
        "\"wbz\" --set time.rho=0", "\"U0\" --set time.rho=0.5", "\"U0\" --set time.rho=0 --set time.rho3=1", "\"V0\" --set time.rho=0.5",
        "\"V0\" --set time.rho=0 --set time.averaged=false", "\"bathe\"", "\"bdf2\""}) {
    const std::string quoted = "'" + method.substr(0, method.find('"', 1) + 1) + "'" + method.substr(method.find('"', 1) + 1);
    succeeded(w.run("hilo-solve scene.toml -o run.h5 --set time.integrator=" + quoted), method);
    const double error = error_of_the_mass(w), told = number_of(w, "run.json", "end");
    fmt::print("{}: true {:.3g} m, told {:.3g} m\n", method, error, told);
    EXPECT_GT(told, 0.5 * error) << method;
    EXPECT_LT(told, error) << method;
  }
}

// Where a period is 2 to 64 steps, differences over as many steps see nothing: no stride may hide a motion from the others.
TEST(StepErrors, AreSeenWhereAPeriodIsAStride) {
  const Workplace w;
  w.write("scene.toml", mass_on_a_spring);
  for (const double steps : {2., 2.05, 4., 7.9, 8., 16., 30., 32., 33., 64.}) {
    const double h = M_PI / 5 / steps;
    succeeded(w.run(fmt::format("hilo-solve scene.toml -o run.h5 --set time.step={} --set time.end={}", h, 300 * h)));
    const double error = error_of_the_mass(w), told = number_of(w, "run.json", "end");
    fmt::print("a period of {} steps: true {:.3g} m, told {:.3g} m\n", steps, error, told);
    EXPECT_GT(told, 0.1 * error) << steps;
    EXPECT_LT(told, 3 * error) << steps;
  }
}

TEST(StepErrors, OfOtherOrdersAreNotTold) {
  const Workplace w;
  for (const char* method : {"radau", "newmark"}) {
    w.write("scene.toml", strip(w.path(), 2, 1,
                                fmt::format("end = 0.1\nstep = 0.005\nintegrator = \"{}\"\nerror_estimate = \"steps\"\n{}", method,
                                            method[0] == 'n' ? "gamma = 0.6\n" : "")));
    succeeded(w.run("hilo-solve scene.toml mesh.h5 -o run.h5"));
    EXPECT_NE(
        text_of(w / "run.json").find("\"why_not\": \"steps alone tell the error of methods of second order, not of " + std::string(method)),
        std::string::npos)
        << method;
  }
}

TEST(StepErrors, GoOnWithTheRun) {
  const Folder folder;
  quiet_warnings(true);
  expect_goes_on(folder.path(), strip(folder.path(), 4, 1, "end = 0.2\nstep = 0.005\nerror_estimate = \"steps\"\n"), "mesh.h5",
                 {1, 4, 13, 27});
  quiet_warnings(false);
  expect_passes_on(2, "StepErrorsOnRanks", folder.path().string());
}
TEST(DISABLED_StepErrorsOnRanks, GoOnWithTheRun) {
  expect_goes_on(".", strip(".", 4, 1, "end = 0.2\nstep = 0.005\nerror_estimate = \"steps\"\n"), "mesh.h5", {4, 13, 27});
}

}  // namespace hilo::test::step_errors_test
