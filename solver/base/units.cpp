// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/units.hpp"

#include <numbers>

namespace hilo {

std::optional<NamedUnit> named_unit(std::string_view name) {
  constexpr double pi = std::numbers::pi, g0 = 9.80665, lbf = 4.4482216152605, inch = 0.0254;
  static constexpr NamedUnit known[] = {
      {"s", 1, "s"},
      {"ms", 1e-3, "s"},
      {"us", 1e-6, "s"},
      {"\u00b5s", 1e-6, "s"},
      {"min", 60, "s"},
      {"h", 3600, "s"},
      {"N", 1, "N"},
      {"kN", 1e3, "N"},
      {"MN", 1e6, "N"},
      {"mN", 1e-3, "N"},
      {"daN", 10, "N"},
      {"lbf", lbf, "N"},
      {"kgf", g0, "N"},
      {"m", 1, "m"},
      {"mm", 1e-3, "m"},
      {"cm", 1e-2, "m"},
      {"um", 1e-6, "m"},
      {"\u00b5m", 1e-6, "m"},
      {"km", 1e3, "m"},
      {"in", inch, "m"},
      {"inch", inch, "m"},
      {"ft", 0.3048, "m"},
      {"Pa", 1, "Pa"},
      {"kPa", 1e3, "Pa"},
      {"MPa", 1e6, "Pa"},
      {"GPa", 1e9, "Pa"},
      {"bar", 1e5, "Pa"},
      {"N/mm^2", 1e6, "Pa"},
      {"N/mm2", 1e6, "Pa"},
      {"N/m^2", 1, "Pa"},
      {"psi", lbf / (inch * inch), "Pa"},
      {"N m", 1, "N m"},
      {"Nm", 1, "N m"},
      {"kNm", 1e3, "N m"},
      {"kN m", 1e3, "N m"},
      {"N mm", 1e-3, "N m"},
      {"Nmm", 1e-3, "N m"},
      {"rad", 1, "rad"},
      {"deg", pi / 180, "rad"},
      {"\u00b0", pi / 180, "rad"},
      {"mrad", 1e-3, "rad"},
      {"m/s", 1, "m/s"},
      {"mm/s", 1e-3, "m/s"},
      {"km/h", 1 / 3.6, "m/s"},
      {"rad/s", 1, "rad/s"},
      {"deg/s", pi / 180, "rad/s"},
      {"rpm", pi / 30, "rad/s"},
      {"1/min", pi / 30, "rad/s"},
      {"m/s^2", 1, "m/s^2"},
      {"m/s2", 1, "m/s^2"},
      {"mm/s^2", 1e-3, "m/s^2"},
      {"g", g0, "m/s^2"},
      {"Hz", 1, "Hz"},
      {"kHz", 1e3, "Hz"},
      {"J", 1, "J"},
      {"kJ", 1e3, "J"},
      {"W", 1, "W"},
      {"kW", 1e3, "W"},
      {"kg", 1, "kg"},
      {"t", 1e3, "kg"},
      {"1", 1, "1"},
      {"-", 1, "1"},
      {"%", 1e-2, "1"},
  };
  for (const NamedUnit& u : known)
    if (u.name == name) return u;
  return std::nullopt;
}

std::string unit_in_heading(std::string_view heading) {
  const size_t open = heading.find_last_of("[("), close = heading.find_last_of("])");
  if (open == heading.npos || close == heading.npos || close < open) return "";
  const std::string_view inside = heading.substr(open + 1, close - open - 1);
  const size_t from = inside.find_first_not_of(' '), to = inside.find_last_not_of(' ');
  return from == inside.npos ? "" : std::string(inside.substr(from, to - from + 1));
}

}  // namespace hilo
