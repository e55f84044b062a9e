// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/corridor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  if (t.size() < 2 || std::ranges::adjacent_find(t, [](double a, double b) { return !(a <= b); }) != t.end())
    throw Error(path, "a corridor needs rising times, two at least");
  std::vector<std::string> names;
  for (const std::string& heading : table.header) names.push_back(without_unit(heading));
  const auto has = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
  std::vector<std::string> known{"t"};
  for (const char* axis : axis_name)
    for (const char* side : {"low", "high"}) known.push_back(fmt::format("{}_{}", axis, side));
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      throw Error(path, fmt::format("column \"{}\" is none of a corridor", name), fmt::format("it has {}", fmt::join(known, ", ")));
  Corridor c;
  c.path = path;
  for (size_t a = 0; a < 3; ++a) {
    const std::string low = fmt::format("{}_low", axis_name[a]), high = fmt::format("{}_high", axis_name[a]);
    if (!has(low) && !has(high)) continue;
    const auto in_g = [&](const std::string& name) { return table.numbers_in("g", table.find(name), "g", "[g] or [m/s^2]"); };
    Corridor::Side side{t, in_g(low), in_g(high)};
    for (size_t i = 0; i < t.size(); ++i) {
      if (std::isnan(side.low[i]) || std::isnan(side.high[i]))
        throw Error(path, fmt::format("{} has an empty cell at t = {:g}", std::isnan(side.low[i]) ? low : high, t[i]),
                    "fill it, or leave the row out");
      if (!(side.low[i] <= side.high[i])) throw Error(path, fmt::format("{} is above {} at t = {:g}", low, high, t[i]));
    }
    c.axis[a] = std::move(side);
  }
  if (!c.axis[0] && !c.axis[1] && !c.axis[2]) throw Error(path, "no corridor in it", "columns t, x_low, x_high (or y_, z_)");
  return c;
}

double outside(const Corridor::Side& side, const std::vector<double>& t, const std::vector<double>& x) {
  const std::vector<double> low = interpolate(side.t, side.low, t), high = interpolate(side.t, side.high, t);
  double worst = std::numeric_limits<double>::quiet_NaN();
  for (size_t i = 0; i < t.size(); ++i)
    if (side.covers(t[i])) worst = std::max({std::isnan(worst) ? 0 : worst, low[i] - x[i], x[i] - high[i]});
  return worst;
}

void add_corridor(std::vector<Crew>& crew, const Corridor& corridor) {
  for (Crew& c : crew)
    for (size_t a = 0; a < 3; ++a) {
      if (!corridor.axis[a]) continue;
      const Corridor::Side& side = *corridor.axis[a];
      const std::vector<double>&t = c.record.uniform, &x = c.change[a];
      const std::string times = fmt::format("{:g} to {:g} s", side.t.front(), side.t.back());
      const bool whole = side.covers(t.front()) && side.covers(t.back());
      c.measures.push_back({fmt::format("outside_{}", axis_name[a]), "g", "farthest out of the corridor", outside(side, t, x), 3, 0,
                            whole ? "inside" : "inside, " + times});
      const size_t k = peak_index(x);
      if (side.covers(t[k]) || std::abs(x[k]) < 1e-3) continue;  // which is written as nothing
      const double span = t.back() - t.front(), shared = std::min(side.t.back(), t.back()) - std::max(side.t.front(), t.front());
      warn(corridor.path, fmt::format("sensor \"{}\": its largest change along {}, {:.4g} g at {:.4g} s, lies outside the corridor's {}: "
                                      "{:.0f} % of the record is not compared",
                                      c.record.name, axis_name[a], x[k], t[k], times, 100 * (1 - std::max(0.0, shared) / span)));
    }
}

}  // namespace hilo
