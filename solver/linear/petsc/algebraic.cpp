// SPDX-License-Identifier: GPL-3.0-or-later
// Algebraic preconditioners of the assembled flexible block.
//
// Incomplete Cholesky factors, of each rank's own part, are best while a wave crosses few hundred elements in a step;
// beyond, smoothed aggregation multigrid is (docs/solvers.md).  Which one is settled by the iterations the last solve took.
#include <petscksp.h>

#include <Eigen/Core>
#include <algorithm>

#include "linear/petsc/block_matrix.hpp"
#include "linear/petsc/flexible.hpp"
#include "linear/petsc/incomplete_cholesky.hpp"
#include "linear/petsc/solver.hpp"
#include "linear/petsc/symmetric_matrix.hpp"

namespace hilo::petsc {
namespace {

using Eigen::Matrix3d;

constexpr int many_iterations = 200;  // then multigrid takes over

class AlgebraicInverse : public FlexibleInverse {
 public:
  explicit AlgebraicInverse(std::vector<double> positions) : positions_(std::move(positions)) {}
  ~AlgebraicInverse() override {
    PCDestroy(&pc_);
    MatDestroy(&scalar_);
  }

  bool set_up() override {
    if (!multigrid_) {
      factor(incomplete_);
      return true;
    }
    const bool fresh = !pc_;
    if (fresh) {
      check(PCCreate(PETSC_COMM_WORLD, &pc_));
      check(PCSetOptionsPrefix(pc_, "hilo_flexible_"));
      check(PCSetErrorIfFailure(pc_, PETSC_FALSE));
    }
    check(MatConvert(assembled(), MATAIJ, scalar_ ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, &scalar_));
    check(MatSetBlockSize(scalar_, 3));
    if (fresh) set_near_null_space(scalar_, positions_);
    check(PCSetOperators(pc_, scalar_, scalar_));
    if (fresh) {
      check(PCSetType(pc_, PCGAMG));
      check(PCGAMGSetReuseInterpolation(pc_, PETSC_TRUE));
      check(PCGAMGSetNSmooths(pc_, 1));
      check(PCSetFromOptions(pc_));
    }
    check(PCSetUp(pc_));
    PCFailedReason reason;
    check(PCGetFailedReason(pc_, &reason));
    return comm().max(reason == PC_NOERROR ? 0 : 1) == 0;
  }

  void apply(Eigen::Ref<Eigen::MatrixXd> X) override {
    if (multigrid_ && !b_.exists()) b_ = Vector(static_cast<PetscInt>(X.rows())), x_ = Vector(static_cast<PetscInt>(X.rows()));
    for (Eigen::Index k = 0; k < X.cols(); ++k) {
      if (!multigrid_) {
        incomplete_.solve(X.col(k).data(), X.col(k).data());
        continue;
      }
      check(VecPlaceArray(b_, X.col(k).data()));
      check(PCApply(pc_, b_, x_));
      check(VecResetArray(b_));
      const Values x(x_);
      std::copy_n(x.data(), X.rows(), X.col(k).data());
    }
  }

  bool strengthen(int iterations, bool failed) override {
    if (multigrid_ || (!failed && iterations <= many_iterations)) return false;
    incomplete_ = {};
    return multigrid_ = true;
  }
  std::string name() const override { return multigrid_ ? "multigrid" : "incomplete Cholesky"; }
  double bytes() const override {
    MatInfo info;
    if (!multigrid_) return incomplete_.bytes();
    return scalar_ && !MatGetInfo(scalar_, MAT_LOCAL, &info) ? 2.5 * info.memory : 0;
  }

 private:
  virtual void factor(IncompleteCholesky& incomplete) = 0;
  virtual Mat assembled() = 0;

  std::vector<double> positions_;
  bool multigrid_ = false;
  IncompleteCholesky incomplete_;
  PC pc_ = nullptr;
  Mat scalar_ = nullptr;  // F without blocks: multigrid wants it so
  Vector b_, x_;
};

/// Of a whole matrix; the factors are those of its symmetric part.
class InverseOfBlocks final : public AlgebraicInverse {
 public:
  InverseOfBlocks(const BlockMatrix& F, std::vector<double> positions) : AlgebraicInverse(std::move(positions)), F_(F) {}

