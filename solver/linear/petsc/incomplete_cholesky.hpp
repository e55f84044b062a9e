// Incomplete Cholesky factors without fill of a rank's own part of the flexible block [meijerink-vandervorst-1977], in 3 x 3 blocks:
//
//     sym(F) ~ L D L^T,  L_ik = (F_ik - sum_j L_ij D_j L_kj^T) D_k^-1  on the pattern of F,  D_i = F_ii - sum_k L_ik D_k L_ik^T
//
// Kept in single precision: an application reads all of it at memory speed, twice.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscmat.h>

#include <vector>

namespace hilo::petsc {

class IncompleteCholesky {
 public:
  /// Of a sequential matrix of 3 x 3 blocks (SEQBAIJ).  Blocks that come out indefinite are taken as they stand in F.
  void factor(Mat F);
  /// x := (L D L^T)^-1 b; both have the matrix's rows.
  void solve(const double* b, double* x);
  double bytes() const { return 4. * static_cast<double>(L_.size() + inverse_.size()) + 4. * static_cast<double>(column_.size()); }

  using Lane = float __attribute__((vector_size(16)));  // a column of three, padded

 private:
  struct Block {
    Lane c[3];
  };
  void find_order(const PetscInt* ia, const PetscInt* ja, PetscInt n);

  std::vector<PetscInt> row_;       // of the matrix, for each place in the order
  std::vector<int> place_;          // and back
  std::vector<size_t> start_;       // of each row of L (n + 1)
  std::vector<int> column_;         // places, ascending
  std::vector<Block> L_, inverse_;  // and of D
  std::vector<Lane> work_;
};

}  // namespace hilo::petsc
