// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/session.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "base/error.hpp"

namespace hilo {
namespace {

bool reading = false;
int crash_exit = static_cast<int>(Exit::input);
std::string end_line;    // what is said where a script ends the program
std::string crash_line;  // what the handler of a crash writes: made beforehand, since it may not allocate

}  // namespace

CrashGuard::CrashGuard(const std::string& path) {
  rlimit room{};
  const bool limited = getrlimit(RLIMIT_AS, &room) == 0 && room.rlim_cur != RLIM_INFINITY;
  crash_exit = static_cast<int>(limited ? Exit::resources : Exit::input);
  crash_line = limited ? fmt::format(
                             "{}: {}: gmsh did not survive the limit of {} MB of memory (raise it, ulimit -v; what the file is worth "
                             "cannot be told before)\n",
                             tool_name(), path, room.rlim_cur >> 20)
                       : fmt::format("{}: {}: gmsh crashed on it (is the file damaged?)\n", tool_name(), path);
  end_line = fmt::format("{}: {}: the script ends the program before there is a mesh (Exit)\n", tool_name(), path);
  static const bool once = std::atexit([] {
                             if (!reading) return;
                             if (write(2, end_line.data(), end_line.size()) < 0) _exit(static_cast<int>(Exit::fault));
                             _exit(static_cast<int>(Exit::input));
                           }) == 0;
  reading = once;
  struct sigaction act {};
  act.sa_handler = [](int) {
    if (write(2, crash_line.data(), crash_line.size()) < 0) _exit(static_cast<int>(Exit::fault));
    _exit(crash_exit);
  };
  for (size_t i = 0; i < signals_.size(); ++i) sigaction(signals_[i], &act, &before_[i]);
  // the default handler would say more than our one line
  terminate_ = std::set_terminate([] { std::raise(SIGABRT); });
}

CrashGuard::~CrashGuard() {
  reading = false;
  std::set_terminate(terminate_);
  for (size_t i = 0; i < signals_.size(); ++i) sigaction(signals_[i], &before_[i], nullptr);
}

GmshSession::GmshSession(const ImportOptions& o) {
  std::fflush(stdout);
  stdout_ = dup(1);
  if (pipe2(said_.data(), O_NONBLOCK | O_CLOEXEC) == 0) dup2(said_[1], 1);  // files cannot be opened here; what does not fit is dropped
  std::vector<std::string> words{"hilo-import"};
  for (const auto& [name, value] : o.define) words.insert(words.end(), {"-setnumber", name, fmt::format("{}", value)});
  std::vector<char*> argv;
  for (auto& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  gmsh::initialize(static_cast<int>(words.size()), argv.data(), false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 1);
  gmsh::logger::start();
}

GmshSession::~GmshSession() {
  try {
    gmsh::logger::stop();  // or the next session would find this one's errors
    gmsh::finalize();
  } catch (...) {  // it is closed either way
  }
  std::cout.flush();
  std::fflush(stdout);
  dup2(stdout_, 1);
  close(stdout_);
  for (const int end : said_) close(end);
}

std::string GmshSession::printed() {
  std::cout.flush();
  std::fflush(stdout);
  char part[4096];
  for (ssize_t n = 0; (n = read(said_[0], part, sizeof part)) > 0;) printed_.append(part, static_cast<size_t>(n));
  return printed_;
}

std::string GmshSession::errors() {
  constexpr size_t most = 6;
  std::vector<std::string> log, found;
  gmsh::logger::get(log);
  for (const auto& l : log)
    if (l.starts_with("Error: ") && std::ranges::find(found, l.substr(7)) == found.end()) found.push_back(l.substr(7));
  const size_t more = found.size() > most ? found.size() - most : 0;
  found.resize(found.size() - more);
  return fmt::format("{}{}", fmt::join(found, "; "), more ? fmt::format("; and {} more", more) : "");
}

}  // namespace hilo
