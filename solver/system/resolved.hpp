// SPDX-License-Identifier: GPL-3.0-or-later
// The frequencies that cells and modes resolve.
#pragma once
#include <vector>

#include "system/system.hpp"

namespace hilo {

/// For each region of the mesh the highest frequency whose shear waves its cells run to 1 %, and that its modes hold; infinite for a rigid
/// one [Hz].  Frequencies of a wave number k come out too high by (k L)^2/24 with linear cells of length L and consistent mass, and by
/// (k L)^4/1440 with quadratic ones (dispersion of a uniform rod).  Collective.
std::vector<double> resolved_frequencies(const System& system);

}  // namespace hilo
