// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/field_peak.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"

namespace hilo {

std::vector<FieldPeak> field_peaks(RunFile& run, const std::vector<Step>& steps, const std::vector<bool>& wanted,
                                   const std::function<std::vector<double>(const Step&, int region)>& values) {
  const Mesh& mesh = run.mesh();
  std::vector<std::vector<std::int64_t>> nodes(wanted.size());
  for (size_t r = 0; r < wanted.size(); ++r)
    if (wanted[r]) nodes[r] = mesh.nodes_of(mesh.region_name[r], run.path);
  std::vector<FieldPeak> peaks(wanted.size());
  for (const Step& step : steps) {
    const auto of_nodes = values(step, -1);
    if (static_cast<std::int64_t>(of_nodes.size()) != mesh.n_nodes())
      throw Error(run.path, fmt::format("step {} holds {} numbers for {} nodes", step.key, of_nodes.size(), mesh.n_nodes()),
                  "the mesh was changed after the run");
    for (size_t r = 0; r < wanted.size(); ++r) {
      const bool own = wanted[r] && !run.own_nodes(static_cast<int>(r)).empty();
      const auto own_values = own ? values(step, static_cast<int>(r)) : std::vector<double>();
      const auto& value = own ? own_values : of_nodes;
      for (const std::int64_t n : nodes[r]) {
        if (!run.holds(n)) continue;
        const double x = value[static_cast<size_t>(n)];
        if (peaks[r].node < 0 || std::abs(x) > std::abs(peaks[r].value)) peaks[r] = {x, step.t, n};
      }
    }
  }
  return peaks;
}

}  // namespace hilo
