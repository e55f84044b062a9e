// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/error.hpp"

namespace hilo {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

double number(const std::string& text, const char* option, const char* hint) {
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(x))
    throw Error(option, fmt::format("\"{}\" is no number", text), hint, Exit::usage);
  return x;
}

std::vector<size_t> from_to(size_t first, size_t last) {
  std::vector<size_t> chosen(last - first + 1);
  std::iota(chosen.begin(), chosen.end(), first);
  return chosen;
}

/// All within a span.
std::vector<size_t> within(const std::vector<double>& t, const std::string& span, const std::string& what) {
  const auto [from, to] = parse_times(span, {t.front(), t.back()});
  const double slack = 1e-9 * (t.back() - t.front());
  std::vector<size_t> chosen;
  for (size_t k = 0; k < t.size(); ++k)
    if (t[k] >= from - slack && t[k] <= to + slack) chosen.push_back(k);
  if (chosen.empty()) {
    double spacing = 0;
    for (size_t k = 1; k < t.size(); ++k) spacing = std::max(spacing, t[k] - t[k - 1]);
    throw Error("--times", fmt::format("{} holds no {} of the run", span, what),
                fmt::format("there are {} from {:g} to {:g} s, up to {:.3g} s apart", t.size(), t.front(), t.back(), spacing));
  }
  return chosen;
}

/// The nearest to each, at most half the widest spacing beyond the ends.
std::vector<size_t> nearest(const std::vector<double>& t, const std::string& times, const std::string& path, const std::string& what) {
  double spacing = 0;
  for (size_t k = 1; k < t.size(); ++k) spacing = std::max(spacing, t[k] - t[k - 1]);
  std::vector<size_t> chosen;
  for (const std::string& text : split(times)) {
    const double wanted = number(text, "--times", "write times in s with commas, 0.05,0.1, or FROM:TO");
    if (wanted < t.front() - 0.5 * spacing || wanted > t.back() + 0.5 * spacing)
      throw Error(path, fmt::format("no {} near t = {} s", what, text), fmt::format("there are {:g} to {:g} s", t.front(), t.back()));
    const auto nearer = [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); };
    chosen.push_back(static_cast<size_t>(std::min_element(t.begin(), t.end(), nearer) - t.begin()));
  }
  return chosen;
}

}  // namespace

std::vector<size_t> choose_instants(const std::vector<double>& t, const std::string& numbers, const std::string& times,
                                    const std::string& path, const std::string& what) {
  if (t.empty()) throw Error(path, fmt::format("holds no {} yet", what));
  if (times.find(':') != times.npos) return within(t, times, what);
  if (!times.empty()) return nearest(t, times, path, what);
  if (numbers == "all") return from_to(0, t.size() - 1);
  if (numbers == "first") return {0};
  if (numbers == "last") return {t.size() - 1};
  std::vector<size_t> chosen;
  for (const std::string& text : split(numbers)) {
    const auto one = [&](const std::string& part) {
      const double k = number(part, "--steps", "write all, first, last, or numbers with commas");
      if (k < 0 || k >= static_cast<double>(t.size()) || k != std::floor(k))
        throw Error(path, fmt::format("no step {}", part), fmt::format("there are 0 to {}", t.size() - 1));
      return static_cast<size_t>(k);
    };
    const auto colon = text.find(':');
    const size_t first = one(text.substr(0, colon)), last = colon == text.npos ? first : one(text.substr(colon + 1));
    if (last < first) throw Error("--steps", fmt::format("\"{}\" goes backwards", text), "write FROM:TO", Exit::usage);
    const auto more = from_to(first, last);
    chosen.insert(chosen.end(), more.begin(), more.end());
  }
  return chosen;
}

std::pair<double, double> parse_times(const std::string& text, std::pair<double, double> all) {
  if (text.empty()) return all;
  const auto wrong = [&](const std::string& hint = "write FROM:TO in s, such as 0.01:0.05") {
    return Error("--times", fmt::format("\"{}\" is no span of time", text), hint, Exit::usage);
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
  if (from == to) throw wrong("its two ends are one instant: TO comes after FROM");
  if (!(from < to)) throw wrong("TO comes after FROM");
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
