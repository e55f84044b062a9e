// SPDX-License-Identifier: GPL-3.0-or-later
// What this rank sends to others, PETSc's and HDF5's messages included: the calls of MPI that carry data are counted on their way.
#pragma once

namespace hilo {

struct Traffic {
  long messages = 0;     // to one rank each
  long collectives = 0;  // sums, maxima and the like over all ranks
  double bytes = 0;      // of both, as handed to MPI by this rank
};
/// Since the start of the process.
const Traffic& traffic();

}  // namespace hilo
