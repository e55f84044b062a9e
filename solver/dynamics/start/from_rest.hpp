// SPDX-License-Identifier: GPL-3.0-or-later
// To equilibrium by steps from rest: M (q1 - q0)/tau^2 + F(q1) = 0, each by Newton's method to its end and kept as a load step is.  All
// speed is lost between them, so parts sink to what is next below and pass through nothing.  tau grows while steps succeed, until q1 is at
// rest without the mass too.
#pragma once
#include <string>

#include "dynamics/run_parts.hpp"

namespace hilo {

/// Loads at time t [s] times `ramp`.
struct LoadLevel {
  double t = 0, ramp = 1;
};
struct RestReport : NewtonReport {
  bool ends = false;  // it failed, and would for less of the loads: what nothing holds leaves the scene, or a signal came
};
/// Takes `state` to rest under these loads.  What moves by a law is in its new place from the first step on.  Where that fails, the state
/// is where the last step ended.  Collective.
RestReport come_to_rest(RunParts& run, State& state, const LoadLevel& under);

/// What memory makes of positions at rest: why they cannot be, or "".  Collective.
std::string keep_at_rest(System& system, const Config& q, const LoadLevel& under);

}  // namespace hilo
