// SPDX-License-Identifier: GPL-3.0-or-later
// Drives and motions that joints do not allow.
#pragma once
#include <string>

#include "dynamics/redundancy/redundancy.hpp"
#include "model/scene.hpp"

namespace hilo {

/// Error (exit 2) naming a drive that ever moves what other joints hold, or a motion that opens a joint between things whose motion is
/// prescribed, at any time until `end` [s].
void refuse_contradictions(const Scene& scene, const System& system, const Redundancy& redundancy, double end);
/// A joint whose redundant rows do not move as what drives others would have it at (q, v, t), or "" where all agree.
std::string contradicted_joint(const System& system, const Config& q, const Config& v, double t);

}  // namespace hilo
