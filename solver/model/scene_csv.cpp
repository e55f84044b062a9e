// SPDX-License-Identifier: GPL-3.0-or-later
// CSV files of a scene: load histories (also from the keys t and value), rows of numbers, points, grids of heights.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>

#include "base/spline.hpp"
#include "base/units.hpp"
#include "model/height_grid.hpp"
#include "model/scene_read.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

std::string_view trim_cell(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r"), last = s.find_last_not_of(" \t\r");
  return first == s.npos ? "" : s.substr(first, last - first + 1);
}

bool is_separator(char c) { return c == ',' || c == ';' || c == '\t'; }

struct Field {
  std::string_view text;
  int column;
};

/// Fields between commas, semicolons or tabs; these may stand in a field in double quotes.
std::vector<Field> fields_of(std::string_view line) {
  std::vector<Field> fields;
  for (size_t begin = 0; begin <= line.size();) {
    size_t end = begin;
    for (bool quoted = false; end < line.size() && (quoted || !is_separator(line[end])); ++end)
      if (line[end] == '"' && (quoted || trim_cell(line.substr(begin, end - begin)).empty() || line[end - 1] == '"')) quoted = !quoted;
    const std::string_view raw = line.substr(begin, end - begin);
    const size_t blank = std::min(raw.find_first_not_of(" \r"), raw.size());
    std::string_view text = trim_cell(raw);
    if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    fields.push_back({text, static_cast<int>(begin + blank + 1)});
    begin = end + 1;
  }
  return fields;
}

bool to_number(std::string_view s, double& x) {
  if (s.starts_with('+')) s.remove_prefix(1);
  const auto [end, code] = std::from_chars(s.data(), s.data() + s.size(), x);
  return code == std::errc() && end == s.data() + s.size() && std::isfinite(x);
}

/// Why point i may not follow the ones before it, or "".
std::string disorder(const std::vector<double>& t, size_t i) {
  if (i >= 1 && t[i] < t[i - 1]) return fmt::format("time {} comes after {}", t[i], t[i - 1]);
  if (i >= 2 && t[i] == t[i - 1] && t[i] == t[i - 2]) return fmt::format("time {} stands three times", t[i]);
  return "";
}
/// Not so what leads nowhere for another reason, such as a link in a circle: reading it tells.
bool is_missing(const std::string& path) {
  std::error_code error;
  return !std::filesystem::exists(path, error) && !error;
}

using PlaceOf = std::function<std::string(size_t)>;  // of a field, file:line:column

/// The lines that hold something, by their fields, one after the other.  Where the file ends is returned.
std::string each_line(const std::string& path, const std::string& where,
                      const std::function<void(const std::vector<Field>&, const PlaceOf&)>& use) {
  if (is_missing(path)) throw Error(where, fmt::format("no file {}", path), "paths in a scene are relative to the scene's folder");
  std::string text = read_text_file(path, where);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  int line_number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    if (trim_cell(line).empty() || trim_cell(line).starts_with('#')) continue;
    const auto fields = fields_of(line);
    use(fields, [&](size_t i) { return fmt::format("{}:{}:{}", path, line_number, fields[i].column); });
  }
  return fmt::format("{}:{}:1", path, line_number + (line_number == 0));
}

constexpr const char* order_rule = "times must rise; two equal ones make a jump";

}  // namespace

namespace {

/// Which of two headings names the time: "t [ms]" or "time"; the first where none does.
size_t time_column(const std::vector<Field>& heading, const PlaceOf& at) {
  bool is_time[2];
  for (size_t i = 0; i < 2; ++i) {
    std::string_view name = trim_cell(heading[i].text.substr(0, heading[i].text.find_first_of("[(")));
    is_time[i] = name == "t" || name == "T" || name == "time" || name == "Time";
  }
  if (is_time[0] && is_time[1]) throw Error(at(1), "both columns are named as times", "write \"t,value\" above the numbers");
  return is_time[1] ? 1 : 0;
}

}  // namespace

HistoryTable read_history_csv(const std::string& path, const std::string& where) {
  HistoryTable h;
  bool header = false;
  size_t first = 0;  // the column of the times
  const std::string last = each_line(path, where, [&](const std::vector<Field>& fields, const PlaceOf& at) {
    if (fields.size() != 2)
      throw Error(at(fields.size() > 2 ? 2 : 0),
                  fmt::format("{} column{} where two are expected: time and value", fields.size(), fields.size() == 1 ? "" : "s"));
    double x[2]{};
    const bool numeric = to_number(fields[0].text, x[0]);
    if (!header) {
      if (numeric) throw Error(at(0), "no header line", "write \"t,value\" above the first numbers");
      header = true, first = time_column(fields, at);
      for (size_t i = 0; i < 2; ++i) {
        const size_t k = i == 0 ? first : 1 - first;
        h.unit[i] = unit_in_heading(fields[k].text), h.place[i] = at(k);
      }
      return;
    }
    for (size_t i = 0; i < 2; ++i)
      if (!to_number(fields[i].text, x[i])) throw Error(at(i), fmt::format("\"{}\" is not a number", fields[i].text));
    h.t.push_back(x[first]);
    h.value.push_back(x[1 - first]);
    if (const auto why = disorder(h.t, h.t.size() - 1); !why.empty()) throw Error(at(first), why, order_rule);
  });
  if (h.t.empty()) throw Error(last, "no times and values", "a header line, then lines \"t,value\"");
  return h;
}

