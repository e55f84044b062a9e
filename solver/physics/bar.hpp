// SPDX-License-Identifier: GPL-3.0-or-later
// Two-node bar of constant section area, consistent mass; one cell at a time.  Its law is that of its material under uniaxial stress.
#pragma once
#include "physics/solid_kernel.hpp"

namespace hilo {

/// By the place of the law in the list of materials.
KernelFunction bar_kernel(size_t law);

}  // namespace hilo
