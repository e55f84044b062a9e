// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/charts/ticks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/math.hpp"

namespace hilo {

Ticks linear_ticks(double low, double high, int n) {
  Ticks ticks;
  if (!(high > low) || n < 1) return ticks;
  const double rough = (high - low) / n, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double nice : {1.0, 2.0, 2.5, 5.0})
    if (nice * power >= rough * (1 - 1e-9)) {
      step = nice * power;
      break;
    }
  // Decimals that write the step itself exactly.
  int decimals = 0;
  for (double s = step; decimals < 12 && std::abs(s - std::round(s)) > 1e-6; s *= 10) ++decimals;
  const double first = std::ceil(low / step - 1e-6), last = std::floor(high / step + 1e-6);
  for (double k = first; k <= last; ++k) {
    ticks.at.push_back(k == 0 ? 0 : k * step);
    ticks.text.push_back(fmt::format("{:.{}f}", ticks.at.back(), decimals));
  }
  return ticks;
}

Ticks log_ticks(double low, double high, int n) {
  Ticks ticks;
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9)), last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  if (last - first < 2) {  // few powers of ten in sight: 2 and 5 times them as well
    for (int k = first - 1; k <= last; ++k)
      for (const int m : {1, 2, 5})
        if (const double x = m * std::pow(10.0, k); x >= low && x <= high) ticks.at.push_back(x), ticks.text.push_back(short_number(x));
    return ticks;
  }
  const int stride = std::max(1, (last - first + n) / std::max(1, n));
  for (int k = first; k <= last; ++k)
    if (k % stride == 0) ticks.at.push_back(std::pow(10.0, k)), ticks.text.push_back(fmt::format("10^{}", k));
  return ticks;
}

int common_exponent(double largest) {
  if (!(largest > 0) || (largest < 2e4 && largest >= 2e-2)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

std::string short_number(double x) {
  if (x == 0) return "0";
  const double size = std::abs(x);
  if (size < 9999.5 && size >= 1e-3) return fmt::format("{:.4g}", x);
  const int e = static_cast<int>(std::floor(std::log10(size)));
  return fmt::format("{:.3g}\u00b710^{}", x / std::pow(10, e), e);
}

namespace {

struct Scaled {
  const char* name;
  double factor;
};
/// Units that measure the same as a stored one; the handy ones come in rising size.
struct UnitFamily {
  const char* stored;
  std::vector<Scaled> handy, others;
};
const std::vector<UnitFamily>& families() {
  static const std::vector<UnitFamily> table = {
      {"Pa", {{"Pa", 1}, {"kPa", 1e-3}, {"MPa", 1e-6}}, {{"GPa", 1e-9}}},
      {"m", {{"\u00b5m", 1e6}, {"mm", 1e3}, {"m", 1}}, {{"um", 1e6}, {"cm", 100}, {"km", 1e-3}}},
      {"m/s", {{"mm/s", 1e3}, {"m/s", 1}}, {{"km/h", 3.6}}},
      {"m/s^2", {{"m/s^2", 1}}, {{"g", 1 / g0}, {"mm/s^2", 1e3}}},
  };
  return table;
}

}  // namespace

ShownUnit handy_unit(const std::string& unit, double largest) {
  ShownUnit best{unit, 1};
  for (const auto& family : families()) {
    if (family.stored != unit || !(largest > 0)) continue;
    best = {family.handy.front().name, family.handy.front().factor};
    for (const auto& u : family.handy)
      if (largest * u.factor >= 1) best = {u.name, u.factor};
  }
  return best;
}

ShownUnit wanted_unit(const std::string& unit, const std::string& wanted) {
  std::vector<std::string> names;
  for (const auto& family : families()) {
    if (family.stored != unit) continue;
    for (const auto* list : {&family.handy, &family.others})
      for (const auto& u : *list) {
        if (wanted == u.name) return {u.name, u.factor};
        names.push_back(u.name);
      }
  }
  if (wanted == unit) return {unit, 1};
  throw Error("--unit", fmt::format("\"{}\" does not measure what is stored in {}", wanted, unit.empty() ? "no unit" : unit),
              names.empty() ? "leave --unit out" : fmt::format("choose one of {}", fmt::join(names, ", ")), Exit::usage);
}

}  // namespace hilo
