// What a sensor felt, of a run or measured: proper acceleration in its axes (x forward, y left, z up), raw and filtered.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace hilo {

/// Raw at the recorded times, filtered at uniform ones; the fourth column is the resultant.
struct SensorRecord {
  std::string name;
  std::vector<double> t, uniform;                    // [s]
  std::array<std::vector<double>, 4> raw, filtered;  // x y z resultant [g]
  std::string where;                                 // for errors
};

/// The sensors that match one of `globs`, of a run, or of a CSV file: a column of time, then columns "x [g]" or "seat.x [m/s^2]", y and z;
/// an axis without a column felt nothing.  Error where a column has another name or unit.
struct Sensors {
  std::string path, title;
  bool complete = true;
  std::vector<SensorRecord> records;
};
Sensors read_sensors(const std::string& path, const std::vector<std::string>& globs, double cfc);

/// Lengths of (x, y, z).
std::vector<double> resultant(const std::array<std::vector<double>, 4>& a);

/// Index of the value largest in size.
size_t peak_index(const std::vector<double>& x);

}  // namespace hilo
