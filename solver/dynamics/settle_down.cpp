// SPDX-License-Identifier: GPL-3.0-or-later
// The start from equilibrium.
//
// Where parts can touch, steps from rest lead there, so that nothing passes through anything: M (q1 - q0)/tau^2 + F(q1) = 0, of Newton's
// method to its end, with what meets looked for anew.  tau grows while steps succeed, until q1 is at rest without the mass too.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "dynamics/held.hpp"
#include "dynamics/linear_step.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/soft_contacts.hpp"
#include "dynamics/stability.hpp"
#include "dynamics/start.hpp"
#include "system/revising.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

Stage rest_at(const Config& q) {
  Stage s = stage_at(q, 0);
  s.elapsed = slow;
  return s;
}

/// A step of tau [s] from rest at `before`, from the guess q.
NewtonReport step_from_rest(RunParts& run, double tau, const Config& before, const NewtonOptions& options, Config& q,
                            std::vector<double>& lambda) {
  const System& system = run.system;
  Config acceleration;
  Unknown u(system, q, q);
  const NewtonReport report = newton(
      system, *run.solver,
      [&](const Unknown& at) {
        const double slope = 1 / (tau * tau);
        combine(acceleration, {{slope, &at.q}, {-slope, &before}});
        Stage s = rest_at(at.q);
        s.a = &acceleration, s.mass_slope = slope;
        return s;
      },
      u, lambda, options);
  q = u.q;
  return report;
}

/// What memory makes of a state: why it cannot be, or "".
std::string keep(System& system, const Config& q) {
  system.commit(q), system.advance(rest_at(q));
  return system.fault(q);
}

/// Of the equations of statics.
Residual residual_at_rest(RunParts& run, const Config& q, const std::vector<double>& lambda) {
  Config none;
  combine(none, {{0, &q}});
  Stage s = rest_at(q);
  s.a = &none;
  Residual r;
  assemble(run.system, *run.solver, s, lambda, r, false);
  return r;
}

/// By steps from rest, as long as they may be.  One that goes against the forces where it began has another state than the next below in
/// mind, as that which it comes from where that is not stable: it is shortened.
NewtonReport come_to_rest(RunParts& run) {
  System& system = run.system;
  State& state = run.state;
  const Config start = state.q;
  constexpr int most = 1000;
  constexpr double first = 0.01, longest = 20, least = 1e-9;  // [s]
  constexpr int easy = 8;                                     // iterations
  NewtonReport report;
  int iterations = 0;
  Config q, way;  // of the last step
  std::vector<double> lambda;
  combine(way, {{0, &state.q}});
  SoftContacts soft(system);
  double tau = first;
  bool stays = false, at_rest = false;  // the last step, where it began; to its tolerance
  for (int k = 0; k < most && tau > least; ++k) {
    const Residual forces = residual_at_rest(run, state.q, state.lambda);
    if (stays && system.comm->max(relative_residual(system, forces)) <= std::max(run.newton.tolerance, 2 * report.residual)) {
      if (tau == longest) return report;
      at_rest = true, tau = longest;  // a last one leaves least
    }
    if (system.largest_difference(start, state.q) > run.newton.reach * system.length) {
      report.converged = false, report.reason = "what nothing holds leaves the scene";
      return report;
    }
    int taken = 0;
    const auto begin = [&] {
      system.commit(state.q), system.settle(false);
      if (const auto carry = system.search(state.q, &way, 2)) run.follow(*carry);
      q = state.q, lambda = state.lambda;
      revise(system, rest_at(q));
    };
    begin();
    report = soft.find(
        run.newton, begin,
        [&](const NewtonOptions& how, SoftContacts::Turn turn) {
          NewtonReport r = step_from_rest(run, tau, state.q, how, q, lambda);
          taken += r.iterations;
          if (!r.converged || !turn.last) return r;
          r.reason = keep(system, q);
          stays = system.largest_difference(q, state.q) <= 1e-6 * system.length;
          if (r.reason.empty() && !stays && work_of(system, forces, Unknown(system, state.q, q).increments(system)) > 0)
            r.reason = "a step goes against the forces";
          r.converged = r.reason.empty();
          return r;
        },
        q);
    report.iterations = iterations += taken;
    if (!report.converged) {
      if (at_rest) {
        begin();
        report.converged = true, report.reason.clear();
        return report;
      }
      combine(way, {{0, &state.q}});
      tau /= 4, stays = false;
      continue;
    }
    system.settle(true);
    combine(way, {{1, &q}, {-1, &state.q}});
    std::swap(state.q, q), std::swap(state.lambda, lambda);
    if (at_rest && stays) return report;
    at_rest = false;
    tau = std::min(tau * (taken <= easy ? 3 : 1.5), longest);
  }
  if (report.converged) report.converged = false, report.reason = fmt::format("{} steps do not end at rest", most);
  return report;
}

/// From a state that is not stable to one that is; false, and all as it was, where none is found.  What touches may be in the way of the
/// straight one.
bool leave(RunParts& run, Stability& stability, const Unstable& unstable) {
  System& system = run.system;
  State& state = run.state;
  const State before = state;
  constexpr int most = 5;  // states on the way that are not stable either
  if (stability.leave(unstable, state.q, state.lambda, true, run.newton) && keep(system, state.q).empty()) return true;
  if (touching(system))
    for (const double nudge : {1e-3, -1e-3}) {
      state = before;
      std::optional<Unstable> from = unstable;
      for (int k = 0; k < most && from && !from->z.empty(); ++k) {
        std::vector<double> z = from->z;
        for (double& x : z) x *= nudge * system.length;
        system.move(state.q, z);
        if (!come_to_rest(run).converged) break;
        from = stability.look(state.q, state.lambda);
      }
      if (!from) return true;
    }
  state = before;
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
  const NewtonReport r =
      touching(system) ? come_to_rest(run) : equilibrium(system, *run.solver, state.q, state.lambda, 0, 1, true, run.newton);
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
  keep(system, state.q), system.settle(true);
  const std::string moved = told_moves(system, drawn, state.q);
  if (run.talk) fmt::print(stderr, "equilibrium after {} iterations{}\n", r.iterations, moved);
  return true;
}

}  // namespace hilo
