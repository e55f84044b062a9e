// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/cfc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

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

/// The area under (t, x), straight between samples and held beyond both ends, from t.front() to times that rise.
struct Area {
  std::span<const double> t, x;
  size_t i = 0;
  double before = 0;  // up to t[i]
  double until(double w) {
    if (w <= t.front()) return x.front() * (w - t.front());
    for (; i + 1 < t.size() && t[i + 1] <= w; ++i) before += (t[i + 1] - t[i]) * (x[i] + x[i + 1]) / 2;
    if (i + 1 == t.size()) return before + x.back() * (w - t.back());
    const double s = (w - t[i]) / (t[i + 1] - t[i]);
    return before + (w - t[i]) * (x[i] + s * (x[i + 1] - x[i]) / 2);
  }
};

}  // namespace

std::vector<double> filter_both_ways(const CfcFilter& filter, std::span<const double> x, size_t pad, Ends front, Ends back) {
  if (x.empty()) return {};
  std::vector<double> padded;
  padded.reserve(x.size() + 2 * pad);
  const size_t last = x.size() - 1;
  const auto away = [&](Ends end, size_t k) { return end == Ends::held ? 0 : std::min(k, last); };
  for (size_t k = pad; k > 0; --k) padded.push_back(x[away(front, k)]);
  padded.insert(padded.end(), x.begin(), x.end());
  for (size_t k = 1; k <= pad; ++k) padded.push_back(x[last - away(back, k)]);
  pass(filter, padded);
  std::reverse(padded.begin(), padded.end());
  pass(filter, padded);
  std::reverse(padded.begin(), padded.end());
  const auto begin = padded.begin() + static_cast<std::ptrdiff_t>(pad);
  return {begin, begin + static_cast<std::ptrdiff_t>(x.size())};
}

EvenSignal evenly(std::span<const double> t, std::span<const double> x, double cfc) {
  const double whole = t.back() - t.front();
  if (!(whole > 0)) return {{t.begin(), t.end()}, {x.begin(), x.end()}};
  const auto rows = t.size() - 1;
  bool even = true;
  for (size_t i = 0; i <= rows; ++i)
    even = even && std::abs(t[i] - t.front() - whole * static_cast<double>(i) / static_cast<double>(rows)) * static_cast<double>(rows) <=
                       0.01 * whole;
  const size_t n = even ? rows : static_cast<size_t>(std::ceil(200 * cfc * whole));
  EvenSignal s{std::vector<double>(n + 1), {}};
  for (size_t i = 0; i <= n; ++i) s.t[i] = t.front() + whole * static_cast<double>(i) / static_cast<double>(n);
  s.t.back() = t.back();
  if (even) {
    s.x = interpolate(t, x, s.t);
    return s;
  }
  const double T = whole / static_cast<double>(n);
  Area area{t, x};
  double before = area.until(s.t[0] - T / 2);
  for (const double middle : s.t) {
    const double now = area.until(middle + T / 2);
    s.x.push_back((now - before) / T), before = now;
  }
  return s;
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
  const EvenSignal even = evenly(t, x, cfc);
  const double T = (even.t.back() - even.t.front()) / static_cast<double>(even.t.size() - 1);
  // At least 10 ms (SAE J211), and long enough for the slowest class to settle.
  const auto pad = static_cast<size_t>(std::ceil(std::max(0.01, 2 / cfc) / T));
  const CfcFilter filter = cfc_filter(cfc, T);
  Filtered f{even.t, filter_both_ways(filter, even.x, pad), {}};
  std::vector<double> mirrored = filter_both_ways(filter, even.x, pad, Ends::held, Ends::mirrored);
  const double mean = std::accumulate(even.x.begin(), even.x.end(), 0.0) / static_cast<double>(even.x.size());
  if (std::abs(mirrored.back() - mean) < std::abs(f.x.back() - mean)) f.x.swap(mirrored);
  const std::vector<double> both = filter_both_ways(filter, even.x, pad, Ends::mirrored, Ends::mirrored);
  for (size_t i = 0; i < f.x.size(); ++i) f.by_ends.push_back(std::max(std::abs(f.x[i] - both[i]), std::abs(f.x[i] - mirrored[i])));
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
