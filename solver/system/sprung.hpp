// SPDX-License-Identifier: GPL-3.0-or-later
// What bodies may vibrate on.
#pragma once
#include "system/system.hpp"

namespace hilo {

/// Whether there are springs or compliant joints.
bool is_sprung(const System& system);

}  // namespace hilo
