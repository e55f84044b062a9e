// SPDX-License-Identifier: GPL-3.0-or-later
// The solid-shell among the shapes: its number lies behind those of base/shape.hpp and of shells that are rigid (model/thin_regions.hpp).
#pragma once
#include "base/shape.hpp"

namespace hilo {

inline constexpr auto shell8 = static_cast<Shape>(12);

}  // namespace hilo
