// SPDX-License-Identifier: GPL-3.0-or-later
// Long tests of random cases run a share of them in the suite, another one each day, and all of them by `make -C tests long`:
// tests/cli/share.py for tests in C++.
#pragma once
#include <cstdlib>
#include <ctime>
#include <string>

namespace hilo::test {

/// Is the case of this number run today, where one of so many parts is?  HILO_DAY=N repeats another day, HILO_DAY=all runs all.
inline bool today(int number, int parts) {
  const char* const given = std::getenv("HILO_DAY");
  const std::string day = given ? given : std::to_string(std::time(nullptr) / 86400);
  return day == "all" || number % parts == std::stol(day) % parts;
}

}  // namespace hilo::test
