// SPDX-License-Identifier: GPL-3.0-or-later
// To equilibrium by steps from rest: M (q1 - q0)/tau^2 + F(q1) = 0, each by Newton's method to its end and kept as a load step is.  All
// speed is lost between them, so parts sink to what is next below and pass through nothing.  tau grows while steps succeed, until q1 is at
// rest without the mass too.
#pragma once
#include <string>

#include "dynamics/run_parts.hpp"

namespace hilo {

/// From the state of a run under the loads at the start.  Where that fails, the state is where the last step ended.  Collective.
NewtonReport come_to_rest(RunParts& run);

/// What memory makes of positions at rest: why they cannot be, or "".  Collective.
std::string keep_at_rest(System& system, const Config& q);

}  // namespace hilo
