// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/crash_guard.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "import/data_line.hpp"

namespace hilo {
namespace {

bool reading = false;
int aloud = 2;   // where a crash is told
int heard = -1;  // what the library says on stderr: the end of a pipe
int crash_exit = static_cast<int>(Exit::input);
std::string end_line;  // what is said where a script ends the program
// what the handler of a crash writes: made beforehand, since it may not allocate
std::string crash_line, quote = " (its last error: ", after_quote = "; is the file damaged?)\n", no_quote = " (is the file damaged?)\n";

constexpr size_t most_heard = 1 << 16;  // what a pipe holds
std::array<char, most_heard> words;

/// All that the library said so far.  Calls that a handler of signals may make alone.
std::string_view listen() {
  size_t n = 0;
  for (ssize_t got = 0; heard >= 0 && n < words.size() && (got = read(heard, words.data() + n, words.size() - n)) > 0;)
    n += static_cast<size_t>(got);
  return {words.data(), n};
}

/// What a line "Error : ..." says, or nothing where it is another.
std::string_view error_in(std::string_view line) {
  constexpr std::string_view mark = "Error";
  if (!line.starts_with(mark)) return {};
  const size_t colon = line.find_first_not_of(' ', mark.size());
  if (colon == line.npos || line[colon] != ':') return {};
  const size_t at = line.find_first_not_of(' ', colon + 1);
  return at == line.npos ? std::string_view{} : line.substr(at);
}

void say(std::string_view text) {
  if (write(aloud, text.data(), text.size()) < 0) _exit(static_cast<int>(Exit::fault));
}

void tell_crash() {
  say(crash_line);
  if (crash_exit == static_cast<int>(Exit::input)) {
    std::string_view last;
    for (const std::string_view line : lines_of(listen()))
      if (const auto error = error_in(line); !error.empty()) last = error;
    if (last.empty())
      say(no_quote);
    else
      say(quote), say(last), say(after_quote);
  }
  _exit(crash_exit);
}

}  // namespace

CrashGuard::CrashGuard(const std::string& path, std::string_view library, bool silent) : silent_(silent) {
  rlimit room{};
  const bool limited = getrlimit(RLIMIT_AS, &room) == 0 && room.rlim_cur != RLIM_INFINITY;
  crash_exit = static_cast<int>(limited ? Exit::resources : Exit::input);
  crash_line = limited ? fmt::format(
                             "{}: {}: {} did not survive the limit of {} MB of memory (raise it, ulimit -v; what the file is worth "
                             "cannot be told before)\n",
                             tool_name(), path, library, room.rlim_cur >> 20)
                       : fmt::format("{}: {}: {} crashed on it", tool_name(), path, library);
  end_line = fmt::format("{}: {}: the script ends the program before there is a mesh (Exit)\n", tool_name(), path);
  static const bool once = std::atexit([] {
                             if (!reading) return;
                             say(end_line);
                             _exit(static_cast<int>(Exit::input));
                           }) == 0;
  reading = once;
  struct sigaction act {};
  act.sa_handler = [](int) { tell_crash(); };
  for (size_t i = 0; i < signals_.size(); ++i) sigaction(signals_[i], &act, &before_[i]);
  if (std::array<int, 2> ends{}; pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) == 0) {  // what does not fit is dropped
    std::fflush(stderr);
    aloud = stderr_ = fcntl(2, F_DUPFD_CLOEXEC, 3);
    dup2(ends[1], 2);
    close(ends[1]);
    heard = ends[0];
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
    if (!silent_)
      for (const std::string_view line : lines_of(listen()))
        if (error_in(line).empty()) std::fprintf(stderr, "%.*s\n", static_cast<int>(line.size()), line.data());
    close(heard);
    heard = -1;
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
