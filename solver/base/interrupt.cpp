// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/interrupt.hpp"

#include <fmt/format.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>

#include "base/error.hpp"

namespace hilo {
namespace {

struct Noted {
  int number;
  const char* name;
};
constexpr Noted all[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}, {SIGUSR1, "SIGUSR1"}};
volatile std::sig_atomic_t came = 0;
timespec came_at;  // written once, by the first of them, while the others wait

/// `timeout`, mpirun and terminals signal a process and then its group, so one request may come twice.
void note(int number) {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (!came) {
    came = number, came_at = now;
  } else if (static_cast<double>(now.tv_sec - came_at.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - came_at.tv_nsec) > 1) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
}

}  // namespace

void note_signals() {
  for (const Noted& s : all) {
    struct sigaction now {};
    if (::sigaction(s.number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) continue;  // nohup
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART;
    for (const Noted& other : all) sigaddset(&action.sa_mask, other.number);
    ::sigaction(s.number, &action, nullptr);
  }
}

void obey_signals() {
  for (const Noted& s : all) {
    struct sigaction now {};
    if (::sigaction(s.number, nullptr, &now) == 0 && now.sa_handler == note) std::signal(s.number, SIG_DFL);
  }
}

std::string noted_signal() {
  for (const Noted& s : all)
    if (came == s.number) return s.name;
  return "";
}

double parse_duration(const std::string& text, const std::string& option) {
  const Error wrong("", fmt::format("{} {} is no time", option, text), "write 90s, 20m, 3h50m, 1d or 2:30:00", Exit::usage);
  const char* at = text.c_str();
  double seconds = 0, group = 0;
  bool colons = text.find(':') != std::string::npos, some = false;
  while (*at) {
    char* end = nullptr;
    if (*at < '0' || *at > '9') throw wrong;
    const double number = std::strtod(at, &end);
    if (end == at || !std::isfinite(number)) throw wrong;
    some = true;
    const char unit = *end;
    at = unit ? end + 1 : end;
    if (colons) {
      group = 60 * group + number;
      if (unit != ':' && unit != '\0') throw wrong;
      if (unit == ':' && !*at) throw wrong;
      continue;
    }
    const double factor = unit == 'd' ? 86400 : unit == 'h' ? 3600 : unit == 'm' ? 60 : unit == 's' || unit == '\0' ? 1 : 0;
    if (factor == 0) throw wrong;
    seconds += factor * number;
  }
  seconds += group;
  if (!some || !(seconds > 0)) throw wrong;
  return seconds;
}

}  // namespace hilo
