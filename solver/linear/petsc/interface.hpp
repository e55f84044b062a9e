// What subdomains share: their common blocks in classes - faces, edges, single nodes - and the primal constraints of each class.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "linear/petsc/subdomain_matrix.hpp"

namespace hilo::petsc {

struct InterfaceClass {
  std::vector<PetscInt> blocks;  // of the subdomain, by ascending global number
  std::vector<int> ranks;        // that have it, ascending, this one among them
  int first = 0;                 // number of its first constraint among those of all ranks
  Eigen::MatrixXd q;             // (3 n_blocks x n_constraints) orthonormal: the rigid motions of its nodes
};

struct Interface {
  std::vector<InterfaceClass> classes;  // of this subdomain
  int n_constraints = 0;                // of all ranks
};

/// Blocks are in one class when the same pieces (connected parts of subdomains) have them and they hang together.
Interface find_interface(const SubdomainMatrix& F);

/// Number of the connected part of the whole flexible mesh that each owned block belongs to.
std::vector<int> connected_parts(const SubdomainMatrix& F);

}  // namespace hilo::petsc
