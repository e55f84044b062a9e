// SPDX-License-Identifier: GPL-3.0-or-later
// [[load]] entries of kind "line": loads by length on beams of any fidelity.
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>

#include "system/beams.hpp"
#include "system/build/builder.hpp"
#include "system/linear_beams.hpp"

namespace hilo {

/// On the beams that an entry names.
void Builder::add_line_load(const Entry& e, const Load& load) {
  const std::string& on = e.text("on");
  const Vec3 from = e.vector3("force_per_length"), end = e.has("force_per_length_end") ? e.vector3("force_per_length_end") : from;
  bool any = false;
  std::vector<std::string> names;
  const auto add = [&](const Beam& beam, const std::vector<BeamCell>& cells, std::vector<LineLoad>& lines) {
    names.push_back(beam.name);
    if (fnmatch(on.c_str(), beam.name.c_str(), 0) != 0) return;
    std::vector<double> sections{0};
    for (int k = 0; k < beam.n_cells; ++k) sections.push_back(sections.back() + cells[beam.first + k].arc.law.length);
    const auto section = [&](const char* key, size_t otherwise) {
      if (!e.has(key)) return otherwise;
      const double s = e.number(key), whole = sections.back();
      const auto near = std::ranges::min_element(sections, {}, [&](double x) { return std::abs(x - s); });
      if (std::abs(*near - s) > 1e-6 * whole)
        throw Error(
            e.where(key),
            fmt::format("{}: no section of beam \"{}\" stands {:.6g} m along it, the nearest at {:.6g} m", e.label(), beam.name, s, *near),
            "a point or more cells of the beam there");
      return static_cast<size_t>(near - sections.begin());
    };
    const size_t first = section("from", 0), last = section("to", sections.size() - 1);
    if (first >= last)
      throw Error(e.where(e.has("to") ? "to" : "from"), fmt::format("{}: it ends where it begins, or before", e.label()), "to beyond from");
    const double begin = sections[first], length = sections[last] - begin;
    const auto value = [&](double s) -> Vec3 { return from + (s - begin) / length * (end - from); };
    LineLoad line{load, beam.first, {}};
    for (size_t k = 0; k + 1 < sections.size(); ++k)
      if (k >= first && k < last)
        line.at.push_back({value(sections[k]), value(sections[k + 1])});
      else
        line.at.push_back({Vec3::Zero(), Vec3::Zero()});
    lines.push_back(std::move(line));
    any = true;
  };
  Beams& beams = out_->part<Beams>();
  for (const Beam& beam : beams.beams) add(beam, beams.cells, beams.lines);
  LinearBeams& linear = out_->part<LinearBeams>();
  for (const Beam& beam : linear.beams) add(beam, linear.cells, linear.lines);
  if (!any) throw Error(e.where("on"), fmt::format("{}: no beam \"{}\"", e.label(), on), suggest(on, names));
}

}  // namespace hilo
