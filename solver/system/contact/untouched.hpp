// SPDX-License-Identifier: GPL-3.0-or-later
// Solids and bodies that nothing holds, moves, loads or touches: a joint, a support or a contact that was forgotten.
#pragma once
#include <string>
#include <vector>

#include "system/system.hpp"

namespace hilo {

/// One line for each, at the start of a run: 'region "lid", about (0, 0.1, 2) m'.  None where the scene is one piece; what has a velocity
/// at the start is meant to fly.  Collective.
std::vector<std::string> untouched(const System& system);

}  // namespace hilo
