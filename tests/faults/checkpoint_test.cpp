// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that are stopped from outside say how to go on, and go on to the same numbers; what does not belong together is refused.
#include "faults.hpp"
#include "model/store.hpp"
#include "scene_parts.hpp"

using namespace hilo::test;

namespace {

constexpr int usage = 1, input = 2, resources = 4, stopped = 6;

/// A pendulum that takes a while.
const std::string pendulum = "gravity = [0, 0, -9.81]\n" + body("arm", 2, {0.3, 0, 0}, {0.01, 0.05, 0.05}) +
                             axial("revolute", "pin", "ground", "arm", {0, 0, 0}, {0, 1, 0}) + in_time(1000, 1e-3) +
                             "[output]\ninterval = 1\n";

class Stopped : public testing::Test {
 protected:
  Workplace work;
  void SetUp() override { work.write("scene.toml", pendulum); }
  /// One line that says how to go on; the results are sound.
  void expect_stopped(const Ran& o, const std::string& by, const std::string& file = "run.h5") const {
    EXPECT_EQ(o.exit, stopped) << o.err;
    EXPECT_NE(o.err.find("stopped by " + by + " at t = "), o.err.npos) << o.err;
    EXPECT_NE(o.err.find("(go on with: hilo-solve --restart " + file + ")"), o.err.npos) << o.err;
    const auto checked = work.run("hilo-show --check " + file);
    EXPECT_EQ(checked.exit, 0) << checked.err;
    EXPECT_NE(checked.out.find("incomplete, sound up to"), checked.out.npos) << checked.out;
  }
  void refused(const std::string& command, int exit, const std::string& message) const {
    const auto o = work.run(command);
    EXPECT_EQ(o.exit, exit) << command;
    EXPECT_EQ(o.err, "hilo-solve: " + message + "\n") << command;
  }
};

const std::string in_background =
    "hilo-solve scene.toml --quiet & p=$!; for k in $(seq 100); do [ -e run.h5 ] && break; sleep 0.05; done; ";

}  // namespace

TEST_F(Stopped, BySignals) {
  for (const char* signal : {"TERM", "INT", "HUP", "USR1"}) {
    SCOPED_TRACE(signal);
    // a shell starts what runs in the background with SIGINT ignored, as nohup does with SIGHUP
    const auto o = work.run(
        "/usr/bin/python3 -c 'import signal, os, sys; signal.signal(signal.SIGINT, signal.SIG_DFL); os.execvp(sys.argv[1], "
        "sys.argv[1:])' hilo-solve scene.toml --quiet & p=$!; rm -f run.h5; for k in $(seq 100); do [ -e run.h5 ] && break; "
        "sleep 0.05; done; sleep 0.1; kill -" +
        std::string(signal) + " $p; wait $p");
    expect_stopped(o, "SIG" + std::string(signal));
  }
}

TEST_F(Stopped, ByOneSignalThatComesThreeTimes) {  // `timeout` and mpirun signal a process, and then its group
  const auto o = work.run(in_background + "sleep 0.1; kill -TERM $p; kill -TERM $p; kill -INT $p; kill -TERM $p; wait $p");
  expect_stopped(o, "SIGTERM");
}

TEST_F(Stopped, ByAFileBesideTheResults) {
  const auto o = work.run(in_background + "touch STOP; wait $p");
  expect_stopped(o, "the file STOP");
  EXPECT_FALSE(std::filesystem::exists(work.path() / "STOP")) << "it would end the next run";
  work.write("STOP", "");
  refused("hilo-solve scene.toml --quiet", usage, "STOP: this file ends a run, and it is there before the run begins (remove it)");
}

TEST_F(Stopped, InTime) {
  expect_stopped(work.run("timeout 60 hilo-solve scene.toml --quiet --time-limit 2s"), "--time-limit");
  refused("hilo-solve scene.toml --time-limit soon", usage, "--time-limit soon is no time (write 90s, 20m, 3h50m, 1d or 2:30:00)");
  refused("hilo-solve scene.toml --checkpoint -3", usage, "--checkpoint -3 is no time (write 90s, 20m, 3h50m, 1d or 2:30:00)");
}

TEST_F(Stopped, OnTwoRanksBySigusr1) {
  const auto o = mpirun(2,
                        "hilo-solve scene.toml --quiet & p=$!; for k in $(seq 200); do [ -e run.h5 ] && break; sleep 0.05; done; sleep "
                        "0.1; kill -USR1 $p; wait $p",
                        work.path());
  expect_stopped(o, "SIGUSR1");
  const auto later = work.run("hilo-solve --restart run.h5 --quiet --set time.end=2000 --time-limit 2s");
  expect_stopped(later, "--time-limit");
}

