// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of [time], those of the integrators among them.
#pragma once
#include "model/scene.hpp"

namespace hilo {

/// Closes the list of integrators.
KindSchema time_schema();

}  // namespace hilo
