#include "linear/petsc/module.hpp"

#include <fmt/format.h>

#include <map>

#include "base/error.hpp"
#include "linear/petsc/solver.hpp"

hilo::KktSolver* hilo_make_petsc_solver(const char* kind, double tolerance, int subdomains, const char* tool) {
  const std::string word = kind;
  hilo::set_tool_name(tool);
  using hilo::petsc::Kind;
  const std::map<std::string, Kind> iterative{
      {"iterative", Kind::algebraic}, {"cg", Kind::cg}, {"bddc", Kind::bddc}, {"feti-dp", Kind::feti_dp}};
  const auto found = iterative.find(word);
  if (word != "direct" && found == iterative.end())
    throw hilo::Error("solver.kind", fmt::format("no PETSc solver \"{}\"", word), "direct, cg, iterative, bddc or feti-dp",
                      hilo::Exit::usage);
  hilo::petsc::start();
  return (word == "direct" ? hilo::petsc::make_direct(tolerance) : hilo::petsc::make_iterative(found->second, tolerance, subdomains))
      .release();
}
