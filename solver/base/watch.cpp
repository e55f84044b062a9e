// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

namespace hilo {
namespace {

constexpr double look_every = 0.25;  // [s]

}  // namespace

struct Watch::Slot {
  int rank;
  std::atomic<double> waited;  // seconds, by the looks of its own thread: a process that was stopped has not waited
  char place[120];
};

struct Watch::Shared {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Win window = MPI_WIN_NULL;
  int n = 0, own = 0;
  Slot* slots = nullptr;
};

std::string Watch::text(const std::source_location& at) {
  const std::string file = at.file_name();
  const size_t from = file.rfind("solver/");
  return fmt::format("{}:{}", from == file.npos ? file : file.substr(from + 7), at.line());
}

Watch::Watch(int rank, int size) : rank_(rank), size_(size), shared_(new Shared) {
  Shared& s = *shared_;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &s.machine);
  MPI_Comm_size(s.machine, &s.n), MPI_Comm_rank(s.machine, &s.own);
  MPI_Aint bytes = s.own == 0 ? static_cast<MPI_Aint>(sizeof(Slot)) * s.n : 0;
  int unit = 1;
  MPI_Win_allocate_shared(bytes, unit, MPI_INFO_NULL, s.machine, &s.slots, &s.window);
  MPI_Win_shared_query(s.window, 0, &bytes, &unit, &s.slots);
  Slot& mine = s.slots[s.own];
  mine.rank = rank, mine.waited = 0, mine.place[0] = '\0';
  MPI_Barrier(s.machine);
  sigset_t all, before;  // signals are the main thread's
  sigfillset(&all), pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    thread_ = std::thread([this] {
      std::unique_lock lock(mutex_);
      while (!end_.wait_for(lock, std::chrono::duration<double>(look_every), [this] { return ends_; })) look();
    });
  } catch (const std::system_error&) {  // no room for a thread: nobody watches
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Watch::~Watch() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  end_.notify_all();
  if (thread_.joinable()) thread_.join();
  MPI_Win_free(&shared_->window), MPI_Comm_free(&shared_->machine);
  delete shared_;
}

void Watch::look() {
  Slot& mine = shared_->slots[shared_->own];
  const std::uint64_t calls = calls_.load(std::memory_order_acquire);
  if (calls % 2 == 0 || calls != seen_) {
    seen_ = calls, looks_ = 0, told_ = false, mine.waited = 0;
    return;
  }
  if (++looks_ == 1) {
    const std::string place = text(at_);
    const size_t n = std::min(place.size(), sizeof mine.place - 1);
    std::memcpy(mine.place, place.data(), n), mine.place[n] = '\0';
  }
  mine.waited = looks_ * look_every;
  if (mine.waited < patience) return;
  const Slot* first = shared_->slots;
  const Slot* last = first + shared_->n;
  const auto waits = [](const Slot& s) { return s.waited >= patience; };
  if (std::any_of(first, first + shared_->own, waits)) return;  // a lower rank speaks for all
  const bool all = shared_->n == size_ && std::all_of(first, last, waits);
  const bool apart = std::any_of(first, last, [&](const Slot& s) { return std::strcmp(s.place, mine.place) != 0; });
  if (all && apart) {
    fmt::print(stderr, "{}: internal fault: ranks wait for each other for ever: {}\n", tool_name(), who_waits());
    std::_Exit(static_cast<int>(Exit::fault));
  }
  if (std::exchange(told_, true) || all) return;
  fmt::print(stderr, "{}: note: after {:g} s {}\n", tool_name(), mine.waited.load(), who_waits());
}

std::string Watch::who_waits() const {
  std::string out;
  for (int k = 0; k < shared_->n; ++k) {
    const Slot& s = shared_->slots[k];
    out += fmt::format("{}rank {} {}", out.empty() ? "" : ", ", s.rank, s.waited > 0 ? fmt::format("waits at {}", s.place) : "works");
  }
  return out;
}

}  // namespace hilo
