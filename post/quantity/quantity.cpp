// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/quantity/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "post/injury/cfc.hpp"
#include "post/injury/gload.hpp"
#include "post/injury/measures.hpp"
#include "post/run/field_peak.hpp"

namespace hilo {
namespace {

std::string component(const Entry& q, const char* fallback) { return q.has("component") ? q.text("component") : fallback; }

Column joint_column(const Entry& q, const RunFile& run) {
  const std::string what = component(q, "force");
  const Series s = run.series("joint." + q.text("joint"));
  Column c{"joint " + q.text("joint") + ": " + what, *unit_of(q), s.t, {}};
  const size_t first = what == "moment" ? 3 : 0;
  const auto one = std::find(s.column.begin(), s.column.end(), what);
  for (size_t row = 0; row < s.rows(); ++row)
    c.value.push_back(one != s.column.end() ? s.at(row, static_cast<size_t>(one - s.column.begin()))
                                            : std::hypot(s.at(row, first), s.at(row, first + 1), s.at(row, first + 2)));
  return c;
}

Column sensor_column(const Entry& q, const RunFile& run) {
  const std::string what = component(q, "resultant");
  const size_t axis = what == "resultant" ? 3 : static_cast<size_t>(what[0] - 'x');
  const std::string label = "sensor " + q.text("sensor") + ": " + what;
  if (q.has("cfc")) {
    const SensorRecord s = read_sensors(run.path, {q.text("sensor")}, q.number("cfc")).records.front();
    return {fmt::format("{}, CFC {:g}", label, q.number("cfc")), "g", s.uniform, s.filtered[axis]};
  }
  const Series s = run.series("sensor." + q.text("sensor"));
  Column c{label + ", raw", "g", s.t, {}};
  for (size_t row = 0; row < s.rows(); ++row)
    c.value.push_back(axis < 3 ? s.at(row, axis) : std::hypot(s.at(row, 0), s.at(row, 1), s.at(row, 2)));
  return c;
}

Column stress_column(const Entry& q, RunFile& run) {
  const MeshFile& file = run.mesh_file();
  const std::string& region = q.text("stress");
  const auto& names = file.mesh.region_name;
  const auto found = std::find(names.begin(), names.end(), region);
  if (found == names.end()) throw Error(q.where("stress"), fmt::format("no region \"{}\"", region), suggest(region, names));
  const auto r = static_cast<size_t>(found - names.begin());
  if (file.fidelity[r] == Fidelity::rigid)
    throw Error(q.where("stress"), fmt::format("\"{}\" is rigid in this run, without stress", region), "tag it linear");
  std::vector<bool> wanted(names.size());
  wanted[r] = true;
  Column c{"von Mises stress in " + region, "Pa", {}, {}};
  for (const Step& step : run.steps) {
    c.t.push_back(step.t);
    c.value.push_back(
        field_peaks(run, {step}, wanted, [&](const Step& s, int of) { return run.field_in(of, s, "von_mises").value; })[r].value);
  }
  return c;
}

/// The distance of two probes, or that of the third from the line through the others, less what it was at the start.
Column between_column(const Entry& q, const RunFile& run) {
  const auto& names = q.texts("between");
  std::vector<Series> probes;
  for (const std::string& name : names) probes.push_back(run.series("probe." + name));
  Column c{"between " + names[0] + " and " + names[1], "m", probes[0].t, {}};
  if (names.size() == 3) c.label = names[2] + " off the line " + names[0] + ", " + names[1];
  const auto at = [&](size_t p, size_t row) { return Vec3(probes[p].at(row, 0), probes[p].at(row, 1), probes[p].at(row, 2)); };
  for (size_t row = 0; row < c.t.size(); ++row) {
    const Vec3 line = at(1, row) - at(0, row);
    const double d = names.size() == 2 ? line.norm() : line.cross(at(2, row) - at(0, row)).norm() / line.norm();
    c.value.push_back(row == 0 ? d : d - c.value[0]);
  }
  if (!c.value.empty()) c.value[0] = 0;
  return c;
}

/// Root of the mean square, by the trapezoid rule of squares: of smooth vibrations it lacks nothing, where straight lines between samples
/// cut their peaks, and of a jump between two samples it is the mean over all places of it.
double rms(const Column& c) {
  double sum = 0;
  for (size_t i = 1; i < c.t.size(); ++i) {
    const double a = c.value[i - 1], b = c.value[i];
    sum += (c.t[i] - c.t[i - 1]) * (a * a + b * b) / 2;
  }
  return std::sqrt(sum / (c.t.back() - c.t.front()));
}

void evaluate(const Entry& q, RunFile& run, QuantityValue& v) {
  if (is_of_shapes(q.kind)) {
    const bool buckles = q.kind == "load_factor";
    const auto mode = static_cast<size_t>(q.number("mode"));
    v.of = fmt::format("{} {}", buckles ? "shape" : "mode", mode);
    if (run.shapes.empty() || run.buckles != buckles)
      throw Error(q.where("mode"), fmt::format("the run is no analysis of {}", buckles ? "buckling" : "modes"),
                  fmt::format("time.analysis = \"{}\"", buckles ? "buckling" : "modes"));
    if (mode >= run.shapes.size()) throw Error(q.where("mode"), fmt::format("{} were found", run.shapes.size() - 1), "raise time.modes");
    v.value = run.shapes[mode];  // the first is the state of rest
    return;
  }
  if (!run.shapes.empty()) throw Error(q.place.text(), "an analysis of modes or buckling has no histories in time");
  if (q.kind == "injury") {
    v.of = fmt::format("sensor {}: {}", q.text("sensor"), q.text("measure"));
    const Crew crew = crew_of(read_sensors(run.path, {q.text("sensor")}, q.number("cfc")).records.front(), q.number("cfc"));
    std::vector<std::string> keys;
    for (const InjuryMeasure& m : crew.measures) {
      keys.push_back(m.key);
      if (m.key == q.text("measure")) v.value = m.value, v.unit = m.unit;
    }
    if (v.unit.empty())
      throw Error(q.where("measure"), fmt::format("no measure \"{}\"", q.text("measure")), suggest(q.text("measure"), keys));
    if (!std::isfinite(v.value)) throw Error(q.where("measure"), "the run is too short, or its steps too long, for it");
    return;
  }
  const Column c = history_of(q, run);
  v.of = c.label, v.unit = c.unit;
  if (q.has("stress")) v.measured = Measured::stress;
  if (q.has("sensor") && !q.has("cfc")) v.measured = Measured::raw_acceleration;
  for (size_t i = 0; i < c.value.size(); ++i)
    if (!std::isfinite(c.value[i])) throw Error(q.place.text(), fmt::format("its value is not a number at t = {:.6g} s", c.t[i]));
  if (c.t.size() < 2) throw Error(q.place.text(), "it has one value in this run, not a history in time");
  if (q.kind == "rms") {
    v.value = rms(c);
  } else if (q.kind == "at") {
    v.t = v.until = q.number("t");
    if (v.t > c.t.back() * (1 + 1e-9)) throw Error(q.where("t"), fmt::format("its history ends at {:g} s", c.t.back()));
    v.value = interpolate(c.t, c.value, std::vector{v.t}).front();
  } else {
    const size_t i = peak_index(c.value);
    v.value = c.value[i], v.t = c.t[i];
    size_t last = c.value.size() - 1;
    while (std::abs(c.value[last]) < std::abs(v.value) / 2) --last;
    v.until = c.t[last];
  }
}

}  // namespace

Column history_of(const Entry& q, RunFile& run) {
  if (q.has("joint")) return joint_column(q, run);
  if (q.has("stress")) return stress_column(q, run);
  if (q.has("sensor")) return sensor_column(q, run);
  if (q.has("between")) return between_column(q, run);
  return RunColumns(run, {}).one(q.text("formula"));
}

std::vector<QuantityValue> quantities(const Scene& scene, RunFile& run) {
  std::vector<QuantityValue> out;
  for (const Entry& q : scene.entries("quantity")) {
    QuantityValue v;
    v.name = q.name, v.kind = q.kind, v.unit = unit_of(q).value_or("");
    try {
      evaluate(q, run, v);
    } catch (const Error& e) {
      v.why = fmt::format("{}: quantity \"{}\": {}{}", e.where.empty() ? q.place.text() : e.where, q.name, e.message,
                          e.hint.empty() ? "" : " (" + e.hint + ")");
    }
    if (q.has("tolerance")) v.tolerance = q.text("tolerance");
    if (q.has("tolerance") && v.why.empty()) v.allowed = parse_tolerance(v.tolerance, v.unit, q.where("tolerance")).allowed(v.value);
    out.push_back(std::move(v));
  }
  return out;
}

Table quantity_table(const std::vector<QuantityValue>& values) {
  Table table{{"quantity", "kind", "of", "unit", "tolerance", "value", "t", "allowed"}, {}, 5, 6};
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format("{:.12g}", x) : "-"; };
  for (const QuantityValue& v : values)
    table.rows.push_back(
        {v.name, v.kind, v.of, v.unit, v.tolerance.empty() ? "-" : v.tolerance, cell(v.value), cell(v.t), cell(v.allowed)});
  return table;
}

}  // namespace hilo
