// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/args.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"

namespace hilo {
namespace {

/// A tool with an option, a subcommand and its option.
struct Tool {
  Tool() : app(make_app({"hilo-saw", "Saws meshes.", "hilo-saw cut log.h5\nhilo-saw --blade 3 cut log.h5"})) {
    app->add_option("-b,--blade", blade, "number of the blade");
    app->require_subcommand(1);
    auto* cut = app->add_subcommand("cut", "Cut it.");
    cut->add_option("log", log, "what is cut")->required();
    cut->add_option("--depth", depth, "how deep [m]");
    example(*cut, "hilo-saw cut log.h5 --depth 0.1");
  }
  bool operator()(std::vector<const char*> words) {
    words.insert(words.begin(), "hilo-saw");
    return parse(*app, static_cast<int>(words.size()), words.data());
  }
  Error error(const std::vector<const char*>& words) {
    try {
      (*this)(words);
    } catch (const Error& e) {
      return e;
    }
    ADD_FAILURE() << "no Error was thrown";
    return Error("", "");
  }
  std::string printed(const std::vector<const char*>& words) {
    testing::internal::CaptureStdout();
    EXPECT_FALSE((*this)(words));
    std::fflush(stdout);
    return testing::internal::GetCapturedStdout();
  }
  int blade = 0;
  double depth = 0;
  std::string log;
  std::unique_ptr<CLI::App> app;
};

TEST(Args, NumbersMayBeNegativeAndOptionsMayFollowTheSubcommand) {
  Tool tool;
  EXPECT_TRUE(tool({"cut", "log.h5", "--depth", "-0.5", "--blade", "7"}));
  EXPECT_EQ(tool.depth, -0.5);
  EXPECT_EQ(tool.blade, 7);
  EXPECT_EQ(tool.log, "log.h5");
}

TEST(Args, NumbersAreFinite) {
  for (const char* depth : {"nan", "-inf", "1e400"})
    EXPECT_EQ(Tool().error({"cut", "log.h5", "--depth", depth}).what(),
              fmt::format("--depth: {} is not a finite number (see hilo-saw --help)", depth));
}

TEST(Args, MistypedWordsAreUsageErrorsWithTheNearestName) {
  EXPECT_STREQ(Tool().error({"cut", "log.h5", "--dephth", "3"}).what(), "unknown option --dephth (did you mean \"--depth\"?)");
  EXPECT_STREQ(Tool().error({"cut", "log.h5", "--baled=3"}).what(), "unknown option --baled (did you mean \"--blade\"?)");
  EXPECT_STREQ(Tool().error({"cutt", "log.h5"}).what(), "unknown command cutt (did you mean \"cut\"?)");
  EXPECT_STREQ(Tool().error({"cut", "log.h5", "more"}).what(), "unexpected argument more (see hilo-saw --help)");
  for (const auto& words : std::vector<std::vector<const char*>>{{}, {"cut"}, {"cut", "log.h5", "--depth", "deep"}, {"--xyz"}}) {
    const Error e = Tool().error(words);
    EXPECT_EQ(e.exit, Exit::usage);
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
  }
}

TEST(Args, HelpEndsWithTheExampleOfTheCommandAsked) {
  const std::string top = Tool().printed({"--help"}), cut = Tool().printed({"cut", "--help"});
  EXPECT_TRUE(top.ends_with("Example:\n  hilo-saw cut log.h5\n  hilo-saw --blade 3 cut log.h5\n")) << top;
  EXPECT_TRUE(cut.ends_with("Example:\n  hilo-saw cut log.h5 --depth 0.1\n")) << cut;
  EXPECT_NE(top.find("Exit codes: 0 done, 1 usage, 2 bad input"), std::string::npos);
}

TEST(Args, VersionNamesToolAndVersion) { EXPECT_EQ(Tool().printed({"--version"}), "hilo-saw " + version() + "\n"); }

TEST(Args, QuietSilencesWarnings) {
  Tool tool;
  EXPECT_TRUE(tool({"cut", "log.h5", "--quiet"}));
  EXPECT_TRUE(is_quiet());
  testing::internal::CaptureStderr();
  warn("here", "something");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  quiet_warnings(false);
}

TEST(Args, ManPageHasEveryOptionOfEveryCommand) {
  const std::string page = Tool().printed({"--man"});
  for (const char* text : {".TH HILO-SAW 1", "\\-b, \\-\\-blade", "number of the blade", ".SH COMMAND cut", "\\-\\-depth",
                           "hilo\\-saw cut log.h5 \\-\\-depth 0.1"})
    EXPECT_NE(page.find(text), std::string::npos) << text << "\n" << page;
}

TEST(Args, MarkdownPageHasARowForEveryOptionOfEveryCommand) {
  const std::string page = Tool().printed({"--markdown"});
  for (const char* text :
       {"# hilo-saw\n", "| `-b, --blade", "number of the blade", "## hilo-saw cut\n", "| `--depth", "hilo-saw cut log.h5 --depth 0.1\n```"})
    EXPECT_NE(page.find(text), std::string::npos) << text << "\n" << page;
}

TEST(Args, CompletionOffersTheOptionsOfTheCommandInUse) {
  const std::string script = Tool().printed({"--completion"});
  const auto offered = [&](const std::string& words) {
    const std::string command =
        "bash -c '" + script + "\nCOMP_WORDS=(" + words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _hilo_saw; echo ${COMPREPLY[@]}'";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::string out;
    char block[256];
    while (const size_t n = std::fread(block, 1, sizeof block, pipe)) out.append(block, n);
    ::pclose(pipe);
    return out;
  };
  EXPECT_EQ(offered("hilo-saw c"), "cut\n");
  EXPECT_EQ(offered("hilo-saw cut --d"), "--depth\n");
  EXPECT_EQ(offered("hilo-saw --d"), "\n");
}

}  // namespace
}  // namespace hilo