std::vector<std::vector<double>> read_rows_csv(const std::string& path, const std::string& where, const RowRule& rule) {
  std::vector<std::vector<double>> rows;
  size_t columns = 0;
  each_line(path, where, [&](const std::vector<Field>& fields, const PlaceOf& at) {
    const bool fits = columns == 0 ? rule.fits(fields.size()) : fields.size() == columns;
    if (!fits)
      throw Error(at(0), fmt::format("{} column{} where {} are expected", fields.size(), fields.size() == 1 ? "" : "s", rule.expected));
    std::vector<double> x(fields.size());
    if (columns == 0) {
      if (to_number(fields[0].text, x[0]))
        throw Error(at(0), "no header line", fmt::format("write \"{}\" above the first numbers", rule.header));
      columns = fields.size();
      return;
    }
    for (size_t k = 0; k < columns; ++k)
      if (!to_number(fields[k].text, x[k])) throw Error(at(k), fmt::format("\"{}\" is not a number", fields[k].text));
    rows.push_back(std::move(x));
  });
  return rows;
}

HeightGrid read_height_grid(const std::string& path, const std::string& where) {
  constexpr const char* form = "the first line is a word and the x of each column, the others a y and the heights there";
  HeightGrid grid;
  const std::string last = each_line(path, where, [&](const std::vector<Field>& fields, const PlaceOf& at) {
    const auto rising = [&](std::vector<double>& list, size_t k, char name) {
      double x = 0;
      if (!to_number(fields[k].text, x))
        throw Error(at(k), fmt::format("\"{}\" is not a number: {} is expected", fields[k].text, name), form);
      if (!list.empty() && !(x > list.back()))
        throw Error(at(k), fmt::format("{} = {} comes after {}", name, x, list.back()), "both must rise");
      list.push_back(x);
    };
    double x = 0;
    if (grid.x.empty()) {
      if (to_number(fields[0].text, x)) throw Error(at(0), "no header line", form);
      for (size_t k = 1; k < fields.size(); ++k) rising(grid.x, k, 'x');
      if (grid.x.size() < 2) throw Error(at(0), fmt::format("{} column of heights: a field has two at least", grid.x.size()), form);
      return;
    }
    if (fields.size() != grid.x.size() + 1)
      throw Error(at(fields.size() > grid.x.size() ? grid.x.size() + 1 : fields.size() - 1),
                  fmt::format("{} columns where the header has {}", fields.size(), grid.x.size() + 1), form);
    rising(grid.y, 0, 'y');
    for (size_t k = 1; k < fields.size(); ++k) {
      if (fields[k].text.empty()) throw Error(at(k), "a hole: no height", "a field has a height at each point; fill holes first");
      if (!to_number(fields[k].text, x))
        throw Error(at(k), fmt::format("\"{}\" is not a height", fields[k].text), "a field has a number at each point; fill holes first");
      grid.heights.push_back(x);
    }
  });
  if (grid.y.size() < 2)
    throw Error(last, fmt::format("{} row{} of heights: a field has two at least", grid.y.size(), grid.y.size() == 1 ? "" : "s"), form);
  return grid;
}

std::vector<Vec3> read_points_csv(const std::string& path, const std::string& where) {
  std::vector<Vec3> points;
  for (const auto& row : read_rows_csv(path, where, {"three", "x,y,z", [](size_t n) { return n == 3; }})) points.emplace_back(row.data());
  return points;
}

namespace {

/// What the unit of the first heading is in seconds; the time of the scene's system where it has none.
double second_of(const HistoryTable& table, const std::string& system) {
  if (table.unit[0].empty()) return to_si("s", system);
  const auto unit = named_unit(table.unit[0]);
  if (!unit || unit->unit != "s")
    throw Error(table.place[0], fmt::format("\"{}\" is no unit of time", table.unit[0]), "s, ms, us, min or h");
  return unit->si;
}

/// A history is a factor on a value in the units of the scene: its own unit must be that, or `scale` must say what it is.
/// Returns that unit in SI, "" where it is not said.
std::string value_unit(const HistoryTable& table, const Entry& e, const std::string& system) {
  if (table.unit[1].empty() || e.given("scale")) return "";
  const auto unit = named_unit(table.unit[1]);
  if (!unit)
    throw Error(table.place[1], fmt::format("the unit \"{}\" is not known", table.unit[1]),
                "take it out of the heading, or give `scale`, what one of it is in the units of the scene");
  const double factor = unit->si / to_si(unit->unit, system);
  if (std::abs(factor - 1) > 1e-12)
    throw Error(table.place[1], fmt::format("values in {}, not in {} of {}", unit->name, unit->unit, system),
                fmt::format("scale = {:g} beside `file` converts them", factor));
  return std::string(unit->unit);
}

}  // namespace

