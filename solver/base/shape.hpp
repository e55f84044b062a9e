// SPDX-License-Identifier: GPL-3.0-or-later
// Cell shapes, numbered as stored in /mesh/cells/shape.  Node order within a cell is VTK's.
#pragma once
#include <cstdint>

namespace hilo {

enum class Shape : std::uint8_t { bar2 = 0, tet4 = 1, tet10 = 2, wedge6 = 3, wedge15 = 4, hex8 = 5, hex20 = 6, hex20r = 7 };
inline constexpr int n_shapes = 8;

}  // namespace hilo
