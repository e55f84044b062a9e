// What a sensor of a run felt: proper acceleration in its axes (x forward, y left, z up), raw and filtered.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "post/run/run_file.hpp"

namespace hilo {

/// Raw at the recorded times, filtered at uniform ones; the fourth column is the resultant.
struct SensorRecord {
  std::string name;
  std::vector<double> t, uniform;                    // [s]
  std::array<std::vector<double>, 4> raw, filtered;  // x y z resultant [g]
};
SensorRecord read_sensor(const RunFile& run, const std::string& name, double cfc);

/// Lengths of (x, y, z).
std::vector<double> resultant(const std::array<std::vector<double>, 4>& a);

/// Index of the value largest in size.
size_t peak_index(const std::vector<double>& x);

}  // namespace hilo
