// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/cfc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.hpp"

namespace hilo {

CfcFilter cfc_filter(double cfc, double T) {
  const double w_a = std::tan(2 * std::numbers::pi * cfc * 2.0775 * T / 2), root = std::numbers::sqrt2 * w_a, D = 1 + root + w_a * w_a;
  const double a0 = w_a * w_a / D;
  return {a0, 2 * a0, a0, -2 * (w_a * w_a - 1) / D, (-1 + root - w_a * w_a) / D};
}

namespace {

/// One pass, started as if the first value had always been there.
void pass(const CfcFilter& f, std::vector<double>& x) {
  double x1 = x.front(), x2 = x1, y1 = x1, y2 = x1;
  for (double& v : x) {
    const double x0 = v;
    v = f.a0 * x0 + f.a1 * x1 + f.a2 * x2 + f.b1 * y1 + f.b2 * y2;
    x2 = x1, x1 = x0, y2 = y1, y1 = v;
  }
}

/// Value at the first of `fit` samples of the straight line that best fits 33 points among them, so that finer sampling changes nothing.
template <class At>
double end_of_line(size_t fit, At at) {
  const size_t n = std::min<size_t>(fit, 33);
  const double m = static_cast<double>(n), middle = (m - 1) / 2;
  double mean = 0, moment = 0;
  for (size_t k = 0; k < n; ++k) {
    const double place = n < 2 ? 0 : static_cast<double>((fit - 1) * k) / (m - 1);
    const auto i = std::min(static_cast<size_t>(place), fit - 1), j = std::min(i + 1, fit - 1);
    const double s = place - static_cast<double>(i), x = (1 - s) * at(i) + s * at(j);
    mean += x / m, moment += (static_cast<double>(k) - middle) * x;
  }
  return n < 2 ? mean : mean - middle * moment / (m * (m * m - 1) / 12);
}

}  // namespace

std::vector<double> filter_both_ways(const CfcFilter& filter, std::span<const double> x, size_t pad, size_t fit) {
  if (x.empty()) return {};
  std::vector<double> padded;
  padded.reserve(x.size() + 2 * pad);
  const size_t last = x.size() - 1, n = std::clamp<size_t>(fit, 1, x.size());
  const double front = end_of_line(n, [&](size_t k) { return x[k]; }), back = end_of_line(n, [&](size_t k) { return x[last - k]; });
  for (size_t k = pad; k > 0; --k) padded.push_back(2 * front - x[std::min(k, last)]);
  padded.insert(padded.end(), x.begin(), x.end());
  for (size_t k = 1; k <= pad; ++k) padded.push_back(2 * back - x[last - std::min(k, last)]);
  pass(filter, padded);
  std::reverse(padded.begin(), padded.end());
  pass(filter, padded);
  std::reverse(padded.begin(), padded.end());
  const auto begin = padded.begin() + static_cast<std::ptrdiff_t>(pad);
  return {begin, begin + static_cast<std::ptrdiff_t>(x.size())};
}

std::vector<double> uniform_times(std::span<const double> t) {
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 1; i < t.size(); ++i)
    if (t[i] > t[i - 1]) smallest = std::min(smallest, t[i] - t[i - 1]);
  const double whole = t.back() - t.front(), intervals = static_cast<double>(t.size() - 1);
  if (!(whole > 0)) return {t.begin(), t.end()};
  const auto n = static_cast<size_t>(std::clamp(std::round(whole / smallest), intervals, 16 * intervals));
  std::vector<double> uniform(n + 1);
  for (size_t i = 0; i <= n; ++i) uniform[i] = t.front() + whole * static_cast<double>(i) / static_cast<double>(n);
  uniform.back() = t.back();
  return uniform;
}

std::vector<double> interpolate(std::span<const double> t, std::span<const double> x, std::span<const double> when) {
  std::vector<double> values;
  values.reserve(when.size());
  size_t i = 0;
  for (const double w : when) {
    while (i + 2 < t.size() && t[i + 1] <= w) ++i;
    if (t.size() == 1) {
      values.push_back(x[0]);
      continue;
    }
    const double h = t[i + 1] - t[i], s = h > 0 ? std::clamp((w - t[i]) / h, 0.0, 1.0) : 1;
    values.push_back((1 - s) * x[i] + s * x[i + 1]);
  }
  return values;
}

void check_rate(std::span<const double> t, double cfc, const std::string& where) {
  double longest = 0;
  for (size_t i = 1; i < t.size(); ++i) longest = std::max(longest, t[i] - t[i - 1]);
  if (t.size() < 2 || !(longest > 0)) throw Error(where, "fewer than two samples cannot be filtered");
  if (longest > 0.1 / cfc * (1 + 1e-9))
    throw Error(where, fmt::format("sampled every {:.4g} s, too seldom for CFC {:g}", longest, cfc),
                fmt::format("a step of at most {:.4g} s, or a lower class", 0.1 / cfc));
}

Filtered cfc_filtered(std::span<const double> t, std::span<const double> x, double cfc, const std::string& where) {
  check_rate(t, cfc, where);
  Filtered f;
  f.t = uniform_times(t);
  const double T = (f.t.back() - f.t.front()) / static_cast<double>(f.t.size() - 1);
  // At least 10 ms (SAE J211), and long enough for the slowest class to settle.
  const auto pad = static_cast<size_t>(std::ceil(std::max(0.01, 2 / cfc) / T));
  f.x = filter_both_ways(cfc_filter(cfc, T), interpolate(t, x, f.t), pad, static_cast<size_t>(std::lround(0.5 / cfc / T)) + 1);
  return f;
}

double clip_level(std::span<const double> t, std::span<const double> x, double duration) {
  if (t.size() < 2 || t.back() - t.front() < duration) return std::numeric_limits<double>::quiet_NaN();
  const auto time_above = [&](double level) {
    double sum = 0;
    for (size_t i = 1; i < t.size(); ++i) {
      const double h = t[i] - t[i - 1], low = std::min(x[i], x[i - 1]), high = std::max(x[i], x[i - 1]);
      sum += level <= low ? h : level >= high ? 0 : h * (high - level) / (high - low);
    }
    return sum;
  };
  double low = *std::min_element(x.begin(), x.end()), high = *std::max_element(x.begin(), x.end());
  for (int i = 0; i < 100 && high - low > 1e-14 * std::max(std::abs(high), std::abs(low)); ++i) {
    const double middle = 0.5 * (low + high);
    (time_above(middle) >= duration ? low : high) = middle;
  }
  return low;
}

}  // namespace hilo
