#include "post/injury/gload.hpp"

#include <fmt/format.h>

#include <cmath>

#include "post/injury/cfc.hpp"

namespace hilo {

std::vector<double> resultant(const std::array<std::vector<double>, 4>& a) {
  std::vector<double> r;
  for (size_t i = 0; i < a[0].size(); ++i) r.push_back(std::hypot(a[0][i], a[1][i], a[2][i]));
  return r;
}

SensorRecord read_sensor(const RunFile& run, const std::string& name, double cfc) {
  const Series series = run.series("sensor." + name);
  SensorRecord s{name, series.t, {}, {}, {}};
  const std::string where = fmt::format("{}: sensor \"{}\"", run.path, name);
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t row = 0; row < series.rows(); ++row) s.raw[axis].push_back(series.at(row, axis));
    Filtered f = cfc_filtered(s.t, s.raw[axis], cfc, where);
    s.uniform = std::move(f.t);
    s.filtered[axis] = std::move(f.x);
  }
  s.raw[3] = resultant(s.raw);
  s.filtered[3] = resultant(s.filtered);
  return s;
}

size_t peak_index(const std::vector<double>& x) {
  size_t best = 0;
  for (size_t i = 1; i < x.size(); ++i)
    if (std::abs(x[i]) > std::abs(x[best])) best = i;
  return best;
}

}  // namespace hilo
