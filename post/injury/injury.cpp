// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/injury.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace hilo {
namespace {

/// State of the one-mass model at time s after a state (x, v) under a0 + slope s: x = C e^{-zeta w s} cos(wd s + ..) + particular.
struct OneMass {
  double w, zeta;
  struct At {
    double x, v;
  };
  At after(const At& at, double a0, double slope, double s) const {
    // particular solution p + q s: q = slope/w^2, p = (a0 - 2 zeta w q)/w^2
    const double q = slope / (w * w), p = (a0 - 2 * zeta * w * q) / (w * w), wd = w * std::sqrt(1 - zeta * zeta);
    const double A = at.x - p, B = (at.v - q + zeta * w * A) / wd;
    const double e = std::exp(-zeta * w * s), c = std::cos(wd * s), d = std::sin(wd * s);
    return {e * (A * c + B * d) + p + q * s, e * ((B * wd - zeta * w * A) * c - (A * wd + zeta * w * B) * d) + q};
  }
};

/// Calls use(t, x) at samples and where the velocity vanishes between them.
template <class Use>
void respond(std::span<const double> t, std::span<const double> a, double omega, double zeta, Use use) {
  const OneMass m{omega, zeta};
  OneMass::At at{0, 0};
  use(t[0], 0.0, true);
  for (size_t i = 1; i < t.size(); ++i) {
    const double h = t[i] - t[i - 1];
    if (!(h > 0)) continue;  // a jump of the signal
    const double slope = (a[i] - a[i - 1]) / h;
    const int pieces = std::max(1, static_cast<int>(std::ceil(h * omega / 0.2)));  // so that at most one peak lies in a piece
    OneMass::At before = at;
    for (int k = 1; k <= pieces; ++k) {
      const double s0 = h * (k - 1) / pieces, s1 = h * k / pieces;
      const OneMass::At end = m.after(at, a[i - 1], slope, s1);
      if (before.v * end.v < 0) {
        double low = s0, high = s1;
        for (int j = 0; j < 60; ++j) {
          const double middle = (low + high) / 2;
          ((m.after(at, a[i - 1], slope, middle).v > 0) == (before.v > 0) ? low : high) = middle;
        }
        use(t[i - 1] + low, m.after(at, a[i - 1], slope, low).x, false);
      }
      before = end;
    }
    at = before;
    use(t[i], at.x, true);
  }
}

/// Integral of a from t[0] to each sample, straight between samples.
std::vector<double> integral(std::span<const double> t, std::span<const double> a) {
  std::vector<double> sum{0};
  for (size_t i = 1; i < t.size(); ++i) sum.push_back(sum.back() + (t[i] - t[i - 1]) * (a[i] + a[i - 1]) / 2);
  return sum;
}

}  // namespace

ModelResponse model_response(std::span<const double> t, std::span<const double> a, double omega, double zeta) {
  ModelResponse r;
  respond(t, a, omega, zeta, [&](double time, double x, bool) {
    const double level = omega * omega * x;
    if (level > r.highest) r.highest = level, r.t_highest = time;
    if (level < r.lowest) r.lowest = level, r.t_lowest = time;
  });
  return r;
}

std::vector<double> model_history(std::span<const double> t, std::span<const double> a, double omega, double zeta) {
  std::vector<double> out;
  size_t next = 0;
  respond(t, a, omega, zeta, [&](double time, double x, bool sample) {
    if (!sample) return;
    while (next < t.size() && t[next] <= time) out.push_back(omega * omega * x), ++next;
  });
  return out;
}

double dynamic_response_index(std::span<const double> t, std::span<const double> a) { return model_response(t, a, 52.9, 0.224).highest; }

