// SPDX-License-Identifier: GPL-3.0-or-later
// What a static solve needs first: parts that cannot move as rigid bodies, or that nothing pushes where they can.
#pragma once
#include <string>

#include "system/system.hpp"

namespace hilo {

/// Static analysis: Error at `where` naming the parts that are free to move under loads at time t times `ramp`, and how.
void require_held(const System& system, const Config& q, double t, double ramp, const std::string& where);
/// Start from equilibrium: mechanisms swing to rest, but what falls for ever does not.  Error at `where` naming it.
void require_rest(const System& system, const Config& q, const std::string& where);
/// What is free to move, as an explanation behind a reason, or nothing.
std::string unheld(const System& system, const Config& q);

}  // namespace hilo
