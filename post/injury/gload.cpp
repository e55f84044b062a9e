// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/gload.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "base/error.hpp"
#include "post/files/csv.hpp"
#include "post/injury/cfc.hpp"
#include "post/run/run_file.hpp"

namespace hilo {

std::vector<double> resultant(const std::array<std::vector<double>, 4>& a) {
  std::vector<double> r;
  for (size_t i = 0; i < a[0].size(); ++i) r.push_back(std::hypot(a[0][i], a[1][i], a[2][i]));
  return r;
}

namespace {

void filter(SensorRecord& s, double cfc) {
  std::array<std::vector<double>, 4> by_ends;
  for (size_t axis = 0; axis < 3; ++axis) {
    Filtered f = cfc_filtered(s.t, s.raw[axis], cfc, s.where);
    s.uniform = std::move(f.t);
    s.filtered[axis] = std::move(f.x), by_ends[axis] = std::move(f.by_ends);
  }
  s.raw[3] = resultant(s.raw);
  s.filtered[3] = resultant(s.filtered), by_ends[3] = resultant(by_ends);
  const double largest = std::abs(s.filtered[3][peak_index(s.filtered[3])]);
  constexpr const char* name[] = {"x", "y", "z", "resultant"};
  for (const size_t a : {3, 2, 1, 0}) {
    const size_t i = peak_index(s.filtered[a]);
    if (!(by_ends[a][i] > 0.02 * largest)) continue;
    const bool early = s.uniform[i] - s.uniform.front() < s.uniform.back() - s.uniform[i];
    return warn(
        s.where,
        fmt::format("CFC {:g} peak of {}, {:.4g} g at {:.4g} s, lies near the {} of the record: what is taken to come {} it changes "
                    "it by up to {:.2g} g: record {:.2g} s more there",
                    cfc, name[a], s.filtered[a][i], s.uniform[i], early ? "start" : "end", early ? "before" : "after", by_ends[a][i],
                    std::max(0.01, 1 / cfc)));
  }
}

Sensors from_csv(const std::string& path, const std::vector<std::string>& globs) {
  const CsvTable table = read_csv(path);
  Sensors out{path, std::filesystem::path(path).stem().string(), {}};
  const std::vector<double> t = table.numbers_in("s", 0, "s", "s or ms");
  for (size_t i = 1; i < t.size(); ++i)
    if (!(t[i] > t[i - 1])) throw Error(path, fmt::format("time does not rise in row {}", i + 1), "the first column is the time");
  std::vector<std::string> all;
  std::map<std::string, std::array<std::vector<double>, 4>> found;
  for (size_t c = 1; c < table.header.size(); ++c) {
    const std::string name = table.header[c].substr(0, table.header[c].find_last_of("[("));
    const std::string plain = name.substr(0, name.find_last_not_of(' ') + 1);
    const size_t dot = plain.rfind('.');
    const std::string axis = dot == plain.npos ? plain : plain.substr(dot + 1);
    std::string of = dot == plain.npos ? out.title : plain.substr(0, dot);
    if (of.starts_with("sensor.")) of.erase(0, 7);  // as hilo-post series writes it
    if (axis != "x" && axis != "y" && axis != "z")
      throw Error(path, fmt::format("column \"{}\" is no axis of a sensor", table.header[c]),
                  "x [g], y [g], z [g], or seat.x [g] and so on");
    if (std::find(all.begin(), all.end(), of) == all.end()) all.push_back(of);
    auto& values = found[of][static_cast<size_t>(axis[0] - 'x')];
    if (!values.empty()) throw Error(path, fmt::format("\"{}\" is there twice", plain), "name the sensors: seat.x, head.x");
    values = table.numbers_in("g", c, "", "[g] or [m/s^2]");
    if (!std::ranges::all_of(values, [](double x) { return std::isfinite(x); }))
      throw Error(path, fmt::format("column \"{}\" has empty cells", table.header[c]), "fill them, or cut the record");
  }
  for (const std::string& name : all) {
    if (std::ranges::none_of(globs, [&](const std::string& g) { return fnmatch(g.c_str(), name.c_str(), 0) == 0; })) continue;
    SensorRecord s{name, t, {}, found[name], {}, fmt::format("{}: sensor \"{}\"", path, name)};
    std::vector<std::string> lacking;
    for (size_t axis = 0; axis < 3; ++axis) {
      if (s.raw[axis].empty()) lacking.emplace_back(1, "xyz"[axis]);
      s.raw[axis].resize(t.size(), 0);
    }
    if (!lacking.empty()) warn(s.where, fmt::format("no column for {}, taken as 0 g", fmt::join(lacking, " and ")));
    out.records.push_back(std::move(s));
  }
  if (out.records.empty()) throw Error(path, fmt::format("no sensor \"{}\"", globs.front()), suggest(globs.front(), all));
  return out;
}

}  // namespace

Sensors read_sensors(const std::string& path, const std::vector<std::string>& globs, double cfc) {
  Sensors out;
  std::optional<ResolvedBand> band;
  if (path.ends_with(".csv")) {
    out = from_csv(path, globs);
  } else {
    const RunFile run = judged_run(path);
    out = {run.path, run.title, {}};
    band = resolved_band(run);
    for (const std::string& name : sensor_names(run, globs)) {
      const Series series = run.series("sensor." + name);
      SensorRecord s{name, series.t, {}, {}, {}, fmt::format("{}: sensor \"{}\"", run.path, name)};
      for (size_t axis = 0; axis < 3; ++axis)
        for (size_t row = 0; row < series.rows(); ++row) s.raw[axis].push_back(series.at(row, axis));
      out.records.push_back(std::move(s));
    }
  }
  for (SensorRecord& s : out.records) {
    filter(s, cfc);
    for (size_t axis = 0; axis < 4 && band; ++axis) {
      RawPeak& raw = s.peak[axis] = raw_peak(*band, s.t, s.raw[axis]);
      s.filtered_peak[axis] = raw_peak(*band, s.uniform, s.filtered[axis], raw.h);
    }
  }
  return out;
}

bool is_above(const std::array<RawPeak, 4>& peaks, size_t axis) {
  return peaks[axis].above * std::abs(peaks[axis].value) > much_above * peaks[3].value;
}

void warn_of_band(const std::vector<SensorRecord>& sensors, double cfc) {
  for (const SensorRecord& s : sensors) {
    const auto warns = [&](const std::string& which, const std::array<RawPeak, 4>& peaks, const char* advice) {
      constexpr const char* axis[] = {"x", "y", "z", "resultant"};
      for (const size_t a : {3, 2, 1, 0})
        if (is_above(peaks, a))
          return warn(s.where, fmt::format("{} peak of {}, {:.3g} g: {}: {}", which, axis[a], peaks[a].value, told(peaks[a]), advice)),
                 true;
      return false;
    };
    if (!warns(fmt::format("CFC {:g}", cfc), s.filtered_peak, "choose a lower class, or another step or mesh"))
      warns("raw", s.peak, "quote the filtered one");
  }
}

size_t peak_index(const std::vector<double>& x) {
  size_t best = 0;
  for (size_t i = 1; i < x.size(); ++i)
    if (std::abs(x[i]) > std::abs(x[best])) best = i;
  return best;
}

}  // namespace hilo
