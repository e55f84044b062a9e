// SPDX-License-Identifier: GPL-3.0-or-later
// What spins, and who of it is not the same all around.
#pragma once
#include "system/system.hpp"

namespace hilo {

/// Angular velocity of each body [rad/s], zero where it is the round-off of what spins faster.
std::vector<Vec3> spins(const System& system, const Config& q, const Config& v);

/// What may make stiffness, damping or forces change as bodies turn with the velocities v: a body with unequal moments of inertia about its
/// axis, or else the springs that spinning bodies carry, by name; "" where there are none.
std::string who_is_uneven(const System& system, const Config& q, const Config& v);

}  // namespace hilo
