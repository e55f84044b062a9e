#include "linear/petsc/module.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "linear/petsc/kinds.hpp"
#include "linear/petsc/solver.hpp"

hilo::KktSolver* hilo_make_petsc_solver(const char* kind, double tolerance, int subdomains, const char* tool) {
  hilo::set_tool_name(tool);
  const std::string word = kind;
  const hilo::petsc::SolverKind* found = hilo::petsc::find_kind(word);
  if (word != "direct" && !found) {
    std::string known = "direct";
    for (const auto& k : hilo::petsc::solver_kinds()) known += ", " + k.word;
    throw hilo::Error("solver.kind", fmt::format("no PETSc solver \"{}\"", word), known, hilo::Exit::usage);
  }
  hilo::petsc::start();
  return (found ? hilo::petsc::make_iterative(*found, tolerance, subdomains) : hilo::petsc::make_direct(tolerance)).release();
}
