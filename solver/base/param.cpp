// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/param.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <map>

#include "base/error.hpp"

namespace hilo {
namespace {

struct Dimension {
  double length, mass, time;
};

/// Exponents of the named units in length, mass, time.
const std::map<std::string, Dimension, std::less<>> dimensions = {
    {"m", {1, 0, 0}},  {"kg", {0, 1, 0}}, {"s", {0, 0, 1}},   {"N", {1, 1, -2}},  {"Pa", {-1, 1, -2}},
    {"J", {2, 1, -2}}, {"W", {2, 1, -3}}, {"rad", {0, 0, 0}}, {"Hz", {0, 0, -1}}, {"1", {0, 0, 0}},
};

/// A system of units: SI value of its length, mass and time.
const std::map<std::string, Dimension, std::less<>> systems = {
    {"m-kg-s", {1, 1, 1}},
    {"mm-t-s", {1e-3, 1e3, 1}},
    {"mm-kg-ms", {1e-3, 1, 1e-3}},
    {"in-lbf-s", {0.0254, 175.126835246476, 1}},  // mass unit lbf s^2/in
    {"ft-lbf-s", {0.3048, 14.5939029372064, 1}},  // mass unit slug
};

}  // namespace

std::string Range::text() const {
  const bool below = std::isfinite(high), over = std::isfinite(low);
  if (over && below) return fmt::format("{}{:g}, {:g}{}", low_open ? "(" : "[", low, high, high_open ? ")" : "]");
  if (over) return fmt::format("{} {:g}", low_open ? ">" : ">=", low);
  if (below) return fmt::format("{} {:g}", high_open ? "<" : "<=", high);
  return "any number";
}

const std::vector<std::string>& unit_systems() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> n;
    for (const auto& [key, value] : systems) n.push_back(key);
    return n;
  }();
  return names;
}

double to_si(std::string_view unit, std::string_view system) {
  const auto s = systems.find(system);
  if (s == systems.end()) throw Error("", fmt::format("unknown unit system \"{}\"", system), suggest(system, unit_systems()));
  double factor = 1;
  int sign = 1;  // everything behind '/' counts down
  for (size_t i = 0; i < unit.size();) {
    if (unit[i] == '/')
      sign = -1, ++i;
    else if (std::isalpha(static_cast<unsigned char>(unit[i]))) {
      size_t j = i;
      while (j < unit.size() && std::isalpha(static_cast<unsigned char>(unit[j]))) ++j;
      const auto d = dimensions.find(unit.substr(i, j - i));
      if (d == dimensions.end()) throw Error("", fmt::format("unknown unit \"{}\"", unit));
      int power = 1;
      if (j < unit.size() && unit[j] == '^') power = unit[j + 1] - '0', j += 2;
      const auto& [l, m, t] = s->second;
      factor *= std::pow(std::pow(l, d->second.length) * std::pow(m, d->second.mass) * std::pow(t, d->second.time), sign * power);
      i = j;
    } else
      ++i;
  }
  return factor;
}

}  // namespace hilo
