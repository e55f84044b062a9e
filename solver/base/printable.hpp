// SPDX-License-Identifier: GPL-3.0-or-later
// Text from outside on somebody's screen.
#pragma once
#include <string>
#include <string_view>

namespace hilo {

/// UTF-8 with characters that cannot be seen written out, "\u202E": controls but line breaks and tabs, what turns the direction of text
/// about, what has no width.
std::string printable(std::string_view text);

}  // namespace hilo
