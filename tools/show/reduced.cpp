// SPDX-License-Identifier: GPL-3.0-or-later
// Reduced regions in a summary.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "show/summary.hpp"

namespace hilo {

void add_reduced(Summary& s, const Store& store) {
  Table regions{{"region", "nodes", "modes", "first, free [Hz]", "last, free [Hz]", "interfaces"}, {}, 1, 6};
  Table held{{"region", "vibration, held [Hz]", "mass along x [%]", "along y [%]", "along z [%]"}, {}, 1, 4};
  for (const auto& link : store.list("/reduced")) {
    const std::string group = "/reduced/" + link, name = from_link_name(link);
    const auto omega2 = store.read<double>(group + "/omega2");
    const auto hertz = [&](double w2) { return fmt::format("{}", std::sqrt(std::max(0.0, w2)) / (2 * std::numbers::pi)); };
    const auto interfaces = store.has(group + "/interfaces") ? store.read_strings(group + "/interfaces") : std::vector<std::string>{};
    const auto rows = store.has(group + "/shapes") ? store.shape(group + "/shapes")[0] : 0;
    regions.rows.push_back({name, std::to_string(rows / 3), std::to_string(omega2.size()), omega2.empty() ? "-" : hertz(omega2.front()),
                            omega2.empty() ? "-" : hertz(omega2.back()), fmt::format("{}", fmt::join(interfaces, ", "))});
    if (!store.has(group + "/held")) continue;
    const auto v = store.read<double>(group + "/held");
    double sum[3] = {};
    const auto percent = [](double share) { return fmt::format("{:.2f}", 100 * share); };
    for (size_t k = 0; k + 3 < v.size(); k += 4) {
      held.rows.push_back({name, fmt::format("{}", v[k]), percent(v[k + 1]), percent(v[k + 2]), percent(v[k + 3])});
      for (size_t c = 0; c < 3; ++c) sum[c] += v[k + 1 + c];
    }
    held.rows.push_back({name, "all of these", percent(sum[0]), percent(sum[1]), percent(sum[2])});
    if (const auto next = store.number_attribute(group, "held_frequency"); next && *next > 0)
      held.rows.push_back({name, fmt::format("left out from {:.4g}", *next), "-", "-", "-"});
  }
  s.list("reduced", std::move(regions));
  s.list("held", std::move(held));
}

}  // namespace hilo
