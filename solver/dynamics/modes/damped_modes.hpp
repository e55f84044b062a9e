// SPDX-License-Identifier: GPL-3.0-or-later
// What damping makes of modes: (s^2 M + s C + K) x = 0 on their span, which grows until the equations hold on all unknowns.
#pragma once
#include "dynamics/modes/linearized.hpp"
#include "dynamics/modes/natural_modes.hpp"

namespace hilo {

/// Damping ratio and frequency of the first `wanted` modes, on the span of all of them, what the equations leave of it, and the rows
/// phi_j.C phi_k.  The slowest pairs of poles are listed, each beside the mode that has most of it.  `at` has the factors of K + shift M.
/// What is to be said of it.
std::vector<std::string> add_damping(std::vector<FoundMode>& modes, const Linearized& at, double shift, size_t wanted);

}  // namespace hilo
