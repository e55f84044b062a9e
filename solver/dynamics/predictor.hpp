// SPDX-License-Identifier: GPL-3.0-or-later
// First guesses of a step's end configuration.
#pragma once
#include "dynamics/state.hpp"
#include "system/system.hpp"

namespace hilo {

/// rigid_rotation: bodies, and flexible regions as wholes, turn by the Cayley rotation of their spin; velocity: q + h v; hold: q.
/// accelerated: q + h v + h^2/2 a, bodies turned likewise, with State::a: off a singular position.
/// `a`, where it has values, is the acceleration of the step before: it bends the path of the bodies of a rigid scene.
enum class Predictor { rigid_rotation, velocity, hold, accelerated };
void predict(const System& system, const State& s, double h, Predictor kind, const Config& a, Config& q);

}  // namespace hilo
