// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/crash_guard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"

namespace hilo {
namespace {

bool reading = false;
int aloud = 2;  // where a crash is told
int crash_exit = static_cast<int>(Exit::input);
std::string end_line;    // what is said where a script ends the program
std::string crash_line;  // what the handler of a crash writes: made beforehand, since it may not allocate

}  // namespace

CrashGuard::CrashGuard(const std::string& path, std::string_view library, bool silent) {
  rlimit room{};
  const bool limited = getrlimit(RLIMIT_AS, &room) == 0 && room.rlim_cur != RLIM_INFINITY;
  crash_exit = static_cast<int>(limited ? Exit::resources : Exit::input);
  crash_line = limited ? fmt::format(
                             "{}: {}: {} did not survive the limit of {} MB of memory (raise it, ulimit -v; what the file is worth "
                             "cannot be told before)\n",
                             tool_name(), path, library, room.rlim_cur >> 20)
                       : fmt::format("{}: {}: {} crashed on it (is the file damaged?)\n", tool_name(), path, library);
  end_line = fmt::format("{}: {}: the script ends the program before there is a mesh (Exit)\n", tool_name(), path);
  static const bool once = std::atexit([] {
                             if (!reading) return;
                             if (write(aloud, end_line.data(), end_line.size()) < 0) _exit(static_cast<int>(Exit::fault));
                             _exit(static_cast<int>(Exit::input));
                           }) == 0;
  reading = once;
  struct sigaction act {};
  act.sa_handler = [](int) {
    if (write(aloud, crash_line.data(), crash_line.size()) < 0) _exit(static_cast<int>(Exit::fault));
    _exit(crash_exit);
  };
  for (size_t i = 0; i < signals_.size(); ++i) sigaction(signals_[i], &act, &before_[i]);
  if (const int nowhere = silent ? open("/dev/null", O_WRONLY | O_CLOEXEC) : -1; nowhere >= 0) {
    std::fflush(stderr);
    aloud = stderr_ = fcntl(2, F_DUPFD_CLOEXEC, 3);
    dup2(nowhere, 2);
    close(nowhere);
  }
  // the default handler would say more than our one line
  terminate_ = std::set_terminate([] { std::raise(SIGABRT); });
}

CrashGuard::~CrashGuard() {
  reading = false;
  if (stderr_ >= 0) {
    std::fflush(stderr);
    dup2(stderr_, 2);
    close(stderr_);
    aloud = 2;
  }
  std::set_terminate(terminate_);
  for (size_t i = 0; i < signals_.size(); ++i) sigaction(signals_[i], &before_[i], nullptr);
}

MemoryLimit::MemoryLimit(const std::string& path) {
  const std::uint64_t bytes = (std::uint64_t{1} << 30) + 50 * std::filesystem::file_size(path);
  rlimit room{};
  getrlimit(RLIMIT_AS, &room);
  before_ = room.rlim_cur;
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  room.rlim_cur = std::min<rlim_t>(room.rlim_cur, pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + bytes);
  setrlimit(RLIMIT_AS, &room);
}

MemoryLimit::~MemoryLimit() {
  rlimit room{};
  getrlimit(RLIMIT_AS, &room);
  room.rlim_cur = before_;
  setrlimit(RLIMIT_AS, &room);
}

}  // namespace hilo
