#include "dynamics/choose_solver.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hilo {

std::unique_ptr<KktSolver> choose_solver(const Scene& scene, const System& system, bool talk) {
  const Entry& e = scene.table("solver");
  std::string kind = e.text("kind");
  const auto unknowns = 3 * system.map.n_global;
  std::string why = "asked for";
  if (kind == "auto") {
    kind = system.comm->size > 1 ? "direct" : "light";
    if (unknowns > 300000) kind = "cg";
    const std::int64_t ranks = system.comm->size, flexible = 3 * system.map.first_dense;
    const auto held = system.comm->sum(std::count_if(system.node_block.begin(), system.node_block.end(), [](int k) { return k >= 0; }));
    if (ranks >= 2 && flexible > 3000 && flexible / ranks <= 100000 && unknowns - flexible <= 3000 && 2 * held < flexible) kind = "bddc";
    why = fmt::format("{} unknowns on {} rank{}", unknowns, system.comm->size, system.comm->size == 1 ? "" : "s");
  }
  const bool is_light = kind == "light" || kind == "klu" || kind == "cholesky" || kind == "umfpack";
  if (is_light && system.comm->size > 1)
    throw Error(e.where("kind"), "the light solvers are serial", "use bddc, direct, cg or iterative under mpirun");
  auto solver =
      is_light ? make_light_solver(kind) : make_petsc_solver(kind, e.number("linear_tolerance"), static_cast<int>(e.number("subdomains")));
  solver->structure(system.cliques, system.map);
  if (talk) fmt::print(stderr, "solver {}: {}\n", solver->name(), why);
  return solver;
}

}  // namespace hilo
