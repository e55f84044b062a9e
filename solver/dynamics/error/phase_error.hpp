// SPDX-License-Identifier: GPL-3.0-or-later
// How far a step of a method of second order is off.
#pragma once
#include <optional>

#include "model/scene.hpp"

namespace hilo {

/// C [1] of the error C h^3 q''' that a step of length h adds to a vibration that it resolves, by the method of [time].  From the roots of
/// q'' = -w^2 q: they turn by w h (1 - C w^2 h^2).  Nothing for methods of other orders and for those of other programs.
std::optional<double> phase_error(const Entry& time, std::string_view method);

}  // namespace hilo
