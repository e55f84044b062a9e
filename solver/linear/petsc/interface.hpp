// SPDX-License-Identifier: GPL-3.0-or-later
// What subdomains share: their common blocks in classes - faces, edges, single nodes - and the primal constraints of each class.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "linear/petsc/subdomain_matrix.hpp"

namespace hilo::petsc {

/// A connected part of a subdomain: the rank that has it and its number there.
struct Holder {
  int rank = 0, number = 0;
  auto operator<=>(const Holder&) const = default;
};

struct InterfaceClass {
  std::vector<PetscInt> blocks;  // of one subdomain, by ascending global number
  std::vector<Holder> holders;   // ascending, the one of these blocks among them
  int piece = 0;                 // its number on this rank
  int first = 0;                 // number of its first constraint among those of all ranks
  Eigen::MatrixXd q;             // (3 n_blocks x n_constraints) orthonormal: the rigid motions of its nodes
};

struct Interface {
  std::vector<InterfaceClass> classes;  // of this rank's subdomains, by first constraint, then piece
  std::vector<int> piece;               // of each block of the subdomains
  int n_pieces = 0;                     // on this rank
  int n_constraints = 0;                // of all ranks
};

/// Blocks are in one class when the same pieces have them and they hang together.
Interface find_interface(const SubdomainMatrix& F);

/// Number of the connected part of the whole flexible mesh that each owned block belongs to.
std::vector<int> connected_parts(const SubdomainMatrix& F);

}  // namespace hilo::petsc
