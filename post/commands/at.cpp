// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post at: a field at a node, at a material point or along a line.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/charts/ticks.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/files/output.hpp"
#include "post/run/field_peak.hpp"
#include "post/run/locate.hpp"
#include "post/scene/shown_field.hpp"

namespace hilo {
namespace {

struct AtOptions {
  std::string run, field, point, steps = "all", times, unit, csv;
  std::vector<std::string> line, show, hide;
  std::int64_t node = -1;
  int n = 50;
  bool json = false;
};

Vec3 parse_point(const std::string& text, const char* option) {
  Vec3 p;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &p.x(), &p.y(), &p.z(), &rest) != 3 || !p.allFinite())
    throw Error(option, fmt::format("\"{}\" is no point", text), "x,y,z in m, as 0.1,0,0.02", Exit::usage);
  return p;
}

/// Where values are asked for; `where[i].cell` is -1 at points of a line that lie in no cell.
struct Places {
  std::vector<Vec3> X;
  std::vector<Located> where;
};

Located at_node(const Mesh& mesh, std::int64_t node, const std::vector<bool>& wanted, const std::string& path, const std::string& label) {
  if (node < 0 || node >= mesh.n_nodes())
    throw Error("--node", fmt::format("no node {}", node), fmt::format("{} has 0 to {}", path, mesh.n_nodes() - 1), Exit::usage);
  std::string regions;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    for (const std::int64_t n : mesh.cell(c)) {
      if (n != node) continue;
      const auto region = static_cast<size_t>(mesh.region[static_cast<size_t>(c)]);
      if (wanted[region]) return {c, {node}, {1}, 0};
      regions = mesh.region_name[region];
    }
  throw Error("--node", fmt::format("node {} is of region \"{}\", which is rigid or not shown: no {} there", node, regions, label));
}

Located at_point(const Mesh& mesh, const Vec3& X, const std::vector<bool>& wanted, const std::string& label) {
  Located at = locate(mesh, wanted, X);
  if (at.cell >= 0) return at;
  const std::vector<bool> all(wanted.size(), true);
  const std::string what = fmt::format("{:g},{:g},{:g}", X[0], X[1], X[2]);
  if (const Located other = locate(mesh, all, X); other.cell >= 0)
    throw Error("--point", fmt::format("{} is in region \"{}\", which is rigid or not shown: no {} there", what,
                                       mesh.region_name[static_cast<size_t>(mesh.region[static_cast<size_t>(other.cell)])], label));
  const NearestRegion nearest = nearest_region(mesh, wanted, X);
  throw Error("--point", fmt::format("{} lies in no cell", what),
              nearest.region < 0
                  ? ""
                  : fmt::format("region \"{}\" is {:.4g} m away", mesh.region_name[static_cast<size_t>(nearest.region)], nearest.distance));
}

Places places(const AtOptions& o, RunFile& run, const std::vector<bool>& wanted, const std::string& label) {
  const Mesh& mesh = run.mesh();
  Places p;
  if (o.node >= 0) {
    p.where = {at_node(mesh, o.node, wanted, run.path, label)};
    p.X = {mesh.X[static_cast<size_t>(o.node)]};
  } else if (!o.point.empty()) {
    p.X = {parse_point(o.point, "--point")};
    p.where = {at_point(mesh, p.X.front(), wanted, label)};
  } else {
    const Vec3 from = parse_point(o.line[0], "--line"), to = parse_point(o.line[1], "--line");
    int outside = 0;
    for (int i = 0; i < o.n; ++i) {
      p.X.emplace_back(from + (to - from) * (static_cast<double>(i) / (o.n - 1)));
      p.where.push_back(locate(mesh, wanted, p.X.back()));
      outside += p.where.back().cell < 0;
    }
    if (outside == o.n) throw Error("--line", fmt::format("none of {} points lies in a cell that has {}", o.n, label));
    if (outside > 0) warn("--line", fmt::format("{} of {} points lie in no cell that has {}: no value there", outside, o.n, label));
  }
  for (Located& at : p.where) {
    for (size_t a = at.nodes.size(); a-- > 0;) {  // on a face, nodes off it have no share
      if (run.holds(at.nodes[a])) continue;
      if (std::abs(at.N[a]) > most_outside)
        throw Error(run.path, "holds the fields of the skin alone, and the place lies inside", "run with output.nodes = \"all\"");
      at.nodes.erase(at.nodes.begin() + static_cast<std::ptrdiff_t>(a)), at.N.erase(at.N.begin() + static_cast<std::ptrdiff_t>(a));
    }
  }
  return p;
}

