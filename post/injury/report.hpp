// SPDX-License-Identifier: GPL-3.0-or-later
// One page to print (the ratio of A4): the pulses of all sensors with their corridor, what they do to people, signs, sources.
#pragma once
#include <string>
#include <vector>

#include "post/injury/corridor.hpp"
#include "post/injury/measures.hpp"

namespace hilo {

/// Where no corridor is given for an axis, it is the room between the lowest and the highest of the sensors.  Error for more sensors than a
/// page has columns.
void write_report(const std::vector<Crew>& crew, double cfc, const Corridor& corridor, const std::string& title, const std::string& run,
                  const std::string& path);

}  // namespace hilo
