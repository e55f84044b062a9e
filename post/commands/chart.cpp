// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post chart: a chart of any CSV files.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "post/charts/figure.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/picture/picture.hpp"

namespace hilo {
namespace {

constexpr const char* by_names = "--by groups by names";

struct ChartOptions {
  std::vector<std::string> files, y;
  std::string x, by, log, title, x_label, y_label, size = "1280x720", png;
  std::vector<double> x_range, y_range, slopes;
  bool markers = false, points = false;
};

/// The rows of a table that share a name in column `by`; all rows where there is none.
std::vector<std::pair<std::string, std::vector<size_t>>> groups(const CsvTable& table, const std::string& by) {
  std::vector<std::pair<std::string, std::vector<size_t>>> found;
  for (size_t row = 0; row < table.rows(); ++row) {
    const std::string name = by.empty() ? "" : table.column[table.find(by)][row];
    auto group = std::find_if(found.begin(), found.end(), [&](const auto& g) { return g.first == name; });
    if (group == found.end()) group = found.insert(found.end(), {name, {}});
    group->second.push_back(row);
  }
  return found;
}

std::string join(const std::string& a, const std::string& b) { return a.empty() || b.empty() ? a + b : a + ", " + b; }

void run(const ChartOptions& o) {
  Figure figure;
  figure.title = o.title;
  std::tie(figure.width, figure.height) = parse_size(o.size);
  Panel common;  // what all panels have
  auto& panel = common;
  panel.x.log = o.log.find('x') != std::string::npos;
  panel.y.log = o.log.find('y') != std::string::npos;
  const auto show = [](Axis& axis, const std::vector<double>& range, const char* option) {
    if (range.empty()) return;
    if (!(range[0] < range[1]) || (axis.log && range[0] <= 0))
      throw Error(option, fmt::format("{},{} is no range of this axis", range[0], range[1]), "LOW,HIGH with LOW < HIGH", Exit::usage);
    axis.low = range[0], axis.high = range[1];
  };
  show(panel.x, o.x_range, "--xrange"), show(panel.y, o.y_range, "--yrange");
  if (!o.slopes.empty() && o.log != "xy")
    throw Error("--slope", "a slope is a guide between logarithmic axes", "add --log xy", Exit::usage);
  for (const double slope : o.slopes) panel.guides.push_back({fmt::format("slope {:g}", std::abs(slope)), slope});
  // a panel for each unit: 250 MPa and 250 kN are not as high as each other
  std::vector<std::string> units;
  std::vector<size_t> columns_of;
  int n_curves = 0;
  Heading first;                                                    // of the abscissae: all are drawn in its unit
  const auto panel_of = [&](const std::string& header) -> Panel& {  // all in one where --ylabel says what it shows
    const std::string unit = !o.y_label.empty() || header.find('[') == header.npos ? "" : unit_in_heading(header);
    const auto at = std::find(units.begin(), units.end(), unit);
    const auto k = static_cast<size_t>(at - units.begin());
    if (at == units.end()) {
      units.push_back(unit), columns_of.push_back(0);
      figure.panels.push_back(common);
      figure.panels.back().y.label = header;
    }
    ++columns_of[k];
    return figure.panels[k];
  };
  for (const std::string& file : o.files) {
    const CsvTable table = read_csv(file);
    const size_t x = o.x.empty() ? 0 : table.find(o.x);
    std::vector<size_t> columns;
    for (const auto& name : o.y) columns.push_back(table.find(name));
    for (size_t c = 0; o.y.empty() && c < table.header.size(); ++c)
      if (c != x && (o.by.empty() || c != table.find(o.by))) columns.push_back(c);
    if (columns.empty()) throw Error(file, "has no column to draw", "two at least: x and y");
    if (first.text.empty()) first = {table.header[x], table.path};
    auto xs = table.numbers(x, by_names);
    for (double& value : xs) value *= unit_factor({table.header[x], table.path}, first);
    for (const size_t c : columns) {
      const auto ys = table.numbers(c, by_names);
      Panel& panel = panel_of(table.header[c]);
      for (const auto& [name, rows] : groups(table, o.by)) {
        ChartCurve curve;
        curve.label = join(o.files.size() > 1 ? std::filesystem::path(file).stem().string() : "", name);
        if (columns.size() > 1 || curve.label.empty()) curve.label = join(curve.label, without_unit(table.header[c]));
        for (const size_t row : rows) curve.x.push_back(xs[row]), curve.y.push_back(ys[row]);
        const int n = n_curves++;
        curve.marker = o.markers || o.points ? n : -1;
        if (o.points) curve.width = 0;
        curve.colour = curve_colour(n);
        curve.dashed = n % 2 != 0 && !o.by.empty();
        panel.curves.push_back(std::move(curve));
      }
    }
  }
  for (size_t k = 0; k < figure.panels.size(); ++k) {
    Panel& p = figure.panels[k];
    if (columns_of[k] > o.files.size()) p.y.label = units[k].empty() ? "" : "[" + units[k] + "]";  // their unit is all they have in common
    p.x.label = o.x_label.empty() ? first.text : o.x_label;
    if (!o.y_label.empty()) p.y.label = o.y_label;
    if (n_curves == 1) p.curves.front().label.clear();
  }
  write_chart(figure, o.png);
}

}  // namespace

Command chart_command(CLI::App& app) {
  auto* sub = app.add_subcommand("chart", "a chart of CSV files: a line of column names \"name [unit]\", then numbers");
  const auto o = std::make_shared<ChartOptions>();
  sub->add_option("files", o->files, "CSV files; - for stdin")->required();
  sub->add_option("-x", o->x, "column of the abscissa, by name or number from 1; the first by default; in the unit of the first file");
  sub->add_option("-y", o->y, "columns to draw, -y once for each; all others by default")->allow_extra_args(false);
  sub->add_option("--by", o->by, "column of names: one curve for each name");
  sub->add_option("--log", o->log, "logarithmic axes: x, y or xy")->check(CLI::IsMember({"x", "y", "xy"}));
  sub->add_flag("--markers", o->markers, "mark the points, each curve by a shape of its own");
  sub->add_flag("--points", o->points, "marks alone, without lines between them: rows that are no course");
  sub->add_option("--xrange", o->x_range, "LOW,HIGH: what the abscissa shows")->delimiter(',')->expected(2);
  sub->add_option("--yrange", o->y_range, "LOW,HIGH: what the ordinate shows")->delimiter(',')->expected(2);
  sub->add_option("--slope", o->slopes, "guide y ~ x^SLOPE, --slope once for each; needs --log xy")->allow_extra_args(false);
  sub->add_option("--title", o->title, "title");
  sub->add_option("--xlabel", o->x_label, "label of the abscissa, with its unit in brackets");
  sub->add_option("--ylabel", o->y_label, "label of the ordinate, with its unit in brackets; without it each unit has a panel of its own");
  sub->add_option("--size", o->size, "size of the chart, WIDTHxHEIGHT")->capture_default_str();
  sub->add_option("-o,--output", o->png, "PNG file")->required();
  example(*sub, "  hilo-post chart energy.csv -y energy.balance --title \"Energy balance\" -o balance.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