TEST_F(Stopped, GoesOnToTheSameNumbersAndToALaterEnd) {
  const std::string run = "hilo-solve scene.toml --quiet --set time.end=0.5 --set output.interval=0.1 ";
  ASSERT_EQ(work.run(run + "-o whole.h5 --checkpoint 100steps").exit, 0);
  ASSERT_EQ(work.run(run + "--checkpoint 100steps").exit, 0);  // kept at the end
  const auto rows = [&](const std::string& file) { return hilo::Store::open(work / file).read<double>("/history/joint/pin"); };
  const std::vector<double> whole = rows("whole.h5");
  ASSERT_EQ(whole.size(), 6 * 501u);
  // from the last checkpoint but one, as if the rest had been lost
  ASSERT_EQ(work.run("mv run.checkpoint-1.h5 run.checkpoint.h5; hilo-solve --restart run.h5 --quiet --checkpoint 100steps").exit, 0);
  EXPECT_EQ(rows("run.h5"), whole);
  // a later end
  ASSERT_EQ(work.run("hilo-solve --restart run.h5 --quiet --set time.end=1 --checkpoint 100steps").exit, 0);
  ASSERT_EQ(work.run("hilo-solve scene.toml --quiet --set time.end=1 --set output.interval=0.1 -o long.h5 --checkpoint 100steps").exit, 0);
  const std::vector<double> one = rows("run.h5"), other = rows("long.h5");
  ASSERT_EQ(one.size(), other.size());
  for (size_t i = 0; i < one.size(); ++i) ASSERT_NEAR(one[i], other[i], 3e-9) << "value " << i << ": the old end was a step like any other";
  EXPECT_NE(work.run("hilo-show run.h5").out.find("--set time.end=1"), std::string::npos) << "provenance of all of it";
  EXPECT_NE(work.run("hilo-show run.h5").out.find("--set time.end=0.5"), std::string::npos);
}

/// As a script does that goes on until a run is done; by default no checkpoint stays.
TEST_F(Stopped, ACompleteRunHasNothingLeftToDo) {
  ASSERT_EQ(work.run("hilo-solve scene.toml --quiet --set time.end=0.1").exit, 0);
  const std::string before = text_of(work / "run.h5");
  for (const char* how : {"", "scene.toml --set time.end=0.1"}) {
    const auto o = work.run(std::string("hilo-solve --restart run.h5 ") + how);
    EXPECT_EQ(o.exit, 0) << o.err;
    EXPECT_NE(o.err.find("run.h5 is complete: nothing is left to do"), o.err.npos) << o.err;
  }
  EXPECT_EQ(text_of(work / "run.h5"), before);
  refused("hilo-solve --restart run.h5 --set time.end=0.2", input,
          "run.h5: no checkpoint lies beside it (run.checkpoint.h5 is not there; see --checkpoint)");
}

/// A second pass makes its results anew, and its checkpoints.
TEST_F(Stopped, PassesOfAToleranceKeepTheirOwnCheckpoints) {
  const std::string solve = "hilo-solve scene.toml --set time.end=3 --set time.tolerance=1e-5 ";
  const auto rows = [&](const std::string& file) { return hilo::Store::open(work / file).read<double>("/history/joint/pin"); };
  const auto kept = work.run(solve + "--checkpoint 100steps");
  EXPECT_EQ(kept.exit, 0) << kept.err;
  EXPECT_NE(kept.err.find("once more"), kept.err.npos) << kept.err;
  const std::vector<double> whole = rows("run.h5");
  ASSERT_EQ(work.run("mv run.checkpoint-1.h5 run.checkpoint.h5; hilo-solve --restart run.h5 --quiet --checkpoint 100steps").exit, 0);
  EXPECT_EQ(rows("run.h5"), whole);
}

// The preconditioner of cg is made again after each checkpoint, so this run's last digits show where its checkpoints were.
TEST_F(Stopped, WithoutTheOptionCheckpointsGoOnAsTheRunHadThem) {
  work.write("deck.inp", deck);
  work.write("scene.toml", R"(gravity = [0.5, 0, -9.81]
[material.soft]
E = 1e6
nu = 0.3
density = 1000
[region."*"]
material = "soft"
[[motion]]
kind = "fixed"
name = "held"
on = "top"
[time]
end = 1
step = 1e-3
[solver]
kind = "cg"
[output]
interval = 0.5
)");
  succeeded(work.run("hilo-import deck.inp -o mesh.h5 && hilo-tag mesh.h5 --nonlinear hull --nonlinear mast -o tags.h5"));
  const std::string run = "hilo-solve scene.toml tags.h5 --quiet ";
  succeeded(work.run(run + "-o whole.h5 --checkpoint 150steps"));
  succeeded(work.run(run + "-o none.h5 --checkpoint none"));
  // a crash: no checkpoint at the stop, as after kill -9
  const auto killed = work.run(
      run +
      "--checkpoint 150steps & p=$!; for k in $(seq 3000); do [ -e run.checkpoint-1.h5 ] && [ -e run.checkpoint.h5 ] && break; sleep 0.01; "
      "done; kill -9 $p; wait $p; [ $? = 137 ]");
  ASSERT_EQ(killed.exit, 0) << "the run ended before it was killed\n" << killed.err;
  const auto all = [&](const std::string& file) {
    std::map<std::string, std::vector<double>> found;
    const hilo::Store store = hilo::Store::open(work / file);
    for (const char* name : {"/history/t", "/history/energy", "/history/momentum", "/history/motion/held"})
      found[name] = store.read<double>(name);
    for (const std::string& step : store.list("/field")) found[step] = store.read<double>("/field/" + step + "/displacement");
    return found;
  };
  const auto whole = all("whole.h5");
  ASSERT_EQ(whole.at("/history/t").size(), 1001u);
  ASSERT_NE(all("none.h5"), whole) << "the scene does not show where checkpoints are";
  // on from the crash without the option, then without the last checkpoint and with another one
  const std::string kept = "for k in '' -1; do cp run.checkpoint$k.h5 kept$k.h5; done; cp run.h5 kept-run.h5; ";
  succeeded(work.run(kept + "hilo-solve --restart run.h5 --quiet"));
  EXPECT_EQ(all("run.h5"), whole);
  for (const char* which : {".checkpoint", ".checkpoint-1"})
    EXPECT_EQ(hilo::Store::open(work / ("run" + std::string(which) + ".h5")).number_attribute("/", "t"),
              hilo::Store::open(work / ("whole" + std::string(which) + ".h5")).number_attribute("/", "t"));
  succeeded(
      work.run("for k in '' -1; do cp kept$k.h5 run.checkpoint$k.h5; done; cp kept-run.h5 run.h5; hilo-solve --restart run.h5 --quiet "
               "--checkpoint none"));
  EXPECT_NE(all("run.h5"), whole) << "--checkpoint none was given, and is not what the run had";
}

