// SPDX-License-Identifier: GPL-3.0-or-later
// The flexible block as a sum of subdomains' matrices, one or several per rank, never assembled: what BDDC and FETI-DP start from.
// The subdomains of a rank follow each other in one block-diagonal matrix, in which a shared block has a place in each of them.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscmat.h>

#include <functional>
#include <vector>

#include "linear/petsc/flexible.hpp"

namespace hilo::petsc {

class SubdomainMatrix final : public FlexibleMatrix {
 public:
  /// Blocks below `map.first_dense`.  A subdomain is what its cliques touch, `n` on this rank; a clique that several ranks know (a spring,
  /// a joint) and that couples flexible blocks counts for the owner of the first.
  SubdomainMatrix(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, int n);
  ~SubdomainMatrix() override;
  SubdomainMatrix(const SubdomainMatrix&) = delete;

  void zero() override;
  void add(int clique, std::span<const int> blocks, const double* K) override;
  /// Shared out evenly among the subdomains that have the block, so that none is left with an empty row.
  void add_diagonal(int block, const double d[3]) override;
  void assemble() override;
  Mat mat() const override { return A_; }
  PetscInt n_owned() const override { return n_owned_; }
  double bytes() const override;

  // The subdomains, in blocks of their own numbering
  PetscInt n_blocks() const { return static_cast<PetscInt>(global_.size()); }
  std::span<const PetscInt> neighbours(PetscInt i) const {
    return {columns_.data() + start_[i], static_cast<size_t>(start_[i + 1] - start_[i])};
  }
  PetscInt global(PetscInt i) const { return global_[i]; }
  int owner(PetscInt i) const { return owner_[i]; }
  const std::vector<double>& positions() const { return X_; }  // (n_blocks x 3), or empty
  PetscInt first_owned() const { return first_; }
  /// Visit the blocks (i, j), j <= i, of the symmetric part, 3 x 3 row major.
  void for_each_symmetric_block(const std::function<void(PetscInt i, PetscInt j, const double* block)>& visit) const;

  /// Give its rows to `row` by global numbers, 3 x 3n values each (of each subdomain: to be summed).
  void for_each_row(const Row& row) const override;

 private:
  void choose_blocks(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, int n);
  void find_pattern(const Cliques& cliques);
  void make_operator();
  void multiply(Vec x, Vec y, bool transposed);

  PetscInt n_owned_ = 0, first_ = 0;
  std::vector<int> offset_;       // of each clique's blocks (n_cliques + 1)
  std::vector<PetscInt> place_;   // of each of them in the clique's subdomain, -1 for those outside
  std::vector<PetscInt> global_;  // of the subdomains' blocks
  std::vector<int> owner_;        // of the subdomains' blocks
  std::vector<double> X_;
  std::vector<char> flexible_;  // of local blocks
  std::vector<PetscInt> start_{0}, columns_;
  std::vector<std::vector<int>> holders_;  // rank of each subdomain that has the block, per owned block
  std::vector<int> owned_place_;           // owned number of each local block, -1 for others'
  std::vector<double> diagonal_;           // waiting to be shared out, 3 per owned block
  std::vector<char> waits_;
  Mat A_ = nullptr, local_ = nullptr;
  bool open_ = false;         // between zero() and assemble()
  VecScatter all_ = nullptr;  // to the subdomains' blocks
  Vec in_ = nullptr, out_ = nullptr;
};

}  // namespace hilo::petsc
