// SPDX-License-Identifier: GPL-3.0-or-later
// The start from equilibrium.  Where parts can touch, or Newton's method alone does not, steps from rest lead there (from_rest): nothing
// passes through anything.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "dynamics/run_parts.hpp"
#include "dynamics/start/from_rest.hpp"
#include "dynamics/start/held.hpp"
#include "dynamics/start/stability.hpp"
#include "dynamics/start/start.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

/// From a state that is not stable to one that is; false, and all as it was, where none is found.  What touches may be in the way of the
/// straight one.
bool leave(RunParts& run, Stability& stability, const Unstable& unstable) {
  System& system = run.system;
  State& state = run.state;
  const State before = state;
  const Kept memory = system.memory();
  const auto go_back = [&] { run.recall(memory), state = before; };
  constexpr int most = 5;  // states on the way that are not stable either
  if (stability.leave(unstable, state.q, state.lambda, true, run.newton) && keep_at_rest(system, state.q, {}).empty()) return true;
  if (touching(system))
    for (const double nudge : {1e-3, -1e-3}) {
      go_back();
      std::optional<Unstable> from = unstable;
      for (int k = 0; k < most && from && !from->z.empty(); ++k) {
        std::vector<double> z = from->z;
        for (double& x : z) x *= nudge * system.length;
        system.move(state.q, z);
        if (!come_to_rest(run, state, {}).converged) break;
        from = stability.look(state.q, state.lambda);
      }
      if (!from) return true;
    }
  go_back();
  system.commit(state.q), system.settle(false);
  return false;
}

/// How far regions (their farthest node) and bodies (their centre, and by their turn) have moved, the farthest first.  Collective.
std::string told_moves(const System& system, const Config& from, const Config& to) {
  struct Move {
    double way, turn;  // [m], [rad]
    std::string name;
  };
  std::vector<Move> moves;
  if (system.mesh) {
    const Mesh& mesh = system.mesh->mesh;
    const std::vector<Vec3> a = system.all_nodes(from), b = system.all_nodes(to);
    std::vector<double> way(mesh.region_name.size(), 0.0);
    for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
      for (const auto n : mesh.cell(c)) way[mesh.region[c]] = std::max(way[mesh.region[c]], (b[n] - a[n]).norm());
    system.comm->max(way);
    for (size_t r = 0; r < way.size(); ++r) moves.push_back({way[r], 0, mesh.region_name[r]});
  }
  for (size_t i = 1; i < system.bodies.size(); ++i) {
    const Body& body = system.bodies[i];
    if (body.patch || system.modes_of[i] >= 0) continue;
    const Move move{(to.c[i] - from.c[i]).norm(), std::abs(Eigen::AngleAxisd(to.R[i] * from.R[i].transpose()).angle()), body.name};
    const auto region = std::ranges::find(moves, body.name, &Move::name);
    if (region == moves.end())
      moves.push_back(move);
    else
      region->turn = move.turn;
  }
  std::ranges::stable_sort(moves, std::greater{}, [&](const Move& m) { return std::max(m.way, 1e-3 * system.length * m.turn); });
  std::string text;
  constexpr size_t most = 6;
  for (size_t i = 0; i < std::min(most, moves.size()); ++i) {
    text += fmt::format("{}\"{}\" {:.3g} m", i ? ", " : "; moved: ", moves[i].name, moves[i].way);
    if (moves[i].turn > 1e-6) text += fmt::format(" and {:.3g} deg", moves[i].turn * 180 / std::numbers::pi);
  }
  return moves.size() > most ? text + fmt::format(", and {} less", moves.size() - most) : text;
}

}  // namespace

bool settle_down(RunParts& run) {
  System& system = run.system;
  State& state = run.state;
  require_rest(system, state.q, run.scene.table("time").where("start"));
  const Config drawn = state.q;
  const std::vector<double> none = state.lambda;
  NewtonReport r;
  if (!touching(system)) r = equilibrium(system, *run.solver, state.q, state.lambda, 0, 1, true, run.newton);
  if (!r.converged || !system.too_far(drawn, state.q).empty()) {
    state.q = drawn, state.lambda = none;
    r = come_to_rest(run, state, {});
  }
  if (!r.converged) {
    run.audit->start(state);
    run.recorder->first(state, run.audit->ledger());
    run.stop("no static equilibrium at the start: " + r.reason + unheld(system, system.start));
    return false;
  }
  Stability stability(system, *run.solver, 0, 1);
  if (const auto unstable = stability.look(state.q, state.lambda)) {
    const Config before = state.q;
    const std::string where = run.scene.table("time").where("start"),
                      found = "the equilibrium at the start is not stable: " + unstable->text;
    if (leave(run, stability, *unstable))
      warn(where, fmt::format("{}. The run starts from a stable one, {:.3g} m away", found, system.largest_difference(before, state.q)));
    else
      warn(where, found + ". No stable one was found: the run starts there");
  }
  if (run.talk && !stability.known()) Stability::tell_unknown(run.solver->name());
  keep_at_rest(system, state.q, {}), system.settle(true);
  const std::string moved = told_moves(system, drawn, state.q);
  if (run.talk) fmt::print(stderr, "equilibrium after {} iterations{}\n", r.iterations, moved);
  return true;
}

}  // namespace hilo
