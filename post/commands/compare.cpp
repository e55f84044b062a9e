// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post compare: how far tables or runs are from the first of them, column by column.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/run/columns.hpp"
#include "post/scene/frame_options.hpp"

namespace hilo {
namespace {

struct CompareOptions {
  std::vector<std::string> files, y;
  std::string x;
  bool json = false;
};

/// Columns over a rising abscissa.
struct Curves {
  std::string path, name, x_title;
  std::vector<double> x;
  std::vector<std::pair<std::string, std::vector<double>>> y;  // title, values
  std::map<std::string, size_t> place;                         // of the first with a title
  const std::vector<double>* find(const std::string& title) const {
    const auto found = place.find(title);
    return found == place.end() ? nullptr : &y[found->second].second;
  }
};

std::string title_of(const Column& c) { return fmt::format("{} [{}]", c.label, c.unit); }

Curves of_run(const CompareOptions& o, const std::string& path) {
  const RunFile run = judged_run(path);
  RunColumns columns(run, {});
  if (run.series_names().empty()) throw Error(path, "holds no history");
  const auto picked = columns.pick(o.y.empty() ? std::vector<std::string>{"*"} : o.y);
  Curves c{path, "", "t [s]", picked.front().t, {}, {}};
  if (!o.x.empty()) {
    const Column x = columns.one(o.x);
    c.x = x.value, c.x_title = title_of(x);
  }
  for (const Column& p : picked) {
    const size_t rows = std::min(c.x.size(), p.t.size());
    if (!std::equal(p.t.begin(), p.t.begin() + static_cast<std::ptrdiff_t>(rows), picked.front().t.begin()))
      throw Error(path, fmt::format("\"{}\" and \"{}\" have different times", picked.front().label, p.label), "compare them one by one");
    c.y.emplace_back(title_of(p), p.value);
    c.y.back().second.resize(c.x.size(), std::numeric_limits<double>::quiet_NaN());
  }
  return c;
}

Curves of_table(const CompareOptions& o, const std::string& path) {
  const CsvTable table = read_csv(path);
  const size_t x = o.x.empty() ? 0 : table.find(o.x);
  Curves c{path, "", table.header[x], table.numbers(x), {}, {}};
  if (o.y.empty())
    for (size_t k = 0; k < table.header.size(); ++k)
      if (k != x) c.y.emplace_back(table.header[k], table.numbers(k));
  for (const auto& name : o.y) c.y.emplace_back(table.header[table.find(name)], table.numbers(table.find(name)));
  return c;
}

Curves read(const CompareOptions& o, const std::string& path) {
  Curves c = path.ends_with(".h5") ? of_run(o, path) : of_table(o, path);
  if (!std::all_of(c.x.begin(), c.x.end(), [](double x) { return std::isfinite(x); }) || !std::is_sorted(c.x.begin(), c.x.end()))
    throw Error(path, fmt::format("\"{}\" does not rise from row to row", c.x_title), "choose the abscissa with -x");
  for (size_t k = 0; k < c.y.size(); ++k) c.place.emplace(c.y[k].first, k);
  return c;
}

constexpr size_t nowhere = std::numeric_limits<size_t>::max();

/// For each row of b the row of a at the same abscissa, to a thousandth of the distance of rows there.
std::vector<size_t> matched(const Curves& a, const Curves& b) {
  std::vector<size_t> of(b.x.size(), nowhere);
  for (size_t j = 0, i = 0; j < b.x.size() && !a.x.empty(); ++j) {
    while (i + 1 < a.x.size() && std::abs(a.x[i + 1] - b.x[j]) < std::abs(a.x[i] - b.x[j])) ++i;
    const double spacing = i + 1 < a.x.size() ? a.x[i + 1] - a.x[i] : i > 0 ? a.x[i] - a.x[i - 1] : 0;
    if (std::abs(a.x[i] - b.x[j]) <= 1e-3 * spacing + 1e-12 * std::abs(a.x[i])) of[j] = i;
  }
  return of;
}

double peak_of(const std::vector<double>& values) {
  double peak = 0;
  for (const double v : values) peak = std::isfinite(v) ? std::max(peak, std::abs(v)) : peak;
  return peak;
}

std::string six_digits(double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x == 0 ? 0.0 : x) : "-"; }

void run(const CompareOptions& o) {
  std::vector<Curves> all;
  for (const auto& file : o.files) all.push_back(read(o, file));
  const auto names = distinct_names(o.files);
  for (size_t k = 0; k < all.size(); ++k) all[k].name = names[k];
  const Curves& first = all.front();

  std::vector<std::vector<size_t>> row(all.size());
  for (size_t k = 1; k < all.size(); ++k) {
    const double factor = unit_factor({all[k].x_title, all[k].path}, {first.x_title, first.path});
    for (double& x : all[k].x) x *= factor;
    row[k] = matched(first, all[k]);
    const auto shared = row[k].size() - static_cast<size_t>(std::count(row[k].begin(), row[k].end(), nowhere));
    if (shared == 0) throw Error(all[k].path, fmt::format("has no {} in common with {}", first.x_title, first.path));
    if (!is_quiet() && shared < row[k].size())
      fmt::print(stderr, "{}: {} of its {} rows are at a {} of {}\n", all[k].path, shared, row[k].size(), first.x_title, first.path);
    std::vector<bool> met(first.x.size());
    for (const size_t i : row[k])
      if (i != nowhere) met[i] = true;
    if (const auto alone = std::count(met.begin(), met.end(), false); alone > 0)
      warn(all[k].path, fmt::format("{} of the {} rows of {} are not in it, and not compared", alone, met.size(), first.path));
  }
  Table table{{"column", "of", "start", "peak", "off by", "in % of peak", "at " + first.x_title}, {}, 2};
  for (const auto& [title, truth] : first.y) {
    std::vector<std::string> lacking;
    for (const Curves& c : all)
      if (!c.find(title)) lacking.push_back(c.path);
    if (!lacking.empty()) {
      if (!is_quiet()) fmt::print(stderr, "\"{}\" is not in {}: left out\n", title, lacking.front());
      continue;
    }
    const double peak = peak_of(truth);
    table.rows.push_back({title, first.name, six_digits(truth.empty() ? NAN : truth.front()), six_digits(peak), "-", "-", "-"});
    for (size_t k = 1; k < all.size(); ++k) {
      const auto& values = *all[k].find(title);
      double off = -1, at = NAN;
      size_t holes = 0;
      for (size_t j = 0; j < values.size(); ++j) {
        if (row[k][j] == nowhere) continue;
        if (!std::isfinite(values[j]) || !std::isfinite(truth[row[k][j]])) {
          ++holes;
          continue;
        }
        if (const double d = std::abs(values[j] - truth[row[k][j]]); d > off) off = d, at = all[k].x[j];
      }
      if (holes > 0)
        warn(all[k].path, fmt::format("\"{}\": {} of {} rows {} no number in one of the two, and {} not compared", title, holes,
                                      values.size(), holes == 1 ? "has" : "have", holes == 1 ? "is" : "are"));
      table.rows.push_back({title, all[k].name, six_digits(values.front()), six_digits(peak_of(values)), six_digits(off < 0 ? NAN : off),
                            six_digits(off < 0 || peak == 0 ? NAN : 100 * off / peak), six_digits(at)});
    }
  }
  if (table.rows.empty()) throw Error(first.path, "has no column in common with all the others");
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

}  // namespace

Command compare_command(CLI::App& app) {
  auto* sub = app.add_subcommand("compare", "how far tables or runs are from the first, at the instants that both have");
  const auto o = std::make_shared<CompareOptions>();
  sub->add_option("files", o->files, "CSV files as series writes them, or run.h5 of hilo-solve; the first is the measure")
      ->required()
      ->expected(2, 99);
  sub->add_option("-x", o->x, "column of the abscissa; the first, or the time of a run, by default; in the unit of the first file");
  sub->add_option("-y", o->y, "columns to compare, -y once for each (of runs: histories, globs or formulas as in series); all by default")
      ->allow_extra_args(false);
  sub->add_flag("--json", o->json, "the table as JSON");
  example(*sub, "  hilo-post compare run.h5 run.h5 -y energy -y 'joint.*'");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
