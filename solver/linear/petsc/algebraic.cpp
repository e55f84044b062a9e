// Algebraic preconditioners of the assembled flexible block.
//
// Incomplete Cholesky factors, of each rank's own part, are best while a wave crosses few hundred elements in a step;
// beyond, smoothed aggregation multigrid is (docs/solvers.md).  Which one is settled by the iterations the last solve took.
#include <petscksp.h>

#include "linear/petsc/block_matrix.hpp"
#include "linear/petsc/flexible.hpp"
#include "linear/petsc/incomplete_cholesky.hpp"
#include "linear/petsc/solver.hpp"

namespace hilo::petsc {
namespace {

constexpr int many_iterations = 200;  // then multigrid takes over

class AlgebraicInverse final : public FlexibleInverse {
 public:
  AlgebraicInverse(const BlockMatrix& F, std::vector<double> positions) : F_(F), positions_(std::move(positions)) {}
  ~AlgebraicInverse() override {
    PCDestroy(&pc_);
    MatDestroy(&scalar_);
  }

  bool set_up() override {
    if (!multigrid_) {
      Mat own;
      check(MatGetDiagonalBlock(F_.mat(), &own));
      incomplete_.factor(own);
      return true;
    }
    const bool fresh = !pc_;
    if (fresh) {
      check(PCCreate(PETSC_COMM_WORLD, &pc_));
      check(PCSetOptionsPrefix(pc_, "hilo_flexible_"));
      check(PCSetErrorIfFailure(pc_, PETSC_FALSE));
    }
    check(MatConvert(F_.mat(), MATAIJ, scalar_ ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, &scalar_));
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
    int failed = reason != PC_NOERROR;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
    return !failed;
  }

  void apply(Vec b, Vec x) override {
    if (multigrid_) return check(PCApply(pc_, b, x));
    const double* in;
    check(VecGetArrayRead(b, &in));
    {
      const Values out(x);
      incomplete_.solve(in, out.data());
    }
    check(VecRestoreArrayRead(b, &in));
  }

  bool strengthen(int iterations, bool failed) override {
    if (multigrid_ || (!failed && iterations <= many_iterations)) return false;
    incomplete_ = {};
    return multigrid_ = true;
  }
  std::string name() const override { return multigrid_ ? "multigrid" : "incomplete Cholesky"; }
  double bytes() const override { return multigrid_ ? 2.5 * F_.bytes() : incomplete_.bytes(); }

 private:
  const BlockMatrix& F_;
  std::vector<double> positions_;
  bool multigrid_ = false;
  IncompleteCholesky incomplete_;
  PC pc_ = nullptr;
  Mat scalar_ = nullptr;  // F without blocks: multigrid wants it so
};

}  // namespace

std::unique_ptr<FlexibleInverse> make_algebraic_inverse(const BlockMatrix& F, std::vector<double> positions) {
  return std::make_unique<AlgebraicInverse>(F, std::move(positions));
}

}  // namespace hilo::petsc
