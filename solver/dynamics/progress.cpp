// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "dynamics/profile.hpp"

namespace hilo {
namespace {

std::string duration(double s) {
  if (s < 60) return fmt::format("{:.0f} s", s);
  if (s < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(s / 60), std::fmod(s, 60));
  return fmt::format("{:.0f} h {:02.0f} min", std::floor(s / 3600), std::floor(std::fmod(s, 3600) / 60));
}

}  // namespace

Progress::Progress(bool quiet, double start, double end)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), start_(start), end_(end), began_(wall_clock()), last_(began_) {}

void Progress::show(double t, long step, int iterations, bool force) {
  if (quiet_) return;
  const double now = wall_clock();
  if (now - last_ < (terminal_ ? 0.1 : 10) && !(force && open_)) return;
  last_ = now;
  const double done = end_ > start_ ? (t - start_) / (end_ - start_) : 1, left = done > 0 ? (now - began_) * (1 - done) / done : 0;
  if (terminal_) {
    fmt::print(stderr, "\r{:5.1f} %  t = {:.6g} s  step {}  {} Newton iterations  {} left   ", 100 * done, t, step, iterations,
               duration(left));
    open_ = true;
  } else {
    fmt::print(stderr, "progress={:.4f} t={:.6g} step={} newton={} left_s={:.0f}\n", done, t, step, iterations, left);
  }
}

void Progress::done() {
  if (open_) fmt::print(stderr, "\n");
}

}  // namespace hilo
