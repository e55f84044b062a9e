// SPDX-License-Identifier: GPL-3.0-or-later
// What damping makes of modes: (lambda^2 M + lambda C + K) x = 0 on their span, which grows until the equations hold on all unknowns.
#pragma once
#include "dynamics/modes/linearized.hpp"
#include "dynamics/modes/natural_modes.hpp"

namespace hilo {

/// Damping ratio and frequency of the first `wanted` modes, on the span of all of them: those of the pair of poles that has most of it (a
/// pair of real ones where the mode creeps), what the equations leave of it, and the rows phi_j.C phi_k.  `at` has the factors of K + shift
/// M.
void add_damping(std::vector<FoundMode>& modes, const Linearized& at, double shift, size_t wanted);

}  // namespace hilo
