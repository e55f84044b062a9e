// SPDX-License-Identifier: GPL-3.0-or-later
// All measures of one sensor: what tables, JSON, CSV and the report page show.
#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "post/injury/gload.hpp"

namespace hilo {

struct InjuryMeasure {
  std::string key, unit, what;  // "DRI", "1", what it is in words
  double value = std::numeric_limits<double>::quiet_NaN();
  int digits = 3;
  double reference = std::numeric_limits<double>::quiet_NaN();  // a level from the literature to compare with
  std::string source = {};                                      // of that level
};

struct Crew {
  SensorRecord record;
  std::array<std::vector<double>, 3> change;  // filtered less what was felt at the start, at record.uniform  [g]
  std::vector<InjuryMeasure> measures;
  double head_class = 0, chest_class = 0;  // CFC of HIC and severity, of the 3 ms clip: the wanted class or the highest the record holds
};
Crew crew_of(SensorRecord record, double cfc);

}  // namespace hilo
