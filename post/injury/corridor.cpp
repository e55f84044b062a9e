// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/corridor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "post/files/csv.hpp"
#include "post/injury/cfc.hpp"

namespace hilo {
namespace {

constexpr const char* axis_name[] = {"x", "y", "z"};

}  // namespace

Corridor read_corridor(const std::string& path) {
  const CsvTable table = read_csv(path);
  const std::vector<double> t = table.numbers_in("s", table.find("t"), "s", "s or ms");
  if (t.size() < 2 || !std::is_sorted(t.begin(), t.end())) throw Error(path, "a corridor needs rising times, two at least");
  const auto has = [&](const std::string& name) {
    return std::any_of(table.header.begin(), table.header.end(),
                       [&](const std::string& h) { return h == name || h.starts_with(name + " "); });
  };
  Corridor c;
  for (size_t a = 0; a < 3; ++a) {
    const std::string low = fmt::format("{}_low", axis_name[a]), high = fmt::format("{}_high", axis_name[a]);
    if (!has(low) && !has(high)) continue;
    const auto in_g = [&](const std::string& name) { return table.numbers_in("g", table.find(name), "g", "[g] or [m/s^2]"); };
    Corridor::Side side{t, in_g(low), in_g(high)};
    for (size_t i = 0; i < t.size(); ++i)
      if (!(side.low[i] <= side.high[i])) throw Error(path, fmt::format("{} is above {} at t = {:g}", low, high, t[i]));
    c.axis[a] = std::move(side);
  }
  if (!c.axis[0] && !c.axis[1] && !c.axis[2]) throw Error(path, "no corridor in it", "columns t, x_low, x_high (or y_, z_)");
  return c;
}

double outside(const Corridor::Side& side, const std::vector<double>& t, const std::vector<double>& x) {
  const std::vector<double> low = interpolate(side.t, side.low, t), high = interpolate(side.t, side.high, t);
  double worst = 0;
  for (size_t i = 0; i < t.size(); ++i)
    if (t[i] >= side.t.front() && t[i] <= side.t.back()) worst = std::max({worst, low[i] - x[i], x[i] - high[i]});
  return worst;
}

void add_corridor(std::vector<Crew>& crew, const Corridor& corridor) {
  for (Crew& c : crew)
    for (size_t a = 0; a < 3; ++a)
      if (corridor.axis[a])
        c.measures.push_back({fmt::format("outside_{}", axis_name[a]), "g", "farthest out of the corridor",
                              outside(*corridor.axis[a], c.record.uniform, c.change[a]), 3, 0, "inside"});
}

}  // namespace hilo
