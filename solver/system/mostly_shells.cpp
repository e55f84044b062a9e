// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/mostly_shells.hpp"

#include "base/shell_shape.hpp"
#include "system/solids.hpp"

namespace hilo {

bool mostly_shells(const System& system) {
  double shells = 0, others = 0;
  for (const SolidBatch& b : system.part<Solids>().batches) (b.shape == shell8 ? shells : others) += static_cast<double>(b.cells.size());
  return system.comm->sum(shells) > system.comm->sum(others);
}

}  // namespace hilo
