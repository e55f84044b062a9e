// SPDX-License-Identifier: GPL-3.0-or-later
// Crashes and greed of libraries that read outside files, turned into errors.
#pragma once
#include <array>
#include <csignal>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

namespace hilo {

/// A damaged file can crash the library that reads it.  While this lives a crash says so in one line and ends with "bad input".  What the
/// library itself says on stderr is kept apart: a crash quotes its last error, a line "Error : ...".  Without a crash these lines are
/// dropped, as who asks the library has them, and the others follow on stderr where this is not `silent`.
class CrashGuard {
 public:
  CrashGuard(const std::string& path, std::string_view library, bool silent = false);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static constexpr std::array<int, 4> signals_{SIGSEGV, SIGABRT, SIGBUS, SIGFPE};
  std::array<struct sigaction, 4> before_{};
  std::terminate_handler terminate_;
  int stderr_ = -1;  // the true one, while the library has another
  bool silent_;
};

/// While this lives the process may take a gigabyte and fifty times the file more memory than it has: a library that believes a damaged
/// count fails there.
class MemoryLimit {
 public:
  explicit MemoryLimit(const std::string& path);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  std::uint64_t before_;  // the limit that there was
};

}  // namespace hilo
