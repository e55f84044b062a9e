// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gmsh/session.hpp"

#include <fcntl.h>
#include <gmsh.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "base/error.hpp"

namespace hilo {
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
  gmsh::option::setNumber("General.Verbosity", 1);  // errors alone, which it writes to stderr too: a CrashGuard quotes the last one
  gmsh::option::setNumber("General.Terminal", 1);
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
  std::vector<std::string> log, found;
  gmsh::logger::get(log);
  for (const auto& l : log)
    if (l.starts_with("Error: ") && std::ranges::find(found, l.substr(7)) == found.end()) found.push_back(l.substr(7));
  return some(found, 6, "; ", "; and {} more");
}

}  // namespace hilo
