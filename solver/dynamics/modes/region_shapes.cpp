// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/region_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/record/recorder.hpp"
#include "system/linear_regions.hpp"

namespace hilo {

std::vector<std::string> write_region_shapes(System& system, const Scene& scene, const std::string& path,
                                             const std::vector<std::string>& provenance) {
  constexpr double part = 0.05;  // of the radius of gyration
  Recorder::Setup setup;
  setup.path = path, setup.fields = {"displacement", "von_mises"}, setup.provenance = provenance;
  setup.own_time = 1, setup.alternates = false, setup.is_static = true;
  Recorder recorder(system, scene, std::move(setup));
  State rest;
  rest.q = system.start;
  rest.v.resize_like(rest.q);
  rest.lambda.assign(3 * static_cast<size_t>(system.n_joint_blocks()), 0.0);
  system.place(rest.q);
  recorder.first(rest, {});
  std::vector<std::string> lines;
  for (const LinearRegion& r : system.part<LinearRegions>().regions) {
    const Modes& m = system.modes[r.modes];
    for (int j = 0; j < m.n_modes; ++j) {
      State at = rest;
      at.t = static_cast<double>(lines.size() + 1);
      at.q.eta[m.first + j / 3][j % 3] = part * system.bodies[m.body].size / m.lever[j / 3];
      system.place(at.q);
      recorder.step(at, {}, {stage_at(at.q, 0), at.lambda}, rest.v, 0);
      lines.push_back(fmt::format("{:5}  {}, mode {}: {:.6g} Hz", lines.size() + 1, system.bodies[m.body].name, j + 1,
                                  std::sqrt(std::max(0.0, r.stiffness[j])) / (2 * std::numbers::pi)));
    }
  }
  recorder.finish(true);
  return lines;
}

}  // namespace hilo
