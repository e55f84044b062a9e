// SPDX-License-Identifier: GPL-3.0-or-later
// What brakes a motion.
#pragma once
#include "system/system.hpp"

namespace hilo {

/// Section and name of the spring or damper whose rate forces take most at a stage; empty where none takes anything.
std::pair<std::string, std::string> takes_most(const System& system, const Stage& stage, std::span<const double> lambda);

}  // namespace hilo
