// SPDX-License-Identifier: GPL-3.0-or-later
// Where a motion begins away from the drawing, what hangs on it by cells begins moved with it, as a rigid body.
#pragma once
#include <string>
#include <vector>

#include "system/system.hpp"

namespace hilo {

/// What begin_moved did.
struct MovedStart {
  double way = 0;                 // the largest of a node or a body [m]
  std::vector<std::string> torn;  // motions that do not begin as what else holds their cells: those begin strained
};

/// q: the drawing, but for what moves by a law.  Free nodes and bodies that cells join to a motion that begins elsewhere take its pose,
/// where all that holds these cells begins with the same one.  `factor` as of System::prescribe.  Collective.
MovedStart begin_moved(const System& system, Config& q, double factor);

}  // namespace hilo