/// What is shown of a field: one number, or all components, of vectors with the size.
struct Shown {
  ShownField field;
  std::vector<std::string> columns;
  std::vector<double> of(const RunFile::Field& raw, const Located& at) const {
    const auto width = static_cast<size_t>(raw.columns);
    std::vector<double> x(width, at.cell < 0 ? std::nan("") : 0.);
    for (size_t a = 0; a < at.nodes.size(); ++a)
      for (size_t c = 0; c < width; ++c) x[c] += at.N[a] * raw.value.at(static_cast<size_t>(at.nodes[a]) * width + c);
    if (field.component >= 0) return {x.at(static_cast<size_t>(field.component))};
    if (columns.size() == width + 1) x.push_back(std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
    return x;
  }
};

/// Of all steps at once.
bool is_envelope(const std::string& name) { return name.find("_envelope") != name.npos; }

Shown shown(const std::string& name, const std::vector<std::string>& known) {
  if (is_named_field(name)) throw Error("FIELD", fmt::format("{} is a name, not a number", name), "", Exit::usage);
  if (const auto components = components_of(name); !components.empty()) {
    Shown s{shown_field(name + "." + components.front(), known), {}};
    s.field.component = -1, s.field.label = name;
    for (const std::string& c : components) s.columns.push_back(fmt::format("{}.{}", name, c));
    return s;
  }
  Shown s{shown_field(name, known), {name}};
  if (s.field.component < 0 && (s.field.unit.starts_with("m") || name == "shell_axis") && !is_envelope(name))  // a vector
    s.columns = {name + ".x", name + ".y", name + ".z", name};
  return s;
}

void run(const AtOptions& o) {
  if ((o.node >= 0) + !o.point.empty() + !o.line.empty() != 1)
    throw Error("at", "where?", "give one of --node N, --point x,y,z and --line x,y,z x,y,z", Exit::usage);
  RunFile run = judged_run(o.run);
  const MeshFile& file = run.mesh_file();
  const auto steps = run.select_steps(is_envelope(o.field) ? "last" : o.steps, is_envelope(o.field) ? "" : o.times);
  const Shown shown = hilo::shown(o.field, run.fields(steps.front()));
  std::vector<bool> wanted = shown_regions(file.mesh, o.show, o.hide);
  for (size_t r = 0; r < wanted.size(); ++r)
    if (shown.field.flexible_only && file.fidelity[r] == Fidelity::rigid) wanted[r] = false;
  std::ignore = warn_of_envelope(run, wanted, o.field);
  const Places at = places(o, run, wanted, shown.field.label);

  const size_t n_values = shown.columns.size();
  std::vector<std::vector<double>> columns((o.line.empty() ? 1 : 5) + n_values);  // t, along a line s X Y Z, values
  double largest = 0;
  for (const Step& step : steps) {
    std::map<int, RunFile::Field> of_region;  // that have values of their own; -1: of nodes
    const auto field_at = [&](const Located& there) -> const RunFile::Field& {
      int r = there.cell < 0 ? -1 : file.mesh.region[static_cast<size_t>(there.cell)];
      if (run.own_nodes(r).empty()) r = -1;
      const auto found = of_region.find(r);
      return found != of_region.end() ? found->second : of_region.emplace(r, run.field_in(r, step, shown.field.array)).first->second;
    };
    const RunFile::Field& raw = field_at({});
    if (raw.value.size() != static_cast<size_t>(file.mesh.n_nodes() * raw.columns))
      throw Error(run.path, fmt::format("step {} holds {} numbers for {} nodes", step.key, raw.value.size(), file.mesh.n_nodes()),
                  "the mesh was changed after the run");
    for (size_t i = 0; i < at.X.size(); ++i) {
      std::vector<double> row{step.t};
      if (!o.line.empty()) row.insert(row.end(), {(at.X[i] - at.X[0]).norm(), at.X[i][0], at.X[i][1], at.X[i][2]});
      for (const double x : shown.of(field_at(at.where[i]), at.where[i])) {
        row.push_back(x);
        if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
      }
      if (row.size() != columns.size())
        throw Error(run.path, fmt::format("field \"{}\" has {} columns", shown.field.array, raw.columns),
                    "the file was not written by hilo-solve");
      for (size_t c = 0; c < row.size(); ++c) columns[c].push_back(row[c]);
    }
  }
  const ShownUnit unit = o.unit.empty() ? handy_unit(shown.field.unit, largest) : wanted_unit(shown.field.unit, o.unit);
  std::vector<std::string> header{"t [s]"};
  if (!o.line.empty()) header.insert(header.end(), {"s [m]", "X [m]", "Y [m]", "Z [m]"});
  for (const auto& name : shown.columns) header.push_back(fmt::format("{} [{}]", name, unit.name));
  for (size_t c = columns.size() - n_values; c < columns.size(); ++c)
    for (double& x : columns[c]) x *= unit.factor;
  if (!o.csv.empty()) return write_out(o.csv, csv_text(header, columns));
  Table table{header, {}, 0, 6};
  for (size_t i = 0; i < columns.front().size(); ++i) {
    auto& row = table.rows.emplace_back();
    for (const auto& column : columns) row.push_back(std::isfinite(column[i]) ? fmt::format("{}", column[i]) : "-");
  }
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

}  // namespace

Command at_command(CLI::App& app) {
  auto* sub = app.add_subcommand("at", "a field at a node, at a material point or along a line, over the outputs of a run");
  const auto o = std::make_shared<AtOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("field", o->field,
                  "von_mises, stress_error, plastic_strain, contact_pressure, stress, acceleration, displacement, velocity, or a "
                  "component: stress.xx, "
                  "velocity.z, shell_force; von_mises_envelope of a run with output.envelope")
      ->required();
  sub->add_option("--node", o->node, "number of a node, as peak prints it (from 0)")->check(CLI::NonNegativeNumber);
  sub->add_option("--point", o->point, "x,y,z in m of a material point: where it is in the mesh, before it moves");
  sub->add_option("--line", o->line, "two points x,y,z: points of the mesh from the first to the second")->expected(2);
  sub->add_option("-n", o->n, "points on the line, ends included")->check(CLI::Range(2, 1000000))->capture_default_str();
  sub->add_option("--steps", o->steps, "all, first, last or numbers: 0,5,10:20")->capture_default_str();
  sub->add_option("--times", o->times, "times in s, or FROM:TO, instead of --steps: the nearest ones");
  sub->add_option("--show", o->show, "regions, by name or glob; all by default")->allow_extra_args(false);
  sub->add_option("--hide", o->hide, "regions to leave out")->allow_extra_args(false);
  sub->add_option("--unit", o->unit, "unit shown: MPa, mm, g, ...; a handy one by default");
  sub->add_option("-o,--output", o->csv, "CSV file (- for stdout) instead of the table");
  sub->add_flag("--json", o->json, "the table as JSON");
  example(*sub,
          "  hilo-post at run.h5 displacement --node 0 --times 0.02\n"
          "  hilo-post at run.h5 von_mises --line 0.25,0,0 0.55,0,0 -n 5 --steps last --unit MPa");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
