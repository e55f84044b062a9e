// SPDX-License-Identifier: GPL-3.0-or-later
// --steps and --times of every command: which instants, which span; and how fast a span is shown.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace hilo {

/// --times "0.01:0.05", ":0.05" or "0.01:" within what there is; "" is all of it.  Error (exit 1) for anything else.
std::pair<double, double> parse_times(const std::string& text, std::pair<double, double> all);
/// Which of the instants `t`, in rising order, --steps and --times ask for, in the order they are asked for.  `times`, where not "", goes
/// before `numbers`: "0.05,0.1" are the nearest ones, "FROM:TO" all within.  `numbers`: all, first, last, or as 0,5,10:20.
/// `what` they are, in messages: an output of fields, a step of histories; `path`: the file that has them.
std::vector<size_t> choose_instants(const std::vector<double>& t, const std::string& numbers, const std::string& times,
                                    const std::string& path, const std::string& what);
/// The speed of 1, 2 or 5 times a power of ten that makes a movie of 6 to 15 s.
double handy_speed(double span);

}  // namespace hilo
