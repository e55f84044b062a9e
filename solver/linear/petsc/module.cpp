// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/module.hpp"

#include "linear/petsc/kinds.hpp"
#include "linear/petsc/solver.hpp"

hilo::KktSolver* hilo_make_petsc_solver(const char* kind, double tolerance, int subdomains, const char* tool) {
  hilo::set_tool_name(tool);
  const std::string word = kind;
  const hilo::petsc::PetscKind* found = word == "direct" ? nullptr : &hilo::petsc::solver_kinds().at(word, "solver.kind");
  hilo::petsc::start();
  return (found ? hilo::petsc::make_iterative(*found, tolerance, subdomains) : hilo::petsc::make_direct(tolerance)).release();
}
