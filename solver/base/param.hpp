// SPDX-License-Identifier: GPL-3.0-or-later
// One entry of an option or parameter table: key, unit, meaning and range.
#pragma once
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace hilo {

/// What a value may be.  Numbers carry a unit string, made of m kg s N Pa J W rad and powers: "kg/m^3", "N s/m".
enum class Type { number, vector3, numbers, text, boolean, texts, history };

/// Closed or open interval of admissible numbers.
struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_open = true, high_open = true;
  bool contains(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
  std::string text() const;
};
inline constexpr Range any_number{};
constexpr Range above(double low) { return {low, std::numeric_limits<double>::infinity(), true, true}; }
constexpr Range at_least(double low) { return {low, std::numeric_limits<double>::infinity(), false, true}; }
constexpr Range between(double low, double high) { return {low, high, true, true}; }
constexpr Range from_to(double low, double high) { return {low, high, false, false}; }

/// A key of the scene: its type, unit, meaning, default (as written in TOML; "" when it may be absent, "!" when it must be given).
struct Param {
  std::string_view key;
  Type type;
  std::string_view unit;
  std::string_view fallback;
  std::string_view meaning;
  Range range = any_number;
  std::array<unsigned char, 2> counts{};  // how many numbers a list may hold, {3} or {1, 3}; {}: any number
};

/// Factor that takes a number in `unit` of the system `system` ("m-kg-s", "mm-t-s", "mm-kg-ms", "in-lbf-s", "ft-lbf-s") to SI.  Throws
/// Error for an unknown system.
double to_si(std::string_view unit, std::string_view system);
const std::vector<std::string>& unit_systems();

}  // namespace hilo
