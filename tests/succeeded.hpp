// SPDX-License-Identifier: GPL-3.0-or-later
// How commands of tests end, and what they say.
#pragma once
#include <gtest/gtest.h>

#include <source_location>
#include <stdexcept>

#include "cli.hpp"

namespace hilo::test {

/// What ran with exit code 0; else the test ends with what it said, and with `about`: which case it was.
inline Ran succeeded(Ran ran, const std::string& about = "") {
  if (ran.exit != 0) throw std::runtime_error("exit code " + std::to_string(ran.exit) + "\n" + ran.out + ran.err + about);
  return ran;
}

/// These words are in what was said.
inline void expect_words(const std::string& said, const std::string& words, std::source_location test = std::source_location::current()) {
  if (said.find(words) == said.npos)
    ADD_FAILURE_AT(test.file_name(), static_cast<int>(test.line())) << "no \"" << words << "\" in\n" << said;
}

/// It ended with this exit code, and these words are in what it said.
inline void expect_end(const Ran& ran, int exit, const std::string& words, std::source_location test = std::source_location::current()) {
  if (ran.exit != exit) ADD_FAILURE_AT(test.file_name(), static_cast<int>(test.line())) << "exit code " << ran.exit << ", not " << exit;
  expect_words(ran.err, words, test);
}

}  // namespace hilo::test