TEST_F(Stopped, WhatDiffersIsRefusedByTheKey) {
  ASSERT_EQ(work.run("hilo-solve scene.toml --quiet --set time.end=0.5 --checkpoint 100steps").exit, 0);
  const std::string go_on = "hilo-solve --restart run.h5 --quiet ";
  const std::string accept = " (--accept goes on all the same)";
  const std::string where = (std::filesystem::canonical(work.path()) / "scene.toml").string() + ": ";
  refused(go_on + "--set body.arm.mass=3", input, where + "body.arm.mass is 3, and was 2 when the run was kept" + accept);
  refused(go_on + "--set time.end=0.3", input, where + "time.end is 0.3, before the checkpoint at t = 0.5 s" + accept);
  refused(go_on + "--set solver.tolerance=1e-14", input, where + "solver.tolerance is 1e-14, and was 1e-10 when the run was kept" + accept);
  refused(go_on + "--set time.step=2e-3", input, where + "time.step is 0.002, and was 0.001 when the run was kept" + accept);
  refused(go_on + "-o other.h5", usage,
          "--restart goes on in the results it names, so there is no -o (copy run.h5 and its checkpoints first)");
  refused("hilo-solve --restart absent.h5", input,
          "absent.h5: no checkpoint lies beside it (absent.checkpoint.h5 is not there; see --checkpoint)");
  EXPECT_EQ(work.run(go_on + "--set time.step=2e-3 --accept --set time.end=0.6 --checkpoint 100steps").exit, 0);
  work.write("scene.toml", std::string(pendulum) + "[[sensor]]\nname = \"s\"\non = \"arm\"\n");
  for (const char* how : {"", "--accept"}) {
    const auto o = work.run(go_on + how);
    EXPECT_EQ(o.exit, input);
    EXPECT_NE(o.err.find("sensor."), o.err.npos) << o.err;
  }
  work.write("scene.toml", pendulum);
  for (const char* other : {"time.error_estimate=\"never\"", "time.integrator=\"bdf2\"", "output.precision=\"single\""})
    for (const char* how : {"--accept ", ""})
      expect_end(work.run(go_on + how + "--set time.end=0.7 --set '" + other + "'"), input,
                 "which does not fit it (run the scene from its start)");
}

TEST_F(Stopped, ADamagedCheckpointIsPassedOverForTheOneBefore) {
  ASSERT_EQ(work.run("hilo-solve scene.toml --quiet --set time.end=0.5 --checkpoint 100steps").exit, 0);
  const std::string whole = text_of(work.path() / "run.checkpoint.h5");
  for (const size_t cut : {whole.size() / 2, whole.size() - 1000}) {
    work.write("run.checkpoint.h5", whole.substr(0, cut));
    const auto o = work.run("hilo-solve --restart run.h5 --checkpoint 100steps");
    expect_end(o, 0, "the one before it is taken");
    EXPECT_NE(o.err.find("goes on from t = 0.4 s"), o.err.npos) << o.err;
  }
}

TEST_F(Stopped, TwoRunsDoNotWriteOneFile) {
  const auto o = work.run(in_background + "hilo-solve scene.toml --quiet --set time.end=1; code=$?; kill -TERM $p; wait $p; exit $code");
  EXPECT_EQ(o.exit, resources) << o.err;
  EXPECT_NE(
      o.err.find("run.h5: another program has it open (wait until the run that writes it ends, close what reads it, or give another -o)"),
      o.err.npos)
      << o.err;
}
