// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of what accelerations do to people, from signals taken as straight between samples.
#pragma once
#include <array>
#include <span>
#include <vector>

namespace hilo {

/// Peak of a one-mass model x'' + 2 zeta w x' + w^2 x = a(t) from rest: the largest and the smallest w^2 x, in the unit of a.  The response
/// to a piecewise linear a is exact, peaks between samples included [nigam-jennings-1969].
struct ModelResponse {
  double highest = 0, lowest = 0;
  double t_highest = 0, t_lowest = 0;  // [s]
};
ModelResponse model_response(std::span<const double> t, std::span<const double> a, double omega, double zeta);
/// w^2 x at the sample times.
std::vector<double> model_history(std::span<const double> t, std::span<const double> a, double omega, double zeta);

/// Dynamic response index of the spine for a seat's acceleration along +z, gravity taken out [g]: w = 52.9 rad/s, zeta = 0.224.
double dynamic_response_index(std::span<const double> t, std::span<const double> a);

/// Head injury criterion: max over t1 < t2 <= t1 + window of (t2 - t1) [mean of a over it]^2.5; a the resultant [g], times samples.
struct HeadInjury {
  double value = 0, t1 = 0, t2 = 0;
};
HeadInjury head_injury(std::span<const double> t, std::span<const double> a, double window);

/// Gadd's severity index: integral of a^2.5 [g^2.5 s].
double severity_index(std::span<const double> t, std::span<const double> a);

/// The stretch around the value largest in size where the signal keeps its sign and at least `fraction` of it.
struct Pulse {
  double peak = 0, t_peak = 0, begin = 0, end = 0;  // peak with its sign; [s]
};
Pulse pulse(std::span<const double> t, std::span<const double> x, double fraction = 0.5);

/// Highest level that a signal, sampled at equal intervals, holds without a break for n of them: max over i of min(x_i .. x_{i+n}); NaN for
/// a longer n than the record.
double level_held(std::span<const double> x, size_t n);

/// Brinkley's dynamic response: model responses per axis (x 62.8/0.2, y 58.0/0.09, z 52.9/0.224) and the largest
/// beta = sqrt(sum (DR_i/limit_i)^2) over time for low, moderate and high risk.
struct Brinkley {
  std::array<ModelResponse, 3> axis;  // x forward, y left, z up [g]
  std::array<double, 3> beta{};       // low, moderate, high
};
Brinkley brinkley(std::span<const double> t, const std::array<std::span<const double>, 3>& a);

}  // namespace hilo
