// hilo-post series: any history of a run as CSV or as a chart.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/commands.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"
#include "post/output.hpp"
#include "post/picture.hpp"
#include "post/run_file.hpp"

namespace hilo {
namespace {

struct Options {
  std::string run, csv, png, size = "1280x720", title;
  std::vector<std::string> names;
  bool list = false, json = false;
};

/// One column of a history.
struct Picked {
  std::string label, unit;  // "joint.trunnion.Fx"
  std::vector<double> t, value;
};

/// Columns in the order they were asked for.
std::vector<Picked> pick(const RunFile& run, const std::vector<std::string>& globs) {
  std::vector<Picked> picked;
  const std::vector<std::string> known = run.series_names();
  for (const std::string& glob : globs) {
    bool any = false;
    for (const std::string& name : known) {
      const Series what = run.describe(name);
      std::optional<Series> s;
      for (size_t c = 0; c < what.column.size(); ++c) {
        const std::string label = name + "." + what.column[c];
        if (!matches(glob, name) && !matches(glob, label)) continue;
        any = true;
        if (std::any_of(picked.begin(), picked.end(), [&](const Picked& p) { return p.label == label; })) continue;
        if (!s) s = run.series(name);
        Picked p{label, what.unit[c], s->t, {}};
        for (size_t row = 0; row < s->rows(); ++row) p.value.push_back(s->at(row, c));
        picked.push_back(std::move(p));
      }
    }
    if (any) continue;
    const std::string hint = suggest(glob, known);
    throw Error(run.path, fmt::format("no history \"{}\"", glob), hint.empty() ? "see --list" : hint);
  }
  return picked;
}

/// Columns over one time axis.  Histories with other times would need another file.
void write_csv(const Options& o, const RunFile& run, const std::vector<Picked>& picked) {
  std::vector<std::string> header{"t [s]"};
  std::vector<std::vector<double>> columns{picked.front().t};
  for (const Picked& p : picked) {
    const size_t rows = std::min(columns[0].size(), p.t.size());  // a run in progress may be a row ahead in one array
    if (!std::equal(p.t.begin(), p.t.begin() + static_cast<std::ptrdiff_t>(rows), columns[0].begin()))
      throw Error(run.path, fmt::format("\"{}\" and \"{}\" have different times", picked.front().label, p.label),
                  "write them to two files");
    for (auto& column : columns) column.resize(rows);
    header.push_back(fmt::format("{} [{}]", p.label, p.unit));
    columns.push_back({p.value.begin(), p.value.begin() + static_cast<std::ptrdiff_t>(rows)});
  }
  write_out(o.csv, csv_text(header, columns));
}

std::string axis_label(const std::string& unit) {
  constexpr std::pair<const char*, const char*> names[] = {{"N", "force"},        {"N m", "moment"},      {"J", "energy"},
                                                           {"m", "length"},       {"m/s", "velocity"},    {"m/s^2", "acceleration"},
                                                           {"g", "acceleration"}, {"kg m/s", "momentum"}, {"kg m^2/s", "angular momentum"}};
  for (const auto& [u, name] : names)
    if (unit == u) return fmt::format("{} [{}]", name, unit);
  return fmt::format("[{}]", unit);
}

/// One panel for each unit; labels lose what all have in common.
void write_png(const Options& o, const RunFile& run, const std::vector<Picked>& picked) {
  Figure figure;
  std::tie(figure.width, figure.height) = parse_size(o.size);
  std::string common = picked.front().label.substr(0, picked.front().label.rfind('.') + 1);
  for (const Picked& p : picked)
    while (!common.empty() && p.label.compare(0, common.size(), common) != 0) {
      const auto dot = common.rfind('.', common.size() - 2);
      common = dot == std::string::npos || common.size() < 2 ? "" : common.substr(0, dot + 1);
    }
  figure.title = !o.title.empty() ? o.title
                 : common.empty() ? run.title
                                  : fmt::format("{}: {}", run.title, common.substr(0, common.size() - 1));
  for (const Picked& p : picked) {
    const std::string label = axis_label(p.unit);
    auto panel = std::find_if(figure.panels.begin(), figure.panels.end(), [&](const Panel& q) { return q.y.label == label; });
    if (panel == figure.panels.end()) panel = figure.panels.insert(figure.panels.end(), Panel{"", {"time [s]"}, {label}, {}});
    panel->curves.push_back({p.label.substr(common.size()), p.t, p.value, curve_colour(static_cast<int>(panel->curves.size()))});
  }
  write_chart(figure, o.png);
}

void list(const Options& o, const RunFile& run) {
  Table table{{"history", "columns", "units"}, {}, 3};
  for (const std::string& name : run.series_names()) {
    const Series s = run.describe(name);
    std::vector<std::string> units;
    for (const auto& u : s.unit)
      if (std::find(units.begin(), units.end(), u) == units.end()) units.push_back(u);
    table.rows.push_back({name, fmt::format("{}", fmt::join(s.column, " ")), fmt::format("{}", fmt::join(units, ", "))});
  }
  write_out("-", o.json ? table.json("") + "\n" : table.text());
}

void run(const Options& o) {
  const RunFile file(o.run);
  if (o.list) return list(o, file);
  if (o.names.empty())
    throw Error("series", "which histories?", "give names or globs, such as energy or \"joint.*\", or --list", Exit::usage);
  const auto picked = pick(file, o.names);
  if (!o.png.empty()) write_png(o, file, picked);
  if (!o.csv.empty() || o.png.empty()) {
    Options to = o;
    if (to.csv.empty()) to.csv = "-";
    write_csv(to, file, picked);
  }
}

}  // namespace

Command series_command(CLI::App& app) {
  auto* sub = app.add_subcommand("series", "histories (reactions, energies, probes, ...) as CSV or as a chart");
  const auto o = std::make_shared<Options>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("names", o->names, "histories or columns by name or glob: energy, joint.trunnion, \"joint.*.Fx\"");
  sub->add_option("-o,--output", o->csv, "CSV file; stdout when neither this nor --png is given");
  sub->add_option("--png", o->png, "chart, one panel for each unit");
  sub->add_option("--title", o->title, "title of the chart");
  sub->add_option("--size", o->size, "size of the chart, WIDTHxHEIGHT")->capture_default_str();
  sub->add_flag("--list", o->list, "list the histories there are");
  sub->add_flag("--json", o->json, "the list as JSON");
  example(*sub, "  hilo-post series run.h5 energy -o energy.csv --png energy.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
