// SPDX-License-Identifier: GPL-3.0-or-later
// Ranks that wait: one that waits for the others for more than a minute says where.  Where all ranks wait, and not at one place, none will
// ever go on: the run ends.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <source_location>
#include <string>
#include <thread>

namespace hilo {

class Watch {
 public:
  /// Collective, as is the end.  A thread looks at this rank every quarter of a second.
  Watch(int rank, int size);
  ~Watch();
  /// From now on this rank waits for the others, until it goes on.
  void waits(const std::source_location& at) {
    at_ = at;
    calls_.fetch_add(1, std::memory_order_release);
  }
  void goes_on() { calls_.fetch_add(1, std::memory_order_release); }
  /// "system/build/build.cpp:58".
  static std::string text(const std::source_location& at);
  /// Waits longer than this are told [s].
  static inline std::atomic<double> patience = 60;

 private:
  struct Shared;  // of the ranks of this machine, in memory that all of them see
  struct Slot;
  void look();
  std::string who_waits() const;
  const int rank_, size_;
  Shared* shared_;
  std::source_location at_;
  std::atomic<std::uint64_t> calls_ = 0;  // odd: it waits
  std::uint64_t seen_ = 0;
  int looks_ = 0;  // at which it waited in the same call
  bool told_ = false, ends_ = false;
  std::mutex mutex_;
  std::condition_variable end_;
  std::thread thread_;
};

}  // namespace hilo