 private:
  void factor(IncompleteCholesky& incomplete) override {
    Mat own;
    check(MatGetDiagonalBlock(F_.mat(), &own));
    PetscInt n = 0;
    const PetscInt *ia = nullptr, *ja = nullptr;
    PetscBool done = PETSC_FALSE;
    check(MatGetRowIJ(own, 0, PETSC_FALSE, PETSC_TRUE, &n, &ia, &ja, &done));
    double* values = nullptr;  // blocks by columns
    check(MatSeqBAIJGetArray(own, &values));
    const auto n_entries = static_cast<size_t>(ia[n]);
    if (pattern_.n() != n) pattern_ = order_lower({ia, static_cast<size_t>(n) + 1}, {ja, n_entries}, n);
    const auto block = [&](PetscInt row, PetscInt column) -> Matrix3d {
      const PetscInt* at = std::lower_bound(ja + ia[row], ja + ia[row + 1], column);
      if (at == ja + ia[row + 1] || *at != column) return Matrix3d::Zero();
      return Eigen::Map<const Matrix3d>(values + 9 * (at - ja));
    };
    incomplete.factor(pattern_, n, [&](int place, Matrix3d* lower, Matrix3d& diagonal) {
      const int i = pattern_.row[place];
      for (size_t e = pattern_.start[place]; e < pattern_.start[place + 1]; ++e) {
        const int k = pattern_.row[pattern_.column[e]];
        *lower++ = (block(i, k) + block(k, i).transpose()) / 2;
      }
      const Matrix3d D = block(i, i);
      diagonal = (D + D.transpose()) / 2;
    });
    check(MatSeqBAIJRestoreArray(own, &values));
    check(MatRestoreRowIJ(own, 0, PETSC_FALSE, PETSC_TRUE, &n, &ia, &ja, &done));
  }
  Mat assembled() override { return F_.mat(); }

  const BlockMatrix& F_;
  LowerPattern pattern_;
};

class InverseOfSymmetric final : public AlgebraicInverse {
 public:
  InverseOfSymmetric(const SymmetricMatrix& F, std::function<std::unique_ptr<BlockMatrix>()> make_whole, std::vector<double> positions)
      : AlgebraicInverse(std::move(positions)), F_(F), make_whole_(std::move(make_whole)) {}

 private:
  void factor(IncompleteCholesky& incomplete) override {
    const auto D = F_.diagonals();
    const LowerPattern& pattern = F_.pattern();
    incomplete.factor(pattern, F_.n_owned(), [&](int place, Matrix3d* lower, Matrix3d& diagonal) {
      for (size_t e = pattern.start[place]; e < pattern.start[place + 1]; ++e) *lower++ = F_.lower(e);
      diagonal = (D[place] + D[place].transpose()) / 2;
    });
  }
  Mat assembled() override {
    if (!whole_) whole_ = make_whole_();
    whole_->zero();
    F_.for_each_row([&](PetscInt i, std::span<const PetscInt> columns, const double* values) { whole_->add_row(i, columns, values); });
    whole_->assemble();
    return whole_->mat();
  }

  const SymmetricMatrix& F_;
  std::function<std::unique_ptr<BlockMatrix>()> make_whole_;
  std::unique_ptr<BlockMatrix> whole_;
};

}  // namespace

std::unique_ptr<FlexibleInverse> make_algebraic_inverse(const BlockMatrix& F, std::vector<double> positions) {
  return std::make_unique<InverseOfBlocks>(F, std::move(positions));
}

std::unique_ptr<FlexibleInverse> make_algebraic_inverse(const SymmetricMatrix& F, std::function<std::unique_ptr<BlockMatrix>()> make_whole,
                                                        std::vector<double> positions) {
  return std::make_unique<InverseOfSymmetric>(F, std::move(make_whole), std::move(positions));
}

}  // namespace hilo::petsc
