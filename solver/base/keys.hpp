// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that entries of several kinds have.
#pragma once
#include "base/param.hpp"

namespace hilo::keys {

inline constexpr Param name{"name", Type::text, "", "!", "name, unique within the section"};
inline constexpr Param history{"history", Type::history, "1", "1",
                               "factor as a function of time: a name of [history.NAME] or a table {t = [...], value = [...]}"};
inline constexpr Param end_a{"a", Type::text, "", "ground", "first end: a rigid region, a body, a set, or ground"};
inline constexpr Param end_b{"b", Type::text, "", "!", "second end: a rigid region, a body, a set, or ground"};
inline constexpr Param at{"at", Type::vector3, "m", "!", "joint point, reference coordinates"};
inline constexpr Param at_a{"at_a", Type::vector3, "m", "!", "point on a"};
inline constexpr Param at_b{"at_b", Type::vector3, "m", "!", "point on b"};
inline constexpr Param axis{"axis", Type::vector3, "1", "!", "joint axis, inertial axes at the start; need not be of unit length"};
inline constexpr Param x_axis{"x", Type::vector3, "1", "",
                              "first axis of the joint frame, made normal to `axis`; that of [1, 0, 0], [0, 1, 0], [0, 0, 1] with the "
                              "smallest part along `axis` when absent"};

}  // namespace hilo::keys
