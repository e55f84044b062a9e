// A sparse matrix of 3 x 3 blocks, filled from dense cliques.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscmat.h>

#include <vector>

#include "linear/kkt.hpp"
#include "linear/petsc/shared.hpp"

namespace hilo::petsc {

class BlockMatrix {
 public:
  /// The blocks with global numbers below `n_global` (rows owned as in the map); cliques pass over the others.
  BlockMatrix(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, std::int64_t n_global);
  ~BlockMatrix();
  BlockMatrix(const BlockMatrix&) = delete;

  void zero();
  void add(std::span<const int> blocks, const double* K);
  void add_diagonal(int block, const double d[3]);
  void assemble();
  Mat mat() const { return A_; }
  PetscInt n_owned() const { return n_owned_; }  // blocks
  double bytes() const;                          // of this rank

 private:
  Mat A_ = nullptr;
  PetscInt n_owned_ = 0;
  std::vector<PetscInt> global_;  // of local blocks; -1 for those not in the matrix
  std::vector<PetscInt> index_;   // of the clique at hand
};

}  // namespace hilo::petsc