void check_history_unit(const Entry& e, const Surroundings& around) {
  if (!e.given("history")) return;
  const Value& history = e.values.find("history")->second;
  const auto found = around.value_units.find(history.texts.empty() ? history.place.text() : history.texts[0]);
  if (found == around.value_units.end() || found->second == "1") return;
  std::string scaled;
  for (const KindSchema& s : scene_schema()) {
    if (s.section != e.section || s.kind != e.kind) continue;
    for (const Param& p : s.params)
      for (const char* key :
           {"force", "torque", "traction", "pressure", "force_per_length", "acceleration", "displacement", "angle", "spin", "velocity"}) {
        if (p.key != key || !e.given(key)) continue;
        if (p.unit == found->second) return;
        scaled = fmt::format("{} in {}", key, p.unit);
      }
  }
  if (!scaled.empty())
    throw Error(e.where("history"), fmt::format("{}: its history has values in {}, and scales {}", e.label(), found->second, scaled),
                "take another column; a factor has no unit in its heading");
}

History history_of(const Entry& e, const std::string& label, const Surroundings& around) {
  const auto fail = [&](std::string_view key, const std::string& what, const std::string& hint) -> History {
    throw Error(e.where(key), label + ": " + what, hint);
  };
  History h;
  if (e.has("file")) {
    if (e.has("t") || e.has("value")) return fail("file", "both a file and a table", "give either file or t and value");
    const std::filesystem::path file = e.text("file");
    const auto table =
        read_history_csv((around.folder == "." ? file : std::filesystem::path(around.folder) / file).string(), e.where("file"));
    const double second = second_of(table, around.units);
    h.t = table.t, h.value = table.value;
    if (const std::string unit = value_unit(table, e, around.units); !unit.empty())
      around.value_units[e.name.empty() ? e.place.text() : e.name] = unit;
    for (double& t : h.t) t *= second;
  } else if (e.has("t") && e.has("value")) {
    h.t = e.numbers("t");
    h.value = e.numbers("value");
    if (h.t.empty()) return fail("t", "t is empty", "at least one time and value");
    if (h.t.size() != h.value.size()) return fail("value", fmt::format("{} times but {} values", h.t.size(), h.value.size()), "");
    for (size_t i = 1; i < h.t.size(); ++i)
      if (const auto why = disorder(h.t, i); !why.empty()) return fail("t", why, order_rule);
  } else {
    return fail("", "neither a file nor t and value", "write file = \"load.csv\", or t = [...] and value = [...]");
  }
  const double scale = e.number("scale");
  for (double& v : h.value) v *= scale;
  const std::string& ramp = e.text("interpolation");
  if (ramp == "smooth" || ramp == "smoother") h.ramp = ramp == "smooth" ? Ramp::smooth : Ramp::smoother;
  const bool spline = ramp == "spline";
  if (!spline && e.given("ends")) return fail("ends", "ends is for interpolation = \"spline\" alone", "set that, or leave ends out");
  if (!spline && ramp != "monotone") return h;
  h.ramp = Ramp::cubic;
  for (size_t i = 1; i < h.t.size(); ++i)
    if (h.t[i] == h.t[i - 1])
      return fail("interpolation", fmt::format("the table jumps at t = {:.6g}, which a smooth curve through its points cannot", h.t[i]),
                  "linear, smooth and smoother allow jumps");
  const std::string& ends = e.text("ends");
  if (e.has("slopes") && (!spline || ends != "clamped"))
    return fail("slopes", "slopes is for interpolation = \"spline\" with ends = \"clamped\" alone", "set both, or leave slopes out");
  if (spline && ends == "periodic") {
    const auto [low, high] = std::minmax_element(h.value.begin(), h.value.end());
    if (h.t.size() < 3) return fail("ends", "a period needs at least three points", "the last point is the first of the next period");
    if (std::abs(h.value.back() - h.value.front()) > 1e-9 * (*high - *low))
      return fail("ends", fmt::format("a period begins with {:.9g} and ends with {:.9g}", h.value.front() / scale, h.value.back() / scale),
                  "the last point is the first of the next period");
    h.value.back() = h.value.front();
    h.repeats = true;
  }
  std::array<double, 2> slopes{};
  if (e.has("slopes")) {
    if (e.numbers("slopes").size() != 2) return fail("slopes", "two slopes: at the first point and at the last", "");
    for (int i = 0; i < 2; ++i) slopes[i] = scale * e.numbers("slopes")[i];
  }
  h.slopes = !spline ? monotone_slopes(h.t, h.value)
                     : spline_slopes(h.t, h.value,
                                     ends == "periodic"  ? SplineEnds::periodic
                                     : ends == "clamped" ? SplineEnds::clamped
                                                         : SplineEnds::natural,
                                     slopes[0], slopes[1]);
  return h;
}

}  // namespace hilo
