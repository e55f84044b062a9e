// SPDX-License-Identifier: GPL-3.0-or-later
// Ranks do not wait for ever: who works alone cannot call the others, and ranks that wait in different places end the run and say where.
#include "base/comm.hpp"

#include <chrono>
#include <ctime>
#include <thread>

#include "base/crowd.hpp"
#include "base/error.hpp"
#include "base/printable.hpp"
#include "base/watch.hpp"
#include "ranks.hpp"
#include "succeeded.hpp"

namespace hilo::test {
namespace {
namespace fs = std::filesystem;

/// Every call that all ranks make, within what one rank does alone, is an Error that names this file; the ranks go on.
void expect_no_calls_alone() {
  const Comm& comm = Comm::world();
  double x[2] = {1, 2};
  const std::vector<std::function<void()>> calls{[&] { comm.sum(x); },
                                                 [&] { comm.sum(1.0); },
                                                 [&] { comm.sum(std::int64_t{1}); },
                                                 [&] { comm.max(x); },
                                                 [&] { comm.max(1.0); },
                                                 [&] { comm.before(1); },
                                                 [&] { comm.copy(x, 0); },
                                                 [&] { comm.gather(std::vector{1}); },
                                                 [&] { comm.of_first(std::vector{1}); },
                                                 [&] { comm.to_first(std::vector{1}); },
                                                 [&] { comm.barrier(); },
                                                 [&] { comm.exchange(std::vector<std::vector<double>>(comm.size)); }};
  for (const auto& call : calls) {
    std::string said;
    try {
      comm.on_first(call);
    } catch (const Error& e) {
      said = e.message;
      EXPECT_EQ(e.exit, Exit::fault);
    }
    EXPECT_NE(said.find("comm_test.cpp:"), said.npos) << said;
  }
  EXPECT_EQ(comm.sum(1.0), comm.size);
  int ran = 0;
  comm.on_first([&] { ++ran; });
  EXPECT_EQ(ran, comm.rank == 0);
}

TEST(Comm, WhoWorksAloneCannotCallTheOthers) {
  expect_no_calls_alone();
  Comm::alone().barrier();
  expect_passes_on(2, "CommOnRanks");
}
TEST(DISABLED_CommOnRanks, Alone) { expect_no_calls_alone(); }

// Suites that end in a fault, as they should.
TEST(DISABLED_WaitForEachOther, InTwoPlaces) {
  Watch::patience = 1;
  const Comm& comm = Comm::world();
  if (comm.rank == 0)
    comm.sum(1.0);
  else
    comm.barrier();
}
TEST(DISABLED_WaitForOne, ThatWorks) {
  Watch::patience = 1;
  const Comm& comm = Comm::world();
  if (comm.rank == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  comm.barrier();
}

// The first of two ranks on one core works, and the other one takes no time from it.
TEST(DISABLED_TwoRanks, ShareOneCore) {
  const Comm& comm = Comm::world();
  const Crowd here = crowd(comm);
  EXPECT_EQ(here.ranks, 2);
  EXPECT_EQ(here.cores, 1);
  const auto took = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double before = took();
  const auto began = std::chrono::steady_clock::now();
  if (comm.rank == 0)
    while (took() < before + 1) {
    }
  comm.barrier();
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - began;
  if (comm.rank == 1) {
    EXPECT_LT((took() - before) / all.count(), 0.2);  // one that asks without end takes half, or a third beside one more process
  }
}

Ran run_on(int ranks, const std::string& suite, const std::string& under = "") {
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  return run("unset $(compgen -e | grep -E '^(OMPI|OPAL|ORTE|PMIX|PRTE)_') HILO_NOTHING\n" + for_ranks + "timeout 120 " + under +
                 "mpirun -n " + std::to_string(ranks) + " '" + self + "' --gtest_also_run_disabled_tests --gtest_filter='*DISABLED_" +
                 suite + "'",
             ".");
}

TEST(Comm, RanksThatWaitInDifferentPlacesEndAndSayWhere) {
  const Ran ran = run_on(3, "WaitForEachOther.*");
  EXPECT_EQ(ran.exit, static_cast<int>(Exit::fault)) << ran.err;
  const auto at = ran.err.find("ranks wait for each other for ever: rank 0 waits at ");
  ASSERT_NE(at, ran.err.npos) << ran.err;
  EXPECT_NE(ran.err.find("rank 2 waits at ", at), ran.err.npos) << ran.err;
  EXPECT_NE(ran.err.find("comm_test.cpp:", at), ran.err.npos) << ran.err;
}

TEST(Comm, RanksThatWaitLeaveTheirCoreToThoseThatWork) {
  const Ran ran = run_on(2, "TwoRanks.*", "taskset -c $(taskset -cp $$ | grep -oE '[0-9]+' | sed -n 2p) ");
  EXPECT_EQ(ran.exit, 0) << ran.out << ran.err;
}

TEST(Comm, ARankThatWaitsLongSaysWhere) { expect_end(run_on(2, "WaitForOne.*"), 0, "rank 0 works, rank 1 waits at "); }

// All ranks or one: whoever needs others is handed them, so that nothing reaches the parallel way unseen.  What reads results and scenes
// has no way to them.
TEST(Comm, OnlyMainsAskForAllRanks) {
  const fs::path root = HILO_SOURCE;
  for (const char* folder : {"solver", "tools", "post"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string name = fs::relative(entry.path(), root).string();
      std::ifstream file(entry.path());
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      const bool may = name == "solver/base/comm.cpp" || name == "solver/base/on_ranks.cpp" || name == "solver/linear/petsc/session.hpp";
      EXPECT_TRUE(may || text.find("Comm::world") == text.npos) << name;
      EXPECT_TRUE(name.rfind("solver", 0) == 0 || text.find("base/comm.hpp") == text.npos) << name;
    }
}

TEST(Printable, WritesOutWhatCannotBeSeen) {
  EXPECT_EQ(printable("plain, d\xC3\xA9j\xC3\xA0 \xE6\xBC\xA2 \xF0\x9F\x9A\x80\n"),
            "plain, d\xC3\xA9j\xC3\xA0 \xE6\xBC\xA2 \xF0\x9F\x9A\x80\n");
  EXPECT_EQ(printable("a\x07"
                      "b\x1B[31m\x7F"),
            "a\\u0007b\\u001B[31m\\u007F");
  EXPECT_EQ(printable("a\xE2\x80\xAE"
                      "b\xC2\x9B"),
            "a\\u202Eb\\u009B");
  EXPECT_EQ(printable("\xFF\xE2\x80"), "\xFF\xE2\x80");
}

}  // namespace
}  // namespace hilo::test
