// SPDX-License-Identifier: GPL-3.0-or-later
// The main of a command that runs on ranks.
#pragma once
#include <functional>
#include <string_view>

#include "base/comm.hpp"

namespace hilo {

/// Run the body on all ranks, in guarded(): an Error ends all of them.  Returns the exit code.
int on_ranks(std::string_view tool, const std::function<void(Comm&)>& body);

}  // namespace hilo
