// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/beam_cell.hpp"

namespace hilo {
void arc_lanes8(const ArcCall& call) {
  typedef double Lanes __attribute__((vector_size(8 * 8)));
  arc::run<Lanes>(call);
}
}  // namespace hilo
