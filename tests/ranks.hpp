// SPDX-License-Identifier: GPL-3.0-or-later
// Tests that run on several ranks: a test starts its own executable under mpirun, with a filter for the suite that holds there.
// Such suites are called DISABLED_..., so that they do not run by themselves.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "base/comm.hpp"
#include "cli.hpp"

namespace hilo::test {

/// Every test of `suite` of this executable passes on `ranks` ranks (1: without mpirun), in `folder`.
inline void expect_passes_on(int ranks, const std::string& suite, const std::string& folder = ".") {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  // what MPI has put into this process' environment would confuse its children
  const std::string clean = "unset $(compgen -e | grep -E '^(OMPI|OPAL|ORTE|PMIX|PRTE)_') HILO_NOTHING\n";
  const std::string launcher = for_ranks + "timeout 300 mpirun -n " + std::to_string(ranks) + " ";
  const Ran ran = run(clean + (ranks == 1 ? "timeout 300 " : launcher) + "'" + self +
                          "' --gtest_also_run_disabled_tests --gtest_filter='*DISABLED_" + suite + ".*'",
                      folder);
  std::string said = ran.out + ran.err;  // ctest would take a failure that shows this word for a test left out
  for (size_t at = 0; (at = said.find("SKIPPED", at)) != said.npos;) said.replace(at, 7, "left out");
  EXPECT_EQ(ran.exit, 0) << suite << " on " << ranks << " ranks:\n" << said;
  EXPECT_NE(ran.out.find("[  PASSED  ]"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.out.find("Running 0 tests"), std::string::npos) << "no suite " << suite;
}

/// Starts MPI before the first test and ends it after the last, as a main would.
class MpiOfTests : public testing::Environment {
  void SetUp() override { Comm::world(); }
  void TearDown() override { Comm::world().finish(); }
};
inline testing::Environment* const mpi_of_tests = testing::AddGlobalTestEnvironment(new MpiOfTests);

}  // namespace hilo::test
