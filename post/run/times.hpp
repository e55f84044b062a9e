// SPDX-License-Identifier: GPL-3.0-or-later
// Spans of time on the command line, and how fast they are shown.
#pragma once
#include <string>
#include <utility>

namespace hilo {

/// --times "0.01:0.05", ":0.05" or "0.01:" within what there is; "" is all of it.  Error (exit 1) for anything else.
std::pair<double, double> parse_times(const std::string& text, std::pair<double, double> all);
/// The speed of 1, 2 or 5 times a power of ten that makes a movie of 6 to 15 s.
double handy_speed(double span);

}  // namespace hilo
