// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/redundancy/singular_start.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/start/start.hpp"
#include "system/collocation.hpp"

namespace hilo {
namespace {

/// Velocities at `from`, taken to `to`: the spins stay.
Config carried(const System& system, const Config& v, const Config& from, const Config& to) {
  Config out = v;
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size() && f.turns(); ++k)
      out.R[f.item[k]] = skew(axial(v.R[f.item[k]] * from.R[f.item[k]].transpose())) * to.R[f.item[k]];
  return out;
}

}  // namespace

double follow_branch(System& system, KktSolver& solver, State& s, Redundancy& redundancy, const std::vector<Active>& rows) {
  constexpr double far = 1e-3;  // over the scene's length
  const Config before = s.v;
  std::optional<Config> ahead = pose_ahead(system, s.q, s.v, s.t, far);
  if (!ahead) ahead = pose_ahead(system, s.q, s.a, s.t, far);
  for (unsigned seed = 1; seed <= 4 && !ahead; ++seed) ahead = pose_aside(system, s.q, seed, s.t, far);
  if (!ahead) return set_rows(system, rows), 0;
  choose_rows_beside(system, *ahead, redundancy);
  const std::vector<Active> chosen = active_rows(system);
  Config tangent[3], way;
  for (int k = 0; k < 3; ++k) {
    if (k > 0) {  // on the same branch
      combine(way, {{1, &*ahead}, {-1, &s.q}});
      ahead = pose_ahead(system, s.q, way, s.t, far / (1 << k));
      if (!ahead) {
        warn("",
             fmt::format("the start is a singular position, where motions of several kinds branch off. The branch of the start was lost "
                         "{:.2g} m away, so velocities mix the branches (start a little beside that position)",
                         far / (1 << k) * system.length));
        return 0;
      }
    }
    tangent[k] = carried(system, s.v, s.q, *ahead);
    project_velocities(system, solver, *ahead, tangent[k], s.t);
    tangent[k] = carried(system, tangent[k], *ahead, s.q);
  }
  combine(s.v, {{1. / 3, &tangent[0]}, {-2, &tangent[1]}, {8. / 3, &tangent[2]}});
  set_rows(system, redundancy.at_pose);
  project_velocities(system, solver, s.q, s.v, s.t);
  set_rows(system, chosen);
  return system.largest_difference(s.v, before);
}

}  // namespace hilo
