// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.hpp"

namespace hilo {

std::pair<double, double> parse_times(const std::string& text, std::pair<double, double> all) {
  if (text.empty()) return all;
  const auto wrong = [&] {
    return Error("--times", fmt::format("\"{}\" is no span of time", text), "write FROM:TO in s, such as 0.01:0.05", Exit::usage);
  };
  const auto colon = text.find(':');
  if (colon == std::string::npos) throw wrong();
  const auto number = [&](const std::string& part, double absent) {
    if (part.empty()) return absent;
    double x = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), x);
    if (error != std::errc() || end != part.data() + part.size()) throw wrong();
    return x;
  };
  const double from = number(text.substr(0, colon), all.first), to = number(text.substr(colon + 1), all.second);
  if (!(from < to)) throw wrong();
  const double slack = 1e-9 * (all.second - all.first);
  if (from < all.first - slack || to > all.second + slack)
    throw Error("--times", fmt::format("{} is not within the run", text), fmt::format("there is {:g}:{:g}", all.first, all.second));
  return {std::max(from, all.first), std::min(to, all.second)};
}

double handy_speed(double span) {
  const double wanted = span / 10, power = std::pow(10, std::floor(std::log10(wanted)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= wanted / 1.5) return digit * power;
  return 10 * power;
}

}  // namespace hilo
