// SPDX-License-Identifier: GPL-3.0-or-later
// A span of time on the command line.
#pragma once
#include <string>
#include <utility>

namespace hilo {

/// --times "0.01:0.05", ":0.05" or "0.01:" within what there is; "" is all of it.  Error (exit 1) for anything else.
std::pair<double, double> parse_times(const std::string& text, std::pair<double, double> all);

}  // namespace hilo
