// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "system/system.hpp"

namespace hilo {

/// Whether most of the cells that deform are shells.  Collective.
bool mostly_shells(const System& system);

}  // namespace hilo
