// SPDX-License-Identifier: GPL-3.0-or-later
// The start from equilibrium.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "dynamics/held.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/stability.hpp"
#include "dynamics/start.hpp"
#include "system/revising.hpp"

namespace hilo {
namespace {

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
  NewtonOptions options = run.newton;
  options.always_chooses = revises(system);
  NewtonReport r;
  constexpr int most = 8;  // times that surfaces come to meet other facets than were near before
  for (int pass = 0; pass < most; ++pass) {
    r = equilibrium(system, *run.solver, state.q, state.lambda, 0, 1, true, options);
    if (!r.converged) break;
    const auto carry = system.search(state.q, nullptr, 0);
    if (!carry) break;
    run.follow(*carry);
  }
  if (!r.converged) {
    run.audit->start(state);
    run.recorder->first(state, run.audit->ledger());
    run.stop("no static equilibrium at the start: " + r.reason + unheld(system, system.start));
    return false;
  }
  Stage rest = stage_at(state.q, 0);
  rest.elapsed = slow;
  revise(system, rest);
  Stability stability(system, *run.solver, 0, 1);
  if (const auto unstable = stability.look(state.q, state.lambda)) {
    const Config before = state.q;
    const std::string where = run.scene.table("time").where("start"),
                      found = "the equilibrium at the start is not stable: " + unstable->text;
    if (stability.leave(*unstable, state.q, state.lambda, true, options))
      warn(where, fmt::format("{}. The run starts from a stable one, {:.3g} m away", found, system.largest_difference(before, state.q)));
    else
      warn(where, found + ". No stable one was found: the run starts there");
  }
  if (run.talk && !stability.known()) Stability::tell_unknown(run.solver->name());
  revise(system, rest), system.advance(rest), system.settle(true);
  const std::string moved = told_moves(system, drawn, state.q);
  if (run.talk) fmt::print(stderr, "equilibrium after {} iterations{}\n", r.iterations, moved);
  return true;
}

}  // namespace hilo
