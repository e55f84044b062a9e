// SPDX-License-Identifier: GPL-3.0-or-later
// What a run will want of memory and disk, before it runs.
#pragma once
#include <string>

#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

struct Wanted {
  double memory = 0;    // of the whole run on one rank, its start included; 0 where it is not known (PETSc's solvers)   [byte]
  double fields = 0;    // on disk                                                                                         [byte]
  double per_step = 0;  // of histories, on disk                                                                           [byte]
  double steps = 0;     // 0 where a tolerance chooses them
  double disk() const { return fields + steps * per_step; }
};
/// From the pattern of the matrix, ordered and counted as its factors will be but not filled, and from what the scene writes.  Collective.
Wanted wanted(const Scene& scene, const System& system);
/// One line: "needs 1.2 GB of memory (9.8 GB are free) and 340 MB of disk".
std::string text(const Wanted& wanted);

}  // namespace hilo