HeadInjury head_injury(std::span<const double> t, std::span<const double> a, double window) {
  const std::vector<double> I = integral(t, a);
  HeadInjury best;
  std::deque<size_t> falling;  // samples of the window from i on that can still be its largest, largest first
  for (size_t i = 0, ahead = 0; i < t.size(); ++i) {
    for (; ahead < t.size() && t[ahead] - t[i] <= window * (1 + 1e-12); falling.push_back(ahead++))
      while (!falling.empty() && a[falling.back()] <= a[ahead]) falling.pop_back();
    if (falling.front() < i) falling.pop_front();
    if (window * std::pow(std::max(0.0, a[falling.front()]), 2.5) <= best.value) continue;  // no mean is more
    for (size_t j = i + 1; j < t.size() && t[j] - t[i] <= window * (1 + 1e-12); ++j) {
      const double span = t[j] - t[i];
      if (!(span > 0)) continue;
      const double mean = std::max(0.0, (I[j] - I[i]) / span), fifth = mean * mean * mean * mean * mean;
      if (span * span * fifth > best.value * best.value) best = {span * std::sqrt(fifth), t[i], t[j]};
    }
  }
  return best;
}

double severity_index(std::span<const double> t, std::span<const double> a) {
  std::vector<double> power;
  for (double x : a) power.push_back(std::pow(std::abs(x), 2.5));
  return integral(t, power).back();
}

Pulse pulse(std::span<const double> t, std::span<const double> x, double fraction) {
  Pulse p;
  if (t.empty()) return p;
  size_t top = 0;
  for (size_t i = 1; i < x.size(); ++i)
    if (std::abs(x[i]) > std::abs(x[top])) top = i;
  const double sign = x[top] < 0 ? -1 : 1, level = fraction * std::abs(x[top]);
  const auto crossing = [&](size_t in, size_t out) {  // between a sample at least at the level and one below it
    const double a = sign * x[in], b = sign * x[out], s = a > b ? (a - level) / (a - b) : 0;
    return t[in] + s * (t[out] - t[in]);
  };
  size_t first = top, last = top;
  while (first > 0 && sign * x[first - 1] >= level) --first;
  while (last + 1 < x.size() && sign * x[last + 1] >= level) ++last;
  return {x[top], t[top], first > 0 ? crossing(first, first - 1) : t[first], last + 1 < x.size() ? crossing(last, last + 1) : t[last]};
}

double level_held(std::span<const double> x, size_t n) {
  if (x.size() <= n) return std::numeric_limits<double>::quiet_NaN();
  double best = -std::numeric_limits<double>::infinity();
  std::deque<size_t> rising;  // samples of the window that can still be its least, least first
  for (size_t i = 0; i < x.size(); ++i) {
    while (!rising.empty() && x[rising.back()] >= x[i]) rising.pop_back();
    rising.push_back(i);
    if (rising.front() + n < i) rising.pop_front();
    if (i >= n) best = std::max(best, x[rising.front()]);
  }
  return best;
}

Brinkley brinkley(std::span<const double> t, const std::array<std::span<const double>, 3>& a) {
  constexpr double omega[3] = {62.8, 58.0, 52.9}, zeta[3] = {0.2, 0.09, 0.224};
  // low, moderate, high; of positive and negative response
  constexpr double up[3][3] = {{35, 40, 46}, {14, 17, 22}, {15.2, 18.0, 22.8}},
                   down[3][3] = {{28, 35, 46}, {14, 17, 22}, {13.4, 16.5, 20.4}};
  Brinkley out;
  std::array<std::vector<double>, 3> dr;
  for (int i = 0; i < 3; ++i) out.axis[i] = model_response(t, a[i], omega[i], zeta[i]), dr[i] = model_history(t, a[i], omega[i], zeta[i]);
  for (size_t n = 0; n < t.size(); ++n)
    for (int level = 0; level < 3; ++level) {
      double sum = 0;
      for (int i = 0; i < 3; ++i) sum += std::pow(dr[i][n] / (dr[i][n] > 0 ? up : down)[i][level], 2);
      out.beta[level] = std::max(out.beta[level], std::sqrt(sum));
    }
  return out;
}

}  // namespace hilo
