// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/crowd.hpp"

#include <sched.h>

#include <atomic>
#include <chrono>
#include <ctime>
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

namespace {
std::atomic<bool> sleeps = false;

/// One more time that a rank that waits has asked for its message.  It asks every microsecond; after a gap another wait has begun.  Linux
/// makes each sleep 50 us longer; woken sooner, a rank that waits would take a third of a core.
void ask_again() {
  using namespace std::chrono;
  thread_local steady_clock::time_point began, last;
  const steady_clock::time_point now = steady_clock::now();
  if (now - last > microseconds(20)) began = now;
  if (sleeps.load(std::memory_order_relaxed) || now - began > microseconds(100)) {
    const timespec pause{0, 20000};
    nanosleep(&pause, nullptr);
  }
  last = steady_clock::now();
}

}  // namespace

/// In the place of libc's, for MPI's calls as well.
extern "C" __attribute__((visibility("default"))) int sched_yield() noexcept {
  ask_again();
  return 0;
}

namespace hilo {

void sleep_while_waiting() { sleeps = true; }

Crowd crowd(const Comm& comm) {
  Crowd out;
  if (comm.size == 1) return out;
  MPI_Comm machine;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &out.ranks);
  cpu_set_t cores;  // of a rank that is bound, its own alone
  CPU_ZERO(&cores);
  const bool known = sched_getaffinity(0, sizeof cores, &cores) == 0;  // not on machines of more than 1024
  MPI_Allreduce(MPI_IN_PLACE, &cores, sizeof cores, MPI_BYTE, MPI_BOR, machine);
  out.cores = known ? CPU_COUNT(&cores) : out.ranks;
  MPI_Comm_free(&machine);
  return out;
}

}  // namespace hilo
