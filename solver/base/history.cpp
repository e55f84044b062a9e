// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/history.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hilo {
namespace {

using std::numbers::pi;

/// First point whose time is greater than `time`; the segment that holds `time` ends there.
size_t end_of_segment(const History& h, double time) {
  return static_cast<size_t>(std::upper_bound(h.t.begin(), h.t.end(), time) - h.t.begin());
}

/// Periods between the first one and that which holds `time`, as a time.
double whole_periods(const History& h, double time) {
  const double period = h.t.back() - h.t.front();
  return h.repeats ? period * std::floor((time - h.t.front()) / period) : 0;
}

/// Value, slope and curvature of a cubic ramp at s from 0 to 1, in the segment that ends at point i.
History::Jet cubic(const History& h, size_t i, double s) {
  const double length = h.t[i] - h.t[i - 1], a = h.slopes[i - 1], b = h.slopes[i], c = (h.value[i] - h.value[i - 1]) / length;
  const double second = 3 * c - 2 * a - b, third = a + b - 2 * c;
  return {h.value[i - 1] + length * s * (a + s * (second + s * third)), a + s * (2 * second + 3 * s * third),
          (2 * second + 6 * s * third) / length};
}

double septic(double s) { return s * s * s * s * (35 + s * (-84 + s * (70 - 20 * s))); }
double septic_slope(double s) { return 140 * s * s * s * (1 - s) * (1 - s) * (1 - s); }
double septic_curvature(double s) { return 420 * s * s * (1 - s) * (1 - s) * (1 - 2 * s); }

/// Mean over [a, b] inside the segment that ends at point i, written so that a short interval loses no digits:
/// the mean of cos(pi s) over [s0, s1] is cos(pi (s0 + s1)/2) sin(x)/x, x = pi (s1 - s0)/2; for degree seven four Gauss points are exact.
double mean_in_segment(const History& h, size_t i, double a, double b) {
  const double length = h.t[i] - h.t[i - 1], s = ((a - h.t[i - 1]) + (b - h.t[i - 1])) / (2 * length);
  if (h.ramp == Ramp::cubic) {  // two Gauss points
    const double off = (b - a) / (2 * length) / std::sqrt(3.0);
    return (cubic(h, i, s - off).value + cubic(h, i, s + off).value) / 2;
  }
  double w = s;
  if (h.ramp == Ramp::smooth) {
    const double x = pi * (b - a) / (2 * length);
    w = (1 - std::cos(pi * s) * (x < 1e-8 ? 1 : std::sin(x) / x)) / 2;
  } else if (h.ramp == Ramp::smoother) {
    constexpr double at[2] = {0.861136311594052575, 0.339981043584856265}, weight[2] = {0.347854845137453857, 0.652145154862546143};
    const double half = (b - a) / (2 * length);
    w = 0;
    for (int k = 0; k < 2; ++k) w += weight[k] / 2 * (septic(s - at[k] * half) + septic(s + at[k] * half));
  }
  return h.value[i - 1] + w * (h.value[i] - h.value[i - 1]);
}

/// Slope of the segment that ends at point i; 0 before the first, after the last and in a jump.
double linear_slope(const History& h, size_t i) {
  if (i == 0 || i >= h.t.size() || h.t[i] == h.t[i - 1]) return 0;
  return (h.value[i] - h.value[i - 1]) / (h.t[i] - h.t[i - 1]);
}

/// Mean over [t0, t1], t0 <= t1, of one that does not repeat.
double mean_once(const History& h, double t0, double t1) {
  const size_t n = h.t.size();
  size_t i = end_of_segment(h, t0);
  const auto over = [&](double a, double b) { return i == 0 ? h.value.front() : i == n ? h.value.back() : mean_in_segment(h, i, a, b); };
  if (i == n || t1 <= h.t[i]) return over(t0, t1);
  double integral = 0, a = t0;
  for (; a < t1; ++i) {
    const double b = i == n ? t1 : std::min(t1, h.t[i]);
    if (b > a) integral += (b - a) * over(a, b);
    a = b;
    if (i == n) break;
  }
  return integral / (t1 - t0);
}

}  // namespace

