// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of each class of interface nodes as a dense matrix: its weights ("deluxe" [dohrmann-widlund-2016]), and where those with
// the rigid motions as constraints are not enough, further constraints from an eigenvalue problem [pechstein-dohrmann-2017].
#pragma once
#include <Eigen/Core>
#include <vector>

#include "linear/petsc/interface.hpp"
#include "linear/petsc/subdomain_factor.hpp"

namespace hilo::petsc {

/// Per class of the interface, in its order.
struct ClassMatrices {
  std::vector<Eigen::MatrixXd> weight;  // (3 n_blocks x 3 n_blocks), sum to one over the holders; empty for classes too large
  std::vector<Eigen::MatrixXd> more;    // (3 n_blocks x further constraints) orthonormal, orthogonal to the rigid motions
  std::vector<int> first_more;          // number of the first of these among those of all ranks
  int n_more = 0;                       // of all ranks
};

/// From factors of S + sum_k regular_k q_k q_k^T.  False, on some ranks at least, when the sums are not positive definite.
bool find_class_matrices(const Interface& interface, const SubdomainFactor& factor, const std::vector<double>& regular,
                         bool more_constraints, ClassMatrices& out);

}  // namespace hilo::petsc
