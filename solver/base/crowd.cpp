// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/crowd.hpp"

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

namespace {
std::atomic<bool> sleeps = false;
}  // namespace

/// In the place of libc's, for MPI's calls as well.
extern "C" __attribute__((visibility("default"))) int sched_yield() noexcept {
  if (!sleeps.load(std::memory_order_relaxed)) return static_cast<int>(syscall(SYS_sched_yield));
  const timespec pause{0, 20000};
  return nanosleep(&pause, nullptr);
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
