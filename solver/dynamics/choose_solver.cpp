// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/choose_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "system/mostly_shells.hpp"

namespace hilo {
namespace {

std::unique_ptr<KktSolver> light(const std::string& kind, const Entry&) { return make_light_solver(kind); }
std::unique_ptr<KktSolver> petsc(const std::string& kind, const Entry& e) {
  return make_petsc_solver(kind, e.number("linear_tolerance"), static_cast<int>(e.number("subdomains")));
}

bool inverts(const Scene& scene) {
  const std::string& analysis = scene.table("time").text("analysis");
  return analysis == "modes" || analysis == "buckling";
}

}  // namespace

Registry<SolverKind>& solver_kinds() {
  static Registry<SolverKind> kinds{"solver",
                                    {{"light", true, light},
                                     {"klu", true, light},
                                     {"cholesky", true, light},
                                     {"umfpack", true, light},
                                     {"direct", false, petsc},
                                     {"cg", false, petsc, true},
                                     {"iterative", false, petsc},
                                     {"bddc", false, petsc},
                                     {"feti-dp", false, petsc}}};
  return kinds;
}

std::int64_t most_factored(const Scene& scene, const System& system) {
  if (inverts(scene)) return std::numeric_limits<std::int64_t>::max();
  // factors of a surface stay thin; incomplete factors and multigrid hardly see that it bends
  constexpr std::int64_t of_cells = 300000, of_surfaces_and_bodies = 3000000;
  const BlockMap& map = system.layout.map;
  const bool stays_thin = 2 * map.first_dense < map.n_global || mostly_shells(system);
  return system.comm->size == 1 && stays_thin ? of_surfaces_and_bodies : of_cells;
}

void add_solver(const SolverKind& kind) {
  words_of("solver", "kind")->add({kind.name});
  solver_kinds().add(kind);
}

std::unique_ptr<KktSolver> choose_solver(const Scene& scene, const System& system, bool talk) {
  const Entry& e = scene.table("solver");
  std::string kind = e.text("kind");
  const auto unknowns = 3 * system.layout.map.n_global;
  std::string why = "asked for";
  if (unknowns == 0) {
    kind = "klu", why = "nothing is free to move";
  } else if (kind == "auto") {
    kind = system.comm->size > 1 ? "direct" : "light";
    constexpr std::int64_t most_beside = 1000;  // blocks of unknowns of folds, which iterative solvers eliminate densely
    if (unknowns > most_factored(scene, system) && system.layout.map.n_with_cells < most_beside) kind = "cg";
    const std::int64_t ranks = system.comm->size, flexible = 3 * system.layout.map.first_dense;
    const auto held = system.comm->sum(std::count_if(system.node_block.begin(), system.node_block.end(), [](int k) { return k >= 0; }));
    const bool is_far = ranks >= 2 && system.traits().reaches;
    if (is_far) kind = "direct";
    if (ranks >= 2 && !is_far && flexible > 3000 && (flexible / ranks <= 100000 || mostly_shells(system)) && unknowns - flexible <= 3000 &&
        2 * held < flexible)
      kind = "bddc";
    why = fmt::format("{} unknowns on {} rank{}", unknowns, system.comm->size, system.comm->size == 1 ? "" : "s");
  }
  const SolverKind& chosen = solver_kinds().at(kind, e.where("kind"));
  if (chosen.serial && system.comm->size > 1 && unknowns > 0)
    throw Error(e.where("kind"), "the light solvers are serial", "use bddc, direct, cg or iterative under mpirun");
  if (system.comm->size > 1 && system.traits().reaches && kind != "direct")
    throw Error(e.where("kind"), fmt::format("surfaces that meet or are tied run on several ranks with \"direct\" alone, not \"{}\"", kind),
                "leave solver.kind out, or run without mpirun");
  if (inverts(scene) && chosen.coarse)
    throw Error(e.where("kind"), fmt::format("modes and buckling need solves to round-off, and \"{}\" stops at four digits", kind),
                "leave solver.kind out, or use iterative where no factor finds room");
  auto solver = chosen.make(kind, e);
  solver->structure(system.layout.cliques, system.layout.map);
  if (talk) fmt::print(stderr, "solver {}: {}\n", solver->name(), why);
  return solver;
}

}  // namespace hilo
