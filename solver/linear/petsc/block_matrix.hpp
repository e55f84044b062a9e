// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse matrix of 3 x 3 blocks, filled from dense cliques.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscmat.h>

#include <vector>

#include "linear/petsc/flexible.hpp"

namespace hilo::petsc {

class BlockMatrix final : public FlexibleMatrix {
 public:
  /// The blocks with global numbers below `n_global` (rows owned as in the map); cliques pass over the others.
  BlockMatrix(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, std::int64_t n_global);
  ~BlockMatrix() override;
  BlockMatrix(const BlockMatrix&) = delete;

  void zero() override;
  void add(int clique, std::span<const int> blocks, const double* K) override;
  void add_diagonal(int block, const double d[3]) override;
  /// Add one row of blocks by global numbers: 3 x 3 each, row major one after the other's columns (3 x 3n).
  void add_row(PetscInt row, std::span<const PetscInt> columns, const double* values);
  void assemble() override;
  Mat mat() const override { return A_; }
  PetscInt n_owned() const override { return n_owned_; }
  double bytes() const override;
  void for_each_row(const Row& row) const override;

 private:
  Mat A_ = nullptr;
  bool open_ = false;  // between zero() and assemble()
  PetscInt n_owned_ = 0;
  std::vector<PetscInt> global_;  // of local blocks; -1 for those not in the matrix
  std::vector<PetscInt> index_;   // of the clique at hand
};

}  // namespace hilo::petsc
