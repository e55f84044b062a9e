// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/universal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/error.hpp"

namespace hilo {
namespace {

/// How records 8 to 11 say what a column is: type of data, exponents of length and force.
struct Quantity58 {
  int type = 0, length = 0, force = 0;  // 0: unknown, 1: general
  double factor = 1;
  std::string unit;
};

Quantity58 quantity_58(const UniversalColumn& c) {
  constexpr int general = 1;
  const bool reaction = c.label.starts_with("joint.") || c.label.starts_with("motion.");
  const struct {
    const char* unit;
    int type, length, force;
  } table[] = {{"m", 8, 1, 0},         {"m/s", 11, 1, 0},    {"m/s^2", 12, 1, 0}, {"N", reaction ? 9 : 13, 0, 1},
               {"N m", general, 1, 1}, {"J", general, 1, 1}, {"Pa", 2, -2, 1},    {"rad", general, 0, 0},
               {"s", 17, 0, 0},        {"Hz", 18, 0, 0},     {"kg", 16, 0, 0},    {"1", general, 0, 0}};
  if (c.unit == "g") return {12, 1, 0, 9.80665, "m/s^2"};  // standard gravity
  for (const auto& row : table)
    if (c.unit == row.unit) return {row.type, row.length, row.force, 1, c.unit};
  return {0, 0, 0, 1, c.unit};
}

std::string letters(const std::string& text, size_t width) {
  std::string out = text.substr(0, width);
  for (char& c : out)
    if (c < 32 || c > 126) c = '?';
  return fmt::format("{:<{}}", out, width);
}

std::string id_line(const std::string& text) { return letters(text.empty() ? "NONE" : text, 80) + "\n"; }

/// Fortran's E13.5, as it is read back.
double six_digits(double x) { return std::strtod(fmt::format("{:13.5e}", x).c_str(), nullptr); }

/// 1 to 3: x, y, z; 4 to 6: about these; 0: a scalar.
int direction(const std::string& label) {
  const std::string last = label.substr(label.rfind('.') + 1);
  if (last.empty()) return 0;
  const auto axis = std::string("xyz").find(last.back());
  if (axis == std::string::npos || last.size() > 2) return 0;
  return static_cast<int>(axis) + (last.front() == 'M' || last.front() == 'L' || last.front() == 'w' ? 4 : 1);
}

}  // namespace

std::string universal_text(const std::string& title, const UniversalColumn& x, const std::vector<UniversalColumn>& columns,
                           const std::string& path) {
  const Quantity58 of_x = quantity_58(x);
  const size_t n = x.value.size();
  std::vector<double> t;
  for (const double v : x.value) t.push_back(of_x.factor * v);
  for (size_t i = 1; i < n; ++i)
    if (!(t[i] > t[i - 1])) throw Error(path, fmt::format("\"{}\" does not rise: a universal file needs that", x.label), "write CSV");
  const double first = n > 0 ? six_digits(t[0]) : 0, step = n > 1 ? six_digits((t[n - 1] - t[0]) / static_cast<double>(n - 1)) : 0;
  const double near = n > 1 ? std::min(1e-6 * (t[n - 1] - t[0]), 0.01 * step) : 0;
  bool even = true, apart = true;
  for (size_t i = 0; i < n; ++i) {
    even &= std::abs(t[i] - first - static_cast<double>(i) * step) <= near;
    apart &= i == 0 || six_digits(t[i]) > six_digits(t[i - 1]);
  }
  if (!even && !apart)
    throw Error(path, fmt::format("the six digits that a universal file has for \"{}\" tell not all rows apart", x.label),
                "write CSV, or fewer rows by --times");

  const auto axis = [](const Quantity58& q, const std::string& label) {
    return fmt::format("{:10}{:5}{:5}{:5} {} {}\n", q.type, q.length, q.force, 0, letters(label, 20), letters(q.unit, 20));
  };
  std::string out = fmt::format("    -1\n   164\n{:10}{}{:10}\n{:25.17e}{:25.17e}{:25.17e}\n{:25.17e}\n    -1\n", 1,
                                letters("SI: Meter (newton)", 20), 2, 1.0, 1.0, 1.0, 273.15);
  std::vector<std::string> things;  // "sensor.seat": numbered as nodes, since a dataset has ten letters for a name
  for (size_t k = 0; k < columns.size(); ++k) {
    const UniversalColumn& c = columns[k];
    const Quantity58 q = quantity_58(c);
    const std::string thing = c.label.substr(0, c.label.rfind('.'));
    const auto at = std::find(things.begin(), things.end(), thing);
    const size_t node = static_cast<size_t>(at - things.begin()) + 1;
    if (at == things.end()) things.push_back(thing);
    out += "    -1\n    58\n";
    out += id_line(c.label) + id_line(c.label.size() > 80 ? c.label.substr(80) : title) + id_line("") + id_line("hilo-post series") +
           id_line("");
    out += fmt::format("{:5}{:10}{:5}{:10} {}{:10}{:4} {}{:10}{:4}\n", of_x.type == 17 ? 1 : 0, k + 1, 1, 0,
                       letters(thing.substr(thing.rfind('.') + 1), 10), node, direction(c.label), letters("NONE", 10), 0, 0);
    out += fmt::format("{:10}{:10}{:10}{:13.5e}{:13.5e}{:13.5e}\n", 4, n, even ? 1 : 0, even ? first : 0.0, even ? step : 0.0, 0.0);
    out += axis(of_x, x.label) + axis(q, c.label.substr(c.label.rfind('.') + 1)) + axis({}, "NONE") + axis({}, "NONE");
    const size_t in_line = even ? 4 : 2;
    for (size_t i = 0; i < n; ++i) {
      const double y = q.factor * c.value.at(i);
      if (!std::isfinite(y))
        throw Error(path, fmt::format("\"{}\" is not finite at {} = {:g}: a universal file cannot say so", c.label, x.label, x.value[i]),
                    "write CSV, or --times without it");
      if (!even) out += fmt::format("{:13.5e}", t[i]);
      out += fmt::format("{:20.12e}", y);
      if ((i + 1) % in_line == 0 || i + 1 == n) out += '\n';
    }
    out += "    -1\n";
  }
  return out;
}

}  // namespace hilo
