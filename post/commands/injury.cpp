// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post injury: what the loads at the sensors do to people, as text, JSON, CSV, a page to print and Eiband's chart.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/injury/eiband.hpp"
#include "post/injury/measures.hpp"
#include "post/injury/report.hpp"

namespace hilo {
namespace {

struct InjuryOptions {
  std::string run, csv, page, eiband, corridor;
  std::vector<std::string> sensors{"*"};
  double cfc = 60;
  bool json = false;
};

std::string cell(const InjuryMeasure& m) { return std::isfinite(m.value) ? fmt::format("{:.{}f}", m.value, m.digits) : "-"; }

/// A row for each measure: for people.
std::string text_of(const std::vector<Crew>& crew) {
  Table table;
  table.header = {"measure", "unit"};
  for (const Crew& c : crew) table.header.push_back(c.record.name);
  table.header.insert(table.header.end(), {"reference", "what"});
  table.n_text = 2;
  for (size_t k = 0; k < crew[0].measures.size(); ++k) {
    const InjuryMeasure& m = crew[0].measures[k];
    std::vector<std::string> row{m.key, m.unit};
    for (const Crew& c : crew) row.push_back(cell(c.measures[k]));
    row.push_back(std::isfinite(m.reference) ? fmt::format("{:g}", m.reference) : "");
    row.push_back(m.source.empty() ? m.what : fmt::format("{} ({})", m.what, m.source));
    table.rows.push_back(row);
  }
  return table.text();
}

/// A row for each sensor: for programs.
Table table_of(const std::vector<Crew>& crew, bool units) {
  Table table;
  table.header = {"sensor"};
  for (const InjuryMeasure& m : crew[0].measures) table.header.push_back(units ? fmt::format("{} [{}]", m.key, m.unit) : m.key);
  for (const Crew& c : crew) {
    std::vector<std::string> row{c.record.name};
    for (const InjuryMeasure& m : c.measures) row.push_back(cell(m));
    table.rows.push_back(row);
  }
  return table;
}

std::string csv_of(const Table& table) {
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (size_t j = 0; j < cells.size(); ++j) out += (j ? "," : "") + (cells[j] == "-" ? std::string() : csv_cell(cells[j]));
    out += '\n';
  };
  line(table.header);
  for (const auto& row : table.rows) line(row);
  return out;
}

void run(const InjuryOptions& o) {
  const Sensors file = read_sensors(o.run, o.sensors, o.cfc);
  std::vector<Crew> crew;
  for (const SensorRecord& record : file.records) crew.push_back(crew_of(record, o.cfc));
  const Corridor corridor = o.corridor.empty() ? Corridor{} : read_corridor(o.corridor);
  add_corridor(crew, corridor);
  if (!o.csv.empty()) write_out(o.csv, csv_of(table_of(crew, true)));
  if (!o.page.empty()) write_report(crew, o.cfc, corridor, file.title, file.path, o.page);
  if (!o.eiband.empty()) write_eiband(crew, o.cfc, file.title, o.eiband);
  const bool in_files = !o.csv.empty() || !o.page.empty() || !o.eiband.empty();
  if (o.csv != "-" && (o.json || !in_files || !is_quiet()))
    write_out("-", o.json ? table_of(crew, false).json().text() + "\n" : text_of(crew));
  warn_of_band(file.records, o.cfc);
  if (!is_quiet() && !o.json)
    fmt::print(stderr,
               "Proper acceleration in the sensors' axes (x forward, y left, z up), minus the value at the start (1 g upward at rest);\n"
               "HIC, SI (CFC 1000 or the highest class the record holds) and clip_3ms (cumulative) use the whole resultant.  Reference "
               "levels do not\n"
               "replace their sources; Brinkley's limits were not checked against theirs (a second source agrees on +z).\n");
}

}  // namespace

Command injury_command(CLI::App& app) {
  auto* sub =
      app.add_subcommand("injury", "what the sensors' loads do to people: DRI, HIC, 3 ms clip, Brinkley, ISO 2631; a page to print");
  const auto o = std::make_shared<InjuryOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve, or a CSV: t [s], x [g], y [g], z [g] (seat.x ... for several)")->required();
  sub->add_option("--sensor", o->sensors, "sensors by name or glob")->allow_extra_args(false)->default_str("*");
  sub->add_option("--cfc", o->cfc, "channel frequency class of the pulses: 60, 180, 600 or 1000 (SAE J211-1)")
      ->check(CLI::IsMember({60.0, 180.0, 600.0, 1000.0}))
      ->default_str("60");
  sub->add_option("-o,--output", o->csv, "CSV with a row for each sensor; - for stdout instead of the table");
  sub->add_option("--png", o->page, "report of one page (A4): pulses with their corridor, measures, signs, sources");
  sub->add_option("--corridor", o->corridor, "CSV with t, x_low, x_high (y_, z_): a corridor for the pulses, changes in g or [m/s^2]");
  sub->add_option("--eiband", o->eiband, "PNG: level held against its duration, with Eiband's tolerances (approximate)");
  sub->add_flag("--json", o->json, "a row for each sensor as JSON");
  example(*sub, "  hilo-post injury run.h5\n  hilo-post injury run.h5 --cfc 60 -o injury.csv --png report.png --eiband eiband.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
