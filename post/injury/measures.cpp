// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "post/injury/cfc.hpp"
#include "post/injury/injury.hpp"
#include "post/injury/weighting.hpp"

namespace hilo {
namespace {

constexpr double g0 = 9.80665;

/// The wanted class, or the highest below it that the record holds.
double class_held(const std::vector<double>& t, double wanted) {
  double longest = 0;
  for (size_t i = 1; i < t.size(); ++i) longest = std::max(longest, t[i] - t[i - 1]);
  for (const double cfc : {1000.0, 600.0, 180.0})
    if (cfc <= wanted && longest <= 0.1 / cfc * (1 + 1e-9)) return cfc;
  return 60;
}

void add_pulses(Crew& c, double cfc) {
  constexpr const char* axis[] = {"x", "y", "z"};
  constexpr const char* way[] = {"forward", "to the left", "upward"};
  for (size_t a = 0; a < 3; ++a) {
    const Pulse p = pulse(c.record.uniform, c.change[a]);
    const auto key = [&](const char* what) { return fmt::format("{}_{}", what, axis[a]); };
    c.measures.push_back({key("peak"), "g", fmt::format("largest change {}, CFC {:g}", way[a], cfc), p.peak, 3});
    c.measures.push_back({key("t"), "ms", "its time", 1e3 * p.t_peak, 1});
    c.measures.push_back({key("width"), "ms", "its duration above half of it", 1e3 * (p.end - p.begin), 1});
  }
}

void add_impact(Crew& c, const std::array<std::vector<double>, 3>& change, const std::string& where) {
  const SensorRecord& r = c.record;
  c.head_class = class_held(r.t, 1000), c.chest_class = class_held(r.t, 180);
  std::array<std::vector<double>, 4> head, chest;
  std::vector<double> t;
  for (size_t a = 0; a < 3; ++a) {
    Filtered f = cfc_filtered(r.t, r.raw[a], c.head_class, where);
    head[a] = std::move(f.x), t = std::move(f.t);
    chest[a] = cfc_filtered(r.t, r.raw[a], c.chest_class, where).x;
  }
  const std::vector<double> h = resultant(head), ch = resultant(chest);
  c.measures.push_back(
      {"DRI", "1", "dynamic response index of the spine", dynamic_response_index(r.t, change[2]), 3, 17.7, "10 % AIS 2+, STANAG 4569"});
  c.measures.push_back(
      {"HIC15", "1", fmt::format("head injury criterion, CFC {:g}", c.head_class), head_injury(t, h, 0.015).value, 3, 700, "FMVSS 208"});
  c.measures.push_back({"HIC36", "1", "the same within 36 ms", head_injury(t, h, 0.036).value, 3, 1000, "FMVSS 208"});
  c.measures.push_back(
      {"clip_3ms", "g", fmt::format("exceeded for 3 ms in all, CFC {:g}", c.chest_class), clip_level(t, ch), 3, 60, "chest, FMVSS 208"});
  c.measures.push_back({"SI", "1", "Gadd's severity index", severity_index(t, h), 3, 1000, "Gadd"});
  const Brinkley b = brinkley(r.t, {change[0], change[1], change[2]});
  constexpr const char* axis[] = {"DR_x", "DR_y", "DR_z"};
  for (size_t a = 0; a < 3; ++a)
    c.measures.push_back(
        {axis[a], "g", "Brinkley's dynamic response", b.axis[a].highest > -b.axis[a].lowest ? b.axis[a].highest : b.axis[a].lowest, 3});
  constexpr const char* level[] = {"beta_low", "beta_moderate", "beta_high"};
  constexpr const char* risk[] = {"low", "moderate", "high"};
  for (size_t k = 0; k < 3; ++k)
    c.measures.push_back({level[k], "1", fmt::format("over the limit of {} risk", risk[k]), b.beta[k], 4, 1, "Brinkley 1990"});
}

void add_vibration(Crew& c, const std::array<std::vector<double>, 3>& change) {
  constexpr const char* axis[] = {"x", "y", "z"};
  Vibration v[3];
  for (size_t a = 0; a < 3; ++a) {
    std::vector<double> metric;
    for (const double x : change[a]) metric.push_back(g0 * x);
    v[a] = vibration(c.record.t, weighted(a == 2 ? weighting_k : weighting_d, c.record.t, metric));
  }
  for (size_t a = 0; a < 3; ++a)
    c.measures.push_back({fmt::format("aw_{}", axis[a]), "m/s^2", fmt::format("weighted r.m.s., {}", a == 2 ? "Wk" : "Wd"), v[a].rms, 4});
  c.measures.push_back({"a_v", "m/s^2", "the three together, k = 1", std::hypot(v[0].rms, v[1].rms, v[2].rms), 4});
  for (size_t a = 0; a < 3; ++a)
    c.measures.push_back({fmt::format("MTVV_{}", axis[a]), "m/s^2", "largest running r.m.s., 1 s", v[a].running, 4});
  for (size_t a = 0; a < 3; ++a) c.measures.push_back({fmt::format("VDV_{}", axis[a]), "m/s^1.75", "vibration dose value", v[a].dose, 4});
}

}  // namespace

Crew crew_of(SensorRecord record, double cfc) {
  Crew c;
  c.record = std::move(record);
  // The models start at rest under what was felt at the start (1 g upward), so that is taken out.
  std::array<std::vector<double>, 3> change;
  for (size_t a = 0; a < 3; ++a) {
    const double start = c.record.raw[a].front();
    for (const double x : c.record.raw[a]) change[a].push_back(x - start);
    for (const double x : c.record.filtered[a]) c.change[a].push_back(x - start);
  }
  add_pulses(c, cfc);
  add_impact(c, change, c.record.where);
  add_vibration(c, change);
  return c;
}

}  // namespace hilo
