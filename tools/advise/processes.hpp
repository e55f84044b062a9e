// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs, so many at once, that end when this one is told to end.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace hilo {

struct Process {
  std::vector<std::string> command;   // a program and what it is given
  std::string log;                    // where its output and errors go
  int status = -1;                    // its exit status, 128 and the signal where one ended it
  double seconds = 0;                 // of processors
  std::function<bool()> is_enough{};  // asked now and then while it runs, may be empty: true ends it
  bool ended_early = false;
};

/// Runs all of them, `at_once` at a time.  A signal (base/interrupt) goes on to those that run; then Error, Exit::stopped.
void run_processes(std::vector<Process>& list, int at_once);

}  // namespace hilo
