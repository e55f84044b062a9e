// SPDX-License-Identifier: GPL-3.0-or-later
// Ranks that share the cores of a machine.
#pragma once
#include "base/comm.hpp"

namespace hilo {

/// Ranks of the run on the machine of this one, and the cores that they may use together.
struct Crowd {
  int ranks = 1, cores = 1;
};

/// Collective.
Crowd crowd(const Comm& comm);
/// From now on a rank that waits sleeps: for more ranks than cores.  MPI asks again and again whether a message has come, and Open MPI
/// calls sched_yield in between where it has been given more ranks than cores.  Linux mostly gives the core back at once, to ranks that
/// have nothing to do: three ranks beside a busy process on two cores took more than 60 s for what takes 8 s with sleep.
void sleep_while_waiting();

}  // namespace hilo
