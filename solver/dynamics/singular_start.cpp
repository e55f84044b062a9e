#include "dynamics/singular_start.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/start.hpp"

namespace hilo {
namespace {

Vec3 axial(const Mat3& S) { return Vec3(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1)) / 2; }

/// Velocities at `from`, taken to `to`: the spins stay.
Config carried(const Config& v, const Config& from, const Config& to) {
  Config out = v;
  for (size_t b = 0; b < v.R.size(); ++b) out.R[b] = skew(axial(v.R[b] * from.R[b].transpose())) * to.R[b];
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
             fmt::format("the branch that leads out of the singular position at the start is lost {:.2g} m away from it: velocities stay "
                         "those of all branches",
                         far / (1 << k) * system.length));
        return 0;
      }
    }
    tangent[k] = carried(s.v, s.q, *ahead);
    project_velocities(system, solver, *ahead, tangent[k], s.t);
    tangent[k] = carried(tangent[k], *ahead, s.q);
  }
  combine(s.v, {{1. / 3, &tangent[0]}, {-2, &tangent[1]}, {8. / 3, &tangent[2]}});
  set_rows(system, redundancy.at_pose);
  project_velocities(system, solver, s.q, s.v, s.t);
  set_rows(system, chosen);
  double change = 0;
  for (size_t i = 0; i < before.x.size(); ++i) change = std::max(change, (s.v.x[i] - before.x[i]).norm());
  for (size_t b = 0; b < before.c.size(); ++b)
    change = std::max({change, (s.v.c[b] - before.c[b]).norm(), (s.v.R[b] - before.R[b]).norm() / std::sqrt(2) * system.bodies[b].size});
  return system.comm->max(change);
}

}  // namespace hilo
