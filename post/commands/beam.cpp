// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post beam: forces, moments and stress along beams.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/charts/figure.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/picture/picture.hpp"
#include "post/run/run_beams.hpp"
#include "post/run/times.hpp"

namespace hilo {
namespace {

struct BeamOptions {
  std::string run, csv, png, size = "1280x900", title, times;
  std::vector<std::string> names;
  bool envelope = false, json = false, sections = false;
};

constexpr const char *value_words[] = {"V1", "V2", "N", "M1", "M2", "T", "high", "low", "von_mises"},
                     *value_units[] = {"N", "N", "N", "N m", "N m", "N m", "Pa", "Pa", "Pa"};
constexpr size_t n_beam_values = std::size(value_words);

/// The values at a section: forces and moments, and stress where the section has a face, else not a number.
using BeamValues = std::array<double, n_beam_values>;
BeamValues values_at(const RunBeam::Section& section, const Vec6& f) {
  BeamValues v;
  std::copy_n(f.data(), 6, v.begin());
  std::fill_n(v.begin() + 6, 3, std::nan(""));
  if (!section.face) return v;
  const StressRange r = stress_range(*section.face, f);
  v[6] = r.high, v[7] = r.low, v[8] = r.von_mises;
  return v;
}

/// Both ends of the cells of beams one after the other, s from the first of them on.
struct Station {
  const RunBeam* beam;
  size_t cell;
  int end;
  double s;
  size_t section() const { return cell + static_cast<size_t>(end); }
};

struct Chain {
  std::vector<Station> stations;
  std::map<std::string, Series> forces;
  BeamValues at(const Station& p, size_t row) const {
    return values_at(p.beam->section(p.section()), beam_forces(forces.at(p.beam->name), row, p.cell, p.end));
  }
};

Chain chain_of(const RunFile& run, const std::vector<std::string>& globs) {
  Chain chain;
  std::vector<std::string> all;
  for (const RunBeam& b : run.beams())
    if (b.bears) all.push_back(b.name);
  if (all.empty() && !run.beams().empty())
    throw Error(run.path, "its beams are rigid: what they bear is not known", "fidelity = \"linear\"");
  if (all.empty()) throw Error(run.path, "has no beams", "write [beam.NAME] into the scene");
  double from = 0;
  for (const std::string& glob : globs) {
    bool any = false;
    for (const RunBeam& b : run.beams()) {
      if (!b.bears || !matches(glob, b.name)) continue;
      any = true;
      if (!chain.forces.emplace(b.name, run.series("beam." + b.name)).second) continue;
      for (size_t k = 0; k < b.line.cells.size(); ++k)
        for (const int end : {0, 1}) chain.stations.push_back({&b, k, end, from + b.line.s[k + static_cast<size_t>(end)]});
      from += b.line.s.back();
    }
    if (any) continue;
    const std::string near = suggest(glob, all);
    throw Error(run.path, fmt::format("no beam \"{}\"", glob), near.empty() ? fmt::format("there is {}", all.front()) : near);
  }
  return chain;
}

/// The steps that --times asks for, of those that all beams have: a run in progress may be a row ahead in one array.
std::vector<size_t> chosen_rows(const Chain& chain, const char* by_default, const std::string& times, const RunFile& run) {
  const Series* shortest = nullptr;
  for (const auto& [name, forces] : chain.forces)
    if (!shortest || forces.rows() < shortest->rows()) shortest = &forces;
  const auto n_rows = static_cast<std::ptrdiff_t>(shortest->rows());
  return choose_instants({shortest->t.begin(), shortest->t.begin() + n_rows}, by_default, times, run.path, "step");
}

std::string header_of(size_t k, const std::string& more = "") { return fmt::format("{}{} [{}]", value_words[k], more, value_units[k]); }

/// Every beam with the largest of what it bears over all steps, or those of --times, where and when its largest stress is.
void overview(const BeamOptions& o, const RunFile& run) {
  Table table{
      {"beam", "cells", "N [N]", "V [N]", "M [N m]", "T [N m]", "high [Pa]", "low [Pa]", "von_mises [Pa]", "s [m]", "t [s]"}, {}, 1, 6};
  const Chain chain = chain_of(run, o.names);
  const std::vector<size_t> rows = chosen_rows(chain, "all", o.times, run);
  for (const RunBeam& b : run.beams()) {
    if (!chain.forces.contains(b.name)) continue;
    double N = 0, V = 0, M = 0, T = 0, s = 0, t = 0;
    StressRange most{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), -1};
    for (const Station& p : chain.stations) {
      if (p.beam != &b) continue;
      const Series& forces = chain.forces.at(b.name);
      for (const size_t row : rows) {
        const BeamValues v = chain.at(p, row);
        if (std::abs(v[2]) > std::abs(N)) N = v[2];
        V = std::max(V, std::hypot(v[0], v[1])), M = std::max(M, std::hypot(v[3], v[4]));
        if (std::abs(v[5]) > std::abs(T)) T = v[5];
        most.high = std::max(most.high, v[6]), most.low = std::min(most.low, v[7]);
        if (v[8] > most.von_mises) most.von_mises = v[8], s = b.line.s[p.section()], t = forces.t[row];
      }
    }
    std::vector<std::string> row{b.name, fmt::format("{}", b.line.cells.size())};
    for (const double x : {N, V, M, T}) row.push_back(fmt::format("{:.6g}", x));
    for (const double x : {most.high, most.low, most.von_mises, s, t}) row.push_back(b.has_face() ? fmt::format("{:.6g}", x) : "-");
    table.rows.push_back(row);
  }
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

/// The numbers of the section of every beam; of a taper those of each section.
void sections(const BeamOptions& o, const RunFile& run) {
  Table table{{"beam", "A [m^2]", "I1 [m^4]", "I2 [m^4]", "I12 [m^4]", "J [m^4]", "k1", "k2", "k12", "s1 [m]", "s2 [m]"}, {}, 1, 6};
  const Chain chain = chain_of(run, o.names);
  for (const RunBeam& b : run.beams()) {
    if (!chain.forces.contains(b.name)) continue;
    for (size_t k = 0; k < b.sections.size(); ++k) {
      auto& row = table.rows.emplace_back(std::vector<std::string>{b.sections.size() > 1 ? fmt::format("{}.{}", b.name, k) : b.name});
      const SectionArea a = b.section(k).area.value_or(SectionArea{});
      for (const double x : {a.A, a.I1, a.I2, a.I12, a.J, a.shear_1, a.shear_2, a.shear_12, a.s1, a.s2})
        row.push_back(b.section(k).area ? fmt::format("{:.6g}", x) : "-");
    }
  }
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

/// BeamCurves over s: those of a time, or the least and the largest of all steps.
struct BeamCurves {
  std::string label;
  std::array<std::vector<double>, n_beam_values> value;
};

void write_png(const BeamOptions& o, const RunFile& run, const std::vector<double>& s, const std::vector<BeamCurves>& curves) {
  Figure figure;
  std::tie(figure.width, figure.height) = parse_size(o.size);
  figure.title = !o.title.empty() ? o.title : fmt::format("{}: {}", run.title, fmt::join(o.names, ", "));
  constexpr std::pair<const char*, std::array<size_t, 3>> panels[] = {
      {"force [N]", {2, 0, 1}}, {"moment [N m]", {3, 4, 5}}, {"stress [Pa]", {6, 7, 8}}};
  for (const auto& [label, of] : panels) {
    Panel panel{"", {"along the beam [m]"}, {label}, {}};
    for (size_t c = 0; c < curves.size(); ++c)
      for (size_t i = 0; i < of.size(); ++i) {
        const std::vector<double>& y = curves[c].value[of[i]];
        if (std::none_of(y.begin(), y.end(), [](double x) { return std::isfinite(x); })) continue;
        const size_t colour = o.envelope ? i : 3 * c + i;
        panel.curves.push_back({fmt::format("{}{}", value_words[of[i]], curves[c].label), s, y, curve_colour(static_cast<int>(colour))});
        panel.curves.back().dashed = o.envelope && c == 0;
      }
    if (!panel.curves.empty()) figure.panels.push_back(std::move(panel));
  }
  write_chart(figure, o.png);
}

void run(const BeamOptions& o) {
  const RunFile run = judged_run(o.run);
  if (o.sections) {
    BeamOptions all = o;
    if (o.names.empty()) all.names = {"*"};
    return sections(all, run);
  }
  if (o.names.empty() || (o.envelope && o.csv.empty() && o.png.empty())) {
    BeamOptions all = o;
    if (o.names.empty()) all.names = {"*"};
    if (!o.csv.empty() || !o.png.empty()) throw Error("beam", "which beams?", "give names or globs", Exit::usage);
    return overview(all, run);
  }
  const Chain chain = chain_of(run, o.names);
  const Series& first = chain.forces.begin()->second;
  const std::vector<size_t> rows = chosen_rows(chain, o.envelope ? "all" : "last", o.times, run);
  std::vector<double> s;
  for (const Station& p : chain.stations) s.push_back(p.s);
  std::vector<BeamCurves> curves(o.envelope ? 2 : rows.size());
  if (o.envelope) {
    curves[0].label = ", least", curves[1].label = ", largest";
    for (const Station& p : chain.stations) {
      BeamValues low = chain.at(p, rows.front()), high = low;
      for (const size_t row : rows) {
        const BeamValues v = chain.at(p, row);
        for (size_t k = 0; k < n_beam_values; ++k) low[k] = std::min(low[k], v[k]), high[k] = std::max(high[k], v[k]);
      }
      for (size_t k = 0; k < n_beam_values; ++k) curves[0].value[k].push_back(low[k]), curves[1].value[k].push_back(high[k]);
    }
  } else {
    for (size_t c = 0; c < rows.size(); ++c) {
      if (rows.size() > 1) curves[c].label = fmt::format(", t = {:g} s", first.t[rows[c]]);
      for (const Station& p : chain.stations) {
        const BeamValues v = chain.at(p, rows[c]);
        for (size_t k = 0; k < n_beam_values; ++k) curves[c].value[k].push_back(v[k]);
      }
    }
  }
  if (!o.png.empty()) write_png(o, run, s, curves);
  if (!o.png.empty() && o.csv.empty()) return;

  std::vector<std::string> header;
  std::vector<std::vector<double>> columns;
  if (o.envelope) {
    header = {"s [m]"}, columns = {s};
    for (size_t k = 0; k < n_beam_values; ++k)
      for (const BeamCurves& c : curves) header.push_back(header_of(k, c.label.substr(1))), columns.push_back(c.value[k]);
  } else {
    header = {"t [s]", "s [m]"}, columns.resize(2 + n_beam_values);
    for (size_t k = 0; k < n_beam_values; ++k) header.push_back(header_of(k));
    for (size_t c = 0; c < curves.size(); ++c) {
      columns[0].insert(columns[0].end(), s.size(), first.t[rows[c]]), columns[1].insert(columns[1].end(), s.begin(), s.end());
      for (size_t k = 0; k < n_beam_values; ++k)
        columns[2 + k].insert(columns[2 + k].end(), curves[c].value[k].begin(), curves[c].value[k].end());
    }
  }
  if (!o.csv.empty()) return write_out(o.csv, csv_text(header, columns));
  Table table{header, {}, 0, 6};
  table.header.insert(table.header.begin(), {"beam", "cell"});
  table.n_text = 2;
  for (size_t i = 0; i < columns.front().size(); ++i) {
    const Station& p = chain.stations[i % s.size()];
    auto& row = table.rows.emplace_back(std::vector<std::string>{p.beam->name, fmt::format("{}.{}", p.cell, p.end == 0 ? "a" : "b")});
    for (const auto& column : columns) row.push_back(std::isfinite(column[i]) ? fmt::format("{}", column[i]) : "-");
  }
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

}  // namespace

Command beam_command(CLI::App& app) {
  auto* sub = app.add_subcommand("beam", "forces, moments and stress along beams, as a table, CSV or a chart; what each bears at most");
  const auto o = std::make_shared<BeamOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("names", o->names, "beams by name or glob, one after the other; without any: the largest values of every beam");
  sub->add_option("--times", o->times,
                  "times in s, the nearest steps, or FROM:TO, all steps within; by default the last step along a beam, all steps for the "
                  "largest values");
  sub->add_flag("--envelope", o->envelope, "the least and the largest of all steps")->excludes("--times");
  sub->add_flag("--sections", o->sections,
                "the numbers of each section: area, second moments, torsion constant, factors of shear, shear centre")
      ->excludes("--times", "--envelope");
  sub->add_option("-o,--output", o->csv, "CSV file, - for stdout; a table on stdout when neither this nor --png is given");
  sub->add_option("--png", o->png, "chart over the length: forces, moments, stress");
  sub->add_option("--title", o->title, "title of the chart");
  sub->add_option("--size", o->size, "size of the chart, WIDTHxHEIGHT")->capture_default_str();
  sub->add_flag("--json", o->json, "the table as JSON");
  example(*sub,
          "  hilo-post beam run.h5\n"
          "  hilo-post beam run.h5 mast --times 0.05,0.1 -o mast.csv --png mast.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
