// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the shapes of cells that programs outside the tree bring (system/add_shape.hpp).
#pragma once

namespace hilo {

/// They begin here; those below are the tree's (base/shape.hpp).  A mesh file has room for `most_shapes`.
inline constexpr int first_outside = 128, most_shapes = 256;

}  // namespace hilo
