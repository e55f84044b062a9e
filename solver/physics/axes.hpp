// SPDX-License-Identifier: GPL-3.0-or-later
// Directions and frames that entries of the scene name.
#pragma once
#include "base/entry_values.hpp"

namespace hilo {

/// A key that names a direction, of unit length.
Vec3 direction(const EntryValues& e, std::string_view key);
/// Frame of `axis` and `x`, third column the axis; the inertial axes where there is none.
Mat3 joint_frame(const EntryValues& e);

}  // namespace hilo
