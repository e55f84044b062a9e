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

}  // namespace hilo
