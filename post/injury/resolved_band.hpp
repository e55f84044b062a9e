// SPDX-License-Identifier: GPL-3.0-or-later
// Up to which frequency the histories of a run mean something, and what of a peak lies above it.
#pragma once
#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include "post/run/run_file.hpp"

namespace hilo {

struct ResolvedBand {
  double samples = 0;                                     // of a period, that the method takes to a frequency right to 1 %
  double mesh = std::numeric_limits<double>::infinity();  // of the cells and modes [Hz] of
  std::string region;

  /// Where the rows of a history are h apart [Hz].
  double at(double h) const { return std::min(mesh, 1 / (samples * h)); }
  bool is_bounded_by_mesh(double h) const { return mesh < 1 / (samples * h); }
};
ResolvedBand resolved_band(const RunFile& run);

/// The value of x largest in size, and what of it lies above the band that its own steps resolve.
struct RawPeak {
  double t = 0, value = 0;  // [s], unit of x
  double band = 0, h = 0;   // [Hz]; distance of the rows there [s]
  std::string region;       // whose cells or modes bound the band; "": the step does
  double above = 0;         // share of the value that a low pass (Butterworth, forwards and backwards) at the band takes away, or adds
};
/// `h`: the step, where x is a finer resampling.
RawPeak raw_peak(const ResolvedBand& band, std::span<const double> t, std::span<const double> x, double h = 0);
/// From this share on a peak says more of step and mesh than of the scene.
inline constexpr double much_above = 0.1;
/// "27 % of it lies above 552 Hz, the most that steps of 0.0001 s resolve".
std::string told(const RawPeak& peak);

}  // namespace hilo
