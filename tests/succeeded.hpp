// SPDX-License-Identifier: GPL-3.0-or-later
// Commands of tests that must end well.
#pragma once
#include <stdexcept>

#include "cli.hpp"

namespace hilo::test {

/// What ran with exit code 0; else the test ends with what it said, and with `about`: which case it was.
inline Ran succeeded(Ran ran, const std::string& about = "") {
  if (ran.exit != 0) throw std::runtime_error("exit code " + std::to_string(ran.exit) + "\n" + ran.out + ran.err + about);
  return ran;
}

}  // namespace hilo::test
