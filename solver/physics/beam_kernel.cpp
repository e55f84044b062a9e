// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/beam_kernel.hpp"

#include "physics/solid_kernel.hpp"

namespace hilo {

void arc_lanes2(const ArcCall&);
void arc_lanes4(const ArcCall&);
void arc_lanes8(const ArcCall&);

ArcKernel arc_kernel() {
  const int w = lanes();
  return {w == 8 ? arc_lanes8 : w == 4 ? arc_lanes4 : arc_lanes2, w};
}

}  // namespace hilo
