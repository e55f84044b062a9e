// SPDX-License-Identifier: GPL-3.0-or-later
// What a sensor felt, of a run or measured: proper acceleration in its axes (x forward, y left, z up), raw and filtered.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "post/injury/resolved_band.hpp"

namespace hilo {

/// Raw at the recorded times, filtered at uniform ones; the fourth column is the resultant.
struct SensorRecord {
  std::string name;
  std::vector<double> t, uniform;                    // [s]
  std::array<std::vector<double>, 4> raw, filtered;  // x y z resultant [g]
  std::string where;                                 // for errors
  std::array<RawPeak, 4> peak{};                     // of the raw ones; band 0: not known, of a signal from a file
  std::array<RawPeak, 4> filtered_peak{};            // likewise
};

/// The sensors that match one of `globs`, of a run, or of a CSV file: a column of time, then columns "x [g]" or "seat.x [m/s^2]", y and z;
/// an axis without a column felt nothing.  Error where a column has another name or unit.
struct Sensors {
  std::string path, title;
  std::vector<SensorRecord> records;
};
Sensors read_sensors(const std::string& path, const std::vector<std::string>& globs, double cfc);

/// Is more than a tenth of the resultant, in the peak of an axis, above what the run resolves?
bool is_above(const std::array<RawPeak, 4>& peaks, size_t axis);
/// Warns of peaks that say more of step and mesh than of the scene.
void warn_of_band(const std::vector<SensorRecord>& sensors, double cfc);

/// Lengths of (x, y, z).
std::vector<double> resultant(const std::array<std::vector<double>, 4>& a);

/// Index of the value largest in size.
size_t peak_index(const std::vector<double>& x);

}  // namespace hilo
