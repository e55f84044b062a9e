// Load histories: value, slope and exact mean of piecewise linear or smooth functions of time.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/scene.hpp"

namespace hilo {
namespace {

using std::numbers::pi;

/// First point whose time is greater than `time`; the segment that holds `time` ends there.
size_t end_of_segment(const History& h, double time) {
  return static_cast<size_t>(std::upper_bound(h.t.begin(), h.t.end(), time) - h.t.begin());
}

double septic(double s) { return s * s * s * s * (35 + s * (-84 + s * (70 - 20 * s))); }
double septic_slope(double s) { return 140 * s * s * s * (1 - s) * (1 - s) * (1 - s); }
double septic_curvature(double s) { return 420 * s * s * (1 - s) * (1 - s) * (1 - 2 * s); }

/// Mean over [a, b] inside the segment that ends at point i, written so that a short interval loses no digits:
/// the mean of cos(pi s) over [s0, s1] is cos(pi (s0 + s1)/2) sin(x)/x, x = pi (s1 - s0)/2; for degree seven four Gauss points are exact.
double mean_in_segment(const History& h, size_t i, double a, double b) {
  const double length = h.t[i] - h.t[i - 1], s = ((a - h.t[i - 1]) + (b - h.t[i - 1])) / (2 * length);
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

}  // namespace

double History::operator()(double time) const {
  const size_t i = end_of_segment(*this, time);
  if (i == 0) return value.front();
  if (i == t.size()) return value.back();
  return mean_in_segment(*this, i, time, time);
}

double History::slope(double time) const {
  const size_t i = end_of_segment(*this, time);
  const double c = linear_slope(*this, i);
  if (c == 0 || ramp == Ramp::linear) return c;
  const double s = (time - t[i - 1]) / (t[i] - t[i - 1]);
  return c * (ramp == Ramp::smooth ? pi / 2 * std::sin(pi * s) : septic_slope(s));
}

double History::curvature(double time) const {
  const size_t i = end_of_segment(*this, time);
  const double c = linear_slope(*this, i);
  if (c == 0 || ramp == Ramp::linear) return 0;
  const double length = t[i] - t[i - 1], s = (time - t[i - 1]) / length;
  return c / length * (ramp == Ramp::smooth ? pi * pi / 2 * std::cos(pi * s) : septic_curvature(s));
}

double History::mean(double t0, double t1) const {
  if (t0 == t1) return (*this)(t0);
  if (t1 < t0) return mean(t1, t0);
  const size_t n = t.size();
  size_t i = end_of_segment(*this, t0);
  const auto over = [&](double a, double b) { return i == 0 ? value.front() : i == n ? value.back() : mean_in_segment(*this, i, a, b); };
  if (i == n || t1 <= t[i]) return over(t0, t1);
  double integral = 0, a = t0;
  for (; a < t1; ++i) {
    const double b = i == n ? t1 : std::min(t1, t[i]);
    if (b > a) integral += (b - a) * over(a, b);
    a = b;
    if (i == n) break;
  }
  return integral / (t1 - t0);
}

std::vector<double> History::events(double t0, double t1) const {
  std::vector<double> found;
  for (size_t i = 0; i < t.size(); ++i) {
    if (t[i] <= t0 || t[i] >= t1) continue;
    const bool jump = i > 0 && t[i] == t[i - 1] && value[i] != value[i - 1];
    const double before = linear_slope(*this, i), after = linear_slope(*this, i + 1);
    const bool kink = ramp == Ramp::linear && std::abs(after - before) > 1e-9 * std::max(std::abs(after), std::abs(before));
    if ((jump || kink) && (found.empty() || found.back() != t[i])) found.push_back(t[i]);
  }
  return found;
}

std::vector<double> History::jumps() const {
  std::vector<double> found;
  for (size_t i = 1; i < t.size(); ++i)
    if (t[i] == t[i - 1] && value[i] != value[i - 1]) found.push_back(t[i]);
  return found;
}

}  // namespace hilo
