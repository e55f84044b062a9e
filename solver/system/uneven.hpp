// SPDX-License-Identifier: GPL-3.0-or-later
// Who is not the same all around, of what spins.
#pragma once
#include "system/system.hpp"

namespace hilo {

/// What may make stiffness, damping or forces change as bodies turn with the velocities v: a body with unequal moments of inertia about its
/// axis, or else the springs that spinning bodies carry, by name; "" where there are none.
std::string who_is_uneven(const System& system, const Config& q, const Config& v);

}  // namespace hilo
