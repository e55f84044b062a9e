// SPDX-License-Identifier: GPL-3.0-or-later
// Which linear solver a run takes.
#pragma once
#include <memory>

#include "base/registry.hpp"
#include "linear/kkt.hpp"
#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

/// The linear solver for the scene, its pattern set: the light one while a factor fits, CG with incomplete factors for what no factor
/// holds; on several ranks that share few nodes BDDC, in a third of the time of MUMPS and two thirds of its memory (docs/solvers.md).
std::unique_ptr<KktSolver> choose_solver(const Scene& scene, const System& system, bool talk);

/// Up to how many unknowns `auto` takes factors: more where most are of bodies and joints, or of shells, whose factors stay thin; without
/// end for modes and buckling, which solve a hundred times with one matrix, and to round-off.
std::int64_t most_factored(const Scene& scene, const System& system);

/// A word of solver.kind that is a solver; `auto` chooses among them.
struct SolverKind {
  std::string_view name;
  bool serial;
  std::unique_ptr<KktSolver> (*make)(const std::string& kind, const Entry& solver);
  bool coarse = false;  // stops at four digits: no solves to round-off, as modes and buckling need
};
Registry<SolverKind>& solver_kinds();
/// One more, from outside the tree: in the table, and a word of the scene.
void add_solver(const SolverKind& kind);

}  // namespace hilo
