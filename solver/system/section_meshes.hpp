// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes of sections that a run keeps in its results.
#pragma once
#include <vector>

namespace hilo {

class System;
struct NamedSection;

const std::vector<NamedSection>& section_meshes(const System& system);

}  // namespace hilo
