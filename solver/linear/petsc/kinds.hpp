// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of iterative solvers: how each takes the flexible block of a system.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/registry.hpp"
#include "linear/petsc/flexible.hpp"

namespace hilo::petsc {

struct FlexibleInput {
  const Cliques& cliques;
  const BlockMap& map;
  const SharedBlocks& shared;
  std::vector<double> positions;  // of the owned flexible blocks, 3 each, or empty
  int subdomains;                 // of this rank, where the kind divides
};

struct PetscKind {
  std::string name;   // of the scene
  std::string title;  // before it has a system
  std::function<Flexible(const FlexibleInput&)> make;
  bool is_symmetric = false;  // conjugate gradients, on the symmetric part of the whole matrix in single precision
  bool goes_direct = false;   // MUMPS does the rest of the run where it fails; its matrix is a SubdomainMatrix
};

/// All of them.
Registry<PetscKind>& solver_kinds();

std::unique_ptr<KktSolver> make_iterative(const PetscKind& kind, double tolerance, int subdomains);

}  // namespace hilo::petsc
