// SPDX-License-Identifier: GPL-3.0-or-later
// One unsymmetric saddle-point matrix, factored by MUMPS [amestoy-2001].
#pragma once
#include "linear/petsc/solver.hpp"

namespace hilo::petsc {

class DirectSolver final : public KktSolver {
 public:
  explicit DirectSolver(double tolerance) : tolerance_(tolerance) {}
  ~DirectSolver() override { MatDestroy(&factor_); }

  void structure(const Cliques& cliques, const BlockMap& map) override;
  void zero() override { matrix_->zero(), factored_ = false; }
  void add(int clique, const double* K) override { matrix_->add(clique, (*cliques_)[clique], K); }
  void add_diagonal(int block, const double d[3]) override { matrix_->add_diagonal(block, d); }
  void sum_shared(std::span<double> local) override { shared_->sum(local); }
  SolveReport solve(std::span<const double> b, std::span<double> x, double) override;
  std::optional<int> eigenvalues_below_zero(int first_row) override;
  bool repeats_cheaply() const override { return is_mostly_dense_; }
  double bytes() const override { return matrix_->bytes() + factor_bytes_; }
  double set_up_seconds() const override { return set_up_; }
  std::string name() const override;

  /// For a solver that gives up and hands over what it has: fill it, then solve().
  BlockMatrix& matrix() { return *matrix_; }

 private:
  SolveReport analyse();
  SolveReport factor();
  SolveReport failure(const char* phase, PetscInt error) const;
  void set(PetscInt control, PetscInt value) { check(MatMumpsSetIcntl(factor_, control, value)); }
  PetscInt infog(PetscInt i) const;

  double tolerance_, factor_bytes_ = 0, set_up_ = 0;
  bool factored_ = false;         // the factors are those of the matrix
  bool is_mostly_dense_ = false;  // bodies and multipliers, whose positions shall be exact; a solve more costs messages
  static constexpr PetscInt usual_room = 35;
  PetscInt room_ = usual_room;  // for delayed pivots, of what the analysis expects [%]; doubled where it does not do
  const Cliques* cliques_ = nullptr;
  std::optional<SharedBlocks> shared_;
  mutable std::optional<BlockMatrix> matrix_;
  Mat factor_ = nullptr;
  Vector x_, b_, r_, dx_;
};

}  // namespace hilo::petsc
