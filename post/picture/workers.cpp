// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/picture/workers.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "base/error.hpp"

namespace hilo {
namespace {

/// One message: a kind ('r' a result, 'e' an error), a length, the bytes.
void send(int to, char kind, const std::string& bytes) {
  const auto all = [&](const char* p, size_t n) {
    while (n > 0) {
      const ssize_t written = ::write(to, p, n);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) std::_Exit(static_cast<int>(Exit::fault));  // nobody reads any more
      p += written, n -= static_cast<size_t>(written);
    }
  };
  const std::uint64_t length = bytes.size();
  all(&kind, 1), all(reinterpret_cast<const char*>(&length), sizeof length), all(bytes.data(), bytes.size());
}

bool receive(int from, char& kind, std::string& bytes) {
  const auto all = [&](char* p, size_t n) {
    while (n > 0) {
      const ssize_t got = ::read(from, p, n);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      p += got, n -= static_cast<size_t>(got);
    }
    return true;
  };
  std::uint64_t length = 0;
  if (!all(&kind, 1) || !all(reinterpret_cast<char*>(&length), sizeof length)) return false;
  bytes.resize(length);
  return all(bytes.data(), bytes.size());
}

/// An error as four lines of text, and back.
std::string written(const Error& e) { return fmt::format("{}\n{}\n{}\n{}", static_cast<int>(e.exit), e.where, e.message, e.hint); }

Error read_error(const std::string& text) {
  std::vector<std::string> part{""};
  for (const char c : text)
    if (c == '\n' && part.size() < 4)
      part.emplace_back();
    else
      part.back() += c;
  part.resize(4);
  return {part[1], part[2], part[3], static_cast<Exit>(std::atoi(part[0].c_str()))};
}

/// Child processes and the pipes from them; none survives it.
struct Children {
  struct Child {
    pid_t id;
    int pipe;
  };
  std::vector<Child> all;

  ~Children() {
    for (const Child& c : all) ::close(c.pipe);
    for (const Child& c : all) ::kill(c.id, SIGTERM);
    for (const Child& c : all) ::waitpid(c.id, nullptr, 0);
  }
};

[[noreturn]] void work(int to, size_t first, size_t stride, size_t n, const std::function<std::function<std::string(size_t)>()>& start) {
  // Mesa's rasterizer shares the cores among the processes instead of taking them all in each.
  const size_t threads = std::max<size_t>(1, std::thread::hardware_concurrency() / stride);
  ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
  try {
    const auto make = start();
    for (size_t k = first; k < n; k += stride) send(to, 'r', make(k));
  } catch (const Error& e) {
    send(to, 'e', written(e));
  } catch (const std::bad_alloc&) {
    send(to, 'e', written({"memory", "not enough for a frame", "fewer --jobs", Exit::resources}));
  } catch (const std::exception& e) {
    send(to, 'e', written({"frame", e.what(), "", Exit::fault}));
  }
  std::_Exit(0);  // without the destructors and buffers of the parent
}

}  // namespace

int default_jobs(size_t n) { return static_cast<int>(std::clamp<size_t>(std::thread::hardware_concurrency(), 1, std::max<size_t>(n, 1))); }

void in_processes(size_t n, int jobs, const std::function<std::function<std::string(size_t)>()>& start,
                  const std::function<void(size_t, std::string)>& take) {
  const auto count = static_cast<size_t>(std::clamp<long>(jobs, 1, static_cast<long>(std::max<size_t>(n, 1))));
  if (count == 1) {
    const auto make = start();
    for (size_t k = 0; k < n; ++k) take(k, make(k));
    return;
  }
  std::fflush(stdout), std::fflush(stderr);
  Children children;
  for (size_t j = 0; j < count; ++j) {
    int ends[2];
    if (::pipe(ends) != 0) throw Error("--jobs", fmt::format("no pipe: {}", std::strerror(errno)), "", Exit::resources);
    const pid_t id = ::fork();
    if (id < 0) throw Error("--jobs", fmt::format("no process: {}", std::strerror(errno)), "", Exit::resources);
    if (id == 0) {
      for (const auto& c : children.all) ::close(c.pipe);
      ::close(ends[0]);
      work(ends[1], j, count, n, start);
    }
    ::close(ends[1]);
    children.all.push_back({id, ends[0]});
  }
  std::string bytes;
  for (size_t k = 0; k < n; ++k) {
    char kind = 0;
    if (!receive(children.all[k % count].pipe, kind, bytes))
      throw Error("--jobs", fmt::format("the process that drew frame {} has died", k), "is there memory for --jobs processes?",
                  Exit::resources);
    if (kind == 'e') throw read_error(bytes);
    take(k, std::move(bytes));
  }
}

}  // namespace hilo
