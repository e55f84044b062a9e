// SPDX-License-Identifier: GPL-3.0-or-later
// The symmetric part of the flexible block in single precision, the lower half of it, as a matrix of differences:
//
//     y_i = R_i x_i + sum_j A_ij (x_j - x_i),   R_i = sum_j A_ij
//
// Stiffness hardly shows in the sums of rows R, which are kept in double precision, nor the neighbours' common motion in the differences:
// what rounding takes is of the size of strains, not of displacements.  A product reads a quarter of the bytes of the whole in double
// precision.  Each rank multiplies with what its cells say of its local blocks.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscmat.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <vector>

#include "linear/petsc/flexible.hpp"
#include "linear/petsc/float_blocks.hpp"
#include "linear/petsc/lower_pattern.hpp"

namespace hilo::petsc {

class SymmetricMatrix final : public FlexibleMatrix {
 public:
  /// Blocks below `map.first_dense`, couplings of this rank's cliques.
  SymmetricMatrix(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared);
  ~SymmetricMatrix() override;
  SymmetricMatrix(const SymmetricMatrix&) = delete;

  void zero() override;
  void add(int clique, std::span<const int> blocks, const double* K) override;
  void add_diagonal(int block, const double d[3]) override;
  void assemble() override;
  Mat mat() const override { return A_; }
  PetscInt n_owned() const override { return n_owned_; }
  double bytes() const override;

  double asymmetry() const override { return std::sqrt(asymmetry_); }  // Frobenius norms

  /// Places: owned blocks first, rows by their owned numbers; then those of others.
  const LowerPattern& pattern() const { return pattern_; }
  /// A_ij of an entry of the pattern.
  Eigen::Matrix3d lower(size_t entry) const { return Eigen::Map<const Eigen::Matrix3f>(L_[entry]).cast<double>(); }
  /// A_ii of the places, owned ones with what all ranks say of them.  For all ranks at once.
  std::vector<Eigen::Matrix3d> diagonals() const;
  /// Give what this rank has of the matrix to `visit`, blocks by global numbers.
  void for_each_block(const std::function<void(PetscInt i, PetscInt j, const Eigen::Matrix3d& block)>& visit) const;
  void for_each_row(const Row& row) const override {
    for_each_block([&](PetscInt i, PetscInt j, const Eigen::Matrix3d& block) {
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> values = block;
      row(i, {&j, 1}, values.data());
    });
  }

 private:
  size_t find(int row, int column) const;
  void lend(const BlockMap& map);
  std::vector<Eigen::Matrix3d> own_diagonals() const;
  void multiply(Vec x, Vec y);

  const SharedBlocks& shared_;
  PetscInt n_owned_ = 0;
  std::vector<int> place_;        // of local blocks, -1 for dense ones
  std::vector<int> local_;        // and back
  std::vector<PetscInt> global_;  // of places
  LowerPattern pattern_;
  FloatBlocks L_;          // A_ij, j < i
  std::vector<double> R_;  // (n x 9), by columns
  struct Entry {
    size_t at;
    bool transposed;
  };
  std::vector<std::vector<size_t>> lent_;     // entries held here between blocks that another rank owns, who has them too
  std::vector<std::vector<Entry>> borrowed_;  // and those others hold of blocks owned here
  std::vector<double> all_, x_;               // a vector of local blocks (n_local x 3), of places (n x 4)
  std::vector<Lane> y_;
  double asymmetry_ = 0;  // squared
  Mat A_ = nullptr;
};

}  // namespace hilo::petsc
