// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post gload: what the sensors felt, raw and filtered, as a table of peaks, CSV and a chart.
#include "post/injury/gload.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "model/store.hpp"
#include "post/charts/figure.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/injury/cfc.hpp"
#include "post/picture/picture.hpp"

namespace hilo {
namespace {

struct GloadOptions {
  std::string run, csv, png, size;
  std::vector<std::string> sensors{"*"};
  double cfc = 60;
  bool json = false;
};

void write_sensors(const GloadOptions& o, const std::vector<SensorRecord>& sensors) {
  std::vector<std::string> header{"t [s]"};
  std::vector<std::vector<double>> columns{sensors.front().t};
  constexpr const char* axis[] = {"x", "y", "z", "resultant"};
  for (const SensorRecord& s : sensors) {
    for (size_t a = 0; a < 4; ++a) header.push_back(fmt::format("{}.raw_{} [g]", s.name, axis[a])), columns.push_back(s.raw[a]);
    for (size_t a = 0; a < 4; ++a) {
      header.push_back(fmt::format("{}.cfc{:g}_{} [g]", s.name, o.cfc, axis[a]));
      columns.push_back(interpolate(s.uniform, s.filtered[a], s.t));
    }
  }
  write_out(o.csv, csv_text(header, columns));
}

void draw_sensors(const GloadOptions& o, const Sensors& run) {
  const auto& sensors = run.records;
  Figure figure;
  figure.title = fmt::format("{}: proper acceleration", run.title);
  std::tie(figure.width, figure.height) =
      parse_size(o.size.empty() ? fmt::format("1280x{}", std::max<size_t>(720, 330 * sensors.size())) : o.size);
  for (const SensorRecord& s : sensors) {
    Panel panel{s.name, {"time [s]"}, {"acceleration [g]"}, {}};
    constexpr const char* axis[] = {"x forward", "y left", "z up"};
    for (size_t a = 0; a < 3; ++a) {
      const Rgb colour = curve_colour(static_cast<int>(a));
      panel.curves.push_back({fmt::format("{}, raw", axis[a]), s.t, s.raw[a], blend(colour, white, 0.35), 1.0});
    }
    for (size_t a = 0; a < 3; ++a)
      panel.curves.push_back(
          {fmt::format("{}, CFC {:g}", axis[a], o.cfc), s.uniform, s.filtered[a], curve_colour(static_cast<int>(a)), 2.6});
    figure.panels.push_back(std::move(panel));
  }
  write_chart(figure, o.png);
}

std::string sensor_table(const GloadOptions& o, const std::vector<SensorRecord>& sensors) {
  Table table;
  table.header = {"sensor"};
  constexpr const char* part[] = {"x", "y", "z", "res"};
  for (const char* a : part) table.header.push_back(fmt::format("raw_{}", a));
  for (const char* a : part) table.header.push_back(fmt::format("cfc{:g}_{}", o.cfc, a));
  table.header.insert(table.header.end(), {"t_res", "clip_3ms", "band", "above"});
  for (const SensorRecord& s : sensors) {
    std::vector<std::string> row{s.name};
    for (size_t a = 0; a < 4; ++a)
      row.push_back(fmt::format("{:.3f}{}", s.raw[a][peak_index(s.raw[a])], !o.json && is_above(s.peak, a) ? "*" : ""));
    for (const auto& x : s.filtered) row.push_back(fmt::format("{:.3f}", x[peak_index(x)]));
    row.push_back(fmt::format("{:.5f}", s.uniform[peak_index(s.filtered[3])]));
    const double clip = clip_level(s.uniform, s.filtered[3]);
    row.push_back(std::isfinite(clip) ? fmt::format("{:.3f}", clip) : "-");
    row.push_back(s.peak[3].band > 0 ? fmt::format("{:.4g}", s.peak[3].band) : "-");
    row.push_back(s.peak[3].band > 0 ? fmt::format("{:.2f}", s.peak[3].above) : "-");
    table.rows.push_back(row);
  }
  return o.json ? table.json().text() + "\n" : table.text();
}

void run(const GloadOptions& o) {
  const Sensors file = read_sensors(o.run, o.sensors, o.cfc);
  const auto& sensors = file.records;
  if (!o.csv.empty()) write_sensors(o, sensors);
  if (!o.png.empty()) draw_sensors(o, file);
  const bool in_files = !o.csv.empty() || !o.png.empty();
  if (o.csv != "-" && (o.json || !in_files || !is_quiet())) write_out("-", sensor_table(o, sensors));
  warn_of_band(sensors, o.cfc);
  if (!is_quiet() && !o.json)
    fmt::print(
        stderr,
        "Peaks in g with their sign (t_res in s); proper acceleration, +1 upward at rest.  CFC {:g}: SAE J211-1, forwards and backwards,\n"
        "the first value held before the record.  clip_3ms: cumulative, of the filtered resultant.  band: the most that step and mesh "
        "resolve\n"
        "to 1 % where the raw resultant is largest [Hz]; above: the share of that peak above it.\n",
        o.cfc);
}

}  // namespace

Command gload_command(CLI::App& app) {
  auto* sub = app.add_subcommand("gload", "G-loads of the sensors: peaks, 3 ms clip, raw and CFC-filtered curves");
  const auto o = std::make_shared<GloadOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve, or a CSV: t [s], x [g], y [g], z [g] (seat.x ... for several)")->required();
  sub->add_option("--sensor", o->sensors, "sensors by name or glob")->allow_extra_args(false)->default_str("*");
  sub->add_option("--cfc", o->cfc, "channel frequency class of the filter: 60, 180, 600 or 1000 (SAE J211-1)")
      ->check(CLI::IsMember({60.0, 180.0, 600.0, 1000.0}))
      ->default_str("60");
  sub->add_option("-o,--output", o->csv, "CSV of raw and filtered values at the recorded times; - for stdout instead of the table");
  sub->add_option("--png", o->png, "chart of raw (thin) and filtered (thick) curves");
  sub->add_option("--size", o->size, "size of the chart, WIDTHxHEIGHT");
  sub->add_flag("--json", o->json, "the table as JSON");
  example(*sub, "  hilo-post gload run.h5 --cfc 60 -o gload.csv --png gload.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
