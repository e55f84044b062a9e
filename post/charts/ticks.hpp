// SPDX-License-Identifier: GPL-3.0-or-later
// Round numbers for axes and colour bars, and how numbers are written in pictures.
#pragma once
#include <string>
#include <vector>

namespace hilo {

/// Ticks of an axis: positions and texts; all texts have the same number of decimals.
struct Ticks {
  std::vector<double> at;
  std::vector<std::string> text;
};
/// About `n` multiples of 1, 2, 2.5 or 5 times a power of ten within [low, high].
Ticks linear_ticks(double low, double high, int n);
/// Powers of ten within [low, high], every so many that at most `n` remain ("10^-3"); with 2 and 5 times them in a short range.
Ticks log_ticks(double low, double high, int n);

/// Power of ten (a multiple of three, 0 for handy numbers) that an axis up to `largest` is better divided by.
int common_exponent(double largest);
/// Four significant digits, no needless zeros, "10^" for the very large and small.
std::string short_number(double x);

/// A unit to show values in: `name`, and the factor from the stored unit.
struct ShownUnit {
  std::string name;
  double factor = 1;
};
/// Pa as kPa or MPa, m as mm or um, by the largest value to be shown; other units stay.
ShownUnit handy_unit(const std::string& unit, double largest);
/// The wanted unit for values stored in `unit` (m/s^2 -> g); Error (exit 1) with the choices when it does not measure the same.
ShownUnit wanted_unit(const std::string& unit, const std::string& wanted);

}  // namespace hilo
