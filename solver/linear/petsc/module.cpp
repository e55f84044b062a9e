#include "linear/petsc/module.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "linear/petsc/solver.hpp"

hilo::KktSolver* hilo_make_petsc_solver(const char* kind, double tolerance, const char* tool) {
  const std::string word = kind;
  hilo::set_tool_name(tool);
  if (word != "direct" && word != "iterative")
    throw hilo::Error("solver.kind", fmt::format("no PETSc solver \"{}\"", word), "direct or iterative", hilo::Exit::usage);
  hilo::petsc::start();
  return (word == "direct" ? hilo::petsc::make_direct(tolerance) : hilo::petsc::make_iterative(tolerance)).release();
}
