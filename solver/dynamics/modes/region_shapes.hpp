// SPDX-License-Identifier: GPL-3.0-or-later
// The modes of linear regions as results, to be drawn.
#pragma once
#include <string>
#include <vector>

#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

/// Writes a run.h5 whose instants are the modes of all linear regions, lowest first: the region displaced by a mode, a twentieth of its
/// radius of gyration at most, all else as drawn.  What each is: a line for it.
std::vector<std::string> write_region_shapes(System& system, const Scene& scene, const std::string& path,
                                             const std::vector<std::string>& provenance);

}  // namespace hilo
