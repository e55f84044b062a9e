// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <map>

#include "base/error.hpp"
#include "base/interrupt.hpp"

namespace hilo {
namespace {

pid_t start(const Process& p) {
  std::vector<char*> words;
  for (const std::string& word : p.command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, p.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t id = -1;
  const int fault = posix_spawnp(&id, words[0], &files, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (fault != 0) throw Error(p.command[0], fmt::format("does not start: {}", std::strerror(fault)), "", Exit::resources);
  return id;
}

using Clock = std::chrono::steady_clock;

struct Running {
  Process* process;
  Clock::time_point look;  // when `is_enough` is asked next
};

/// At first after a second, and so seldom that it takes a twentieth of the time.
void end_early(std::map<pid_t, Running>& running) {
  for (auto& [id, r] : running) {
    const auto now = Clock::now();
    if (!r.process->is_enough || r.process->ended_early || now < r.look) continue;
    r.process->ended_early = r.process->is_enough();
    if (r.process->ended_early) kill(id, SIGTERM);
    const auto took = Clock::now() - now;
    r.look = now + std::max<Clock::duration>(std::chrono::milliseconds(500), 20 * took);
  }
}

}  // namespace

void run_processes(std::vector<Process>& list, int at_once) {
  std::map<pid_t, Running> running;
  size_t next = 0;
  bool told = false;
  while (next < list.size() || !running.empty()) {
    const std::string signal = noted_signal();
    if (!signal.empty() && !told) {
      for (const auto& [id, p] : running) kill(id, SIGTERM);
      told = true, next = list.size();
    }
    while (next < list.size() && static_cast<int>(running.size()) < at_once) {
      Process& p = list[next++];
      running[start(p)] = {&p, Clock::now() + std::chrono::seconds(1)};
    }
    if (running.empty()) break;
    int status = 0;
    rusage use{};
    const pid_t ended = wait4(-1, &status, WNOHANG, &use);
    const auto found = running.find(ended);
    if (found == running.end()) {
      end_early(running);
      usleep(2000);
      continue;
    }
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    Process& p = *found->second.process;
    p.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    p.seconds = seconds(use.ru_utime) + seconds(use.ru_stime);
    running.erase(found);
  }
  if (told) throw Error("", fmt::format("{}: its runs have ended", noted_signal()), "those that are whole are kept", Exit::stopped);
}

}  // namespace hilo
