// SPDX-License-Identifier: GPL-3.0-or-later
// A library that crashes on a file: one line that quotes the library's last error, and exit code 2.  A process that dies stands for it.
#include "import/crash_guard.hpp"

#include <gmsh.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "../cli.hpp"
#include "import/gmsh/session.hpp"

namespace hilo::test::crash_guard_test {
namespace {

const testing::ExitedWithCode bad_input(2);
constexpr const char* without_error = "a\\.step: gmsh crashed on it \\(is the file damaged\\?\\)\n$";

TEST(CrashGuardDeathTest, ACrashQuotesTheLastErrorOfTheLibrary) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE})
    for (const bool silent : {false, true})
      EXPECT_EXIT(
          {
            const CrashGuard guard("a.step", "gmsh", silent);
            std::fputs("Error   : no such face\nInfo    : on it goes\nError   : Could not fix wire in face 7\nErrors are bad\n", stderr);
            std::raise(signal);
          },
          bad_input, "^[^\n]*a\\.step: gmsh crashed on it \\(its last error: Could not fix wire in face 7; is the file damaged\\?\\)\n$");
}

TEST(CrashGuardDeathTest, ACrashWithoutAnErrorSaysSoAlone) {
  EXPECT_EXIT(
      {
        const CrashGuard guard("a.step", "gmsh");
        std::fputs("Info    : fine\nError   :\n", stderr);
        std::abort();
      },
      bad_input, without_error);
  EXPECT_EXIT(
      {
        {
          const CrashGuard before("b.step", "gmsh");
          std::fputs("Error   : of b\n", stderr);
        }
        const CrashGuard guard("a.step", "gmsh");
        std::raise(SIGSEGV);
      },
      bad_input, without_error);
}

// gmsh itself says the error, in its own format.
TEST(CrashGuardDeathTest, ErrorsOfGmshAreHeard) {
  const Workplace place;
  place.write("a.geo", "Error(\"a wire of %g edges is open\", 3);\n");
  EXPECT_EXIT(
      {
        const CrashGuard guard("a.step", "gmsh");
        const GmshSession session({});
        try {
          gmsh::merge(place / "a.geo");
        } catch (...) {  // the error is thrown as well
        }
        std::raise(SIGSEGV);
      },
      bad_input, "gmsh crashed on it \\(its last error: .*a wire of 3 edges is open.*; is the file damaged\\?\\)\n$");
}

TEST(CrashGuardDeathTest, WithoutACrashTheRestIsHeardUnlessItIsSilent) {
  for (const bool silent : {false, true})
    EXPECT_EXIT(
        {
          {
            const CrashGuard guard("a.step", "gmsh", silent);
            std::fputs("Error   : that the library reports too\nheard\n", stderr);
          }
          std::fputs("after\n", stderr);
          std::fflush(stderr);
          _exit(0);
        },
        testing::ExitedWithCode(0), testing::Eq(std::string(silent ? "after\n" : "heard\nafter\n")));
}

}  // namespace
}  // namespace hilo::test::crash_guard_test