double History::operator()(double time) const {
  time -= whole_periods(*this, time);
  const size_t i = end_of_segment(*this, time);
  if (i == 0) return value.front();
  if (i == t.size()) return value.back();
  return mean_in_segment(*this, i, time, time);
}

History::Jet History::at(double time, double near) const {
  const double periods = whole_periods(*this, near);
  time -= periods, near -= periods;
  const size_t i = end_of_segment(*this, near);
  if (i == 0) return {value.front(), 0, 0};
  if (i == t.size()) return {value.back(), 0, 0};
  const double length = t[i] - t[i - 1], inside = std::clamp(time, t[i - 1], t[i]), s = (inside - t[i - 1]) / length;
  const double v = mean_in_segment(*this, i, inside, inside), c = (value[i] - value[i - 1]) / length;
  if (ramp == Ramp::linear) return {v, c, 0};
  if (ramp == Ramp::cubic) return cubic(*this, i, s);
  const bool cosine = ramp == Ramp::smooth;
  return {v, c * (cosine ? pi / 2 * std::sin(pi * s) : septic_slope(s)),
          c / length * (cosine ? pi * pi / 2 * std::cos(pi * s) : septic_curvature(s))};
}

double History::slope(double time) const { return at(time, time).slope; }
double History::curvature(double time) const { return at(time, time).curvature; }

double History::mean(double t0, double t1) const {
  if (t0 == t1) return (*this)(t0);
  if (t1 < t0) return mean(t1, t0);
  const double first = whole_periods(*this, t0), last = whole_periods(*this, t1);
  if (first == last) return mean_once(*this, t0 - first, t1 - first);
  const double end = first + t.back(), begin = last + t.front(), whole = begin - end;  // of the period of t0, of that of t1, between them
  const double sum = (end - t0) * mean_once(*this, t0 - first, t.back()) + (t1 - begin) * mean_once(*this, t.front(), t1 - last);
  return (sum + (whole > 0 ? whole * mean_once(*this, t.front(), t.back()) : 0)) / (t1 - t0);
}

std::vector<History::Break> History::breaks() const {
  std::vector<Break> found;
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-9 * std::max(std::abs(a), std::abs(b)); };
  if (ramp == Ramp::cubic) {  // its slope is continuous but where it begins and ends
    if (repeats || t.size() < 2) return found;
    double steepest = 0, sharpest = 0;
    for (size_t i = 1; i < t.size(); ++i) {
      steepest = std::max({steepest, std::abs(slopes[i - 1]), std::abs(slopes[i])});
      sharpest = std::max({sharpest, std::abs(cubic(*this, i, 0).curvature), std::abs(cubic(*this, i, 1).curvature)});
    }
    for (size_t i = 0; i < t.size(); ++i) {
      const double before = i > 0 ? cubic(*this, i, 1).curvature : 0, behind = i + 1 < t.size() ? cubic(*this, i + 1, 0).curvature : 0;
      if ((i == 0 || i + 1 == t.size()) && std::abs(slopes[i]) > 1e-9 * steepest)
        found.push_back({t[i], 1});
      else if (std::abs(behind - before) > 1e-9 * sharpest)
        found.push_back({t[i], 2});
    }
    return found;
  }
  for (size_t i = 0, j; i < t.size(); i = j + 1) {
    for (j = i; j + 1 < t.size() && t[j + 1] == t[i];) ++j;
    const double before = linear_slope(*this, i), behind = linear_slope(*this, j + 1);
    // a cosine ramp of slope c over the length L leaves with the curvature pi^2/2 c/L and arrives with its negative
    const double arriving = before == 0 ? 0 : -before / (t[i] - t[i - 1]), leaving = behind == 0 ? 0 : behind / (t[j + 1] - t[j]);
    if (value[j] != value[i])
      found.push_back({t[i], 0});
    else if (ramp == Ramp::linear && differ(before, behind))
      found.push_back({t[i], 1});
    else if (ramp == Ramp::smooth && differ(arriving, leaving))
      found.push_back({t[i], 2});
  }
  return found;
}

}  // namespace hilo
