// SPDX-License-Identifier: GPL-3.0-or-later
// What tests of tools on meshes share: a folder, and what must hold when a command refuses.
#pragma once
#include <gtest/gtest.h>

#include "../cli.hpp"

namespace hilo::test {

class ToolCase : public testing::Test {
 protected:
  /// The command must fail with this code and line, say nothing on stdout and leave the folder as it was.
  void expect_refused(const std::string& command, int exit, const std::string& message) {
    const auto before = place.files();
    const auto ran = place.run(command);
    EXPECT_EQ(ran.exit, exit) << command;
    EXPECT_EQ(ran.out, "") << command;
    EXPECT_EQ(ran.err, command.substr(0, command.find(' ')) + ": " + message + "\n") << command;
    EXPECT_EQ(place.files(), before) << command;
  }
  Workplace place;
};

}  // namespace hilo::test
