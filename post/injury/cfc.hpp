// SPDX-License-Identifier: GPL-3.0-or-later
// Filters and measures of accelerations, as in crash tests.
//
// Channel frequency class (SAE J211-1): a 2-pole Butterworth filter run forwards and backwards (4 poles, no phase),
//   w_d = 2 pi CFC 2.0775,  w_a = tan(w_d T/2),  D = 1 + sqrt2 w_a + w_a^2,
//   a0 = w_a^2/D,  a1 = 2 a0,  a2 = a0,  b1 = -2 (w_a^2 - 1)/D,  b2 = (-1 + sqrt2 w_a - w_a^2)/D,
//   y_n = a0 x_n + a1 x_{n-1} + a2 x_{n-2} + b1 y_{n-1} + b2 y_{n-2}.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace hilo {

struct CfcFilter {
  double a0, a1, a2, b1, b2;
};
/// Coefficients for a class and a sampling interval T [s].
CfcFilter cfc_filter(double cfc, double T);

/// How a record is continued beyond an end: by its last value there, or by its mirror image.
enum class Ends { held, mirrored };
/// Filter forwards and backwards, with `pad` samples of continuation at both ends, so that they do not ring.
std::vector<double> filter_both_ways(const CfcFilter& filter, std::span<const double> x, size_t pad, Ends front = Ends::held,
                                     Ends back = Ends::held);

/// (t, x), straight between samples, at equal intervals.  Even records (to a hundredth of their interval) keep theirs; of others the means
/// over intervals of 1/(200 CFC), which keep the area of the shortest shock.
struct EvenSignal {
  std::vector<double> t, x;
};
EvenSignal evenly(std::span<const double> t, std::span<const double> x, double cfc);
/// Linear interpolation of (t, x) at `when`.
std::vector<double> interpolate(std::span<const double> t, std::span<const double> x, std::span<const double> when);

/// One component, filtered at equal intervals.  The first value is held before the record.  After it the last one is held or the record
/// mirrored, whichever ends nearer to the mean: a shock that is over there comes once, and an oscillation above the class does
/// not pass.  Error (at `where`) when an interval of t is longer than 1/(10 CFC): such a record does not hold what the filter is to pass.
struct Filtered {
  std::vector<double> t, x;
  std::vector<double> by_ends;  // what other continuations would change
};
Filtered cfc_filtered(std::span<const double> t, std::span<const double> x, double cfc, const std::string& where);
void check_rate(std::span<const double> t, double cfc, const std::string& where);

/// The largest level that (t, x), taken as straight between samples, exceeds for `duration` in all (cumulative).  NaN for a shorter record.
double clip_level(std::span<const double> t, std::span<const double> x, double duration = 3e-3);

}  // namespace hilo
