// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post series: any history of a run as CSV, as universal file or as a chart.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/charts/figure.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/files/universal.hpp"
#include "post/injury/resolved_band.hpp"
#include "post/picture/picture.hpp"
#include "post/run/columns.hpp"
#include "post/run/expression.hpp"
#include "post/run/times.hpp"

namespace hilo {
namespace {

struct SeriesOptions {
  std::string run, csv, png, size = "1280x720", title, x, times;
  std::vector<std::string> names, lets;
  bool list = false, json = false;
};

/// The abscissa, and the columns over it, within --times.
struct Picked {
  Column x;
  std::vector<Column> y;
};

Picked pick(const SeriesOptions& o, const RunFile& run) {
  RunColumns columns(run, o.lets);
  Picked p{{}, columns.pick(o.names)};
  p.x = o.x.empty() ? Column{"t", "s", p.y.front().t, p.y.front().t} : columns.one(o.x);
  size_t rows = p.x.t.size();  // a run in progress may be a row ahead in one array
  for (const Column& c : p.y) rows = std::min(rows, c.t.size());
  for (const Column& c : p.y)
    if (!std::equal(p.x.t.begin(), p.x.t.begin() + static_cast<std::ptrdiff_t>(rows), c.t.begin()))
      throw Error(run.path, fmt::format("\"{}\" and \"{}\" have different times", o.x.empty() ? p.y.front().label : p.x.label, c.label),
                  "write them to two files");
  std::vector<size_t> kept;
  if (rows > 0) {
    const std::vector<double> instants(p.x.t.begin(), p.x.t.begin() + static_cast<std::ptrdiff_t>(rows));
    kept = choose_instants(instants, "all", o.times, run.path, "step");
  }
  const auto cut = [&](Column& c) {
    Column all = c;
    c.t.clear(), c.value.clear();
    for (const size_t i : kept) c.t.push_back(all.t[i]), c.value.push_back(all.value[i]);
  };
  cut(p.x);
  for (Column& c : p.y) cut(c);
  return p;
}

std::string column_title(const Column& c) { return fmt::format("{} [{}]", c.label, c.unit); }

void write_universal(const std::string& path, const RunFile& run, const Picked& picked) {
  std::vector<UniversalColumn> columns;
  for (const Column& c : picked.y) columns.push_back({c.label, c.unit, c.value});
  write_out(path, universal_text(run.title, {picked.x.label, picked.x.unit, picked.x.value}, columns, run.path));
}

void write_csv(const std::string& path, const Picked& picked) {
  std::vector<std::string> header{column_title(picked.x)};
  std::vector<std::vector<double>> columns{picked.x.value};
  for (const Column& c : picked.y) header.push_back(column_title(c)), columns.push_back(c.value);
  write_out(path, csv_text(header, columns));
}

/// What the curves of a panel have in common, with its unit: a quantity, or the component they all are of.
std::string axis_label(const std::string& unit, const std::vector<ChartCurve>& curves) {
  constexpr std::pair<const char*, const char*> names[] = {{"N", "force"},        {"N m", "moment"},      {"J", "energy"},
                                                           {"m", "length"},       {"m/s", "velocity"},    {"m/s^2", "acceleration"},
                                                           {"g", "acceleration"}, {"kg m/s", "momentum"}, {"kg m^2/s", "angular momentum"}};
  for (const auto& [u, name] : names)
    if (unit == u) return fmt::format("{} [{}]", name, unit);
  const auto component = [](const ChartCurve& c) { return c.label.substr(c.label.rfind('.') + 1); };
  const bool alike = std::ranges::all_of(curves, [&](const ChartCurve& c) { return component(c) == component(curves.front()); });
  return fmt::format("{} [{}]", alike ? component(curves.front()) : "value", unit);
}

/// One panel for each unit; labels lose what all have in common.
void write_png(const SeriesOptions& o, const RunFile& run, const Picked& picked) {
  Figure figure;
  std::tie(figure.width, figure.height) = parse_size(o.size);
  std::string common = picked.y.front().label.substr(0, picked.y.front().label.rfind('.') + 1);
  for (const Column& p : picked.y)
    while (!common.empty() && p.label.compare(0, common.size(), common) != 0) {
      const auto dot = common.rfind('.', common.size() - 2);
      common = dot == std::string::npos || common.size() < 2 ? "" : common.substr(0, dot + 1);
    }
  figure.title = !o.title.empty() ? o.title
                 : common.empty() ? run.title
                                  : fmt::format("{}: {}", run.title, common.substr(0, common.size() - 1));
  const std::string x = o.x.empty() ? "time [s]" : column_title(picked.x);
  for (const Column& p : picked.y) {
    auto panel = std::find_if(figure.panels.begin(), figure.panels.end(), [&](const Panel& q) { return q.y.label == p.unit; });
    if (panel == figure.panels.end()) panel = figure.panels.insert(figure.panels.end(), Panel{"", {x}, {p.unit}, {}});
    panel->curves.push_back({p.label.substr(common.size()), picked.x.value, p.value, curve_colour(static_cast<int>(panel->curves.size()))});
  }
  for (Panel& p : figure.panels) p.y.label = axis_label(p.y.label, p.curves);
  write_chart(figure, o.png);
}

void list(const SeriesOptions& o, const RunFile& run) {
  Table table{{"history", "columns", "units"}, {}, 3};
  for (const std::string& name : run.series_names()) {
    const Series s = run.describe(name);
    std::vector<std::string> units;
    for (const auto& u : s.unit)
      if (std::find(units.begin(), units.end(), u) == units.end()) units.push_back(u);
    constexpr size_t most = 24;  // of a beam there may be thousands
    const bool many = !o.json && s.column.size() > most;
    table.rows.push_back({name,
                          fmt::format("{}", fmt::join(s.column.begin(), many ? s.column.begin() + most / 2 : s.column.end(), " ")) +
                              (many ? fmt::format(" ... {}, {} in all", s.column.back(), s.column.size()) : ""),
                          fmt::format("{}", fmt::join(units, ", "))});
  }
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

/// Of peaks of forces and accelerations that say more of step and mesh than of the scene, beside what their history has in the same unit.
void warn_of_band(const RunFile& run, const std::vector<Column>& columns) {
  if (run.store().has("/scene") && scene_of(run).table("time").text("analysis") != "dynamic") return;  // t is no time
  const ResolvedBand band = resolved_band(run);
  constexpr std::string_view kinds[] = {"N", "N m", "m/s^2", "g"};
  size_t count = 0;
  double worst = 0;
  std::string what;
  for (const Column& c : columns) {
    if (std::ranges::find(kinds, c.unit) == std::end(kinds)) continue;
    const RawPeak peak = raw_peak(band, c.t, c.value);
    if (peak.above <= much_above) continue;
    double size = std::abs(peak.value);
    const std::string history = c.label.substr(0, c.label.rfind('.'));
    if (const auto all = run.series_names(); std::ranges::find(all, history) != all.end()) {
      const Series s = run.series(history);
      for (size_t k = 0; k < s.value.size(); ++k)
        if (s.unit[k % s.unit.size()] == c.unit) size = std::max(size, std::abs(s.value[k]));
    }
    const double share = peak.above * std::abs(peak.value) / size;
    if (share <= much_above) continue;
    if (++count; share > worst)
      worst = share, what = fmt::format("{}, peak of {:.4g} {} at {:.4g} s: {}", c.label, peak.value, c.unit, peak.t, told(peak));
  }
  if (count > 0) warn(run.path, count == 1 ? what : fmt::format("{}; so have {} columns more", what, count - 1));
}

void run(const SeriesOptions& o) {
  const RunFile file = judged_run(o.run);
  if (o.list) return list(o, file);
  if (o.names.empty())
    throw Error("series", "which histories?", "give names or globs, such as energy or \"joint.*\", or --list", Exit::usage);
  const Picked picked = pick(o, file);
  warn_of_band(file, picked.y);
  if (!o.png.empty()) write_png(o, file, picked);
  if (o.csv.ends_with(".unv") || o.csv.ends_with(".uff")) return write_universal(o.csv, file, picked);
  if (!o.csv.empty() || o.png.empty()) write_csv(o.csv.empty() ? "-" : o.csv, picked);
}

}  // namespace

Command series_command(CLI::App& app) {
  auto* sub =
      app.add_subcommand("series", "histories (reactions, energies, probes, ...) as CSV, as universal file (dataset 58) or as a chart");
  const auto o = std::make_shared<SeriesOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("names", o->names,
                  "histories or columns by name or glob: energy, joint.trunnion, \"joint.*.Fx\", joint.trunnion.F and .M for resultants; "
                  "or a formula: \"pull [kN] = "
                  "hypot(joint.pin.Fx, joint.pin.Fy)/1e3\", of columns, t [s], pi, + - * / ^ and " +
                      expression_functions() + " (d: rate, of second order; start: first value)");
  sub->add_option("--let", o->lets, "NAME = FORMULA: a name for the formulas after it, no column; --let once for each")
      ->allow_extra_args(false);
  sub->add_option("-x", o->x, "abscissa: a column or a formula, \"angle [deg] = 360*t\"; the time by default");
  sub->add_option("--times", o->times, "times in s, the nearest steps, or FROM:TO, all steps within; the whole run by default");
  sub->add_option("-o,--output", o->csv,
                  "CSV file, or a universal file where the ending is .unv or .uff; CSV on stdout when neither this nor --png is given");
  sub->add_option("--png", o->png, "chart, one panel for each unit");
  sub->add_option("--title", o->title, "title of the chart");
  sub->add_option("--size", o->size, "size of the chart, WIDTHxHEIGHT")->capture_default_str();
  sub->add_flag("--list", o->list, "list the histories there are");
  sub->add_flag("--json", o->json, "the list as JSON");
  example(*sub,
          "  hilo-post series run.h5 energy -o energy.csv --png energy.png\n"
          "  hilo-post series run.h5 energy -o energy.unv\n"
          "  hilo-post series run.h5 'energy in all [J] = energy.kinetic + energy.elastic + energy.gravity' --times 0.01: -o all.csv");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
