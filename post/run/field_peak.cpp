// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/field_peak.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/error.hpp"

namespace hilo {

std::vector<FieldPeak> field_peaks(RunFile& run, const std::vector<Step>& steps, const std::vector<bool>& wanted,
                                   const std::function<std::vector<double>(const Step&, int region)>& values, bool of_cells) {
  const Mesh& mesh = run.mesh();
  std::vector<std::vector<std::int64_t>> places(wanted.size());
  for (size_t r = 0; r < wanted.size() && !of_cells; ++r)
    if (wanted[r]) places[r] = mesh.nodes_of(mesh.region_name[r], run.path);
  for (std::int64_t c = 0; c < mesh.n_cells() && of_cells; ++c)
    if (const auto r = static_cast<size_t>(mesh.region[static_cast<size_t>(c)]); wanted[r]) places[r].push_back(c);
  const std::int64_t rows = of_cells ? mesh.n_cells() : mesh.n_nodes();
  std::vector<FieldPeak> peaks(wanted.size());
  for (const Step& step : steps) {
    const auto of_all = values(step, -1);
    if (static_cast<std::int64_t>(of_all.size()) != rows)
      throw Error(run.path, fmt::format("step {} holds {} numbers for {} {}", step.key, of_all.size(), rows, of_cells ? "cells" : "nodes"),
                  "the mesh was changed after the run");
    for (size_t r = 0; r < wanted.size(); ++r) {
      const bool own = wanted[r] && !of_cells && !run.own_nodes(static_cast<int>(r)).empty();
      const auto own_values = own ? values(step, static_cast<int>(r)) : std::vector<double>();
      const auto& value = own ? own_values : of_all;
      for (const std::int64_t n : places[r]) {
        if (!of_cells && !run.holds(n)) continue;
        const double x = value[static_cast<size_t>(n)];
        if (peaks[r].place < 0 || std::abs(x) > std::abs(peaks[r].value)) peaks[r] = {x, step.t, n};
      }
    }
  }
  return peaks;
}

std::vector<bool> warn_of_envelope(RunFile& run, const std::vector<bool>& shown, const std::string& field) {
  std::vector<bool> sharing(shown.size());
  std::vector<std::string> names;
  for (size_t r = 0; r < shown.size() && field.starts_with("von_mises_envelope"); ++r)
    if (shown[r] && !run.own_nodes(static_cast<int>(r)).empty()) sharing[r] = true, names.push_back(run.mesh().region_name[r]);
  if (!names.empty())
    warn(run.path,
         fmt::format("the envelope has one value for each node, at those shared by regions that of the first: peaks of \"{}\" there "
                     "are known at the steps written alone (peak --field von_mises; a shorter output.interval sees more)",
                     fmt::join(names, "\", \"")));
  return sharing;
}

}  // namespace hilo
