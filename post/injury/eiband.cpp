// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/injury/eiband.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "post/charts/figure.hpp"
#include "post/injury/injury.hpp"
#include "post/picture/picture.hpp"

namespace hilo {

const std::vector<Tolerance>& eiband_tolerances() {
  static const std::vector<Tolerance> all{{"towards the spine (-x), eyeballs out", 0, -1, {1e-3, 0.044, 0.2, 1}, {45, 45, 25, 13}},
                                          {"towards the breastbone (+x), eyeballs in", 0, +1, {1e-3, 0.09, 1}, {45, 45, 25}},
                                          {"towards the head (+z)", 2, +1, {1e-3, 0.04, 0.1, 0.2, 0.5}, {20, 20, 16, 10, 10}},
                                          {"towards the seat (-z)", 2, -1, {1e-3, 0.02, 0.1}, {15, 15, 10}}};
  return all;
}

HeldLevel levels_of(const Crew& crew, size_t axis, int sign) {
  std::vector<double> x;
  for (const double v : crew.change[axis]) x.push_back(sign * v);
  HeldLevel held;
  if (x.size() < 2) return held;
  const double T = (crew.record.uniform.back() - crew.record.uniform.front()) / static_cast<double>(x.size() - 1);
  const double steps = 24, start = std::max(1.0, std::ceil(1e-3 / T - 1e-9));  // a decade in so many steps, from a millisecond
  size_t before = 0;
  for (int k = 0;; ++k) {
    const auto n = static_cast<size_t>(std::lround(start * std::pow(10, k / steps)));
    if (n >= x.size()) break;
    if (n == before) continue;
    before = n;
    held.duration.push_back(static_cast<double>(n) * T), held.level.push_back(level_held(x, n));
  }
  return held;
}

void write_eiband(const std::vector<Crew>& crew, double cfc, const std::string& title, const std::string& path) {
  Figure figure;
  figure.title = fmt::format("{}: level held, CFC {:g}, over Eiband's tolerance: an overlay, not a limit", title, cfc);
  figure.width = 1280, figure.height = 1600;
  for (const Tolerance& t : eiband_tolerances()) {
    Panel panel{"Acceleration " + t.name, {"duration [s]", true, 1e-3, 2}, {"level held [g]", true, 0.01, 100}, {}};
    panel.curves.push_back({"Eiband 1959, approximate", t.duration, t.level, ink, 2.4});
    panel.curves.back().dashed = true;
    for (size_t i = 0; i < crew.size(); ++i) {
      const HeldLevel h = levels_of(crew[i], t.axis, t.sign);
      panel.curves.push_back(
          {crew[i].record.name, h.duration, h.level, curve_colour(static_cast<int>(i)), 1.8 + 1.8 * static_cast<double>(i)});
    }
    figure.panels.push_back(std::move(panel));
  }
  write_chart(figure, path);
}

}  // namespace hilo
