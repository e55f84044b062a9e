// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/resolved_band.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "post/injury/cfc.hpp"

namespace hilo {

/// The period of a method of second order is wrong by (w h)^2/12, 1 % at 18 steps a period; those of higher order resolve more than rows
/// show, of which ten are asked for.
ResolvedBand resolved_band(const RunFile& run) {
  ResolvedBand band;
  if (run.store().has("/scene")) {
    const Scene scene = scene_of(run);
    const Entry& time = scene.table("time");
    const std::string method = time.text("integrator");
    band.samples = method == "radau" || method == "gauss" ? 10 : 2 * std::numbers::pi / std::sqrt(12 * 0.01);
  }
  if (!run.store().has("/resolved")) return band;
  const std::vector<double> mesh = run.store().read<double>("/resolved");
  const auto lowest = std::min_element(mesh.begin(), mesh.end());
  if (lowest == mesh.end() || !std::isfinite(*lowest)) return band;
  band.mesh = *lowest;
  band.region = run.store().text_attribute("/resolved", "region").value_or("?");
  return band;
}

RawPeak raw_peak(const ResolvedBand& band, std::span<const double> t, std::span<const double> x, double h) {
  RawPeak p;
  if (t.size() < 3) return p;
  if (!std::ranges::all_of(x, [](double v) { return std::isfinite(v); })) {  // rows without a value say nothing
    std::vector<double> there, value;
    for (size_t i = 0; i < x.size(); ++i)
      if (std::isfinite(x[i])) there.push_back(t[i]), value.push_back(x[i]);
    return raw_peak(band, there, value, h);
  }
  size_t k = 0;
  for (size_t i = 1; i < x.size(); ++i)
    if (std::abs(x[i]) > std::abs(x[k])) k = i;
  p.t = t[k], p.value = x[k];
  p.h = h > 0 ? h : std::max(k > 0 ? t[k] - t[k - 1] : 0, k + 1 < t.size() ? t[k + 1] - t[k] : 0);
  p.band = band.at(p.h), p.region = band.is_bounded_by_mesh(p.h) ? band.region : "";
  if (p.value == 0 || !std::isfinite(p.band)) return p;
  const double cfc = p.band / 2.0775 * std::sqrt(3);  // takes a tenth of a wave at the band
  // The filter remembers less than 3/cfc.  Ends are mirrored, so that a peak there is judged as one inside.
  const auto first = std::ranges::lower_bound(t, p.t - 3 / cfc), last = std::ranges::upper_bound(t, p.t + 3 / cfc);
  const auto from = static_cast<size_t>(std::max<std::ptrdiff_t>(first - t.begin() - 1, 0)),
             count = std::min(static_cast<size_t>(last - t.begin()) + 1, t.size()) - from;
  const EvenSignal near = evenly(t.subspan(from, count), x.subspan(from, count), cfc);
  const double T = (near.t.back() - near.t.front()) / static_cast<double>(near.t.size() - 1);
  const std::vector<double> below =
      filter_both_ways(cfc_filter(cfc, T), near.x, static_cast<size_t>(std::ceil(2 / (cfc * T))), Ends::mirrored, Ends::mirrored);
  double left = 0;  // near the peak: half a wave of the band on either side
  for (size_t i = 0; i < near.t.size(); ++i)
    if (std::abs(near.t[i] - p.t) <= 0.5 / p.band) left = std::max(left, below[i] * (p.value > 0 ? 1 : -1));
  p.above = std::abs(1 - left / std::abs(p.value));
  return p;
}

std::string told(const RawPeak& p) {
  return fmt::format("{:.0f} % of it lies above {:.3g} Hz, the most that {} to 1 %", 100 * p.above, p.band,
                     !p.region.empty() ? fmt::format("cells and modes of region \"{}\" resolve", p.region)
                                       : fmt::format("steps of {:.3g} s resolve", p.h));
}

}  // namespace hilo
