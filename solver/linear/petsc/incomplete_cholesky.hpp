// SPDX-License-Identifier: GPL-3.0-or-later
// Incomplete Cholesky factors without fill of a rank's own part of the flexible block [meijerink-vandervorst-1977], in 3 x 3 blocks:
//
//     sym(F) ~ L D L^T,  L_ik = (F_ik - sum_j L_ij D_j L_kj^T) D_k^-1  on the pattern of F,  D_i = F_ii - sum_k L_ik D_k L_ik^T
//
// Kept in single precision: an application reads all of it at memory speed, twice.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "linear/petsc/float_blocks.hpp"
#include "linear/petsc/lower_pattern.hpp"

namespace hilo::petsc {

class IncompleteCholesky {
 public:
  /// The blocks of one row of sym(F), those of its lower columns and the diagonal one, by its place in the pattern's order.
  using Row = std::function<void(int place, Eigen::Matrix3d* lower, Eigen::Matrix3d& diagonal)>;
  /// Of the first `n` places of a pattern that outlives the factors.  Blocks that come out indefinite are taken as they stand in F.
  void factor(const LowerPattern& pattern, int n, const Row& row);
  /// x := (L D L^T)^-1 b; both have the matrix's rows and may be the same.
  void solve(const double* b, double* x);
  double bytes() const { return L_.bytes() + inverse_.bytes() + static_cast<double>(work_.size() * sizeof(Lane)); }

 private:
  const LowerPattern* pattern_ = nullptr;
  FloatBlocks L_, inverse_;  // and of D
  std::vector<Lane> work_;
};

}  // namespace hilo::petsc
