// SPDX-License-Identifier: GPL-3.0-or-later
// Units as engineers write them: kN, MPa, ms.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace hilo {

/// What one of a named unit is in SI.
struct NamedUnit {
  std::string_view name;
  double si;
  std::string_view unit;  // the SI unit, as to_si reads it: "N", "m/s^2"
};
/// "kN", "N/mm^2", "deg"; nothing for a name that is not known.
std::optional<NamedUnit> named_unit(std::string_view name);
/// The unit in a heading "force [kN]" or "force (kN)", "" without one.
std::string unit_in_heading(std::string_view heading);

}  // namespace hilo
